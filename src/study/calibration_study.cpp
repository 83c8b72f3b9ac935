#include "plumb/study/calibration_study.hpp"

#include <cmath>

#include "plumb/scenario/library.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace study {
namespace {

constexpr double kG0Squared = kG0_mps2 * kG0_mps2;
constexpr double kPerG4 = 1.0 / (kG0Squared * kG0Squared);

/// E_g of the vectors that plumb gets from these sensors by least squares over the fitted axes [g0^4].
double own_cost_g4(const Datasheet& datasheet, const CommonFrame& frame, const std::vector<Station>& stations,
                   SensorSet used) {
  std::array<SensorRow, kCapacity> rows{};
  for (int i = 0; i < datasheet.size; ++i) {
    const auto s = static_cast<std::size_t>(i);
    rows[s] = datasheet.sensor[s].row;
    rows[s].axis = frame.axis[s];
  }
  const plumb::Expected<SensorArray> array = SensorArray::make(rows.data(), datasheet.size);
  if (!array) return std::nan("");
  const LeastSquares map = least_squares(*array, used);
  double sum = 0.0;
  for (const Station& station : stations) {
    Readings y{};
    for (std::size_t i = 0; i < static_cast<std::size_t>(datasheet.size); ++i)
      y[i] = station.mean[i] / frame.scale[i] - frame.bias_mps2[i];
    const Vec3 x = map.estimate(y);
    const double error = dot(x, x) - kG0Squared;
    sum += error * error;
  }
  return sum / static_cast<double>(stations.size()) * kPerG4;
}

/// Where plumb's fit stands after every iteration, the datasheet first and the finished calibration last: the same
/// point as the last iteration, turned onto the nominal axes.
std::vector<CommonFrame> own_frames(const Fits& fits, const std::vector<Station>& stations) {
  Calibrator calibrator(fits.datasheet, study_gravity(), FitOptions{});
  std::vector<CommonFrame> out = {frame_of(fits.datasheet, calibrator.parameters())};
  while (!calibrator.done()) {
    calibrator.iterate(stations.data(), static_cast<int>(stations.size()));
    out.push_back(frame_of(fits.datasheet, calibrator.parameters()));
  }
  out.back() = frame_of(*fits.own);
  return out;
}

}  // namespace

ParameterError error_of(const FitHistory& history, const IterationPoint& at) noexcept {
  const int n = history.used.size();
  ParameterError sum;
  for (int i = 0; i < n; ++i) {
    const double bias = at.parameter[bias_index(i)] - history.truth[bias_index(i)];
    const double scale = at.parameter[scale_index(n, i)] / history.truth[scale_index(n, i)] - 1.0;
    sum.bias_mps2 += bias * bias / n;
    sum.scale += scale * scale / n;
    for (int j = 0; j < n; ++j) {
      if (j == i) continue;
      const std::size_t m = misalignment_index(n, i, j);
      const double error = at.parameter[m] - history.truth[m];
      sum.misalignment += error * error / (n * (n - 1));
    }
  }
  return {std::sqrt(sum.bias_mps2), std::sqrt(sum.scale), std::sqrt(sum.misalignment)};
}

StudyExpected<CalibrationStudy> calibration_study(const scenario::Tool& tool, std::uint64_t seed) {
  StudyExpected<std::vector<Station>> stations = calibration_stations(tool, seed);
  if (!stations) return tl::unexpected<std::string>(stations.error());
  std::vector<PaperTrace> traces;
  StudyExpected<Fits> fits = fit_both(tool.datasheet, *stations, &traces);
  if (!fits) return tl::unexpected<std::string>(fits.error());
  CalibrationStudy out;
  const std::vector<CommonFrame> frames = own_frames(*fits, *stations);
  const CommonFrame truth = frame_of(tool);
  const std::vector<SensorSet> sets = fits->combinations();
  for (std::size_t k = 0; k < sets.size(); ++k) {
    FitHistory history;
    history.used = sets[k];
    const PaperFit& fit = fits->paper_fit(sets[k]);
    history.paper_converged = fit.converged;
    history.paper_rank = fit.rank;
    const std::optional<PaperParameters> real = paper_form(tool.datasheet, truth, sets[k]);
    if (!real) return tl::unexpected<std::string>("the true axes lie in one plane. Remedy: give another tool");
    history.truth = *real;
    for (int s = 0; s < traces[k].size; ++s) {
      const PaperIteration& iteration = traces[k].iteration[static_cast<std::size_t>(s)];
      history.paper.push_back({iteration.parameter, iteration.cost * kPerG4});
    }
    for (const CommonFrame& frame : frames) {
      const std::optional<PaperParameters> form = paper_form(tool.datasheet, frame, sets[k]);
      if (!form) return tl::unexpected<std::string>("the fitted axes lie in one plane. Remedy: give another tool");
      history.own.push_back({*form, own_cost_g4(tool.datasheet, frame, *stations, sets[k])});
    }
    out.history.push_back(std::move(history));
  }
  out.stations = *std::move(stations);
  out.fits = *std::move(fits);
  return out;
}

StudyExpected<Proportion> plain_inverse_ends(std::uint64_t seed, int tools) {
  PaperOptions options;
  options.step = PaperStep::plain_inverse;
  std::uint64_t ends = 0;
  constexpr std::uint64_t kFirstTool = 100;
  for (int k = 0; k < tools; ++k) {
    const std::uint64_t own_seed = scenario::derive_seed(seed, kFirstTool + static_cast<std::uint64_t>(k));
    const scenario::Tool tool = scenario::paper_tool(own_seed);
    const StudyExpected<std::vector<Station>> stations = calibration_stations(tool, own_seed);
    if (!stations) return tl::unexpected<std::string>(stations.error());
    PaperFit fit;
    const plumb::Expected<void> done =
        paper_calibrate(tool.datasheet, study_gravity(), stations->data(), static_cast<int>(stations->size()),
                        SensorSet::first(tool.datasheet.size), options, fit);
    if (!done) return tl::unexpected<std::string>(std::string("the paper's fit: ") + describe(done.error().code));
    if (fit.converged) ++ends;
  }
  return proportion(ends, static_cast<std::uint64_t>(tools));
}

}  // namespace study
}  // namespace PLUMB_ABI
}  // namespace plumb

#include "plumb/findings/fit_figures.hpp"

#include <algorithm>
#include <cmath>

namespace plumb {
inline namespace PLUMB_ABI {
namespace findings {
namespace {

double share_of(double sigma, double prior) {
  return prior > 0.0 ? std::clamp(1.0 - sigma * sigma / (prior * prior), 0.0, 1.0) : 0.0;
}

/// Variance of the length of a row and of its two tilts together, from the covariance of the calibrated rows.
void split_axis_covariance(const SensorArray& array, int i, double& along, double& across) {
  const auto entry = [&array, i](int p, int q) { return array.row_covariance(4 * i + p, 4 * i + q); };
  const Vec3& h = array.axis(i);
  along = across = 0.0;
  for (int p = 0; p < 3; ++p) {
    across += entry(p, p);
    for (int q = 0; q < 3; ++q) along += h[static_cast<std::size_t>(p)] * h[static_cast<std::size_t>(q)] * entry(p, q);
  }
  across = std::max(across - along, 0.0);
  along = std::max(along, 0.0);
}

}  // namespace

std::vector<SensorFigures> sensor_figures(const CalibrationRun& run, const io::ArrayFile& array) {
  std::vector<SensorFigures> out;
  for (int i = 0; i < array.array.size(); ++i) {
    const auto a = static_cast<std::size_t>(i);
    SensorFigures f;
    f.id = array.array.row(i).id.data();
    f.sample_noise_mg = run.told().sample_noise_mps2[a] / kMilliG0_mps2;
    out.push_back(f);
    if (!run.study.shown) continue;
    const Calibration& shown = *run.study.shown;
    const DatasheetSensor& nominal = array.datasheet.sensor[a];
    const SensorCoefficients& fitted = shown.model.sensor[a];
    double along = 0.0, across = 0.0;
    split_axis_covariance(shown.array, i, along, across);
    f.known = true;
    f.bias_mg = fitted.bias[0] / kMilliG0_mps2;
    f.bias_sigma_mg = shown.report.sigma[4 * a + 3] / kMilliG0_mps2;
    f.bias_share = shown.report.data_share[4 * a + 3];
    f.scale = fitted.scale[0] * kG0_mps2;
    f.scale_change = fitted.scale[0] / nominal.coefficients.scale[0] - 1.0;
    f.scale_sigma = std::sqrt(along);
    f.scale_share = share_of(f.scale_sigma, nominal.prior.scale);
    f.axis_shift_deg = deg_from_rad(angle_between_rad(shown.array.axis(i), array.array.axis(i)));
    f.axis_sigma_deg = deg_from_rad(std::sqrt(0.5 * across));
    f.axis_share = share_of(std::sqrt(0.5 * across), nominal.prior.axis_rad);
    f.data_share = std::min({f.bias_share, f.scale_share, f.axis_share});
    f.e_cal_mg = shown.report.e_cal_mps2[a] / kMilliG0_mps2;
    f.residual_rms_mg = shown.report.residual_rms_mps2[a] / kMilliG0_mps2;
    out.back() = f;
  }
  return out;
}

std::vector<OddStation> odd_stations(const CalibrationRun& run) {
  std::vector<OddStation> out;
  for (std::size_t k = 0; k < run.study.predicted.size(); ++k) {
    const StationPrediction& p = run.study.predicted[k];
    if (p.judged && p.sigmas > kOddStation_sigmas) out.push_back({static_cast<int>(k) + 1, p.sigmas});
  }
  std::stable_sort(out.begin(), out.end(),
                   [](const OddStation& a, const OddStation& b) { return a.sigmas > b.sigmas; });
  return out;
}

std::vector<PaperFigures> paper_figures(const PaperCalibration& paper, const io::ArrayFile& array) {
  const auto figures_of = [&array](const PaperFit& fit) {
    PaperFigures f;
    f.used = fit.used;
    f.sound = fit.sound();
    f.stop = fit.stop;
    f.iterations = fit.iterations;
    f.rank = fit.rank;
    f.start_cost = fit.start_cost;
    f.cost = fit.cost;
    f.length_error_mg = std::sqrt(fit.cost) / (2.0 * array.gravity.g_mps2) / kMilliG0_mps2;
    return f;
  };
  std::vector<PaperFigures> out = {figures_of(paper.all)};
  const int triples = array.array.size() > 3 ? paper.triples : 0;  // of three sensors the triple is all
  for (int k = 0; k < triples; ++k) out.push_back(figures_of(paper.triple[static_cast<std::size_t>(k)]));
  return out;
}

double noise_factor(const FitReport& report, const io::ArrayFile& array, int sensor) {
  return report.sample_noise_mps2[static_cast<std::size_t>(sensor)] /
         array.datasheet.sensor[static_cast<std::size_t>(sensor)].row.sigma_mps2;
}

}  // namespace findings
}  // namespace PLUMB_ABI
}  // namespace plumb

/// The noise of the stations from the median of their residuals: what outliers cannot raise.
#include <cmath>

#include "fit_internal.hpp"
#include "plumb/numeric/tails.hpp"
#include "station_solver.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

using numbers::at;

namespace fit {
namespace {

/// Residuals over their median, by magnitude: eight bins an octave, 2^-32 to 2^32 in squares. Any number of stations in
/// fixed storage; a bin is 5 % of the noise wide, and the median is read between its edges.
constexpr int kPerOctave = 8;
constexpr int kOctaves = 64;
constexpr int kBins = kPerOctave * kOctaves;

/// From zero to where the median no longer moves; one would do where all weights are equal.
constexpr int kPasses = 5;
/// Part of the outlier limit at which a residual is worth a second look.
constexpr double kPulled = 0.75;

int bin_of(double ratio) noexcept {
  if (!(ratio > 0.0)) return 0;
  int exponent = 0;
  const double mantissa = std::frexp(ratio, &exponent);  // in [0.5, 1)
  const int bin = (exponent + kOctaves / 2) * kPerOctave + static_cast<int>((mantissa - 0.5) * 2.0 * kPerOctave);
  return bin < 0 ? 0 : bin >= kBins ? kBins - 1 : bin;
}

/// Lower edge of a bin.
double edge_of(int bin) noexcept {
  const int octave = bin / kPerOctave;
  return std::ldexp(0.5 + 0.5 * (bin - octave * kPerOctave) / kPerOctave, octave - kOctaves / 2);
}

template <class Count>
double median_of(const std::array<Count, kBins>& histogram, int stations) noexcept {
  const double half = 0.5 * stations;
  double below = 0.0;
  for (int bin = 0; bin < kBins; ++bin) {
    const double here = histogram[at(bin)];
    if (below + here >= half) {
      return edge_of(bin) + (edge_of(bin + 1) - edge_of(bin)) * ((half - below) / here);
    }
    below += here;
  }
  return edge_of(kBins);
}

}  // namespace

template <class Count>
[[gnu::noinline]] double median_misfit(const Problem& problem, const Parameters& theta, double misfit_variance,
                                       int freedom, double share) noexcept {
  std::array<Count, kBins> histogram{};
  StationSolver solver(problem, theta, misfit_variance);
  int stations = 0, total_freedom = 0, last_freedom = 0;
  double expected = 1.0, variance = 0.0, rows = 0.0;
  for (int s = 0; s < problem.count; ++s) {
    if (solver.solve(problem.stations[s]) != Loaded::used) continue;
    if (solver.freedom() != last_freedom) {
      last_freedom = solver.freedom();
      expected = chi2_tail_quantile(0.5, last_freedom);
    }
    ++histogram[at(bin_of(solver.chi2 / expected))];
    ++stations;
    total_freedom += solver.freedom();
    for (int k = 0; k < solver.rows; ++k) variance += 1.0 / solver.weight[at(k)];
    rows += solver.rows;
  }
  if (stations == 0 || freedom < 1) return misfit_variance;
  // The fit has taken its share of the residuals.
  const double factor = share * median_of(histogram, stations) * total_freedom / freedom;
  return std::fmax(misfit_variance + (factor - 1.0) * variance / rows, 0.0);
}

namespace {

/// Whether some residual is far above what noise of this variance leaves.
[[gnu::noinline]] bool any_beyond(const Problem& problem, const Parameters& theta, double variance) noexcept {
  StationSolver solver(problem, theta, variance);
  for (int s = 0; s < problem.count; ++s) {
    if (solver.solve(problem.stations[s]) != Loaded::used) continue;
    const double limit = kPulled * outlier_limit(solver.freedom());
    if (solver.chi2 > limit * limit) return true;
  }
  return false;
}

}  // namespace

template <class Count>
bool stands_out(const Problem& problem, const Parameters& theta, int freedom) noexcept {
  double variance = 0.0;
  for (int pass = 0; pass < kPasses; ++pass) variance = median_misfit<Count>(problem, theta, variance, freedom, 1.0);
  return any_beyond(problem, theta, variance);
}

template double median_misfit<int>(const Problem&, const Parameters&, double, int, double) noexcept;
template double median_misfit<std::uint8_t>(const Problem&, const Parameters&, double, int, double) noexcept;
template bool stands_out<int>(const Problem&, const Parameters&, int) noexcept;
template bool stands_out<std::uint8_t>(const Problem&, const Parameters&, int) noexcept;

}  // namespace fit
}  // namespace PLUMB_ABI
}  // namespace plumb

#include "more_hours.hpp"

#include <cmath>

#include "likelihood.hpp"
#include "power_bins.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace noise {
namespace {

/// A log that is to tell more is longer by a quarter at least; lengths are tried in these steps, up to a
/// hundred times as long.
constexpr double kLengthStep = 1.25;
constexpr int kMostSteps = 21;
/// Sigmas of a 95 % interval.
constexpr double kSigmas = 1.959963984540054;

}  // namespace

std::optional<double> more_hours(Term term, double wanted, const Coefficients& noise, std::size_t readings,
                                 double period_s) {
  const bool line = term == Term::drift_rate;
  Variances true_squares = squares(noise);
  if (!line) true_squares[index(term)] = wanted * wanted;
  double times = 1.0;
  for (int step = 0; step < kMostSteps; ++step) {
    times *= kLengthStep;
    const double length = times * static_cast<double>(readings);
    const Precision at = precision(empty_bins(static_cast<std::size_t>(length), period_s), true_squares);
    const double variance = line ? at.of_slope : at.of_squares[index(term)];
    const double size = line ? std::fabs(wanted) : wanted * wanted;
    if (kSigmas * std::sqrt(variance) <= size) return (times - 1.0) * static_cast<double>(readings) * period_s / 3600.0;
  }
  return std::nullopt;
}

}  // namespace noise
}  // namespace PLUMB_ABI
}  // namespace plumb

/// The power of a log's cosine components in narrow bands, and what each term of noise adds to it (private to
/// src/noise).
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "plumb/noise/fit.hpp"
#include "plumb/noise/terms.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace noise {

/// Components of about one frequency. Under the model their power is `unit_power` times the squares of the
/// coefficients, and power_sum over that is chi-square of `count` degrees of freedom.
struct PowerBin {
  double frequency_hz = 0.0;
  double count = 0.0;
  double power_sum = 0.0;
  Variances unit_power{};
  /// Of a bin of one component that a line shows in: the component, and that of a line of slope 1 a second. Else 0.
  double component = 0.0;
  double component_of_line = 0.0;
};

/// Of readings without their line. The time is linear in their number: long logs are cut into pieces for their high
/// frequencies, and averaged for the low ones. Frequencies inside `left_out` do not count.
std::vector<PowerBin> power_bins(std::vector<double> readings, double period_s, const std::vector<Band>& left_out);

/// The same bins of a log of `readings` samples, with no data in them: what such a log would show.
std::vector<PowerBin> empty_bins(std::size_t readings, double period_s);

/// The longest piece of such a log that is transformed at its own rate.
std::size_t longest_piece_of_fit(std::size_t readings) noexcept;

/// The line through the readings by least squares, taken off them; returns its slope [unit/s].
double take_line_off(std::vector<double>& readings, double period_s) noexcept;

}  // namespace noise
}  // namespace PLUMB_ABI
}  // namespace plumb

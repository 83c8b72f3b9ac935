/// Errors that a tool carries from station to station, one by one.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "plumb/survey/checks.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace survey {

/// reading = (1 + scale) true + bias, on each axis by itself.
enum class Term : std::uint8_t {
  accelerometer_bias_x,
  accelerometer_bias_y,
  accelerometer_bias_z,
  accelerometer_scale_x,
  accelerometer_scale_y,
  accelerometer_scale_z,
  magnetometer_bias_x,
  magnetometer_bias_y,
  magnetometer_bias_z,  ///< axial interference of the drill string is part of it, and cannot be told from it
  magnetometer_scale_x,
  magnetometer_scale_y,
  magnetometer_scale_z,
};
inline constexpr std::size_t kTermCount = 12;
const char* to_string(Term term) noexcept;  ///< "magnetometer bias z"
const char* unit_of(Term term) noexcept;    ///< "m/s^2", "T" or "1"
double sigma_of(Term term, const ToolErrors& tool) noexcept;

/// Values of all terms, by number. [m/s^2, T, 1]
using TermValues = std::array<double, kTermCount>;

/// The station with these errors taken off.
Measurement without(const TermValues& errors, const Measurement& station) noexcept;

/// What the six components change with each term of a station, row-major 6 x 12: the identity for a bias, the component
/// for a scale.
std::array<double, 72> term_weights(const Measurement& station) noexcept;

/// A station with what it is compared with. Sigmas `common` of a reference err alike at all stations of a survey.
struct ReferencedStation {
  Measurement measured;
  Reference reference;
};

}  // namespace survey
}  // namespace PLUMB_ABI
}  // namespace plumb

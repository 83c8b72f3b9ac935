/// What a column of a table holds, by its name (private to src/logs).
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "plumb/core/config.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace logs {

enum class ColumnKind : std::uint8_t {
  other,
  time,
  instance,     ///< which of several chips a row is of
  device,       ///< its number
  force,        ///< an accelerometer's
  rate,         ///< a gyroscope's
  temperature,  ///< in degrees Celsius
  axis_alone,   ///< "x": of what, the other columns have to say
};

enum class ColumnUnit : std::uint8_t {
  none,     ///< the name says none
  unknown,  ///< the name says one that is not known here
  mps2,
  g,
  mg,
  gal,
  ftps2,
  radps,
  degps,
  s,
  ms,
  us,
  ns,
};

struct ColumnName {
  ColumnKind kind = ColumnKind::other;
  int axis = -1;  ///< 0, 1, 2
  ColumnUnit unit = ColumnUnit::none;
  std::string group;  ///< what tells the columns of one chip from those of another; empty where nothing does
};

/// "acc_x [m/s^2]", "ax_g", "accelerometer_m_s2[0]", "field.linear_acceleration.x", "Accel-X (g)", "time (us)".
ColumnName column_name(std::string_view header);

/// "m/s^2", "g", "deg/s", "us", with or without brackets: what `ColumnName::unit` says of it.
ColumnUnit unit_of(std::string_view text);
/// m/s^2 in one of them, or rad/s in one; 0 for what is neither.
double factor_of(ColumnUnit unit) noexcept;
const char* to_string(ColumnUnit unit) noexcept;

}  // namespace logs
}  // namespace PLUMB_ABI
}  // namespace plumb

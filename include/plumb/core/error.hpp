/// Errors as values: a code, the index of what was wrong, and the figure that broke the rule.
/// Nothing in layers 1 to 4 throws, aborts or allocates; bad input comes back as an `Error`.
#pragma once

#include <cstdint>
#include <tl/expected.hpp>

#include "plumb/core/config.hpp"
#include "plumb/core/detail/fields.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

enum class Errc : std::uint8_t {
  ok = 0,
  too_few_sensors,       ///< value = number given, limit = 3
  too_many_sensors,      ///< value = number given, limit = capacity
  axis_not_unit,         ///< index = sensor, value = |h|, limit = 1
  axes_rank_deficient,   ///< value = smallest singular value of H
  duplicate_id,          ///< index = the later sensor
  empty_id,              ///< index = sensor
  sigma_not_positive,    ///< index = sensor, value = sigma
  not_finite,            ///< index = position of the value
  out_of_range,          ///< index = field, value = given, limit = the bound it broke
  range_too_small,       ///< full scale below gravity plus margin: index = sensor
  too_few_stations,      ///< value = given, limit = needed
  unobservable,          ///< value = rank, limit = rank needed
  diverged,              ///< value = cost
  implausible,           ///< index = sensor, value = the parameter, limit = its physical bound
  poor_fit,              ///< value = residual, limit = allowed
  not_calibrated,        ///< no accepted calibration
  wrong_key,             ///< reset key does not match
  not_invertible,        ///< cross-axis matrix of the sensor model is singular
  wrong_mode,            ///< mode "paper" was given to HealthMonitor, or "plumb" to PaperMonitor
  wrong_state,           ///< the state machine does not take this request now: value = state (HealthState)
  not_confirmed,         ///< a station held out of the fit contradicts it: index = station, value = statistic
  not_unique,            ///< many parameter sets say the same: value = sensors, limit = most that give one set
  too_few_levels,        ///< temperature levels below those that the order needs: value = given, limit = needed
  implausible_gravity,   ///< not gravity near the Earth's surface: index 0 = length, 1 = sigma; value, limit [m/s^2]
  buffer_too_small,      ///< value = bytes given, limit = bytes needed
  snapshot_truncated,    ///< value = bytes given, limit = bytes that the snapshot claims to have
  snapshot_damaged,      ///< no snapshot at all, or its check sum does not fit
  snapshot_older,        ///< value = its format, limit = the format that is read
  snapshot_newer,        ///< value = its format, limit = the format that is read
  snapshot_capacity,     ///< value = its capacity, limit = that of this build
  snapshot_foreign,      ///< of another configuration, array or calibration
  snapshot_implausible,  ///< intact, yet nothing that a monitor can have remembered
  frame_not_orthogonal,  ///< index = row of the output frame, value = what a product of rows is off by, limit = allowed
  may_accelerate         ///< no fit where an acceleration is allowed for: value = its bound [m/s^2], limit = 0
};
inline constexpr Errc kLastErrc = Errc::may_accelerate;

struct Error {
  Errc code = Errc::ok;
  int index = -1;      ///< sensor, station or field, -1 where none applies
  double value = 0.0;  ///< what was found
  double limit = 0.0;  ///< what would have been allowed

  friend constexpr bool operator==(const Error& a, const Error& b) noexcept {
    return a.code == b.code && a.index == b.index;
  }
  static constexpr auto fields() noexcept {
    return field_list(up_to(&Error::code, kLastErrc), within(&Error::index, -1, 1000), any(&Error::value),
                      any(&Error::limit));
  }
};

template <class T>
using Expected = tl::expected<T, Error>;

inline tl::unexpected<Error> fail(Errc code, int index = -1, double value = 0.0, double limit = 0.0) noexcept {
  return tl::unexpected<Error>(Error{code, index, value, limit});
}

/// What is wrong, in a few words ("axis is not of unit length"). Never null.
const char* describe(Errc code) noexcept;

/// How to mend it, as an instruction ("divide the axis by its length"). Never null.
const char* remedy(Errc code) noexcept;

}  // namespace PLUMB_ABI
}  // namespace plumb

/// How far an in-flight recalibration has come, and what it asks for.
#pragma once

#include <cstdint>

#include "plumb/core/detail/flag.hpp"
#include "plumb/core/error.hpp"
#include "plumb/core/sensor_set.hpp"
#include "plumb/core/vec3.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

enum class RecalibrationPhase : std::uint8_t { idle, collecting, fitting, accepted };
const char* to_string(RecalibrationPhase phase) noexcept;

struct RecalibrationProgress {
  RecalibrationPhase phase = RecalibrationPhase::idle;
  Flag offered;             ///< the host's calibration is on trial: no fit is made, every station is a proof
  int stations = 0;         ///< entered and used by the fit
  int held_out = 0;         ///< entered and kept for the proof
  int stations_wanted = 0;  ///< still missing, of either kind; 0 unless collecting
  SensorSet lacking;        ///< sensors along whose axis gravity has not changed enough to tell bias from scale
  Vec3 wanted_direction{};  ///< unit vector of gravity that would help most; zero where nothing is asked for
  Error last_refusal;       ///< why the last fit was not accepted; `ok` where none was refused

  static constexpr auto fields() noexcept {
    using P = RecalibrationProgress;
    return field_list(up_to(&P::phase, RecalibrationPhase::accepted), &P::offered, within(&P::stations, 0, 1000),
                      within(&P::held_out, 0, 1000), within(&P::stations_wanted, 0, 1000), &P::lacking,
                      &P::wanted_direction, &P::last_refusal);
  }
};

}  // namespace PLUMB_ABI
}  // namespace plumb

/// Raw means of one block or of one station, with the direction that the calibration in force made of them.
#pragma once

#include <array>

#include "plumb/core/detail/fields.hpp"
#include "plumb/core/vec3.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

/// Raw means of one block or of one station.
struct StationMean {
  std::array<double, kCapacity> raw{};
  Vec3 direction{};  ///< of gravity, unit vector in the tool frame, by the calibration in force
  double temperature_degc = 0.0;
  double samples = 0.0;  ///< N behind the means; 0 = nothing here

  bool plausible() const noexcept { return samples >= 0.0; }
  static constexpr auto fields() noexcept {
    using S = StationMean;
    return field_list(per_sensor(any(&S::raw)), any(&S::direction), any(&S::temperature_degc), &S::samples);
  }
};

}  // namespace PLUMB_ABI
}  // namespace plumb

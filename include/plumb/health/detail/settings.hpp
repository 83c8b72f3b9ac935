/// What a monitor was configured with, and the limits that follow from it. No step writes to it, but that the limits of
/// the triples are those of the axes in force.
#pragma once

#include <array>
#include <cstdint>

#include "plumb/core/detail/flag.hpp"
#include "plumb/detection/set_test.hpp"
#include "plumb/health/monitor_config.hpp"
#include "plumb/health/monitor_setup.hpp"
#include "plumb/health/stability.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

struct Settings {
  MonitorConfig config;
  Mat3 frame{1, 0, 0, 0, 1, 0, 0, 0, 1};  ///< of the output
  std::array<float, kCapacity> resolution_mps2{};
  std::array<StabilityNow, kCapacity> stability{};
  std::array<Vec3, kCapacity> lever_arm_m{};
  TestLimits limits;
  double scatter_factor = 0.0;    ///< scatter of a channel over its noise, at rest up to this
  double mae_quantile = 0.0;      ///< of the mean absolute error of one triple, in sigmas
  double k_integrity = 0.0;       ///< sigmas that the integrity risk leaves
  int protection_faults = 1;      ///< K of the priors
  bool stability_stated = false;  ///< of every sensor
  Flag lever_arms_known;          ///< read in every row, before the storage has been compared
  std::uint64_t identity = 0;     ///< of the setup, gravity omitted

  static constexpr auto fields() noexcept {
    using S = Settings;
    return field_list(not_stored(&S::config), not_stored(&S::frame), not_stored(&S::resolution_mps2),
                      not_stored(&S::stability), not_stored(&S::lever_arm_m), not_stored(&S::limits),
                      not_stored(&S::scatter_factor), not_stored(&S::mae_quantile), not_stored(&S::k_integrity),
                      not_stored(&S::protection_faults), not_stored(&S::stability_stated),
                      not_stored(&S::lever_arms_known), not_stored(&S::identity));
  }
};

}  // namespace PLUMB_ABI
}  // namespace plumb

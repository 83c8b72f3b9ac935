/// How the tool turns, as far as the host knows, and how it should be turned.
#pragma once

#include "plumb/core/detail/fields.hpp"
#include "plumb/core/vec3.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

/// Set by the host between steps; holds until set again. A sensor at r feels w x (w x r) beside gravity, which
/// parity cannot tell from a fault. A changing rate is not modelled: then say that it is not known.
struct Rotation {
  bool turning = false;
  bool rate_known = false;
  Vec3 rate_radps{};  ///< tool frame

  static constexpr auto fields() noexcept {
    return field_list(&Rotation::turning, &Rotation::rate_known, &Rotation::rate_radps);
  }
};

/// "Rotate the tool", for a machine: gravity has to change by `change_mps2` along `along` before the explanations that
/// are still consistent can be distinguished (theorem T9: a wrong one that passes at one attitude misses its length at
/// another by the fault times that change over G).
struct RotationRequest {
  bool wanted = false;
  Vec3 along{};              ///< unit vector, output frame; zero: any turn does
  double change_mps2 = 0.0;  ///< of gravity along it; beyond 2 G no turn is enough
  double angle_rad = 0.0;    ///< least turn that counts as another attitude

  static constexpr auto fields() noexcept {
    using R = RotationRequest;
    return field_list(&R::wanted, any(&R::along), any(&R::change_mps2), any(&R::angle_rad));
  }
};

}  // namespace PLUMB_ABI
}  // namespace plumb

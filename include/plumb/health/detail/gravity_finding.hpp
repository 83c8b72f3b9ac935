/// What the length of the vector over many attitudes says of gravity, what has been reported, and by how much gravity
/// is taken to be known worse for it.
#pragma once

#include "plumb/health/detail/block_report.hpp"
#include "plumb/health/reference_study.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

class GravityFinding {
 public:
  struct Terms {
    const Settings& settings;
    const InForce& in_force;
    const BlockEvidence& evidence;
    SensorSet in_service;
    bool trusted = false;       ///< a passed block, and the tool is not in doubt
    bool corroborated = false;  ///< every sensor of the array serves, and none is doubted
  };
  /// What is new. `widen_mps2`: to be added to three sigma of gravity; 0 = nothing.
  struct News {
    bool told = false, noticed = false;
    double widen_mps2 = 0.0;
    NormMismatch finding;
  };

  void clear() noexcept { *this = GravityFinding{}; }
  /// Sensors or gravity are others: what was read does not go with what will be.
  void forget_attitudes() noexcept { study_.clear(); }
  /// The host has stated another gravity. True where the finding was about the other one, and is withdrawn.
  bool withdraw() noexcept;
  /// One block at rest.
  News study(const Terms& terms, const BlockReport& report) noexcept;

  NormMismatchKind told() const noexcept { return told_; }
  /// What may have turned the direction beside an offset that gravity was widened for, of which no test tells any more.
  double turn_rad() const noexcept { return widened_mps2_ > 0.0 ? turn_rad_ : 0.0; }

 private:
  bool learn(const Terms& terms, const BlockReport& report) noexcept;
  News tell(const Terms& terms) noexcept;

  ReferenceStudy study_;
  double turn_rad_ = 0.0;
  double widened_mps2_ = 0.0;  ///< part of three sigma of gravity that was found, not stated
  NormMismatchKind told_ = NormMismatchKind::none;

  friend struct FieldsOf;
  static constexpr auto fields() noexcept {
    using G = GravityFinding;
    return field_list(&G::study_, &G::turn_rad_, &G::widened_mps2_, up_to(&G::told_, NormMismatchKind::common_bias));
  }
};

}  // namespace PLUMB_ABI
}  // namespace plumb

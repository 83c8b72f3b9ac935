/// Does a station agree with what is known of gravity and of the field?
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "plumb/gravity/gravity.hpp"
#include "plumb/survey/attitude.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace survey {

/// What the length of gravity, the length of the field and its dip should be at a station.
struct Reference {
  GravityReference gravity;
  geomagnetic::FieldReference field;
};

enum class LimitKind : std::uint8_t {
  from_uncertainty,  ///< k sigma of measurement and reference together, k from the rate of false alarms
  fixed,             ///< the usual numbers, whatever the tool and the place
};
const char* to_string(LimitKind kind) noexcept;

/// B 300 nT and dip 0.25 deg: ISCWSA e-book, section 22.1. It names none for gravity: 2.5 mg is common practice,
/// without a source that could be cited.
struct FixedLimits {
  double gravity_mps2 = 2.5e-3 * kG0_mps2;
  double field_tesla = 300e-9;
  double dip_rad = rad_from_deg(0.25);
};

struct CheckSettings {
  LimitKind limits = LimitKind::from_uncertainty;
  double false_alarm = 0.0027;  ///< of each check at each station: 3 sigma
  FixedLimits fixed;
};

struct Check {
  double measured = 0.0;
  double reference = 0.0;
  double sigma = 0.0;  ///< of the difference
  double limit = 0.0;  ///< with the bounds of biases in it (from_uncertainty)
  bool passed = false;

  double difference() const noexcept { return measured - reference; }
};

/// In m/s^2, tesla and rad.
struct StationChecks {
  Check gravity, field, dip;

  bool field_passed() const noexcept { return field.passed && dip.passed; }
};

/// `total` as for `attitude_of`. What is not finite fails. The three have errors in common (gravity in the dip): each
/// is judged by itself.
StationChecks check_station(const Measurement& station, const Covariance6& total, const Reference& reference,
                            const CheckSettings& settings);

enum class StationStatus : std::uint8_t {
  accepted,          ///< every check passed
  inclination_only,  ///< gravity passed, the field did not: no azimuth
  rejected,          ///< gravity failed: nothing of it is to be used
};
const char* to_string(StationStatus status) noexcept;  ///< "accepted", "inclination only", "rejected"

/// A station, judged. Azimuths are there only where all three checks passed; inclination and toolface where gravity
/// did.
struct SurveyStation {
  Measurement measured;
  Reference reference;
  StationChecks checks;
  StationStatus status = StationStatus::rejected;
  Attitude attitude;
  OrUndefined<TrueAzimuth> true_azimuth;
  OrUndefined<GridAzimuth> grid_azimuth;

  /// Letters of what is wrong: G, B, D of the checks that failed, V no azimuth for being vertical, H none for want of a
  /// horizontal field, N not finite; empty: nothing.
  std::string flags() const;
};

struct StationSettings {
  ToolErrors tool = iscwsa_tool();
  CheckSettings checks;
  Convergence convergence;
};

SurveyStation judge_station(const Measurement& station, const Reference& reference, const StationSettings& settings);

}  // namespace survey
}  // namespace PLUMB_ABI
}  // namespace plumb

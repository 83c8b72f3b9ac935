/// The health of one tool over one run, as a directional engineer asks for it: every station with its colour and why,
/// every event, the extremes, and whether the tool may be surveyed with. It takes the verdicts as they come; what it
/// keeps grows with stations and events, not with samples. docs/health-report.md states the rules.
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "plumb/core/sample.hpp"
#include "plumb/health/verdict.hpp"
#include "plumb/navigation/tilt.hpp"
#include "plumb/verification/turn_advice.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace verification {

/// Green: use it. Orange: for orientation only. Red: do not use it.
enum class Colour : std::uint8_t { green, orange, red };
const char* to_string(Colour colour) noexcept;

/// Why a station is not green. Up to `last_red` red, the rest orange.
enum class StationReason : std::uint8_t {
  failed,        ///< FAILED (latched): the fault could not be isolated
  no_direction,  ///< the output is invalid, or there is no vector
  alarm,         ///< a test is beyond its limit and no sensor could be excluded
  common_bias,   ///< the sensors share a bias
  length_far,    ///< |G| off by more than twice its limit
  last_red = length_far,
  length,         ///< |G| beyond its limit
  norm_mismatch,  ///< the monitor doubts the length of gravity
  unconfirmed,    ///< the monitor is not yet validated, or in doubt
  degraded,       ///< no redundancy left
  no_bound,       ///< nothing bounds the error
  wide_bound,     ///< the bound is beyond the alert limit
  temperature,    ///< outside the calibrated span, or changing too fast
  calibration,    ///< coefficients that none could check
  changed,        ///< good at its end, but not all the time
};
inline constexpr int kStationReasons = static_cast<int>(StationReason::changed) + 1;
const char* to_string(StationReason reason) noexcept;
/// For someone who has not read the manual.
const char* explain(StationReason reason) noexcept;

/// |G| is green within this many standard deviations of reference, noise and calibration together, orange within twice
/// as many.
inline constexpr double kLengthSigmas = 3.0;

/// One still stretch. What a survey would take from it is what its last block says; the extremes are over all blocks.
struct StationHealth {
  std::int64_t label = -1;  ///< of the log; -1 = none
  double begin_s = 0.0, end_s = 0.0;
  double depth_m = std::numeric_limits<double>::quiet_NaN();  ///< last known at the station
  double temperature_degc = 0.0;
  int blocks = 0;
  HealthState state = HealthState::suspect;
  Validity validity = Validity::invalid;
  Cause cause = Cause::none;
  Cause decided_by = Cause::none;
  double statistic = 0.0, limit = 0.0;
  Vec3 gravity_mps2{};       ///< tool frame
  double length_mps2 = 0.0;  ///< |G|
  double reference_mps2 = 0.0;
  double length_limit_mps2 = 0.0;  ///< of | |G| - reference |: kLengthSigmas, and the acceleration allowed for
  Tilt tilt;
  bool protected_by_bound = false, alert = true;
  double protection_calibrated_axes_rad = 0.0, protection_housing_rad = 0.0, toolface_protection_housing_rad = 0.0;
  std::uint16_t usable = 0;
  NormMismatchKind reference = NormMismatchKind::none;
  SensorSet used, provisionally_excluded, excluded, absent;
  // Over all blocks.
  Validity worst_validity = Validity::valid;
  double worst_ratio = 0.0;  ///< statistic over limit
  double worst_off_mps2 = 0.0;
  int changes = 0;  ///< events at the station

  double off_mps2() const noexcept { return length_mps2 - reference_mps2; }
};

/// The rule. Empty = green.
std::vector<StationReason> reasons_against(const StationHealth& station);
Colour colour_of(const StationHealth& station);

/// A record with what single channels show at that moment: of the sensors that it names, and of those in service.
struct NamedEvent : TransitionRecord {
  SensorSet noisy, stuck, clipped;
};
NamedEvent named_event(const Verdict& verdict) noexcept;

/// Extremes and counts of the run.
struct RunExtremes {
  std::uint64_t samples = 0, blocks = 0, refused = 0;
  double first_s = 0.0, last_s = 0.0;
  bool temperature_known = false;
  double temperature_min_degc = 0.0, temperature_max_degc = 0.0, temperature_rate_degc_per_min = 0.0;
  double off_mps2 = 0.0, ratio = 0.0, mae_mps2 = 0.0;                         ///< largest of their size
  double protection_calibrated_axes_rad = 0.0, protection_housing_rad = 0.0;  ///< largest of their size
  double off_at_s = 0.0, ratio_at_s = 0.0;
  std::array<std::uint64_t, kCapacity> clipped{}, scattering{}, not_finite{};  ///< blocks, by sensor
};

enum class SurveyUse : std::uint8_t { yes, orientation_only, no };
const char* to_string(SurveyUse use) noexcept;

class ToolHealth {
 public:
  /// `each_block`: every row of the log is a station. `frame`: from the tool's to the output frame.
  /// `acceleration_mps2`: the bound that was stated to the monitor.
  ToolHealth(const Mat3& frame, bool each_block, double acceleration_mps2 = 0.0)
      : frame_(frame), each_block_(each_block), acceleration_mps2_(acceleration_mps2) {}

  /// In order, with what the monitor said to it. `depth_m` NaN = not known.
  void take(const Sample& sample, const Verdict& verdict, double depth_m);

  const std::vector<StationHealth>& stations() const noexcept { return stations_; }
  const std::vector<NamedEvent>& events() const noexcept { return events_; }
  const RunExtremes& extremes() const noexcept { return extremes_; }
  const Verdict& last() const noexcept { return last_; }

  /// What is known from elsewhere against the sensors at the end of the run, for the sentence; empty: nothing. The tool
  /// is then usable for orientation at most.
  void doubt(std::string why) { doubt_ = std::move(why); }

  int count(Colour colour) const;
  /// Of the tool as it is at the end of the run.
  SurveyUse use() const;
  /// Why it is that.
  std::string sentence() const;
  /// What to do now, the most urgent first; `beside`: what is known from elsewhere.
  std::vector<std::string> actions(const SensorArray& array, const std::vector<std::string>& beside = {}) const;

 private:
  SeenAttitudes seen() const;
  std::vector<std::string> advice(StationReason reason, const SensorArray& array) const;
  bool begins_station(const Sample& sample, const Vec3& direction) const;
  void take_block(const Sample& sample, const Verdict& verdict);
  void take_extremes(const Sample& sample, const Verdict& verdict);

  Mat3 frame_;
  bool each_block_;
  double acceleration_mps2_;
  std::string doubt_;
  bool moved_ = true;  ///< since the last block
  std::uint32_t tag_ = 0;
  int changes_ = 0;  ///< events since the last block
  double depth_m_ = std::numeric_limits<double>::quiet_NaN();
  Vec3 direction_{};  ///< of the first block of the station
  std::vector<StationHealth> stations_;
  std::vector<NamedEvent> events_;
  RunExtremes extremes_;
  Verdict last_;
};

}  // namespace verification
}  // namespace PLUMB_ABI
}  // namespace plumb

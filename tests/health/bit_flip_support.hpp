/// Single bits of a monitor's storage flipped, and what comes of it: the same samples are played to the monitor that
/// was hurt and to one that was not, over stations without a new fault and then over stations with one. A monitor that
/// went blind shows at those.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "first_calibration_support.hpp"
#include "recalibration_support.hpp"

namespace plumb_test {

/// What the tool did at one sample, as only the test knows it.
struct Truth {
  plumb::Sample sample;
  plumb::Vec3 direction{};  ///< of gravity, in the frame of the monitor's axes
  plumb::Vec3 before{};     ///< at the station before: a block may still be that one's
  plumb::SensorSet faulty;
};

/// A monitor in some state, and what the tool does from there on.
struct Predicament {
  std::string name;
  std::unique_ptr<plumb::HealthMonitor> monitor = std::make_unique<plumb::HealthMonitor>();
  std::vector<Truth> after;
  std::vector<plumb::Verdict> unhurt;  ///< what the monitor that was not hurt says
};

enum class FlipOutcome { same, harmless, reported, distrusted, wrong_exclusion, wrong_output, late };
inline constexpr int kFlipOutcomes = 7;
inline const char* to_string(FlipOutcome outcome) {
  constexpr const char* kNames[] = {"same",         "harmless",  "reported", "unproven or failed", "WRONG exclusion",
                                    "WRONG output", "WRONG late"};
  return kNames[static_cast<int>(outcome)];
}
inline bool is_wrong(FlipOutcome outcome) { return outcome >= FlipOutcome::wrong_exclusion; }

/// The steps within which a flip must be detected where it does harm.
inline constexpr int kFlipSteps = 64;

inline double angle_between(const plumb::Vec3& a, const plumb::Vec3& b) {
  return std::atan2(plumb::norm(plumb::cross(a, b)), plumb::dot(a, b));
}

/// What is published as usable and further off than is said with it.
inline bool is_beyond_bound(const plumb::Verdict& v, const Truth& truth, double alert_limit_rad) {
  if (v.validity != plumb::Validity::valid && v.validity != plumb::Validity::degraded) return false;
  const double bound_rad = v.protection_available ? v.protection_level_calibrated_axes_rad : alert_limit_rad;
  const double off_rad =
      std::fmin(angle_between(v.gravity_mps2, truth.direction), angle_between(v.gravity_mps2, truth.before));
  return !(off_rad <= bound_rad) || !std::isfinite(plumb::norm(v.gravity_mps2));
}

struct FlipResult {
  FlipOutcome outcome = FlipOutcome::same;
  int steps = 0;  ///< until it was reported, or went wrong
};

/// Steps the monitor that was hurt along. What was wrong in the monitor that was not is not held against it.
inline FlipResult play_flip(plumb::HealthMonitor& hurt, const Predicament& at) {
  using plumb::HealthState;
  using plumb::Qualifier;
  bool same = true, distrusted = false;
  for (std::size_t k = 0; k < at.after.size(); ++k) {
    const Truth& truth = at.after[k];
    const plumb::Verdict& v = hurt.step(truth.sample);
    const plumb::Verdict& w = at.unhurt[k];
    const int step = static_cast<int>(k) + 1;
    if (v.cause == plumb::Cause::memory && v.state == HealthState::failed && v.validity == plumb::Validity::invalid)
      return {step <= kFlipSteps ? FlipOutcome::reported : FlipOutcome::late, step};
    const plumb::SensorSet blamed =
        (v.excluded | v.provisionally_excluded) - (w.excluded | w.provisionally_excluded | w.absent | truth.faulty);
    if (!blamed.empty()) return {FlipOutcome::wrong_exclusion, step};
    const double alert_limit_rad = plumb::MonitorConfig{}.alert_limit_rad;
    if (is_beyond_bound(v, truth, alert_limit_rad) && !is_beyond_bound(w, truth, alert_limit_rad))
      return {FlipOutcome::wrong_output, step};
    same = same && v.state == w.state && v.validity == w.validity && v.in_service == w.in_service &&
           v.gravity_mps2 == w.gravity_mps2 && v.statistic == w.statistic && v.qualifiers == w.qualifiers;
    const bool less_trusted = (v.state == HealthState::failed && w.state != HealthState::failed) ||
                              ((v.qualifiers & ~w.qualifiers) & Qualifier::not_yet_validated) != 0;
    distrusted = distrusted || (step <= kFlipSteps && less_trusted);
  }
  return {distrusted ? FlipOutcome::distrusted : same ? FlipOutcome::same : FlipOutcome::harmless, 0};
}

/// Plays `at` after the bit was flipped in a copy of its monitor.
inline FlipResult flip(const Predicament& at, std::size_t bit, plumb::HealthMonitor& scratch) {
  scratch = *at.monitor;
  auto* bytes = reinterpret_cast<unsigned char*>(&scratch);
  bytes[bit / 8] = static_cast<unsigned char>(bytes[bit / 8] ^ (1U << (bit % 8)));
  return play_flip(scratch, at);
}

/// Where the stations of the tail lie, and what is wrong with the tool there.
class Tail {
 public:
  static constexpr int kQuietStations = 4, kFaultyStations = 6;

  /// `sample(direction)` is the next sample of the tool; `turn(direction)` the direction in the monitor's frame;
  /// `break_sensor()` begins the new fault and returns the sensors that are faulty from then on.
  template <class SampleOf, class TurnOf, class Break>
  static void play(Predicament& at, plumb::Vec3 here, plumb::SensorSet faulty, std::uint64_t seed,
                   const SampleOf& sample, const TurnOf& turn, const Break& break_sensor) {
    Noise luck(seed);
    plumb::HealthMonitor unhurt = *at.monitor;
    plumb::Vec3 before = here;
    for (int s = 0; s <= kQuietStations + kFaultyStations; ++s) {
      if (s == kQuietStations + 1) faulty = faulty | break_sensor();
      const int window = at.monitor->config().window;
      for (int k = 0; k < (s == 0 ? 1 : 2) * window; ++k) {
        at.after.push_back({sample(here), turn(here), turn(before), faulty});
        at.unhurt.push_back(unhurt.step(at.after.back().sample));
      }
      before = here;
      here = random_direction(luck);
    }
  }
};

/// The states of a calibrated monitor, each with something to remember.
inline Predicament in_state(const std::string& name, int n) {
  Predicament at;
  at.name = name;
  plumb::MonitorConfig config;
  if (name == "excluded") config.recalibrate_after_exclusion = true;
  auto tool = std::make_unique<Tool>(n, config, 5);
  tool->drift(5e-4);
  int broken = -1, second = -1;
  tool->fault = [&broken, &second](int i, double r, int) { return i == broken || i == second ? r + 0.3 : r; };
  Rig& rig = tool->rig;
  plumb::Vec3 here = direction_at(30, 40);
  plumb::SensorSet faulty;
  const auto visit = [&](int stations) {
    for (int k = 0; k < stations; ++k) rig.stay(here = random_direction(tool->directions), 2);
  };
  if (name != "not_yet_validated") rig.prove();
  if (name == "suspect" || name == "excluded") {
    broken = 0;
    faulty = plumb::SensorSet::of(0);
    visit(name == "suspect" ? 2 : 9);
  }
  if (name == "recalibrating" || name == "fitting") {
    visit(1);
    rig.monitor.request_recalibration();
    visit(5);
  }
  if (name == "failed") {
    for (int k = 0; k < 8; ++k) {
      plumb::Sample s = rig.sample(here, plumb::kG0_mps2);
      s.delivered = plumb::SensorSet::first(2);
      rig.step(s);
    }
  }
  if (name == "fitting") {
    const auto phase = [&rig] { return rig.monitor.recalibration().progress(rig.monitor.array()).phase; };
    for (int k = 0; k < 4000 && phase() != plumb::RecalibrationPhase::fitting; ++k) {
      if (k % 64 == 0) here = random_direction(tool->directions);
      rig.step(rig.sample(here, plumb::kG0_mps2));
    }
  } else {
    here = random_direction(tool->directions);
    for (int k = 0; k < 2 * config.window + 11; ++k) rig.step(rig.sample(here, plumb::kG0_mps2));
  }
  *at.monitor = rig.monitor;
  Tail::play(
      at, here, faulty, 17, [&](const plumb::Vec3& u) { return rig.sample(u, plumb::kG0_mps2); },
      [](const plumb::Vec3& u) { return u; },
      [&] {
        second = 1;
        return plumb::SensorSet::of(1);
      });
  return at;
}

/// Another life for each: 4 sensors lose their redundancy with an exclusion (degraded), more do not (isolated).
inline std::vector<std::string> flipped_states() {
  return {"not_yet_validated", "nominal", "suspect", "excluded", "recalibrating", "fitting", "failed", "initial"};
}

/// A monitor that makes its own calibration, some stations into it.
inline Predicament in_first_calibration(int n) {
  Predicament at;
  at.name = "initial";
  UncalibratedTool tool(n, 3);
  tool.start();
  for (int k = 0; k < 5; ++k) tool.stay(random_direction(tool.noise));
  plumb::Vec3 here = random_direction(tool.noise);
  for (int k = 0; k < 11; ++k) tool.step(tool.sample(here));
  *at.monitor = tool.monitor;
  bool broken = false;
  tool.distort = [&broken](int i, double r, int) { return broken && i == 1 ? r + 0.3 : r; };
  Tail::play(
      at, here, {}, 17, [&](const plumb::Vec3& u) { return tool.sample(u); }, [&](const plumb::Vec3& u) { return u; },
      [&] {
        broken = true;
        return plumb::SensorSet::of(1);
      });
  return at;
}

}  // namespace plumb_test

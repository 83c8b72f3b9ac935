// How long a doubt may last, and how the tool is validated: the isolation timeout, validation, probation.
#include <algorithm>
#include <cmath>

#include "plumb/health/detail/diagnosis.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

using std::size_t;

namespace {

/// A sensor is validated only when its prediction has moved by this part of gravity ...
constexpr double kProvingShare = 0.02;
/// ... and by this many standard deviations of its block mean.
constexpr double kProvingSigmas = 10.0;

}  // namespace

double proving_change_mps2(const InForce& in_force, int sensor, double samples) noexcept {
  return std::fmax(kProvingShare * in_force.gravity.g_mps2,
                   kProvingSigmas * in_force.array.sigma_mps2(sensor) / std::sqrt(samples));
}

bool Diagnosis::expected(HealthEvent event, const DecisionState& machine) const noexcept {
  return machine.mode == Mode::recalibrating && machine.base == Mode::suspect &&
         suspicion_ == cause_of(event, Cause::none) &&
         (event == HealthEvent::norm_mismatch || event == HealthEvent::no_consistent_hypothesis);
}

/// One chip determines a vector by itself, and a dead one is at rest in any flight. Where others scatter that determine
/// one as well, some of those at rest must measure gravity (docs/theory.md, section 5.7).
bool Diagnosis::is_rest_witnessed(const Terms& terms, const BlockTests& tests) noexcept {
  const SensorArray& array = terms.in_force.array;
  if (!array.units().grouped() || rank_of(array, terms.last.scattering) < 3) return true;
  return some_measure_gravity(terms, tests, terms.last.calm & terms.machine.sensors.in_service);
}

/// The timeout counts doubt, not alarms alone: a block between the limit to leave suspect and the one to enter it would
/// else hold the monitor there for ever. It rests at a norm mismatch, by which no sensor in service is suspected.
void Diagnosis::count_doubt(const Terms& terms, const BlockTests& tests, const BlockReport& report) noexcept {
  // The contradiction for which the host had a fit made is not new, and the fit needs more stations than the isolation
  // timeout allows.
  const bool known = answer_.no_consistent_hypothesis && expected(HealthEvent::no_consistent_hypothesis, terms.machine);
  episode_.note_suspected((episode_.candidate | terms.machine.sensors.provisionally_excluded).size());
  if (!report.doubtful(terms.machine.mode) || known || terms.in_force.owes_calibration()) return;
  if (!is_rest_witnessed(terms, tests)) return;
  const MonitorConfig& config = terms.settings.config;
  episode_.stations.add(station_.direction, config.distinct_attitude_angle_rad);
  if (episode_.doubtful_blocks < config.isolation_timeout_blocks) ++episode_.doubtful_blocks;
}

/// Of attitudes in doubt, which do not count while those to come may speak against the calibration; of blocks in doubt
/// where they are counted.
bool Diagnosis::is_out_of_stations(const Terms& terms) const noexcept {
  const bool gathers = terms.check.gathers() && isolation_.confirmed_grade() >= 1;
  return !gathers && episode_.stations.size() >= terms.settings.config.isolation_timeout;
}
bool Diagnosis::is_out_of_blocks(const Terms& terms) const noexcept {
  const MonitorConfig& config = terms.settings.config;
  return config.isolation_timeout_blocks > 0 && episode_.doubtful_blocks >= config.isolation_timeout_blocks;
}

bool Diagnosis::isolation_timed_out(const Terms& terms) const noexcept {
  const Mode mode = terms.machine.mode;
  if (mode != Mode::suspect && mode != Mode::recalibrating) return false;
  if (terms.check.refused()) return false;  // no sensor is suspected of it
  return (is_out_of_stations(terms) || is_out_of_blocks(terms)) &&
         (!terms.machine.timed_out || unbounded_run_ >= terms.settings.config.passed_blocks);
}

/// Whether the block is explained by no more faults than the grade bears, with enough left to check one another: four
/// sensors, or of chips one more than determine a vector. Another attitude may then single that explanation out; and
/// where none does, because two of them are images of each other, no attitude speaks against the tool.
bool Diagnosis::is_isolable(const SensorArray& array, const BlockEvidence& evidence) const noexcept {
  const int grade = std::max(isolation_.confirmed_grade(), isolation_.provisional_grade());
  const int left = array.units().count(isolation_.monitored() & evidence.usable) - scan_.least;
  return scan_.least <= grade && left >= (array.units().grouped() ? isolation_.coplanarity() + 2 : 4);
}

/// Blocks in a row in which the doubt had neither a bound nor a way out. A bound: of the estimate, or of that of the
/// unsuspected sensors: a faulty one moves the estimate by any amount once it is known, and has so many
/// stations to go before it is excluded. A way out: `is_isolable`, which ends with the blocks where these are counted.
void Diagnosis::count_unbounded(const Terms& terms, const BlockTests& tests, const BlockReport& report,
                                double turn_rad) noexcept {
  const MonitorConfig& config = terms.settings.config;
  bool within = bounded(config.alert_limit_rad);
  if (!within && terms.machine.mode == Mode::suspect && (is_out_of_stations(terms) || is_out_of_blocks(terms))) {
    const ProtectionTerms by{terms.settings.protection_faults, terms.settings.k_integrity};
    within = (!is_out_of_blocks(terms) && is_isolable(terms.in_force.array, tests.block())) ||
             isolation_.bounded_without(tests, terms.machine.sensors.in_service, scan_, by,
                                        config.alert_limit_rad - turn_rad);
  }
  if (within) {
    unbounded_run_ = 0;
  } else if (report.kind != BlockReport::Kind::reference && unbounded_run_ < config.passed_blocks) {
    ++unbounded_run_;
  }
}

/// Takes note of what each sensor in service should read; whether that of every one has moved by enough by now.
bool Diagnosis::note_predictions(const Terms& terms, const Vec3& x_mps2) noexcept {
  const SensorArray& array = terms.in_force.array;
  bool moved = true;
  for (int i = 0; i < array.size(); ++i) {
    if (!terms.machine.sensors.in_service.has(i)) continue;
    const auto a = static_cast<size_t>(i);
    const auto prediction = static_cast<float>(dot(array.axis(i), x_mps2));
    if (!have_predictions_ || prediction < least_prediction_[a]) least_prediction_[a] = prediction;
    if (!have_predictions_ || prediction > most_prediction_[a]) most_prediction_[a] = prediction;
    const auto change_mps2 = static_cast<double>(most_prediction_[a] - least_prediction_[a]);
    if (!(change_mps2 >= proving_change_mps2(terms.in_force, i, terms.last.evidence.samples))) moved = false;
  }
  have_predictions_ = true;
  return moved;
}

void Diagnosis::count_clean(const Terms& terms, const BlockTests& tests, const BlockReport& report,
                            DecisionState& machine) noexcept {
  using Kind = BlockReport::Kind;
  const MonitorConfig& config = terms.settings.config;
  if (report.kind != Kind::clean) {
    machine.clean_run = 0;
    if (report.kind != Kind::soft || report.doubtful(machine.mode)) episode_.clean.clear();
    if (report.kind != Kind::soft) {
      forget_predictions();
      forget_probation();
    }
    return;
  }
  if (machine.clean_run < config.passed_blocks) ++machine.clean_run;
  if (machine.not_yet_validated && !terms.in_force.owes_calibration()) {
    const bool moved = note_predictions(terms, report.used.x_mps2);
    const bool believed = isolation_.confirmed_grade() < 1 || terms.check.believed();
    if (moved && believed && machine.clean_run >= config.passed_blocks) machine.not_yet_validated = false;
  }
  // While a sensor is provisionally excluded the episode ends only when it, too, agrees again.
  const SensorSet monitored = isolation_.monitored() & tests.block().usable;
  const SetTest& all = tests.of(monitored);
  if (!(all.consistent(terms.settings.limits) && all.parity_consistent(terms.settings.limits))) return;
  const double apart_rad = config.distinct_attitude_angle_rad;
  episode_.clean.add(known_direction(report.used, apart_rad), apart_rad);
  const bool on_record = episode_.open || episode_.stations.size() > 0;
  if (on_record && episode_.clean.size() >= config.forget_blocks) {
    forget_episode();
    machine.timed_out = false;
  }
}

void Diagnosis::examine_probation(const Terms& terms, const BlockTests& tests, const BlockReport& report) noexcept {
  const DecisionState& machine = terms.machine;
  if (report.kind != BlockReport::Kind::clean || episode_.open || machine.not_yet_validated ||
      machine.mode == Mode::failed || machine.mode == Mode::suspect)
    return;
  const BlockEvidence& evidence = tests.block();
  const SensorLedger& s = machine.sensors;
  const TestLimits& limits = terms.settings.limits;
  const MonitorConfig& config = terms.settings.config;
  const SensorSet asked = ((s.excluded | s.provisionally_excluded) - (s.readmitted | s.absent)) & evidence.usable &
                          terms.last.calm & terms.in_force.calibrated;
  // A chip is asked as a whole, less the channels that are lost.
  const SensorUnits& units = terms.in_force.array.units();
  const SensorSet whole =
      units.units_within(asked, ((s.excluded | s.provisionally_excluded) - s.absent) & terms.in_force.calibrated);
  SensorSet fine;
  for (int u = 0; u < units.size(); ++u) {
    if (!whole.has(u)) continue;
    const SensorSet unit = units.sensors_of(SensorSet::of(u)) & asked;
    const SetTest& t = tests.of((s.in_service & evidence.usable) | unit);
    if (t.tested && t.consistent(limits) && t.parity <= config.clear_fraction * t.parity_alarm_limit(limits))
      fine = fine | unit;
  }
  const SensorSet still = on_probation_ & fine;
  if (still.empty()) probation_.clear();
  on_probation_ = still.empty() ? fine : still;
  const double apart_rad = config.distinct_attitude_angle_rad;
  if (!on_probation_.empty()) probation_.add(known_direction(report.used, apart_rad), apart_rad);
}

bool Diagnosis::probation_passed(const MonitorConfig& config) const noexcept {
  return !on_probation_.empty() && probation_.size() >= config.probation_stations;
}

}  // namespace PLUMB_ABI
}  // namespace plumb

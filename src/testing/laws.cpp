#include "plumb/testing/laws.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <vector>

#include "oracle.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace testing {
namespace {

/// Stations over which an answer must stand before a sensor is excluded (the default of `isolation_stations`): what
/// a law asks of a monitor is not taken from a configuration that asks for less.
constexpr int kExcludingStations = 4;

LawResult broken(const std::string& why) { return {false, true, why}; }
LawResult silent(const std::string& why) { return {true, false, why}; }

std::string names(const SensorArray& array, SensorSet set) {
  std::string text;
  for (int i = 0; i < array.size(); ++i) {
    if (set.has(i)) text += (text.empty() ? "" : ", ") + std::string(array.row(i).id.data());
  }
  return text.empty() ? "nobody" : text;
}

std::string at(const Verdict& verdict) { return " at t = " + std::to_string(verdict.time_s) + " s"; }

template <std::size_t N>
bool same_bits(const std::array<double, N>& a, const std::array<double, N>& b) {
  return std::memcmp(a.data(), b.data(), sizeof a) == 0;
}
bool same_bits(double a, double b) { return std::memcmp(&a, &b, sizeof a) == 0; }

/// All that a user acts on.
bool same(const Verdict& a, const Verdict& b) {
  return a.state == b.state && a.qualifiers == b.qualifiers && a.validity == b.validity && a.cause == b.cause &&
         a.in_service == b.in_service && a.provisionally_excluded == b.provisionally_excluded &&
         a.excluded == b.excluded && a.absent == b.absent && a.suspects == b.suspects && a.usable == b.usable &&
         a.alert == b.alert && same_bits(a.statistic, b.statistic) && same_bits(a.limit, b.limit) &&
         same_bits(a.gravity_mps2, b.gravity_mps2) && same_bits(a.covariance, b.covariance) &&
         same_bits(a.protection_level_calibrated_axes_rad, b.protection_level_calibrated_axes_rad) &&
         same_bits(a.mae_all_mps2, b.mae_all_mps2);
}

/// Plays a case; `look(verdict, truth)` returns an empty text as long as all is well.
template <class Look>
LawResult play(const Case& c, Look look) {
  auto simulator = scenario::Simulator::make(scenario_of(c));
  if (!simulator) return broken("the case cannot be played: " + simulator.error());
  const auto monitor = std::make_unique<HealthMonitor>();
  const Expected<void> configured = monitor->configure(setup_of(c));
  if (!configured) return broken(std::string("the monitor refuses the set-up: ") + describe(configured.error().code));
  Sample sample;
  while (simulator->next(sample)) {
    const std::string wrong = look(*monitor, monitor->step(sample), sample, simulator->truth());
    if (!wrong.empty()) return broken(wrong + at(monitor->verdict()));
  }
  return {};
}

bool constant(scenario::FaultKind kind) {
  using scenario::FaultKind;
  return kind == FaultKind::bias_step || kind == FaultKind::stuck_level || kind == FaultKind::random_level;
}

struct StationSpan {
  int from = 0, until = -1;
};

/// Where everything must have been distinguished: behind the last onset, early enough for the answer to stand over the
/// stations that an exclusion takes, before the isolation timeout is over and the run ends. Every station from the
/// first onset on may have used part of the isolation timeout.
StationSpan stations_to_tell(const Case& c) {
  double first = c.faults.front().onset;
  double last = first;
  for (const scenario::Fault& fault : c.faults) {
    first = std::min(first, fault.onset);
    last = std::max(last, fault.onset);
  }
  int isolation_timeout = c.config.isolation_timeout;
  if (c.config.isolation_timeout_blocks > 0)
    isolation_timeout = std::min(isolation_timeout, c.config.isolation_timeout_blocks / kStationBlocks);
  const int from = static_cast<int>(last);
  const int within_timeout = static_cast<int>(first) + isolation_timeout - kExcludingStations;
  return {from, std::min(within_timeout, c.stations - kExcludingStations - 2)};
}

bool all_finite(const Verdict& v) {
  bool ok = std::isfinite(v.statistic) && std::isfinite(v.limit) && std::isfinite(v.mae_all_mps2) &&
            std::isfinite(v.protection_level_calibrated_axes_rad);
  for (const double x : v.gravity_mps2) ok = ok && std::isfinite(x);
  for (const double x : v.covariance) ok = ok && std::isfinite(x);
  return ok;
}

}  // namespace

LawResult never_excludes_a_healthy_sensor(const Case& c) {
  const SensorSet faulty = faulty_of(c);
  int strict = -1;
  int parity = -1;
  auto result = play(c, [&](const HealthMonitor&, const Verdict& v, const Sample&, const scenario::Truth&) {
    if (strict < 0) {
      strict = v.confirmed_grade;
      parity = v.provisional_grade;
    }
    if (faulty.size() <= strict && !faulty.contains(v.excluded)) {
      return "excluded " + names(c.array, v.excluded) + " though only " + names(c.array, faulty) + " are faulty";
    }
    if (faulty.size() <= parity && !faulty.contains(v.provisionally_excluded)) {
      return "provisionally excluded " + names(c.array, v.provisionally_excluded) + " though only " +
             names(c.array, faulty) + " are faulty";
    }
    return std::string();
  });
  if (result.holds && faulty.size() > strict) return silent("more faults than any grade covers");
  return result;
}

LawResult isolates_what_is_isolable(const Case& given) {
  Case c = given;
  c.calibration_mps2 = 0.0;
  c.gravity_error = 0.0;
  c.walk = Walk::random;  // an answer must hold at E attitudes that differ
  const auto passing = [](const scenario::Fault& f) { return !constant(f.kind) || !std::isinf(f.duration); };
  c.faults.erase(std::remove_if(c.faults.begin(), c.faults.end(), passing), c.faults.end());
  const SensorSet faulty = faulty_of(c);
  if (faulty.empty() || faulty.size() > c.array.size() - 3)
    return silent("no constant fault, or more than n - 3 faults");
  const StationSpan span = stations_to_tell(c);
  if (span.until < span.from) return silent("the isolation timeout may expire before the isolation is confirmed");
  if (!told_apart(c, faulty, span.from, span.until)) return silent("the stations do not separate the hypotheses");
  SensorSet out;
  const auto result = play(c, [&](const HealthMonitor&, const Verdict& v, const Sample&, const scenario::Truth&) {
    out = v.excluded | v.provisionally_excluded;
    return std::string();
  });
  if (!result.holds || out == faulty) return result;
  return broken("excluded at the end: " + names(c.array, out) + ", faulty: " + names(c.array, faulty));
}

LawResult detects_above_the_threshold(const Case& c) {
  if (c.faults.size() != 1 || c.array.size() < 4) return silent("more or fewer than one fault, or no redundancy");
  const scenario::Fault& fault = c.faults.front();
  if (fault.kind != scenario::FaultKind::bias_step) return silent("not a constant shift");
  if (parity_shift(c, fault.sensor, fault.magnitude) < kFarShift) return silent("below the threshold");
  const double first = kTrustStations + fault.onset;
  const double last = first + fault.duration;
  int blocks = 0;
  std::uint32_t station = 0;
  return play(c, [&](const HealthMonitor&, const Verdict& v, const Sample&, const scenario::Truth& truth) {
    if (truth.station != station) blocks = 0;
    station = truth.station;
    if (!v.tick || truth.station < first || truth.station >= last) return std::string();
    ++blocks;
    const bool plain =
        v.state != HealthState::suspect && v.validity == Validity::valid && v.in_service.has(fault.sensor);
    return plain && blocks >= 1 ? std::string("valid without suspicion, with the faulty sensor in service")
                                : std::string();
  });
}

LawResult sets_are_a_partition(const Case& c) {
  return play(c, [&](const HealthMonitor&, const Verdict& v, const Sample&, const scenario::Truth&) {
    const int sum = v.in_service.size() + v.provisionally_excluded.size() + v.excluded.size() + v.absent.size();
    const bool all = (v.in_service | v.provisionally_excluded | v.excluded | v.absent) == v.configured;
    return all && sum == v.configured.size() ? std::string() : std::string("the sets do not form a partition");
  });
}

LawResult excluded_bytes_do_not_matter(const Case& c) {
  auto simulator = scenario::Simulator::make(scenario_of(c));
  const auto one = std::make_unique<HealthMonitor>();
  if (!simulator || !one->configure(setup_of(c))) return broken("the case cannot be played");
  const auto two = std::make_unique<HealthMonitor>(*one);
  Sample sample;
  bool any = false;
  std::uint64_t row = 0;
  while (simulator->next(sample)) {
    // Both lie far off, so that neither sensor passes its probation, and never alike: one rests, the other shakes.
    Sample other = sample;
    const SensorSet out = one->verdict().excluded;
    any = any || !out.empty();
    ++row;
    for (int i = 0; i < c.array.size(); ++i) {
      if (!out.has(i)) continue;
      sample.raw[static_cast<std::size_t>(i)] = 77.0;
      other.raw[static_cast<std::size_t>(i)] = -5e3 - static_cast<double>(row % 7);
    }
    const Verdict& a = one->step(sample);
    if (!same(a, two->step(other))) return broken("the readings of an excluded sensor change the verdict" + at(a));
  }
  return any ? LawResult() : silent("no sensor was excluded");
}

LawResult failed_is_latched(const Case& c) {
  bool failed = false;
  auto result = play(c, [&](const HealthMonitor&, const Verdict& v, const Sample&, const scenario::Truth&) {
    const bool left = failed && v.state != HealthState::failed;
    failed = v.state == HealthState::failed;
    if (failed && v.validity != Validity::invalid) return std::string("failed, but not invalid");
    return left ? std::string("left failed without a reset") : std::string();
  });
  return result.holds && !failed ? silent("never failed") : result;
}

LawResult snapshot_is_transparent(const Case& c) {
  auto simulator = scenario::Simulator::make(scenario_of(c));
  const MonitorSetup setup = setup_of(c);
  const auto one = std::make_unique<HealthMonitor>();
  const auto two = std::make_unique<HealthMonitor>();
  if (!simulator || !one->configure(setup) || !two->configure(setup)) return broken("the case cannot be played");
  // Somewhere in the run, mostly within a block.
  const std::uint64_t cut = scenario::derive_seed(c.seed, 1) % simulator->size();
  std::vector<std::uint8_t> bytes(HealthMonitor::snapshot_size_max());
  Sample sample;
  for (std::uint64_t row = 0; simulator->next(sample); ++row) {
    const Verdict& a = one->step(sample);
    if (!same(a, two->step(sample))) return broken("the restored monitor gives another verdict" + at(a));
    if (row != cut) continue;
    const Expected<std::size_t> size = two->snapshot(bytes.data(), bytes.size());
    if (!size) return broken("the snapshot cannot be written" + at(a));
    if (!two->restore(setup, bytes.data(), *size)) return broken("the snapshot is refused" + at(a));
  }
  return {};
}

LawResult replay_is_exact(const Case& c) {
  std::vector<Verdict> first;
  auto result = play(c, [&](const HealthMonitor&, const Verdict& v, const Sample&, const scenario::Truth&) {
    if (v.tick) first.push_back(v);
    return std::string();
  });
  std::size_t k = 0;
  if (!result.holds) return result;
  return play(c, [&](const HealthMonitor&, const Verdict& v, const Sample&, const scenario::Truth&) {
    const bool differs = v.tick && (k >= first.size() || !same(first[k], v));
    if (v.tick) ++k;
    return differs ? std::string("the second run gives another verdict") : std::string();
  });
}

/// Whether every sensor in service delivered a number with this sample.
bool delivers_all(const Sample& sample, SensorSet in_service) {
  for (int i = 0; i < kCapacity; ++i) {
    if (in_service.has(i) && !(sample.delivered.has(i) && std::isfinite(sample.raw[static_cast<std::size_t>(i)])))
      return false;
  }
  return true;
}

LawResult verdict_agrees_with_itself(const Case& c) {
  std::uint32_t sequence = 0;
  return play(c, [&](const HealthMonitor&, const Verdict& v, const Sample& sample, const scenario::Truth&) {
    const bool usable = v.validity == Validity::valid || v.validity == Validity::degraded;
    if (!all_finite(v)) return std::string("a number is not finite");
    if (v.state == HealthState::suspect && v.validity == Validity::degraded)
      return std::string("suspect, but published as degraded");
    if (v.validity == Validity::valid && (!v.protection_available || v.alert))
      return std::string("valid without a bound within the alert limit");
    if (v.state == HealthState::failed && v.validity != Validity::invalid)
      return std::string("failed, but not invalid");
    if ((v.qualifiers & Qualifier::moving) != 0 && v.validity == Validity::valid)
      return std::string("moving, but valid");
    if (v.validity == Validity::invalid && (v.usable & Usable::vector) != 0) return std::string("invalid, but usable");
    if (v.protection_available != ((v.usable & Usable::protection_level) != 0) && usable) {
      return std::string("protection level and its bit differ");
    }
    // Where the sets change, the newest vector is still that of the sets from before.
    constexpr double kAnotherAttitude_rad = rad_from_deg(5.0);
    const bool newest = v.accepted && v.transition.sequence == 0 && delivers_all(sample, v.in_service);
    if (usable && newest && angle_between_rad(v.gravity_mps2, v.latest_mps2) > kAnotherAttitude_rad)
      return std::string("usable, but the newest sample has a different attitude");
    if (v.transition.sequence != 0 && v.transition.sequence != sequence + 1) return std::string("a record is missing");
    if (v.transition.sequence != 0) sequence = v.transition.sequence;
    return std::string();
  });
}

LawResult motion_excludes_no_sensor(const Case& c) {
  Case moving = c;
  scenario::Fault shake;
  shake.kind = scenario::FaultKind::shake;
  shake.sensor = scenario::kWholeLog;
  shake.clock = scenario::Clock::station;
  shake.onset = 1.0;
  // From the seed: 0.1 mg0, at which some channels show it and others do not, to 1 g0.
  shake.magnitude = 1e-4 * kG0_mps2 * std::pow(10.0, static_cast<double>(c.seed % 41) / 10.0);
  moving.faults = {shake};
  return play(moving, [&](const HealthMonitor&, const Verdict& v, const Sample&, const scenario::Truth&) {
    const SensorSet out = v.excluded | v.provisionally_excluded | v.absent;
    if (!out.empty()) return "excluded or lost " + names(c.array, out) + " for motion";
    return v.state == HealthState::failed ? std::string("failed for motion") : std::string();
  });
}

const std::vector<Law>& laws() {
  static const std::vector<Law> all = {{"never excludes a healthy sensor", never_excludes_a_healthy_sensor},
                                       {"isolates what is isolable", isolates_what_is_isolable},
                                       {"detects above the threshold", detects_above_the_threshold},
                                       {"sets are a partition", sets_are_a_partition},
                                       {"excluded bytes do not matter", excluded_bytes_do_not_matter},
                                       {"failed is latched", failed_is_latched},
                                       {"snapshot is transparent", snapshot_is_transparent},
                                       {"replay is exact", replay_is_exact},
                                       {"verdict agrees with itself", verdict_agrees_with_itself},
                                       {"motion excludes no sensor", motion_excludes_no_sensor}};
  return all;
}

}  // namespace testing
}  // namespace PLUMB_ABI
}  // namespace plumb

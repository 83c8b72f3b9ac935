#include "plumb/health/detail/diagnosis.hpp"
#include "plumb/detection/estimate_error.hpp"

#include <algorithm>
#include <cmath>

namespace plumb {
inline namespace PLUMB_ABI {

using std::size_t;

namespace {

/// So many stations at which a sensor alone scatters exclude it, whatever E is: two were pushes in 4 of 1 135 000
/// episodes in motion (docs/attacks.md).
constexpr int kScatterStations = 4;

/// A direction may stand on record where half of the angle that tells attitudes apart is so many times its own standard
/// deviation.
constexpr double kDirectionSigmas = 3.0;
/// Votes at one station are taken at 1, 2, 4, 8 and 16 blocks: refined, never repeated at will.
constexpr int kLastVoteBlock = 16;

}  // namespace

Vec3 known_direction(const SetTest& test, double distinct_attitude_angle_rad) noexcept {
  const double sigma_rad = tilt_sigma_rad(test.x_mps2, test.covariance);
  return kDirectionSigmas * sigma_rad <= 0.5 * distinct_attitude_angle_rad ? test.x_mps2 : Vec3{};
}

void Diagnosis::clear(const InForce& in_force, SensorSet in_service, int assumed_faults) noexcept {
  *this = Diagnosis{};
  asserted_left_ = assumed_faults;
  isolation_.pose(in_force.array, in_service);
  consistent_ = isolation_.live();
}

void Diagnosis::forget_episode() noexcept {
  episode_.clear();
  isolation_.clear();
  answer_ = IsolationAnswer{};
}

void Diagnosis::forget_votes() noexcept {
  isolation_.clear();
  answer_ = IsolationAnswer{};
  episode_.take_back();
}

void Diagnosis::forget_probation() noexcept {
  probation_.clear();
  on_probation_ = SensorSet{};
}

void Diagnosis::begin_anew() noexcept {
  forget_episode();
  scan_ = FaultSetScan{};
  forget_probation();
  unbounded_run_ = 0;
  drift_rad_ = 0.0;
}

void Diagnosis::withdraw_answer() noexcept {
  answer_ = IsolationAnswer{};
  episode_.take_back();
}

void Diagnosis::spend_asserted(int faults) noexcept {
  if (asserted_left_ > 0) asserted_left_ -= std::min(faults, asserted_left_);
}

bool Diagnosis::follow_alarm(const BlockReport& report, bool calibrated) noexcept {
  // The datasheet alone suspects no sensor.
  if (report.kind != BlockReport::Kind::alarm || episode_.open || !calibrated) return false;
  episode_.open = true;
  station_.clear();
  return true;
}

void Diagnosis::ask_about(const Terms& terms, const BlockTests& tests, const BlockReport& report,
                          SensorSet found_in_motion) noexcept {
  if (found_in_motion.empty() || episode_.open || report.kind == BlockReport::Kind::reference) return;
  const SetTest& all = tests.of(isolation_.monitored() & tests.block().usable);
  const TestLimits& limits = terms.settings.limits;
  if (!all.tested || (all.consistent(limits) && all.parity_consistent(limits))) return;
  episode_.open = true;
  station_.clear();
}

bool Diagnosis::some_measure_gravity(const Terms& terms, const BlockTests& tests, SensorSet sensors) noexcept {
  const SensorUnits& units = terms.in_force.array.units();
  const auto measures_gravity = [&](SensorSet set) {
    const SetTest& t = tests.of(set);
    return t.tested && t.consistent(terms.settings.limits);
  };
  bool out = measures_gravity(sensors);
  for (int u = 0; u < units.size() && !out; ++u) out = measures_gravity(units.sensors_of(SensorSet::of(u)) & sensors);
  return out;
}

/// Whether enough sensors to determine a vector read what they read when the station began. Then the tool has not
/// turned, whatever the others make of the direction: a faulty sensor that steps is no new attitude. A chip is enough,
/// and one that is dead or stuck reads the same for ever: it speaks only if it is asked, and measures gravity.
bool Diagnosis::is_still_there(const Terms& terms, const BlockTests& tests, SensorSet voters) const noexcept {
  const auto samples = static_cast<double>(station_.samples);
  const SensorArray& array = terms.in_force.array;
  const SensorSet same =
      reads_the_same(array, terms.last.evidence, station_.reading_mps2, samples) & station_.delivered;
  return array.units().grouped() ? some_measure_gravity(terms, tests, same & voters) : rank_of(array, same) == 3;
}

/// A station at which the question was asked, and no block gave the candidate for an answer, takes it back.
void Diagnosis::leave_station() noexcept {
  if (station_.asked && !station_.answered) episode_.take_back();
  station_.clear();
}

void Diagnosis::follow_station(const Terms& terms, const BlockTests& tests, const BlockReport& report,
                               std::uint32_t tag) noexcept {
  const BlockEvidence& evidence = tests.block();
  const SensorLedger& sensors = terms.machine.sensors;
  const SensorSet monitored = sensors.in_service | sensors.provisionally_excluded;
  const SensorSet voters = episode_.candidate.empty() ? sensors.in_service : monitored - episode_.candidate;
  const SetTest& clear = tests.of(voters & evidence.usable);
  const SetTest& pose = clear.tested ? clear : report.used;
  const Vec3& direction = pose.x_mps2;
  // A station of sensors that all read zero points nowhere: no angle to it would ever end it.
  const bool nowhere = !(norm(station_.direction) > 0.0);
  const MonitorConfig& config = terms.settings.config;
  const bool turned = nowhere || angle_between_rad(station_.direction, direction) > config.station_angle_rad;
  if (!station_.open || tag != station_.tag || (turned && !is_still_there(terms, tests, voters))) {
    leave_station();
    station_.open = true;
    station_.tag = tag;
    station_.direction = known_direction(pose, config.distinct_attitude_angle_rad);
    station_.last = direction;
    station_.samples = static_cast<float>(evidence.samples);
    station_.delivered = evidence.usable;
    for (size_t a = 0; a < kCapacity; ++a) station_.reading_mps2[a] = static_cast<float>(evidence.mean_mps2[a]);
  }
  drift_rad_ = angle_between_rad(station_.last, direction);
  station_.last = direction;
  if (station_.blocks < StationTrack::kMostBlocks) ++station_.blocks;
}

/// What scatters may be all that shows of a movement: the confirmed grade bears so many faulty ones that hang that the
/// healthy ones at rest lie in one plane, and do not feel a movement across it. So its average rejects nothing. But a
/// sensor that alone scatters, whichever others are doubted, while these agree, is the answer of this station by that.
/// A chip that scatters beside a single one feels the tool move, or is noisy: nothing tells which.
SensorSet Diagnosis::isolated_by_scatter(const Terms& terms, const BlockTests& tests) const noexcept {
  const SensorUnits& units = terms.in_force.array.units();
  if (units.count(terms.facts.noisy()) != 1 || isolation_.confirmed_grade() < 1) return {};
  const SensorSet noisy = units.whole(terms.facts.noisy()) & isolation_.monitored();
  const bool checked = isolation_.provisional_grade() >= 1;
  if (checked ? !terms.facts.noisy_for_certain().contains(terms.facts.noisy()) : units.grouped()) return {};
  const SensorSet others = isolation_.monitored() - noisy;
  const TestLimits& limits = terms.settings.limits;
  const SetTest& rest = tests.of(others & tests.block().usable);
  const bool agree =
      terms.last.calm.contains(others) && rest.tested && rest.consistent(limits) && rest.parity_consistent(limits);
  return agree ? noisy : SensorSet{};
}

/// By the vote where that names anyone, else by scatter.
Diagnosis::Suspicion Diagnosis::suspect(const Terms& terms, const BlockTests& tests,
                                        const IsolationAnswer& voted) const noexcept {
  if (!voted.strict.empty()) return {voted.strict, false};
  const SensorSet scatters = isolated_by_scatter(terms, tests);
  return {scatters, !scatters.empty()};
}

bool Diagnosis::is_vote_due(const BlockTests& tests) const noexcept {
  const int blocks = station_.blocks;
  // An answer that a silent channel leaves untestable neither confirms nor takes back the one before.
  const bool testable = tests.block().usable.contains(isolation_.monitored());
  return testable && blocks <= kLastVoteBlock && (blocks & (blocks - 1)) == 0;
}

void Diagnosis::vote(const Terms& terms, const BlockTests& tests) noexcept {
  if (!is_vote_due(tests)) return;
  answer_ = isolation_.vote(tests, terms.last.calm);
  station_.asked = true;
  const Suspicion suspected = suspect(terms, tests, answer_);
  answer_.strict = suspected.isolated;
  note_suspicion(terms, tests, suspected);
}

/// What the isolation of one station makes of the candidate that the stations before it have named.
void Diagnosis::note_suspicion(const Terms& terms, const BlockTests& tests, const Suspicion& suspected) noexcept {
  const SensorSet monitored = isolation_.monitored(), usable = tests.block().usable;
  const TestLimits& limits = terms.settings.limits;
  const SetTest& full = tests.of(monitored & usable);
  const bool visible = !full.consistent(limits) || !full.parity_consistent(limits);
  // A fault may come and go within a station: a block without it neither confirms nor takes back.
  if (suspected.isolated.empty() && !visible) return;
  if (suspected.isolated != episode_.candidate) {
    episode_.take_back();
    episode_.candidate = suspected.isolated;
    episode_.by_scatter = suspected.by_scatter;
  }
  station_.answered = !suspected.isolated.empty();
  // A station at which the fault cannot be seen confirms nothing.
  if (suspected.isolated.empty() || !visible) return;
  episode_.by_scatter = episode_.by_scatter && suspected.by_scatter;
  const SetTest& survivors = tests.of((monitored - suspected.isolated) & usable);
  const double apart_rad = terms.settings.config.distinct_attitude_angle_rad;
  if (survivors.tested) episode_.agreeing.add(known_direction(survivors, apart_rad), apart_rad);
}

SensorSet Diagnosis::noise_confirmed(const SensorArray& array, const ChannelFacts& facts) const noexcept {
  const SensorSet out = array.units().whole(facts.noisy_long_enough());
  const bool at_stations = episode_.by_scatter && episode_.agreeing.size() >= ChannelFacts::kConfirm;
  return at_stations && isolation_.provisional_grade() >= 1 ? out | episode_.candidate : out;
}

/// Until the calibration is believed a sensor is excluded only if the others agree at every attitude on record; once
/// it has been refuted, by no evidence: that rests on what was learned a moment ago.
bool Diagnosis::may_exclude(const Terms& terms, SensorSet isolated) const noexcept {
  if (!terms.check.open()) return true;
  const CalibrationCheck::Terms by{terms.in_force.array, terms.in_force.gravity, terms.settings.limits};
  return !terms.check.finding().contradicted && terms.check.corroborates(by, isolation_.monitored(), isolated);
}

SensorSet Diagnosis::isolated(const Terms& terms) const noexcept {
  const SensorSet monitored = isolation_.monitored();
  if (asserted_left_ > 0 && episode_.open && !scan_.asserted.empty() &&
      terms.in_force.array.units().count(scan_.asserted) <= asserted_left_ && may_exclude(terms, scan_.asserted))
    return scan_.asserted;
  if (isolation_.confirmed_grade() < 1 || episode_.candidate.empty()) return {};
  const int survivors = (monitored - episode_.candidate).size();
  int needed = terms.settings.config.isolation_stations;
  if (survivors <= 3 && needed < 2) needed = 2;  // three survivors have no parity: one station may be a mirror
  if (episode_.by_scatter && isolation_.provisional_grade() >= 1) return {};  // provisionally, and by `noise_confirmed`
  // At a few stations its scatter may be pushes that the others do not feel, and a liar hides.
  if (episode_.by_scatter && needed < kScatterStations) needed = kScatterStations;
  const bool agreed = episode_.agreeing.size() >= needed && may_exclude(terms, episode_.candidate);
  return agreed ? episode_.candidate : SensorSet{};
}

Conclusion Diagnosis::conclude(const Terms& terms, const BlockReport& report, NoiseKnowledge noise) noexcept {
  using Kind = BlockReport::Kind;
  Conclusion out;
  out.refuted = report.kind == Kind::alarm && asserted_left_ == 0 && !terms.in_force.owes_calibration();
  if (may_accuse(terms.machine.mode)) {
    out.isolated = episode_.open ? isolated(terms) : SensorSet{};
    if (!out.isolated.empty())
      last_grade_ = asserted_left_ > 0 && out.isolated == scan_.asserted ? Grade::assumed : Grade::confirmed;
    const bool by_parity =
        episode_.open && noise.learned && report.kind == Kind::alarm && report.cause == Cause::parity;
    const SensorSet odd = by_parity && may_exclude(terms, answer_.parity) ? answer_.parity : SensorSet{};
    // Where all sensors may be noisier than stated, the scatter of one may be its share of that.
    const SensorSet scatters =
        noise.learned || noise.others_as_stated ? noise_confirmed(terms.in_force.array, terms.facts) : SensorSet{};
    out.aside = aside_ = (odd | scatters) & terms.machine.sensors.in_service;
  }
  if (out.refuted) asserted_left_ = -1;
  return out;
}

/// Who may corroborate against a fault set of the assumed size: those at rest, and those that scatter by themselves
/// whichever so many others hang.
SensorSet Diagnosis::corroborating(const Terms& terms) const noexcept {
  const SensorSet noisy = terms.facts.noisy_for_certain();
  if (noisy.empty()) return terms.last.calm;  // before the grade, which is dear
  const SensorSet in_service = terms.machine.sensors.in_service;
  if (asserted_left_ > provisional_grade(terms.in_force.array, in_service & terms.last.usable)) return terms.last.calm;
  return terms.last.calm | noisy;
}

void Diagnosis::rescan(const Terms& terms, const BlockTests& tests, double turn_rad,
                       double reference_turn_rad) noexcept {
  consistent_ = isolation_.live();
  if (!terms.last.known) return;
  const int priors = terms.settings.protection_faults;
  int depth = std::max(priors, asserted_left_);
  if (episode_.open && isolation_.confirmed_grade() > depth) depth = isolation_.confirmed_grade();
  const SensorLedger& sensors = terms.machine.sensors;
  const int aside = terms.in_force.array.units().count(sensors.provisionally_excluded & terms.last.evidence.usable);
  scan_ = isolation_.scan(tests, sensors.in_service, depth, asserted_left_,
                          {priors, terms.settings.k_integrity, aside, episode_.open, terms.machine.not_yet_validated},
                          corroborating(terms));
  scan_.protection_rad += turn_rad;
  scan_.protection_rad += reference_turn_rad;
}

void Diagnosis::follow_rest(const Terms& terms, const BlockReport& report) noexcept {
  rest_.follow(terms.in_force.array, terms.last.evidence);
  const bool passed = report.kind == BlockReport::Kind::clean && !episode_.open;
  if (passed && !terms.in_force.owes_calibration()) rest_.take(terms.last.evidence);
}

}  // namespace PLUMB_ABI
}  // namespace plumb

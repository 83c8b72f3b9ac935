#include "motion_attack.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <stdexcept>

#include "force_check.hpp"

namespace plumb_bench {
namespace {

using namespace plumb;

constexpr double kDuration_s = 3.0;
constexpr std::size_t kBegin = 1000;     ///< samples; healthy before
constexpr std::size_t kTrial = 32;       ///< samples that an adaptive adversary looks ahead
constexpr std::size_t kLeastOfLie = 64;  ///< samples before the others change what they do
constexpr int kTrials = 8;

struct Layout {
  FlightArray array;
  int sensors;
};
constexpr Layout kLayouts[] = {{FlightArray::cone, 4},   {FlightArray::cone, 5},   {FlightArray::cone, 6},
                               {FlightArray::cone, 8},   {FlightArray::cone, 12},  {FlightArray::triads, 6},
                               {FlightArray::triads, 9}, {FlightArray::triads, 12}};

FlightCase drawn_case(Draw& draw) {
  FlightCase out;
  const Layout& layout = kLayouts[draw.below(static_cast<int>(std::size(kLayouts)))];
  out.array = layout.array;
  out.sensors = layout.sensors;
  out.kind = static_cast<scenario::FlightKind>(draw.below(scenario::kFlightKinds));
  out.gyros = 1 + draw.below(2);
  out.max_faults = draw.below(2) == 0 ? kMotionDepth : 1 + draw.below(kMotionDepth);
  constexpr int kShortest[] = {1, 1, 1, 4, 32};
  out.shortest_block = kShortest[draw.below(static_cast<int>(std::size(kShortest)))];
  out.duration_s = kDuration_s;
  out.seed = draw.bits();
  return out;
}

/// What the flight reads without the adversary, and the truth.
struct Told {
  std::vector<MotionSample> sample;
  std::vector<Vec3> force;
};

Told told_of(const FlightCase& one) {
  Told out;
  feed(one, [&](const scenario::FlightSample& truth, const MotionSample& sample) {
    out.sample.push_back(sample);
    out.force.push_back(truth.specific_force_mps2);
  });
  return out;
}

/// Units that lie, as many as are promised for; one where a fault is at best detected, and nobody may be blamed.
void draw_liars(AttackKind kind, int more_units, const FlightCase& one, const FlightBrief& brief, Draw& draw,
                LieScene* scene, int* units_lying) {
  const SensorUnits& units = brief.array.units();
  const bool any = kind == AttackKind::adaptive;
  const bool gyro = kind == AttackKind::gyro || kind == AttackKind::both || (any && draw.below(3) == 0);
  if (gyro) scene->gyro = draw.below(one.gyros);
  if (kind == AttackKind::gyro) return;
  const int grade = std::min(motion_grade(brief.array, brief.array.all()), brief.setup.max_faults);
  const int most = std::max(grade, 1) - (gyro && one.gyros == 1 ? 1 : 0);
  if (most < 1) return;
  const int lying = more_units > 0 ? most + more_units : 1 + draw.below(most);
  while (units.count(scene->liars) < lying)
    scene->liars = scene->liars | units.sensors_of(SensorSet::of(draw.below(units.size())));
  *units_lying = lying;
}

std::string words_of(const FlightCase& one, const LieScene& scene, int units_lying) {
  char text[160];
  std::snprintf(text, sizeof text, "%s, %d sensors%s, %d gyro%s, max_faults %d, shortest_block %d, %d lying unit%s%s",
                to_string(one.kind), one.sensors, one.array == FlightArray::triads ? " on chips" : "", one.gyros,
                one.gyros == 1 ? "" : "s", one.max_faults, one.shortest_block, units_lying, units_lying == 1 ? "" : "s",
                scene.gyro >= 0 ? ", a lying gyro" : "");
  return text;
}

/// Attack on one flight, with what the adversary does next.
class Attack {
 public:
  Attack(AttackKind kind, std::uint64_t number, int more_units)
      : draw_(number), one_(drawn_case(draw_)), brief_(brief_of(one_)), told_(told_of(one_)) {
    adaptive_ = kind == AttackKind::adaptive;
    scene_.array = brief_.array;
    scene_.map = least_squares(brief_.array, brief_.array.all());
    draw_liars(kind, more_units, one_, brief_, draw_, &scene_, &out_.units_lying);
    out_.scene = words_of(one_, scene_, out_.units_lying);
    sensors_ = drawn_lie(scene_, draw_);
    gyro_ = drawn_lie(scene_, draw_);
    if (const auto sound = monitor_.configure(brief_.array, brief_.setup); !sound)
      throw std::runtime_error(describe(sound.error().code));
  }

  AttackOutcome run() {
    for (std::size_t k = 0; k < told_.sample.size(); ++k) {
      if (k >= kBegin) plan(k - kBegin);
      if (loses_rows_ && draw_.below(150) == 0) continue;
      past_.add(told_.force[k]);
      judge(monitor_.step(k < kBegin ? told_.sample[k]
                                     : with_lie(told_.sample, kBegin, k - kBegin, scene_, sensors_, gyro_)),
            k >= kBegin);
      if (k >= kBegin) host();
    }
    return out_;
  }

 private:
  /// Before sample k of the attack.
  void plan(std::size_t k) {
    if (adaptive_ && k % kTrial == 0) {
      choose(k);
    } else if (!adaptive_ && k >= next_change_) {
      next_change_ = k + kLeastOfLie + static_cast<std::size_t>(draw_.below(1024));
      sensors_ = drawn_lie(scene_, draw_);
      gyro_ = drawn_lie(scene_, draw_);
    }
  }

  /// Of some lies, the one that on a copy of the monitor brings the healthy closest to be blamed.
  void choose(std::size_t k) {
    const Lie sensors = sensors_, gyro = gyro_;
    double best = value_of(k, sensors, gyro);
    for (int trial = 0; trial < kTrials; ++trial) {
      const bool fresh = draw_.below(3) == 0;
      const Lie a = fresh ? drawn_lie(scene_, draw_) : changed_lie(sensors, scene_, draw_);
      const Lie b = fresh ? drawn_lie(scene_, draw_) : changed_lie(gyro, scene_, draw_);
      const double value = value_of(k, a, b);
      if (value <= best) continue;
      best = value;
      sensors_ = a, gyro_ = b;
    }
  }

  double value_of(std::size_t k, const Lie& sensors, const Lie& gyro) {
    *copy_ = monitor_;
    for (std::size_t j = k; j < k + kTrial && kBegin + j < told_.sample.size(); ++j)
      copy_->step(with_lie(told_.sample, kBegin, j, scene_, sensors, gyro));
    const MotionVerdict& v = copy_->verdict();
    const SensorSet healthy = brief_.array.all() - scene_.liars;
    const Vec3 truth = told_.force[std::min(kBegin + k + kTrial, told_.force.size()) - 1];
    const double off = v.sample.validity == ForceValidity::bounded ? norm(minus(v.sample.force_mps2, truth)) : 0.0;
    return 100.0 * ((v.isolated | v.excluded) & healthy).size() + 2.0 * (v.suspects & healthy).size() -
           3.0 * (v.suspects & scene_.liars).size() - 10.0 * ((v.isolated | v.excluded) & scene_.liars).size() +
           off / (1.0 + v.sample.bound_mps2);
  }

  /// A host that does what it may: liars leave service and return, evidence is taken back, rows are lost.
  void host() {
    if (draw_.below(400) != 0) return;
    switch (draw_.below(4)) {
      case 0: monitor_.forget(); break;
      case 1: monitor_.set_in_service(brief_.array.all() - scene_.liars); break;
      case 2: monitor_.set_in_service(brief_.array.all()); break;
      default: loses_rows_ = !loses_rows_; break;
    }
  }

  /// One unit that is not isolated may lie. A bound that assumes the gyro promises nothing where that one lies, and
  /// where nothing checks the sensors left all of them must be honest.
  bool promised(const SpecificForce& force, bool attacked) const {
    if (force.validity == ForceValidity::none) return false;
    const bool gyro_lies = attacked && scene_.gyro >= 0;
    if (gyro_lies && force.gyro_assumed) return false;
    const int lying = attacked ? brief_.array.units().count(force.used & scene_.liars) : 0;
    const int gyro_units = gyro_lies && one_.gyros == 1 ? 1 : 0;
    return lying + gyro_units <= (force.validity == ForceValidity::bounded ? 1 : 0);
  }

  void check(const SpecificForce& force, std::size_t samples, bool attacked, BoundTally* tally) {
    if (past_.count() <= 2 * samples || !promised(force, attacked)) return;
    const std::uint64_t before = tally->violations;
    check_bound(force, past_.mean(samples), tally);
    if (tally->violations > before && out_.passed_at_s < 0.0) out_.passed_at_s = force.time_s;
  }

  void judge(const MotionVerdict& v, bool attacked) {
    const SensorSet named = v.isolated | v.excluded;
    const bool honest_gyros = !attacked || scene_.gyro < 0;
    if ((v.alarm && !attacked) || (v.gyros_disagree && honest_gyros)) out_.false_alarm = true;
    if (v.alarm) out_.alarm = true;
    if (!(named & scene_.liars).empty()) out_.isolated = true;
    if (!(attacked ? scene_.liars : SensorSet()).contains(named) && !out_.blamed) {
      out_.blamed = true;
      out_.blamed_at_s = v.sample.time_s;
    }
    check(v.sample, static_cast<std::size_t>(one_.shortest_block), attacked, &out_.sample);
    if (v.block_ended) check(v.block, kForceBlock, attacked, &out_.block);
  }

  Draw draw_;
  FlightCase one_;
  FlightBrief brief_;
  Told told_;
  LieScene scene_;
  Lie sensors_, gyro_;
  MotionMonitor monitor_;
  std::unique_ptr<MotionMonitor> copy_ = std::make_unique<MotionMonitor>();
  TrueForce past_;
  AttackOutcome out_;
  std::size_t next_change_ = 0;
  bool adaptive_ = false, loses_rows_ = false;
};

}  // namespace

const char* to_string(AttackKind kind) noexcept {
  switch (kind) {
    case AttackKind::sensors: return "accelerometers";
    case AttackKind::gyro: return "a gyro";
    case AttackKind::both: return "both";
    case AttackKind::adaptive: return "adaptive";
  }
  return "";
}

AttackOutcome attack(AttackKind kind, std::uint64_t number, int more_units) {
  return std::make_unique<Attack>(kind, number, more_units)->run();
}

}  // namespace plumb_bench

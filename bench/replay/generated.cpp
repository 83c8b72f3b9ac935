// Plays a generated case: the simulator's rows into a monitor, and what the host does on the way.
#include <limits>
#include <memory>

#include "plan.hpp"
#include "player.hpp"

namespace plumb_replay {
inline namespace PLUMB_ABI {

using namespace plumb;

namespace {

constexpr double kMilligee_mps2 = 1e-3 * kG0_mps2;
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

class Host {
 public:
  Host(const Plan& plan, Player& player, Draws& draws) : plan_(plan), player_(player), draws_(draws) {}

  void before(const scenario::Truth& truth) {
    const int station = static_cast<int>(truth.station);
    if (station != station_) at_station(station);
    if (plan_.situation == Situation::turning) tell_turn(truth);
    const bool cuts = plan_.power_cycles || plan_.situation == Situation::power_cycle;
    if (cuts && draws_.one_in(plan_.situation == Situation::power_cycle ? 150 : 600)) player_.power_cycle();
    if (plan_.situation == Situation::bad_snapshot && draws_.one_in(500)) {
      player_.power_cycle(static_cast<Player::Damage>(draws_.below(4)));
    }
  }

 private:
  void at_station(int station) {
    station_ = station;
    switch (plan_.situation) {
      case Situation::recalibrate:
        if (station % 7 == 4) player_.recalibrate();
        break;
      case Situation::offer_good:
        if (station % 11 == 5) offer_good();
        break;
      case Situation::offer_wrong:
        if (station % 5 == 4) offer_wrong();
        break;
      case Situation::offer_and_ask:
        if (station % 3 == 2) draws_.one_in(2) ? player_.recalibrate() : offer_good();
        break;
      case Situation::reset: reset(); break;
      case Situation::inhibit:
        if (draws_.one_in(3)) player_.inhibit(frozen_ = !frozen_);
        break;
      case Situation::gravity:
        if (draws_.one_in(3)) set_gravity();
        break;
      case Situation::storage:
        if (station == 4 || station == 9) overwrite();
        break;
      default: break;
    }
  }

  void offer_good() {
    if (plan_.has_other) return player_.offer(plan_.other_model, plan_.other_array);
    player_.offer(player_.monitor().model(), player_.monitor().array());
  }

  void offer_wrong() {
    SensorModel model = plan_.has_other ? plan_.other_model : player_.monitor().model();
    SensorCoefficients& victim = model.sensor[static_cast<std::size_t>(draws_.below(model.size))];
    switch (draws_.below(5)) {
      case 0: victim.bias[0] += draws_.either_sign(0.1, 3.0) * kMilligee_mps2; break;
      case 1: victim.scale[0] *= 1.0 + draws_.either_sign(1e-4, 3e-3); break;
      case 2: victim.bias[0] += 100.0 * kMilligee_mps2; break;
      case 3: victim.bias[0] = kNone; break;
      default: model.size -= 1; break;
    }
    player_.offer(model, plan_.has_other ? plan_.other_array : player_.monitor().array());
  }

  void reset() {
    const std::uint64_t key = plan_.setup.config.reset_key;
    const bool failed = player_.monitor().verdict().state == HealthState::failed;
    if (!failed && !draws_.one_in(12)) return;
    if (draws_.one_in(3)) player_.reset(key + 1, player_.monitor().array().all());
    const SensorSet some(static_cast<std::uint32_t>(draws_.seed()));
    player_.reset(key, draws_.one_in(3) ? some & player_.monitor().array().all() : player_.monitor().array().all());
  }

  void set_gravity() {
    GravityReference gravity = plan_.setup.gravity;
    gravity.g_mps2 += draws_.normal() * 0.3 * kMilligee_mps2;
    if (draws_.one_in(5)) gravity.sigma_mps2 *= 10.0;
    if (draws_.one_in(8)) gravity.g_mps2 = draws_.one_in(2) ? 1.0 : kNone;
    player_.set_gravity(gravity);
  }

  void overwrite() {
    const MonitorSetup& setup = player_.setup();
    player_.overwrite(draws_.one_in(2) ? 0U : 0xFFU);
    const auto wrong = std::make_unique<MonitorSetup>(setup);
    wrong->config.window = 0;
    unconfigured_rows_ = 5;
    if (draws_.one_in(2)) player_.configure(*wrong);
  }

  /// Told truly, as unknown, or as what it is not; and not anew while nothing changes.
  void tell_turn(const scenario::Truth& truth) {
    const bool turning = norm(truth.rate_radps) > 0.0;
    if (turning == turning_) return;
    turning_ = turning;
    Rotation rotation{turning, draws_.one_in(2), truth.rate_radps};
    if (draws_.one_in(5)) rotation.rate_radps = scaled(rotation.rate_radps, 1.2);
    player_.set_rotation(rotation);
    if (draws_.one_in(4)) player_.set_rotation({true, true, {kNone, 0.0, 0.0}});
  }

 public:
  /// A monitor whose storage was lost runs on for a few samples, then is configured anew.
  void after() {
    if (unconfigured_rows_ > 0 && --unconfigured_rows_ == 0) player_.configure();
  }

 private:
  const Plan& plan_;
  Player& player_;
  Draws& draws_;
  int station_ = 0, unconfigured_rows_ = 0;
  bool frozen_ = false, turning_ = false;
};

/// Raw values of a tool that is pushed: what every sensor shows more.
void push(const Plan& plan, const scenario::Truth& truth, Sample& sample) {
  if (truth.station % 3 != 0) return;
  const scenario::Tool& tool = plan.scenario.tool;
  for (int i = 0; i < tool.datasheet.size; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const double sense = tool.model.reads == Reads::gravity ? 1.0 : -1.0;
    sample.raw[k] += sense * tool.model.scale_at(i, sample.temperature_degc) * dot(tool.axes[k], plan.push_mps2);
  }
}

/// Rows of a log of station means, out of samples.
class Mean {
 public:
  explicit Mean(int samples) : samples_(samples) {}
  /// True where a mean is complete: then `sample` is it.
  bool take(Sample& sample) {
    if (samples_ <= 1) return true;
    if (sum_.count == 0 || sum_.delivered != sample.delivered) {
      sum_ = sample;
      sum_.count = 1;
      return false;
    }
    for (std::size_t i = 0; i < sample.raw.size(); ++i) sum_.raw[i] += sample.raw[i];
    sum_.time_s = sample.time_s;
    if (++sum_.count < static_cast<std::uint32_t>(samples_)) return false;
    sample = sum_;
    for (double& raw : sample.raw) raw /= samples_;
    sum_.count = 0;
    return true;
  }

 private:
  int samples_;
  Sample sum_ = empty();
  static Sample empty() {
    Sample out;
    out.count = 0;
    return out;
  }
};

void play(const CaseNumber& number, const Stage& stage) {
  Draws draws(number.seed, static_cast<std::uint64_t>(number.number));
  const auto plan = std::make_unique<Plan>();
  const bool made = make_plan(number, draws, stage.coverage, *plan);
  auto simulator = scenario::Simulator::make(plan->scenario);
  if (!made || !simulator) {
    stage.coverage.met("case", "not playable");
    if (!simulator) std::fprintf(stderr, "%s: %s\n", number.name().c_str(), simulator.error().c_str());
    return;
  }
  Player player(stage, plan->setup);
  const bool configured = plan->situation == Situation::storage || player.configure();
  stage.coverage.met("case", configured ? "played" : "setup refused");
  Host host(*plan, player, draws);
  Mean mean(plan->samples_per_row);
  const bool pushed = norm(plan->push_mps2) > 0.0;
  for (Sample sample; simulator->next(sample);) {
    if (pushed) push(*plan, simulator->truth(), sample);
    if (!mean.take(sample)) continue;
    if (player.rows() == 10 && plan->situation == Situation::storage) player.configure();
    host.before(simulator->truth());
    player.step(sample);
    host.after();
  }
  player.finish();
}

}  // namespace

}  // namespace PLUMB_ABI

#if PLUMB_CAPACITY == 8
void play_generated_8(const CaseNumber& number, const Stage& stage) { play(number, stage); }
#else
void play_generated_24(const CaseNumber& number, const Stage& stage) { play(number, stage); }
#endif

}  // namespace plumb_replay

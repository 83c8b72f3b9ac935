/// A monitor that is told anything of motion, and its twin that is told nothing: what must be equal in both while no
/// block at rest has been judged since (REQ-200).
#pragma once

#include <string>

#include "support/simulated_tool.hpp"

namespace plumb_test {

class MotionTwin {
 public:
  explicit MotionTwin(const plumb::HealthMonitor& monitor) : told(monitor), twin_(monitor) { begin_anew(); }

  /// One sample for both. What motion decided though it must not, in words; empty where it did not.
  std::string step(const plumb::Sample& sample, const plumb::MotionFinding& finding) {
    told.set_motion(finding);
    const plumb::SensorSet before = told.verdict().in_service;
    const plumb::Verdict& v = told.step(sample);
    const plumb::Verdict& w = twin_.step(sample);
    std::string wrong = of_record(v, before, finding);
    if (wrong.empty() && !v.tick && !w.tick) wrong = rests_ ? at_rest(v, w) : between(v, w);
    lost_ = lost_ || v.transition.event == plumb::HealthEvent::channel_lost;
    if (v.tick) rests_ = (v.usable & plumb::Usable::stationary) != 0;
    if (v.tick || w.tick) begin_anew();
    return wrong;
  }
  /// The host has done something to `told`, or rest has spoken: from here on the twin is compared anew.
  void begin_anew() {
    twin_ = told;
    twin_.set_motion({});
    lost_ = false;
  }

  plumb::HealthMonitor told;
  int alarms = 0, exclusions = 0;  ///< that came from motion

 private:
  std::string of_record(const plumb::Verdict& v, plumb::SensorSet before, const plumb::MotionFinding& finding) {
    using plumb::HealthEvent;
    const plumb::TransitionRecord& t = v.transition;
    if (t.sequence == 0 || t.cause != plumb::Cause::parity_in_motion) return "";
    if (t.event != HealthEvent::alarm && t.event != HealthEvent::provisional_exclusion)
      return std::string("a record of motion with the event ") + to_string(t.event);
    const bool excludes = t.event == HealthEvent::provisional_exclusion;
    ++(excludes ? exclusions : alarms);
    if (t.to != plumb::HealthState::suspect) return std::string("motion led to ") + to_string(t.to);
    if (t.grade != (excludes ? plumb::Grade::provisional : plumb::Grade::none)) return "another grade than provisional";
    const bool found = (finding.excluded & before).contains(t.sensors);
    const bool fits = found && t.sensors.empty() != excludes;
    return fits ? "" : "the record names others than were found";
  }
  /// A block at rest has ended, and none in motion since.
  static std::string at_rest(const plumb::Verdict& v, const plumb::Verdict& w) {
    if ((v.qualifiers & plumb::Qualifier::moving) != 0) return "";
    return v.state == w.state && v.in_service == w.in_service ? "" : "motion counted at rest";
  }
  std::string between(const plumb::Verdict& v, const plumb::Verdict& w) const {
    using plumb::HealthEvent;
    using plumb::HealthState;
    using plumb::Qualifier;
    const bool doubts =
        v.transition.event == HealthEvent::alarm || v.transition.event == HealthEvent::provisional_exclusion;
    if (v.transition.sequence != 0 && w.transition.sequence == 0 && doubts &&
        v.transition.cause != plumb::Cause::parity_in_motion)
      return "motion passes for rest";
    if (v.excluded != w.excluded) return "a sensor was excluded for good";
    if (v.absent != w.absent) return "a channel was lost";
    if (!w.in_service.contains(v.in_service)) return "a sensor was reinstated";
    // A channel that falls silent beside a provisional exclusion may leave fewer than three axes.
    if (v.state == HealthState::failed && w.state != HealthState::failed && !lost_now(v)) return "failed";
    if (v.state == HealthState::degraded_3_sensor && w.state != v.state) return "degraded";
    if (v.state == HealthState::recalibrating && w.state != v.state) return "a recalibration began";
    if (v.stations_on_record != w.stations_on_record) return "a station counts towards the isolation timeout";
    constexpr int kSame = Qualifier::timed_out | Qualifier::not_yet_validated | Qualifier::initial_calibration;
    if ((v.qualifiers & kSame) != (w.qualifiers & kSame)) return "the timeout or the validation changed";
    if (v.norm_mismatch.kind != w.norm_mismatch.kind) return "a norm mismatch was found";
    return "";
  }
  bool lost_now(const plumb::Verdict& v) const {
    return lost_ || v.transition.event == plumb::HealthEvent::channel_lost;
  }

  plumb::HealthMonitor twin_;
  bool lost_ = false;
  bool rests_ = false;  ///< the last block that was judged was one at rest
};

/// A tool that is shaken and held still, with faults that come and go, a host that asks, inhibits and resets, and a
/// monitor in motion that says anything of anybody.
class MotionLife {
 public:
  MotionLife(int n, std::uint64_t seed) : noise_(seed), n_(n), rig_(cone_array(n), {}, seed) {
    rig_.prove();
    if (noise_.uniform() < 0.3) rig_.restart();  // not yet validated
  }
  std::string run(int blocks) {
    MotionTwin twin(rig_.monitor);
    std::string wrong;
    for (block = 0; block < blocks && wrong.empty(); ++block) {
      turn(twin.told);
      twin.begin_anew();
      for (int k = 0; k < rig_.setup.config.window && wrong.empty(); ++k) wrong = twin.step(sample(), finding());
    }
    heard = twin.alarms + twin.exclusions;
    return wrong;
  }
  int heard = 0;  ///< records of what was found in motion
  int block = 0;

 private:
  void turn(plumb::HealthMonitor& monitor) {
    if (noise_.uniform() < 0.5) {
      const bool rests = noise_.uniform() < 0.4;
      rms_mps2_ = rests ? 0.0 : std::pow(10.0, -3.0 + 4.0 * noise_.uniform());
    }
    if (rms_mps2_ == 0.0 && noise_.uniform() < 0.5) direction_ = random_direction(noise_);
    if (noise_.uniform() < 0.1) {
      const int faulty = static_cast<int>(noise_.uniform() * n_);
      const double bias_mps2 = noise_.uniform() < 0.4 ? 0.0 : 5.0 * noise_.uniform();
      const bool silent = noise_.uniform() < 0.1;
      rig_.distort = [=](int i, double r, int) { return i != faulty ? r : silent ? std::nan("") : r + bias_mps2; };
    }
    if (noise_.uniform() < 0.05) monitor.inhibit(noise_.uniform() < 0.5);
    if (noise_.uniform() < 0.05) (void)monitor.request_recalibration();
    if (noise_.uniform() < 0.1) (void)monitor.reset(rig_.setup.config.reset_key, rig_.setup.array.all());
  }
  plumb::Sample sample() {
    plumb::Vec3 a = plumb::scaled(direction_, plumb::kG0_mps2);
    for (double& x : a) x += rms_mps2_ * noise_.normal();
    const double length = plumb::norm(a);
    return rig_.sample(plumb::scaled(a, 1.0 / length), length);
  }
  /// Mostly as before: what a monitor in motion has found it keeps for a while.
  plumb::MotionFinding finding() {
    if (noise_.uniform() < 0.9) return finding_;
    const auto bits = static_cast<std::uint32_t>(noise_.uniform() * 4294967296.0);
    finding_ = {noise_.uniform() < 0.7, plumb::SensorSet(noise_.uniform() < 0.5 ? bits : 1U << (bits % 8U))};
    if (noise_.uniform() < 0.3) finding_.excluded = plumb::SensorSet{};
    return finding_;
  }

  Noise noise_;
  int n_;
  Rig rig_;
  plumb::MotionFinding finding_;
  double rms_mps2_ = 0.0;
  plumb::Vec3 direction_{0, 0, 1};
};

}  // namespace plumb_test

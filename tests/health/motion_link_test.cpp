// Both monitors on one tool: it flies with a fault, rests, and flies again.
#include "plumb/health/motion_link.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "motion/rigid_motion.hpp"

namespace motion_link_test {
namespace {

using namespace plumb;
using plumb_test::direction_at;
using plumb_test::RigidMotion;

constexpr int kSensors = 6;
constexpr double kSigma_mps2 = 0.01;
constexpr std::uint64_t kPause = 20;  ///< samples that are not recorded between two ways to move

/// Six accelerometers at 1 kHz with a monitor of each kind, as an embedder would run them.
class Tool {
 public:
  Tool() : array_(plumb_test::cone_array(kSensors, kSigma_mps2)), setup_(plumb_test::motion_setup(kSensors)) {
    setup_.gyros = 2;
    rest_setup_.array = array_;
    rest_setup_.model = plumb_test::identity_model(kSensors);
    rest_setup_.gravity = {kG0_mps2, 1e-3, GravityModel::value};
    EXPECT_TRUE(health.configure(rest_setup_).has_value());
    EXPECT_TRUE(motion.configure(array_, setup_).has_value());
  }
  /// Of both monitors only the snapshot of the one at rest is left.
  void lose_power() {
    std::vector<std::uint8_t> bytes(HealthMonitor::snapshot_size_max());
    const Expected<std::size_t> size = health.snapshot(bytes.data(), bytes.size());
    ASSERT_TRUE(size.has_value());
    ASSERT_TRUE(health.restore(rest_setup_, bytes.data(), *size).has_value());
    ASSERT_TRUE(motion.configure(array_, setup_).has_value());
    number_ += 5000;
  }

  void fly(int samples) {
    number_ += kPause;
    RigidMotion flight(array_, setup_, 7);
    for (int k = 0; k < samples; ++k, ++number_) step(flight.sample(number_));
  }
  /// At one attitude for four blocks, at ever new ones.
  void rest(int attitudes) {
    for (int a = 0; a < attitudes; ++a, ++attitude_) {
      const Vec3 direction = direction_at(20.0 + 37.0 * (attitude_ % 4), 75.0 * attitude_ + 5.0);
      number_ += kPause;
      for (int k = 0; k < 128; ++k, ++number_) step(still(direction));
    }
  }
  bool has(HealthEvent event, Cause cause) const {
    for (const TransitionRecord& r : records) {
      if (r.event == event && r.cause == cause) return true;
    }
    return false;
  }

  HealthMonitor health;
  MotionMonitor motion;
  SensorSet faulty;
  std::vector<TransitionRecord> records;
  int settled = 0;

 private:
  MotionSample still(const Vec3& direction) {
    MotionSample s;
    s.time_s = static_cast<double>(number_) * setup_.sample_period_s;
    s.delivered = array_.all();
    for (int i = 0; i < kSensors; ++i)
      s.reading_mps2[static_cast<std::size_t>(i)] =
          dot(array_.axis(i), direction) * kG0_mps2 + kSigma_mps2 * noise_.normal();
    s.rate_given = {true, true};
    return s;
  }
  /// At rest the limits know nothing of lever arms.
  void tell_rotation(const Vec3& rate_radps) {
    const bool turns = norm(rate_radps) > HealthMonitor::kStillRate_radps;
    if (turns == turning_) return;
    turning_ = turns;
    EXPECT_TRUE(health.set_rotation({turns, false, {}}).has_value());
  }
  void step(MotionSample in) {
    for (int i = 0; i < kSensors; ++i) {
      if (faulty.has(i)) in.reading_mps2[static_cast<std::size_t>(i)] += 1.0;
    }
    tell_rotation(in.rate_radps[0]);
    motion.set_in_service(health.verdict().in_service);
    health.set_motion(motion_finding(motion.step(in)));
    Sample out;
    out.time_s = in.time_s;
    out.delivered = in.delivered;
    out.temperature_degc = 25.0;
    for (std::size_t i = 0; i < kSensors; ++i) out.raw[i] = in.reading_mps2[i];
    const Verdict& v = health.step(out);
    if (v.transition.sequence != 0) records.push_back(v.transition);
    if (!settles_motion(v)) return;
    motion.forget();
    ++settled;
  }

  SensorArray array_;
  MotionSetup setup_;
  MonitorSetup rest_setup_;
  plumb_test::Noise noise_{3};
  std::uint64_t number_ = 0;
  int attitude_ = 0;
  bool turning_ = false;
};

// Verifies: REQ-200
TEST(MotionLink, AFaultInFlightIsExcludedProvisionallyAndConfirmedAtRest) {
  Tool tool;
  tool.rest(8);
  ASSERT_EQ(tool.health.verdict().state, HealthState::nominal);
  tool.fly(400);
  EXPECT_EQ(tool.health.verdict().state, HealthState::nominal) << "a healthy flight";
  tool.records.clear();
  tool.faulty = SensorSet::of(3);
  tool.fly(600);
  EXPECT_TRUE(tool.has(HealthEvent::alarm, Cause::parity_in_motion));
  EXPECT_TRUE(tool.has(HealthEvent::provisional_exclusion, Cause::parity_in_motion));
  EXPECT_EQ(tool.records.size(), 2U) << "each told once";
  EXPECT_EQ(tool.health.verdict().state, HealthState::suspect);
  EXPECT_EQ(tool.health.verdict().provisionally_excluded, tool.faulty);
  EXPECT_EQ(tool.motion.verdict().sample.used, SensorSet::first(6) - tool.faulty);
  EXPECT_FALSE(tool.motion.verdict().alarm) << "the others agree";
  tool.rest(12);
  EXPECT_EQ(tool.health.verdict().excluded, tool.faulty);
  EXPECT_EQ(tool.health.verdict().state, HealthState::isolated);
  EXPECT_EQ(tool.records.back().event, HealthEvent::exclusion);
  EXPECT_EQ(tool.records.back().grade, Grade::confirmed);
  EXPECT_GT(tool.settled, 0);
  EXPECT_TRUE(tool.motion.verdict().excluded.empty()) << "forgotten: it is out of service";
  tool.records.clear();
  tool.fly(600);
  EXPECT_TRUE(tool.records.empty());
  EXPECT_EQ(tool.health.verdict().state, HealthState::isolated);
}

/// What motion has excluded is in the snapshot of the monitor at rest, which tells it to the one in motion.
// Verifies: REQ-200, REQ-163
TEST(MotionLink, APowerCycleInFlightDoesNotBringTheExcludedSensorBack) {
  Tool tool;
  tool.rest(8);
  tool.faulty = SensorSet::of(3);
  tool.fly(600);
  ASSERT_EQ(tool.health.verdict().provisionally_excluded, tool.faulty);
  tool.lose_power();
  tool.fly(20);
  EXPECT_EQ(tool.motion.verdict().sample.used, SensorSet::first(6) - tool.faulty);
  EXPECT_FALSE(tool.motion.verdict().alarm) << "nothing had to be found again";
  EXPECT_EQ(tool.health.verdict().provisionally_excluded, tool.faulty);
}

// Verifies: REQ-200
TEST(MotionLink, AFaultThatIsGoneAtRestIsRefutedAndTheSensorServesInFlightAgain) {
  Tool tool;
  tool.rest(8);
  tool.faulty = SensorSet::of(3);
  tool.fly(600);
  EXPECT_EQ(tool.health.verdict().provisionally_excluded, tool.faulty);
  tool.faulty = SensorSet();
  tool.rest(12);
  EXPECT_EQ(tool.health.verdict().state, HealthState::nominal);
  EXPECT_EQ(tool.records.back().event, HealthEvent::probation_passed);
  EXPECT_TRUE(tool.motion.verdict().excluded.empty());
  tool.records.clear();
  tool.fly(600);
  EXPECT_TRUE(tool.records.empty());
  EXPECT_EQ(tool.motion.verdict().sample.used, SensorSet::first(6));
}

// Verifies: REQ-200
TEST(MotionLink, WhatSettlesIsWhatRestOrTheOperatorDecided) {
  Verdict v;
  EXPECT_FALSE(settles_motion(v));
  v.transition.sequence = 1;
  for (int e = 0; e < kEventCount; ++e) {
    v.transition.event = static_cast<HealthEvent>(e);
    v.transition.from = v.transition.to = HealthState::suspect;
    const bool stays = settles_motion(v);
    v.transition.to = HealthState::isolated;
    const bool leaves = settles_motion(v);
    const HealthEvent event = v.transition.event;
    const bool always = event == HealthEvent::exclusion || event == HealthEvent::probation_passed ||
                        event == HealthEvent::reset || event == HealthEvent::fit_accepted;
    EXPECT_EQ(stays, always) << to_string(event);
    EXPECT_EQ(leaves, always || event == HealthEvent::passed_block) << to_string(event);
  }
}

}  // namespace
}  // namespace motion_link_test

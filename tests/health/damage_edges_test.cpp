// Edges of what a monitor believes: sizes that memory has damaged, figures of a snapshot that no monitor can have
// written.
#include <gtest/gtest.h>

#include <cstring>
#include <memory>

#include "first_calibration_support.hpp"
#include "snapshot_support.hpp"
#include "support/member.hpp"

// Serves: REQ-163

namespace health_damage_edges_test {
namespace {

using namespace plumb;
using plumb_test::Bytes;
using plumb_test::direction_at;
using plumb_test::member;
using plumb_test::Rig;
using plumb_test::snapshot_of;
using plumb_test::Tool;
using plumb_test::UncalibratedTool;

bool& configured_of(HealthMonitor& m) { return member<29, bool>(m); }
SensorSet& calibrated_of(HealthMonitor& m) { return member<22, SensorSet>(m); }
Mode& base_of(HealthMonitor& m) { return member<49, Mode>(m); }
Cause& suspicion_of(HealthMonitor& m) { return member<50, Cause>(m); }
BlockEvidence& evidence_of(HealthMonitor& m) { return member<87, BlockEvidence>(m); }
int& sensors_of(HealthMonitor& m) { return member<4, int>(member<3, SensorArray>(m)); }
int& model_size_of(HealthMonitor& m) { return member<1, SensorModel>(m).size; }
int& block_size_of(HealthMonitor& m) { return member<6, int>(member<80, BlockAccumulator>(m)); }

/// Where a figure lies in the snapshot: an archive that neither writes nor reads.
class Place {
 public:
  Place(int sensors, const void* wanted) : sensors_(sensors), wanted_(wanted) {}
  int sensors() const noexcept { return sensors_; }
  void fail() noexcept { ADD_FAILURE() << "the monitor itself is none"; }
  template <class T>
  void done(T&) noexcept {}
  template <class T, class Check>
  void scalar(T& figure, const Check&) noexcept {
    if (static_cast<const void*>(&figure) == wanted_) at = kSnapshotHeaderSize + end_;
    end_ += sizeof(T);
  }
  std::size_t at = 0;

 private:
  int sensors_;
  const void* wanted_;
  std::size_t end_ = 0;
};

/// The monitor's snapshot with another value in the place of `figure`, and sums that are true.
template <class T>
void forge(HealthMonitor& monitor, const T& figure, const T& lie, Bytes& bytes) {
  Place place(monitor.array().size(), &figure);
  transfer(place, monitor, AnyBits{});
  ASSERT_GT(place.at, 0U);
  std::memcpy(bytes.data() + place.at, &lie, sizeof lie);
  plumb_test::seal(bytes);
}

bool taken_up(const MonitorSetup& setup, const Bytes& bytes) {
  return std::make_unique<HealthMonitor>()->restore(setup, bytes.data(), bytes.size()).has_value();
}

// Negative: REQ-166
TEST(MonitorDamageEdge, ASizeThatDoesNotFitIsReportedBeforeItIsAnIndex) {
  Rig rig(plumb_test::tetrahedron());
  rig.prove();
  const auto reported = [&rig](const auto& damage) {
    auto hurt = std::make_unique<HealthMonitor>(rig.monitor);
    damage(*hurt);
    const bool taken = hurt->request_recalibration().has_value();
    const Verdict& v = hurt->step(rig.sample(direction_at(20, 20), kG0_mps2));
    return !taken && v.cause == Cause::memory && v.state == HealthState::failed;
  };
  EXPECT_FALSE(reported([](HealthMonitor& m) { m.inhibit(false); }));
  for (const int n : {2, 3, kCapacity + 1}) EXPECT_TRUE(reported([n](HealthMonitor& m) { sensors_of(m) = n; })) << n;
  EXPECT_TRUE(reported([](HealthMonitor& m) { model_size_of(m) = 3; }));
  EXPECT_TRUE(reported([](HealthMonitor& m) { block_size_of(m) = -1; }));
  EXPECT_TRUE(reported([](HealthMonitor& m) { block_size_of(m) = m.config().window; }));
  EXPECT_TRUE(reported([](HealthMonitor& m) { configured_of(m) = false; })) << "it passes for none that never was";
}

TEST(MonitorDamageEdge, AMonitorThatNeverWasHasNothingToSeal) {
  HealthMonitor none;
  none.inhibit(true);
  EXPECT_FALSE(none.request_recalibration().has_value());
  EXPECT_EQ(none.step(Sample{}).validity, Validity::invalid);
  EXPECT_EQ(none.verdict().cause, HealthMonitor().verdict().cause);
}

// Negative: REQ-163
TEST(ForgedEdge, ARecalibrationThatCameFromNoStateIsNotTakenUp) {
  Tool tool(4, {}, 5);
  tool.begin();
  HealthMonitor& m = tool.rig.monitor;
  const Bytes good = snapshot_of(m);
  for (const Mode from : {Mode::initial, Mode::failed, Mode::recalibrating, Mode::nominal}) {
    Bytes bytes = good;
    forge(m, base_of(m), from, bytes);
    EXPECT_EQ(taken_up(tool.rig.setup, bytes), from == Mode::nominal) << static_cast<int>(from);
  }
}

/// A suspicion that nobody is sent into recalibration with: the alarm of that kind is news all the same.
// Negative: REQ-163
TEST(ForgedEdge, ASuspicionThatAnAlarmWouldMeetHidesNoAlarm) {
  Tool tool(4, {}, 5);
  tool.rig.prove();
  tool.bias = {0.05, -0.04, 0.045, 0.035};
  tool.visit(1);
  HealthMonitor& m = tool.rig.monitor;
  for (int k = 0; k < 4 && !m.request_recalibration().has_value(); ++k) tool.visit(1);
  tool.visit(1);
  ASSERT_EQ(tool.state(), HealthState::recalibrating);
  ASSERT_EQ(suspicion_of(m), Cause::contradiction);
  Bytes bytes = snapshot_of(m);
  forge(m, suspicion_of(m), Cause::parity, bytes);
  ASSERT_TRUE(m.restore(tool.rig.setup, bytes.data(), bytes.size()).has_value());
  ASSERT_EQ(tool.state(), HealthState::recalibrating);
  tool.bias = {};
  tool.fault = [](int i, double r, int) { return i == 2 ? r + 0.3 : r; };
  tool.visit(1);
  EXPECT_EQ(tool.state(), HealthState::suspect);
}

// Negative: REQ-163
TEST(ForgedEdge, AVectorBeyondWhatReadingsMayBeIsNotTakenUp) {
  Rig rig(plumb_test::tetrahedron());
  rig.prove();
  Bytes bytes = snapshot_of(rig.monitor);
  EXPECT_TRUE(taken_up(rig.setup, bytes));
  forge(rig.monitor, evidence_of(rig.monitor).mean_mps2[1], 1e30, bytes);
  EXPECT_FALSE(taken_up(rig.setup, bytes));
}

// Negative: REQ-163
TEST(ForgedEdge, ACalibrationOfTwoSensorsIsNotTakenUp) {
  UncalibratedTool tool(4, 3);
  tool.start();
  tool.follow(40);
  ASSERT_TRUE(tool.calibrated());
  Bytes bytes = snapshot_of(tool.monitor);
  EXPECT_TRUE(taken_up(tool.setup, bytes));
  forge(tool.monitor, calibrated_of(tool.monitor), SensorSet::first(2), bytes);
  EXPECT_FALSE(taken_up(tool.setup, bytes));
}

}  // namespace
}  // namespace health_damage_edges_test

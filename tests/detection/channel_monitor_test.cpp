#include "plumb/detection/channel_monitor.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace channel_monitor_test {
namespace {

using namespace plumb;

Sample full_sample() {
  Sample s;
  s.delivered = SensorSet::first(4);
  for (double& v : s.raw) v = 1.0;
  return s;
}

ChannelMonitor monitor_of_four(double full_scale = 5.0) {
  ChannelMonitor gate;
  std::array<double, kCapacity> full{};
  full.fill(full_scale);
  gate.configure(4, full, 3);
  return gate;
}

// Verifies: REQ-144
// Negative: REQ-140
TEST(ChannelGate, SortsChannelsByWhatTheyDelivered) {
  ChannelMonitor gate = monitor_of_four();
  Sample s = full_sample();
  s.delivered = s.delivered.without(0);
  s.raw[1] = std::numeric_limits<double>::quiet_NaN();
  s.raw[2] = -4.98;  // 99.6 % of full scale
  const GateResult r = gate.gate(s);
  EXPECT_EQ(r.missing, SensorSet::of(0));
  EXPECT_EQ(r.not_finite, SensorSet::of(1));
  EXPECT_EQ(r.clipped, SensorSet::of(2));
  EXPECT_EQ(r.usable, SensorSet::of(2).with(3)) << "a clipped value is still evidence";
  EXPECT_FALSE(r.gap);
}

// Verifies: REQ-144
TEST(ChannelGate, UnknownFullScaleNeverClips) {
  Sample s = full_sample();
  s.raw[0] = 1e9;
  ChannelMonitor gate = monitor_of_four(0.0), known = monitor_of_four();
  EXPECT_TRUE(gate.gate(s).clipped.empty());
  EXPECT_EQ(known.gate(s).clipped, SensorSet::of(0));
}

// Verifies: REQ-141
TEST(ChannelGate, LossIsConfirmedAndSoIsReturn) {
  ChannelMonitor gate = monitor_of_four();
  Sample bad = full_sample();
  bad.raw[3] = std::numeric_limits<double>::infinity();
  gate.gate(bad);
  gate.gate(bad);
  EXPECT_TRUE(gate.lost().empty()) << "two bad samples are a glitch";
  gate.gate(bad);
  EXPECT_EQ(gate.lost(), SensorSet::of(3));
  EXPECT_EQ(gate.counters(3).not_finite, 3U);
  for (int k = 0; k < 2; ++k) gate.gate(full_sample());
  EXPECT_TRUE(gate.back().empty());
  gate.gate(full_sample());
  EXPECT_EQ(gate.back(), SensorSet::of(3));
  gate.reinstate(SensorSet::of(3));
  EXPECT_TRUE(gate.lost().empty());
  EXPECT_TRUE(gate.back().empty());
}

// Negative: REQ-141
TEST(ChannelGate, AGlitchBetweenGoodSamplesNeverAddsUp) {
  ChannelMonitor gate = monitor_of_four();
  Sample bad = full_sample();
  bad.delivered = bad.delivered.without(2);
  for (int k = 0; k < 100; ++k) {
    gate.gate(bad);
    gate.gate(full_sample());
  }
  EXPECT_TRUE(gate.lost().empty());
  EXPECT_EQ(gate.counters(2).missing, 100U);
}

// Verifies: REQ-141
TEST(ChannelGate, ASilentBusIsAGapAndLosesNoChannel) {
  ChannelMonitor gate = monitor_of_four();
  Sample silent = full_sample();
  silent.delivered = SensorSet{};
  for (int k = 0; k < 50; ++k) EXPECT_TRUE(gate.gate(silent).gap);
  EXPECT_TRUE(gate.lost().empty());
}

/// Hours without the end of a block: the count stands still before it could run over.
// Serves: REQ-144
TEST(ChannelGate, AMillionSamplesWithoutABlockLoseNoChannel) {
  ChannelMonitor channels;
  std::array<double, kCapacity> full_scale{};
  channels.configure(3, full_scale, 8);
  Sample sample;
  sample.delivered = SensorSet::first(3);
  for (int k = 0; k < 1000003; ++k) {
    sample.raw[0] = k % 7;
    ASSERT_EQ(channels.gate(sample).usable, sample.delivered);
  }
  EXPECT_TRUE(channels.lost().empty());
}

}  // namespace
}  // namespace channel_monitor_test

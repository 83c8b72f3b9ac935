#include "plumb/scenario/injector.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "plumb/scenario/library.hpp"

namespace plumb {
namespace scenario {
namespace injector_test {
namespace {

Fault make(FaultKind kind, int sensor, double onset, double magnitude) {
  Fault fault;
  fault.kind = kind;
  fault.sensor = sensor;
  fault.onset = onset;
  fault.magnitude = magnitude;
  return fault;
}

/// A recorded log: row k has time 0.1 k and the value 0.001 (k + 1) + sensor on every channel.
Sample recorded(int k) {
  Sample sample;
  sample.time_s = 0.1 * k;
  sample.delivered = SensorSet::first(4);
  for (std::size_t i = 0; i < 4; ++i) sample.raw[i] = 0.001 * (k + 1) + static_cast<double>(i);
  return sample;
}

Injector injector_for(const std::vector<Fault>& faults) {
  Datasheet sheet = paper_datasheet();
  for (DatasheetSensor& sensor : sheet.sensor) sensor.resolution_raw = 0.0;
  auto injector = Injector::make(sheet, sheet.model(), faults, 1);
  EXPECT_TRUE(injector) << injector.error();
  return *injector;
}

TEST(Injector, TouchesOnlyItsSensorFromOnsetOn) {
  Injector injector = injector_for({make(FaultKind::stuck_level, 2, 0.5, -3.0)});
  for (int k = 0; k < 10; ++k) {
    Sample sample = recorded(k);
    const SensorSet faulty = injector.apply(sample);
    EXPECT_EQ(faulty, k >= 5 ? SensorSet::of(2) : SensorSet());
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_EQ(sample.raw[i], i == 2 && k >= 5 ? -3.0 : recorded(k).raw[i]) << k << " " << i;
    }
  }
  EXPECT_TRUE(injector.without_effect().empty());
}

TEST(Injector, StuckAtLastKeepsTheLastFiniteValueBefore) {
  Injector injector = injector_for({make(FaultKind::stuck_last, 1, 0.5, 0.0)});
  for (int k = 0; k < 10; ++k) {
    Sample sample = recorded(k);
    if (k == 4) sample.raw[1] = std::numeric_limits<double>::quiet_NaN();
    injector.apply(sample);
    EXPECT_EQ(std::isnan(sample.raw[1]), k == 4);
    if (k != 4) {
      EXPECT_EQ(sample.raw[1], recorded(k < 4 ? k : 3).raw[1]) << k;
    }
  }
}

TEST(Injector, StuckAtLastFromTheFirstRowKeepsTheFirstValue) {
  Injector injector = injector_for({make(FaultKind::stuck_last, 1, 0.0, 0.0)});
  for (int k = 0; k < 5; ++k) {
    Sample sample = recorded(k);
    if (k == 0) sample.delivered = sample.delivered.without(1);
    injector.apply(sample);
    EXPECT_EQ(sample.raw[1], recorded(k < 1 ? k : 1).raw[1]) << k;
  }
}

TEST(Injector, FaultsInSequenceAndTogether) {
  Fault bias = make(FaultKind::bias_step, 0, 0.2, 1.0);
  bias.duration = 0.3;
  const Fault stuck = make(FaultKind::stuck_last, 0, 0.4, 0.0);
  const Fault other = make(FaultKind::stuck_level, 3, 0.4, 0.0);
  Injector injector = injector_for({bias, stuck, other});
  const double step = kPaperScale_VpMps2;
  for (int k = 0; k < 8; ++k) {
    Sample sample = recorded(k);
    const SensorSet faulty = injector.apply(sample);
    double expected = recorded(k).raw[0];
    if (k == 2 || k == 3) expected += step;
    if (k >= 4) expected = recorded(3).raw[0] + step;  // stuck while biased
    EXPECT_DOUBLE_EQ(sample.raw[0], expected) << k;
    EXPECT_EQ(faulty.has(3), k >= 4);
  }
}

TEST(Injector, ChangedChannelsAreDigitisedOthersAreNot) {
  Datasheet sheet = paper_datasheet();
  Injector injector = *Injector::make(
      sheet, sheet.model(), {make(FaultKind::bias_step, 0, 0.0, 100.0), make(FaultKind::bias_step, 1, 0.0, 0.01)}, 1);
  Sample sample = recorded(0);
  injector.apply(sample);
  EXPECT_EQ(sample.raw[0], kPaperFullScale_V);
  const double codes = sample.raw[1] / kPaperResolution_V;
  EXPECT_EQ(codes, std::floor(codes));
  EXPECT_EQ(sample.raw[2], recorded(0).raw[2]) << "not a whole code, and not to be touched";

  Sample mean = recorded(1);
  mean.count = 200;
  const double before = mean.raw[1];
  injector.apply(mean);
  EXPECT_DOUBLE_EQ(mean.raw[1], before + 0.01 * kPaperScale_VpMps2) << "a mean is not a code";
}

TEST(Injector, StationsAreCountedByTheirTags) {
  Fault fault = make(FaultKind::stuck_level, 0, 2.0, -1.0);
  fault.clock = Clock::station;
  fault.duration = 1.0;
  Injector injector = injector_for({fault});
  const std::uint32_t tags[] = {0, 17, 17, 0, 17, 4, 4, 0, 9, 9};
  for (int k = 0; k < 10; ++k) {
    Sample sample = recorded(k);
    sample.station = tags[k];
    EXPECT_EQ(injector.apply(sample).has(0), k >= 5 && k <= 7) << k;
  }
}

TEST(Injector, ReportsWhichFaultsHadNoEffect) {
  Fault late = make(FaultKind::stuck_level, 0, 100.0, 0.0);
  Fault over = make(FaultKind::stuck_level, 0, -5.0, 0.0);
  over.duration = 1.0;
  Fault untagged = make(FaultKind::stuck_level, 0, 1.0, 0.0);
  untagged.clock = Clock::station;
  Injector injector = injector_for({late, make(FaultKind::stuck_level, 1, 0.0, 0.0), over, untagged});
  for (int k = 0; k < 10; ++k) {
    Sample sample = recorded(k);
    injector.apply(sample);
  }
  EXPECT_EQ(injector.without_effect(), (std::vector<int>{0, 2, 3}));
}

TEST(Injector, DriftThatBeganBeforeTheLogGrowsFromItsFirstRow) {
  Injector injector = injector_for({make(FaultKind::drift, 0, 0.0, 0.1)});
  Sample first = recorded(0);
  first.time_s = 1.6e9;
  injector.apply(first);
  EXPECT_EQ(first.raw[0], recorded(0).raw[0]);
  Sample second = recorded(1);
  second.time_s = 1.6e9 + 2.0;
  injector.apply(second);
  EXPECT_DOUBLE_EQ(second.raw[0], recorded(1).raw[0] + kPaperScale_VpMps2 * 0.1 * 2.0);
}

TEST(Injector, MissingChannelsStayMissing) {
  Injector injector = injector_for({make(FaultKind::stuck_level, 0, 0.0, -1.0)});
  Sample sample = recorded(0);
  sample.delivered = sample.delivered.without(0);
  injector.apply(sample);
  EXPECT_FALSE(sample.delivered.has(0));
  EXPECT_EQ(sample.raw[0], recorded(0).raw[0]);
}

TEST(Injector, BadFaultsAreNamedByPosition) {
  const Datasheet sheet = paper_datasheet();
  const auto injector = Injector::make(
      sheet, sheet.model(), {make(FaultKind::stuck_level, 0, 0.0, 0.0), make(FaultKind::stuck_level, 9, 0.0, 0.0)}, 1);
  ASSERT_FALSE(injector);
  EXPECT_EQ(injector.error().rfind("fault 2: ", 0), 0U) << injector.error();
}

}  // namespace
}  // namespace injector_test
}  // namespace scenario
}  // namespace plumb

#include "plumb/scenario/delivery.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "plumb/scenario/course.hpp"
#include "plumb/scenario/library.hpp"

namespace plumb {
namespace scenario {
namespace delivery_test {
namespace {

Fault on_log(FaultKind kind, double magnitude, double first_row, double rows) {
  Fault fault;
  fault.kind = kind;
  fault.sensor = kWholeLog;
  fault.clock = Clock::row;
  fault.onset = first_row;
  fault.duration = rows;
  fault.magnitude = magnitude;
  return fault;
}

/// The rows in the order in which they arrive, of ten.
std::vector<int> order(const std::vector<Fault>& faults) {
  Delivery delivery(faults, 1);
  std::vector<int> rows;
  Delivery::Parcel parcel;
  for (std::uint64_t row = 0; row < 10; ++row) {
    Moment now;
    now.row = row;
    delivery.push(Sample(), now);
    while (delivery.pop(parcel)) rows.push_back(static_cast<int>(parcel.row));
  }
  delivery.finish();
  while (delivery.pop(parcel)) rows.push_back(static_cast<int>(parcel.row));
  EXPECT_TRUE(delivery.without_effect().empty());
  return rows;
}

TEST(Delivery, RowsAreLostDoubledSwappedAndOvertaken) {
  EXPECT_EQ(order({}), (std::vector<int>{0, 1, 2, 3, 4, 5, 6, 7, 8, 9}));
  EXPECT_EQ(order({on_log(FaultKind::drop, 1.0, 3, 2)}), (std::vector<int>{0, 1, 4, 5, 6, 7, 8, 9}));
  EXPECT_EQ(order({on_log(FaultKind::repeat, 0.0, 9, 2)}), (std::vector<int>{0, 1, 2, 3, 4, 5, 6, 7, 8, 8, 9, 9}));
  EXPECT_EQ(order({on_log(FaultKind::swap, 0.0, 2, 4)}), (std::vector<int>{0, 2, 1, 4, 3, 5, 6, 7, 8, 9}));
  EXPECT_EQ(order({on_log(FaultKind::late, 3.0, 2, 1)}), (std::vector<int>{0, 2, 3, 4, 1, 5, 6, 7, 8, 9}));
  EXPECT_EQ(order({on_log(FaultKind::late, 50.0, 9, 2)}), (std::vector<int>{0, 1, 2, 3, 4, 5, 6, 7, 8, 9}));
  EXPECT_EQ(order({on_log(FaultKind::swap, 0.0, 10, 5)}), (std::vector<int>{0, 1, 2, 3, 4, 5, 6, 7, 8, 9}))
      << "the last row has none to swap with and comes all the same";
}

TEST(Delivery, TimeRunsBehindAndShareOfRowsIsLost) {
  Delivery delivery({on_log(FaultKind::back, 2.0, 2, 1), on_log(FaultKind::drop, 0.25, 3, 1e9)}, 7);
  Delivery::Parcel parcel;
  int arrived = 0;
  for (std::uint64_t row = 0; row < 40000; ++row) {
    Sample sample;
    sample.time_s = static_cast<double>(row);
    Moment now;
    now.row = row;
    delivery.push(sample, now);
    while (delivery.pop(parcel)) {
      ++arrived;
      EXPECT_EQ(parcel.sample.time_s, static_cast<double>(parcel.row) - (parcel.row == 1 ? 2.0 : 0.0));
    }
  }
  EXPECT_NEAR(arrived / 40000.0, 0.75, 5.0 * std::sqrt(0.25 * 0.75 / 40000.0));
}

/// What the monitor sees of it: samples refused, nobody blamed, the output as it was.
TEST(Delivery, TheMonitorRefusesSamplesOutOfOrderAndExcludesNoSensor) {
  struct Case {
    FaultKind kind;
    double magnitude;
    bool refuses;
  };
  for (const Case& c :
       {Case{FaultKind::repeat, 0.0, true}, Case{FaultKind::swap, 0.0, true}, Case{FaultKind::late, 5.0, true},
        Case{FaultKind::back, 2.0, true}, Case{FaultKind::drop, 0.3, false}}) {
    auto course = make_course(paper_datasheet(), 4);
    ASSERT_TRUE(course);
    const bool single = c.kind == FaultKind::late;
    course->scenario.faults = {on_log(c.kind, c.magnitude, 1500, single ? 1 : 400)};
    const auto result = run(*course);
    ASSERT_TRUE(result) << result.error();
    EXPECT_EQ(result->refused > 0, c.refuses) << to_string(c.kind);
    EXPECT_TRUE(result->out.empty()) << to_string(c.kind);
    EXPECT_EQ(result->state, HealthState::nominal) << to_string(c.kind);
  }
}

TEST(Delivery, TheSimulatorRewindsAndNumbersItsRows) {
  Scenario scenario = calibration_run(paper_tool(1), 1, 2);
  scenario.faults = {on_log(FaultKind::swap, 0.0, 10, 20), on_log(FaultKind::drop, 1.0, 50, 3)};
  auto simulator = Simulator::make(scenario);
  ASSERT_TRUE(simulator) << simulator.error();
  std::vector<Sample> first;
  Sample sample;
  while (simulator->next(sample)) {
    first.push_back(sample);
    EXPECT_EQ(sample.time_s, simulator->at(simulator->row()).time_s);
  }
  EXPECT_EQ(first.size(), simulator->size() - 3);
  EXPECT_GT(first[9].time_s, first[10].time_s);
  simulator->rewind();
  for (const Sample& expected : first) {
    ASSERT_TRUE(simulator->next(sample));
    EXPECT_EQ(sample.time_s, expected.time_s);
    EXPECT_EQ(sample.raw, expected.raw);
  }
  EXPECT_FALSE(simulator->next(sample));
}

}  // namespace
}  // namespace delivery_test
}  // namespace scenario
}  // namespace plumb

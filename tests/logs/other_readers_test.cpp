// Logs that others wrote, and what readers that others wrote find in them (tests/logs/fixtures/README.md).
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "plumb/logs/flight_log.hpp"
#include "support/recording.hpp"
#include "told.hpp"

namespace other_readers_test {
namespace {

using namespace plumb::logs;
using namespace logs_told;

std::string fixture(const std::string& name) { return std::string(PLUMB_SOURCE_DIR) + "/tests/logs/fixtures/" + name; }

const nlohmann::json& found_by_others() {
  static const nlohmann::json all = nlohmann::json::parse(std::ifstream(fixture("other_readers.json")));
  return all;
}

using Row = std::array<double, 4>;

Row row_of(const ImuRecord& record) {
  const Axes& force = record.specific_force_mps2;
  return {record.time_s, force[0], force[1], force[2]};
}

/// Sums are added in the same order by both: what is left is rounding of unlike products.
void expect_row(const Row& ours, const nlohmann::json& theirs, double rounding, const std::string& what) {
  ASSERT_EQ(theirs.size(), ours.size()) << what;
  for (std::size_t k = 0; k < ours.size(); ++k) {
    const double value = theirs[k].get<double>();
    EXPECT_NEAR(ours[k], value, rounding * std::fmax(1.0, std::abs(value))) << what << " column " << k;
  }
}

void expect_source(const std::vector<ImuRecord>& records, const nlohmann::json& theirs, const std::string& name) {
  ASSERT_EQ(records.size(), theirs["records"].get<std::size_t>()) << name;
  expect_row(row_of(records.front()), theirs["first"], 1e-14, name + " first");
  expect_row(row_of(records.back()), theirs["last"], 1e-14, name + " last");
  Row sums{};
  Row by_place{};
  for (std::size_t i = 0; i < records.size(); ++i) {
    const Row row = row_of(records[i]);
    for (std::size_t k = 0; k < row.size(); ++k) {
      sums[k] += row[k];
      by_place[k] += static_cast<double>(i + 1) * row[k];
    }
  }
  expect_row(sums, theirs["sums"], 1e-11, name + " sums");
  expect_row(by_place, theirs["sums_by_place"], 1e-11, name + " sums by place");
}

/// The same sources with the same readings at the same times, in the same order.
void expect_what_others_found(const std::string& path, const std::string& name) {
  const nlohmann::json& theirs = found_by_others().at(name);
  Told told;
  const auto extent = read_log(path, told);
  ASSERT_TRUE(extent.has_value()) << extent.error().text();
  EXPECT_EQ(told.sources.size(), theirs["sources"].size()) << name;
  for (const auto& [source, expected] : theirs["sources"].items())
    expect_source(told.records_of(source), expected, source);
  // A parameter that changes is told again.
  EXPECT_GE(told.parameters.size(), theirs["parameters"].get<std::size_t>()) << name;
  if (!theirs.contains("values")) return;
  EXPECT_EQ(told.parameters.size(), theirs["values"].size());
  for (const auto& [parameter, value] : told.parameters)
    EXPECT_EQ(value, theirs["values"].value(parameter, std::nan(""))) << parameter;
}

TEST(OtherWriters, UlogOfUlogCpp) { expect_what_others_found(fixture("ulog_cpp.ulg"), "ulog_cpp.ulg"); }

TEST(OtherWriters, UlogOfFlyMs) { expect_what_others_found(fixture("ulog_flyms.ulg"), "ulog_flyms.ulg"); }

TEST(OtherWriters, DataflashWithUnitsOfAPythonClass) {
  expect_what_others_found(fixture("dataflash_python.bin"), "dataflash_python.bin");
}

TEST(OtherWriters, DataflashWithoutUnitsOfBlackbox) {
  expect_what_others_found(fixture("dataflash_blackbox.bin"), "dataflash_blackbox.bin");
}

// What the readers of others do not hand on beside the readings.
TEST(OtherWriters, ClipsDropoutsDevicesAndTemperaturesAreRead) {
  Told told;
  const auto extent = read_log(fixture("ulog_cpp.ulg"), told);
  ASSERT_TRUE(extent.has_value()) << extent.error().text();
  EXPECT_EQ(told.all_notes(), "");
  EXPECT_DOUBLE_EQ(extent->dropped_s, 0.035);
  ASSERT_LT(told.number_of("sensor_accel[1]"), told.sources.size());
  EXPECT_EQ(told.sources[told.number_of("sensor_accel[1]")].device_id, 3670050U);
  std::array<std::uint64_t, 3> clipped{};
  for (const ImuRecord& record : told.records_of("sensor_accel[0]")) {
    for (std::size_t k = 0; k < 3; ++k) clipped[k] += record.clipped[k];
  }
  EXPECT_EQ(clipped, (std::array<std::uint64_t, 3>{0, 4, 0}));
  std::uint64_t added_up = 0;
  for (const ImuRecord& record : told.records_of("vehicle_imu_status[0]")) added_up += record.clipped[0];
  EXPECT_EQ(added_up, 12U) << "four rises of three, what was counted before the log is not in it";

  Told blackbox;
  ASSERT_TRUE(read_log(fixture("dataflash_blackbox.bin"), blackbox).has_value());
  EXPECT_FLOAT_EQ(static_cast<float>(blackbox.records_of("IMU[2]").front().temperature_degc), 40.25F);
  Told python;
  ASSERT_TRUE(read_log(fixture("dataflash_python.bin"), python).has_value());
  EXPECT_EQ(python.all_notes(), "");
  EXPECT_EQ(python.sources[0].device_id, 2753028U);
}

class RealLogs : public testing::TestWithParam<const char*> {};

TEST_P(RealLogs, OfPx4AreReadAsByAnotherReader) {
  const std::string name = GetParam();
  const std::string path = plumb_test::recording_path(name);
  if (!std::ifstream(path)) {
    GTEST_SKIP() << "log not found: " << path << " (set PLUMB_DATA_DIR to the directory that holds logs/)";
  }
  expect_what_others_found(path, name);
}

INSTANTIATE_TEST_SUITE_P(OtherReaders, RealLogs,
                         testing::Values("logs/sample_log_small.ulg", "logs/sample_appended_multiple.ulg",
                                         "logs/sample_px4_events.ulg"),
                         [](const auto& one) {
                           const std::string name = one.param;
                           return name.substr(5, name.size() - 9);
                         });

}  // namespace
}  // namespace other_readers_test

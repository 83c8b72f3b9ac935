// The section `motion` of a calibration file: bit for bit, and strictly.
#include <nlohmann/json.hpp>

#include "io_test_support.hpp"
#include "plumb/io/calibration_file.hpp"

namespace calibration_motion_test {
namespace {

using namespace io_test;
using namespace plumb;
using namespace plumb::io;
using Json = nlohmann::ordered_json;

ArrayFile array_of(const std::string& text = kArrayText) {
  FileExpected<ArrayFile> array = parse_array_text(text, "tool.toml");
  if (!array) throw std::runtime_error(array.error().what);
  return *std::move(array);
}

/// Of the test at hand: others run at the same time.
std::string path_of(const std::string& name) {
  const ::testing::TestInfo* info = ::testing::UnitTest::GetInstance()->current_test_info();
  return ::testing::TempDir() + "plumb_io_" + info->test_suite_name() + "_" + info->name() + "_" + name;
}

std::string text_of(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return std::string(std::istreambuf_iterator<char>(in), {});
}

/// A calibration at rest, as a file.
std::string at_rest() {
  const ArrayFile array = array_of();
  Calibration calibration;
  calibration.array = array.array;
  calibration.model = array.datasheet.model();
  calibration.report.stations = 24;
  calibration.report.parameters = 16;
  calibration.report.rank = 13;
  calibration.report.gauge = 3;
  CalibrationContext context;
  context.log_file = "stand.csv";
  context.plumb_version = "1.0.0";
  context.gravity = array.gravity;
  const std::string path = path_of("rest.json");
  EXPECT_TRUE(write_calibration(path, calibration, array, context).has_value());
  return path;
}

MotionCalibration motion() {
  MotionCalibration out;
  for (int i = 0; i < 4; ++i) {
    MotionCalibration::Sensor& one = out.sensor.emplace_back();
    one.stated_lever_arm_m = {0.01 * i, 1.0 / 3.0, -0.02};
    one.lever_arm_m = {0.01 * i + 1e-17, 0.1 + 0.2, -0.02123456789012345};
    one.lever_arm_sigma_m = {1e-4, 2e-4, 3e-4};
    one.lever_arm_bound_m = 1.1e-3;
    one.lag_s = -1.7e-5;
    one.lag_sigma_s = 9e-6;
    one.lag_bound_s = 5e-5;
    one.rectification_per_mps2 = -3e-6;
    one.rectification_sigma_per_mps2 = 1e-6;
    one.rectification_bound_per_mps2 = 8e-6;
  }
  out.lever_arms_stated = true;
  out.gyros = 2;
  out.gyro = {0.011, 0.012, 0.0061, 0.0017, 3.1e-5};
  out.log_file = "logs/flight.csv";
  out.log_bytes = 12345678901;
  out.log_hash = 0xfedcba9876543210;
  out.rows = 30000;
  out.plumb_version = "1.0.0";
  out.date = "2026-03-31";
  return out;
}

std::string with_motion() {
  const std::string to = path_of("motion.json");
  EXPECT_TRUE(add_motion(at_rest(), to, motion(), array_of()).has_value());
  return text_of(to);
}

/// With the checksum made right again, as an attacker would.
std::string sealed(Json root) {
  root.erase("checksum");
  const std::string text = root.dump();
  char sum[32];
  std::snprintf(sum, sizeof sum, "fnv1a64:%016llx", static_cast<unsigned long long>(fnv1a(text.data(), text.size())));
  root["checksum"] = sum;
  return root.dump(1);
}

FileExpected<CalibrationFile> read(const std::string& json) {
  const std::string path = path_of("read.json");
  std::ofstream(path, std::ios::binary) << json;
  return read_calibration(path, array_of());
}

TEST(CalibrationMotion, ComesBackBitForBitAndTheRestOfTheFileStays) {
  const std::string json = with_motion();
  const FileExpected<CalibrationFile> file = read(json);
  ASSERT_TRUE(file.has_value()) << file.error().text();
  ASSERT_NE(file->motion, nullptr);
  const MotionCalibration &there = *file->motion, here = motion();
  ASSERT_EQ(there.sensor.size(), 4U);
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_EQ(there.sensor[k].stated_lever_arm_m, here.sensor[k].stated_lever_arm_m);
    EXPECT_EQ(there.sensor[k].lever_arm_m, here.sensor[k].lever_arm_m);
    EXPECT_EQ(there.sensor[k].lever_arm_sigma_m, here.sensor[k].lever_arm_sigma_m);
    EXPECT_EQ(there.sensor[k].lever_arm_bound_m, here.sensor[k].lever_arm_bound_m);
    EXPECT_EQ(there.sensor[k].lag_s, here.sensor[k].lag_s);
    EXPECT_EQ(there.sensor[k].lag_bound_s, here.sensor[k].lag_bound_s);
    EXPECT_EQ(there.sensor[k].rectification_per_mps2, here.sensor[k].rectification_per_mps2);
    EXPECT_EQ(there.sensor[k].rectification_bound_per_mps2, here.sensor[k].rectification_bound_per_mps2);
  }
  EXPECT_EQ(there.gyro.lag_s, here.gyro.lag_s);
  EXPECT_EQ(there.gyros, 2);
  EXPECT_EQ(there.log_file, "flight.csv");
  EXPECT_EQ(there.log_bytes, here.log_bytes);
  EXPECT_EQ(there.log_hash, here.log_hash);
  EXPECT_EQ(there.rows, 30000U);
  EXPECT_EQ(there.date, "2026-03-31");
  // Added once more to itself it is the same file; without it, the file before.
  const std::string again = path_of("again.json");
  ASSERT_TRUE(add_motion(path_of("motion.json"), again, there, array_of()).has_value());
  EXPECT_EQ(text_of(again), json);
  Json bare = Json::parse(json), rest = Json::parse(text_of(at_rest()));
  bare.erase("motion");
  bare["checksum"] = rest["checksum"] = "";
  EXPECT_EQ(bare.dump(), rest.dump());
}

TEST(CalibrationMotion, AFileWithoutItIsAsBefore) {
  const FileExpected<CalibrationFile> file = read(text_of(at_rest()));
  ASSERT_TRUE(file.has_value()) << file.error().text();
  EXPECT_EQ(file->motion, nullptr);
}

// Negative: REQ-037
TEST(CalibrationMotion, RefusesWhatNobodyWrites) {
  const Json good = Json::parse(with_motion());
  const auto refusal = [&good](const std::vector<std::string>& where, const Json& value) {
    Json root = good;
    Json* at = &root["motion"];
    for (const std::string& step : where) at = at->is_array() ? &(*at)[std::stoul(step)] : &(*at)[step];
    *at = value;
    const FileExpected<CalibrationFile> file = read(sealed(root));
    return file ? std::string("accepted") : file.error().text();
  };
  const struct {
    std::vector<std::string> where;
    Json value;
    const char* words;
  } cases[] = {
      {{"lever_arm_limit"}, 1.0, "motion.lever_arm_limit: is not known"},
      {{"gyro", "scale"}, 0.01, "motion.gyro.scale: is not known"},
      {{"sensors", "1", "skew_s"}, 1e-5, "motion.sensors[2].skew_s: is not known"},
      {{"provenance", "host"}, "x", "motion.provenance.host: is not known"},
      {{"version"}, 2, "motion.version: is 2"},
      {{"sensors"}, Json::array(), "is not a list of 4"},
      {{"sensors", "0", "lever_arm_m"}, Json{1.0, 2.0}, "is not a list of 3"},
      {{"sensors", "0", "lever_arm_m"}, Json{1.0, "nan", 2.0}, "must be from -10 to 10"},
      {{"sensors", "2", "lever_arm_bound_m"}, -1e-3, "motion.sensors[3].lever_arm_bound_m: is -0.001"},
      {{"sensors", "2", "lag_bound_s"}, "inf", "must be from 0 to 1"},
      {{"sensors", "3", "id"}, "A9", "motion.sensors[4].id: is \"A9\", must be \"A4\""},
      {{"sensors", "3", "lag_bound_s"}, "short", "is not a number"},
      {{"gyro", "noise_radps"}, -1.0, "motion.gyro.noise_radps: is -1"},
      {{"gyros"}, 3, "must be 1 or 2"},
      {{"lever_arms_stated"}, 1, "is not true or false"},
      {{"provenance", "date"}, "yesterday", "motion.provenance.date"},
      {{"provenance", "rows"}, -5, "out of range"},
      {{"gyro"}, 1.0, "motion.gyro: is not an object"},
  };
  for (const auto& one : cases) {
    const std::string told = refusal(one.where, one.value);
    EXPECT_NE(told.find(one.words), std::string::npos) << told;
    EXPECT_NE(told.find("Remedy: "), std::string::npos) << told;
  }
}

// Negative: REQ-037
TEST(CalibrationMotion, RefusesAFileThatLacksAnyKeyOfIt) {
  const Json good = Json::parse(with_motion());
  const std::vector<std::vector<std::string>> objects = {{}, {"provenance"}, {"gyro"}, {"sensors", "1"}};
  for (const std::vector<std::string>& where : objects) {
    const auto at_of = [&where](Json& root) {
      Json* at = &root["motion"];
      for (const std::string& step : where) at = at->is_array() ? &(*at)[std::stoul(step)] : &(*at)[step];
      return at;
    };
    Json copy = good;
    for (const auto& [key, value] : at_of(copy)->items()) {
      if (key == "date") continue;  // a file may lack it
      Json root = good;
      at_of(root)->erase(key);
      const FileExpected<CalibrationFile> file = read(sealed(root));
      EXPECT_FALSE(file.has_value()) << key;
    }
  }
}

}  // namespace
}  // namespace calibration_motion_test

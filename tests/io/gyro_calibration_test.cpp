// The calibration file of a group of gyros: what is written is read, and nonsense is not.
#include "plumb/io/gyro_calibration.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <string>

#include "plumb/io/hash.hpp"
#include "plumb/io/output_file.hpp"
#include "support/gyro_tool.hpp"

namespace gyro_calibration_test {
namespace {

using namespace plumb;
using namespace plumb::io;
using plumb_test::GyroTool;

ArrayFile gyros() {
  const auto read = parse_array_text(GyroTool::of_chips(3, 1).array_file(), "tool.toml", {}, "gyros");
  EXPECT_TRUE(read.has_value()) << read.error().text();
  return *read;
}

GyroCalibration any() {
  GyroCalibration out;
  out.absolute = out.bias_from_rest = out.delay_fitted = true;
  out.sample_radps = 1.0 / 3.0, out.held_out_turns_rad = 1e-3 / 7.0;
  out.log = {{"fitted", "/somewhere/motion.csv", 123456789012ULL, 0xFEDCBA9876543210ULL, 4711},
             {"turns", "turns.csv", 1, 2, 3}};
  out.plumb_version = "1.0.0";
  out.date = "2026-03-31", out.serial = "T7";
  for (int i = 0; i < 9; ++i) {
    GyroCalibration::Axis one;
    one.row = {1.0 / 3.0, -2.0 / 3.0, 0.7 + 0.01 * i};
    one.row_covariance = {4e-6, 1e-6, 0, 1e-6, 1e-6, 0, 0, 0, 9e-6};
    one.bias_radps = 0.1 / 3.0, one.bias_sigma_radps = 1e-4, one.delay_s = -1e-4 / 3.0, one.delay_sigma_s = 1e-6;
    one.per_force = {1e-5, -1e-5, 0.0}, one.per_force_sigma = {1e-6, 1e-6, 1e-6};
    one.bound = {0.01, 0.02, 0.03, 0.0004, 5e-5};
    out.axis.push_back(one);
  }
  return out;
}

class File {
 public:
  ~File() { std::filesystem::remove(path_); }
  File() = default;
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  FileExpected<GyroCalibration> read(const std::string& text) const {
    EXPECT_TRUE(write_file(path_, text).has_value());
    return read_gyro_calibration(path_, gyros());
  }

 private:
  std::string path_ = (std::filesystem::temp_directory_path() /
                       ("gyros_" + std::to_string(reinterpret_cast<std::uintptr_t>(this)) + ".json"))
                          .string();
};

TEST(GyroCalibrationFile, EveryFigureComesBackBitForBit) {
  const GyroCalibration out = any();
  const auto back = File().read(gyro_calibration_json(out, gyros()));
  ASSERT_TRUE(back.has_value()) << back.error().text();
  ASSERT_EQ(back->axis.size(), 9U);
  for (std::size_t i = 0; i < 9; ++i) {
    const GyroCalibration::Axis &a = out.axis[i], &b = back->axis[i];
    EXPECT_EQ(a.row, b.row);
    EXPECT_EQ(a.row_covariance, b.row_covariance);
    EXPECT_EQ(a.bias_radps, b.bias_radps);
    EXPECT_EQ(a.bias_sigma_radps, b.bias_sigma_radps);
    EXPECT_EQ(a.delay_s, b.delay_s);
    EXPECT_EQ(a.delay_sigma_s, b.delay_sigma_s);
    EXPECT_EQ(a.per_force, b.per_force);
    EXPECT_EQ(a.per_force_sigma, b.per_force_sigma);
    EXPECT_EQ(a.bound.scale, b.bound.scale);
    EXPECT_EQ(a.bound.axis_rad, b.bound.axis_rad);
    EXPECT_EQ(a.bound.bias_radps, b.bound.bias_radps);
    EXPECT_EQ(a.bound.lag_s, b.bound.lag_s);
    EXPECT_EQ(a.bound.g_sensitivity_s_per_m, b.bound.g_sensitivity_s_per_m);
  }
  EXPECT_TRUE(back->absolute && back->bias_from_rest && back->delay_fitted && !back->force_fitted);
  EXPECT_EQ(back->sample_radps, out.sample_radps);
  EXPECT_EQ(back->held_out_turns_rad, out.held_out_turns_rad);
  ASSERT_EQ(back->log.size(), 2U);
  EXPECT_EQ(back->log[0].file, "motion.csv") << "only the last part of a path";
  EXPECT_EQ(back->log[0].bytes, out.log[0].bytes);
  EXPECT_EQ(back->log[0].hash, out.log[0].hash);
  EXPECT_EQ(back->log[1].use, "turns");
  EXPECT_EQ(back->date + back->serial + back->plumb_version, "2026-03-31T71.0.0");
}

/// Refused, and the field that is named.
std::string field_of(const GyroCalibration& calibration) {
  const auto back = File().read(gyro_calibration_json(calibration, gyros()));
  return back ? "accepted" : back.error().field + (back.error().remedy.empty() ? " without a remedy" : "");
}

// Sound by its checksum, and no gyro's.
TEST(GyroCalibrationFile, FiguresThatNoGyroHasAreRefused) {
  EXPECT_EQ(field_of(any()), "accepted");
  const auto changed = [](auto change) {
    GyroCalibration out = any();
    change(out.axis[3]);
    return field_of(out);
  };
  using Axis = GyroCalibration::Axis;
  EXPECT_EQ(changed([](Axis& a) { a.row = {0.1, 0.1, 0.1}; }), "sensors[4].row");
  EXPECT_EQ(changed([](Axis& a) { a.row[1] = std::nan(""); }), "sensors[4].row");
  EXPECT_EQ(changed([](Axis& a) { a.row_covariance[0] = -1e-6; }), "sensors[4].row_covariance");
  EXPECT_EQ(changed([](Axis& a) { a.row_covariance[1] = a.row_covariance[3] = 3e-6; }), "sensors[4].row_covariance");
  EXPECT_EQ(changed([](Axis& a) { a.bias_radps = HUGE_VAL; }), "sensors[4].bias_radps");
  EXPECT_EQ(changed([](Axis& a) { a.bound.scale = 0.5; }), "sensors[4].scale_bound");
  EXPECT_EQ(changed([](Axis& a) { a.bound.lag_s = -1e-6; }), "sensors[4].lag_bound_s");
  GyroCalibration few = any();
  few.axis.pop_back();
  EXPECT_EQ(field_of(few), "sensors");
  GyroCalibration dated = any();
  dated.date = "2026-13-01";
  EXPECT_EQ(field_of(dated), "provenance.date");
}

}  // namespace
}  // namespace gyro_calibration_test

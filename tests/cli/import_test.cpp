// plumb import: from a log of another program to an array file.
#include <cmath>
#include <string>

#include "logs/ulog_bytes.hpp"
#include "tool_runner.hpp"

namespace import_test {
namespace {

using namespace plumb_test;
using namespace ulog_bytes;

constexpr int kDevices[] = {501, 502, 503};

/// Three accelerometers of PX4 at rest in one attitude after another, at 50 Hz. Chip k samples k ms later. `raw`:
/// before the calibration; PX4 keeps that of the third chip in the first slot. From `bad_s` on chip 1 reads 1 m/s^2 too
/// much along x.
std::string flight(bool raw, double bad_s = 1.0e9) {
  std::string out = header(0) + flags();
  if (raw) {
    for (int slot = 0; slot < 3; ++slot) {
      const int chip = 2 - slot;
      const std::string prefix = "CAL_ACC" + std::to_string(slot) + "_";
      out += parameter("int32_t " + prefix + "ID", u32(static_cast<std::uint64_t>(kDevices[chip])));
      out += parameter("float " + prefix + "XOFF", f32(0.1F * static_cast<float>(chip + 1)));
    }
  }
  out += format(raw ? "sensor_accel:uint64_t timestamp;uint32_t device_id;float x;float y;float z;float temperature;"
                    : "vehicle_imu:uint64_t timestamp;uint32_t accel_device_id;float[3] delta_velocity;uint32_t "
                      "delta_velocity_dt;");
  for (int chip = 0; chip < 3; ++chip) out += subscription(chip, chip, raw ? "sensor_accel" : "vehicle_imu");
  unsigned noise = 7;
  const auto next = [&noise] {
    noise = noise * 1664525U + 1013904223U;
    return 0.1 * (static_cast<double>(noise >> 16U) / 65536.0 - 0.5);
  };
  for (int k = 0; k < 6000; ++k) {
    const double angle = 0.7 * (k / 400);  // another attitude every 8 s
    for (int chip = 0; chip < 3; ++chip) {
      const double time_s = 0.02 * k + 0.001 * chip;
      double x = 9.8 * std::sin(angle) * std::cos(1.3 * angle) + next();
      const double y = 9.8 * std::sin(angle) * std::sin(1.3 * angle) + next();
      const double z = -9.8 * std::cos(angle) + next();
      if (chip == 1 && time_s >= bad_s) x += 1.0;
      if (raw) x += 0.1 * (chip + 1);
      const auto f = [raw](double value) { return static_cast<float>(raw ? value : 0.005 * value); };
      out += data(chip, u64(static_cast<std::uint64_t>(1.0e6 * time_s + 0.5)) +
                            u32(static_cast<std::uint64_t>(kDevices[chip])) + f32(f(x), f(y), f(z)) +
                            (raw ? f32(30.0F) : u32(5000)));
    }
  }
  return out;
}

/// The commands that import says to run next, each with its arguments.
std::vector<std::vector<std::string>> next_of(const std::string& out) {
  std::vector<std::vector<std::string>> commands;
  std::istringstream lines(out.substr(out.find("Next:\n") + 6));
  for (std::string line; std::getline(lines, line);) {
    std::vector<std::string> words;
    std::string word;
    bool quoted = false;
    for (const char c : line + " ") {
      if (c == '"' || c == '\'') {
        quoted = !quoted;
      } else if (c == ' ' && !quoted) {
        if (!word.empty()) words.push_back(word);
        word.clear();
      } else {
        word += c;
      }
    }
    if (words.size() > 1) commands.emplace_back(words.begin() + 1, words.end());
  }
  return commands;
}

// What it says to run next leads to a monitor that isolates the chip that fails, and no other.
TEST(ImportCommand, TheRoadLeadsFromALogToTheFaultyChip) {
  for (const bool raw : {true, false}) {
    const Workshop where;
    where.put("flight.ulg", flight(raw, 60.0));
    const Outcome imported = run(where, {"import", "flight.ulg", "--out", "made", "--gravity", "9.8 m/s^2"});
    ASSERT_EQ(imported.code, 0) << imported.err;
    const auto next = next_of(imported.out);
    ASSERT_EQ(next.size(), 2U) << imported.out;
    const Outcome calibrated = run(where, next[0]);
    EXPECT_EQ(calibrated.code, 0) << calibrated.out << calibrated.err;
    const Outcome monitored = run(where, next[1]);
    EXPECT_TRUE(says(monitored.out, {"excluded"})) << monitored.err;
    const std::size_t at = monitored.out.find("excluded ");
    const std::string excluded = monitored.out.substr(at, monitored.out.find('\n', at) - at);
    EXPECT_TRUE(says(excluded, {"x1"})) << raw << monitored.out << monitored.err;
    for (const char* healthy : {"x0", "y0", "z0", "x2", "y2", "z2"})
      EXPECT_EQ(excluded.find(healthy), std::string::npos) << raw << excluded;
  }
}

// The calibration of a chip is that of its device, in whichever slot the autopilot keeps it.
TEST(ImportCommand, CalibrationsFollowTheDeviceNotTheSlot) {
  const Workshop where;
  where.put("flight.ulg", flight(true));
  ASSERT_EQ(run(where, {"import", "flight.ulg", "--out", "made"}).code, 0);
  EXPECT_TRUE(says(where.text("made/coefficients.csv"), {"x0,1,0.1", "y0,1,0 m/s^2", "x1,1,0.2", "x2,1,0.3"}));
}

TEST(ImportCommand, RowsAreAtTheInstantsOfOneChipAndSayHowFarTheOthersAre) {
  const Workshop where;
  where.put("flight.ulg", flight(true));
  const Outcome outcome = run(where, {"import", "flight.ulg", "--out", "made", "--align", "nearest"});
  EXPECT_TRUE(says(outcome.out, {"6000 rows, at the instants of sensor_accel[", "1.00 ms away"})) << outcome.out;
  const std::string log = where.text("made/log.csv");
  EXPECT_EQ(line_of(log, 1), "t_s,temperature_degc,x0,y0,z0,x1,y1,z1,x2,y2,z2");
}

TEST(ImportCommand, WhatCannotBeIsRefusedWithARemedy) {
  const Workshop where;
  where.put("flight.ulg", flight(true));
  where.put("empty.ulg", header(0) + flags());
  const Outcome message = run(where, {"import", "flight.ulg", "--out", "made", "--message", "vehicle_imu"});
  EXPECT_EQ(message.code, 3);
  EXPECT_TRUE(says(message.err, {"flight.ulg", "no message \"vehicle_imu\"", "Remedy: choose one of sensor_accel"}));
  EXPECT_EQ(run(where, {"import", "empty.ulg", "--out", "made"}).code, 3);
  EXPECT_EQ(run(where, {"import", "absent.ulg", "--out", "made"}).code, 3);
  EXPECT_EQ(run(where, {"import", "flight.ulg", "--out", "flight.ulg"}).code, 1);
  EXPECT_EQ(run(where, {"import", "flight.ulg", "--out", "made", "--gravity", "-9.8 m/s^2"}).code, 2);
  EXPECT_EQ(run(where, {"import", "flight.ulg"}).code, 2);
}

}  // namespace
}  // namespace import_test

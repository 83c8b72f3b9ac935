// plumb import: from a log of another program to an array file.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "logs/dataflash_bytes.hpp"
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
std::string flight(bool raw, double bad_s = 1.0e9, int chips = 3) {
  std::string out = header(0) + flags();
  if (raw) {
    for (int slot = 0; slot < chips; ++slot) {
      const int chip = chips - 1 - slot;
      const std::string prefix = "CAL_ACC" + std::to_string(slot) + "_";
      out += parameter("int32_t " + prefix + "ID", u32(static_cast<std::uint64_t>(kDevices[chip])));
      out += parameter("float " + prefix + "XOFF", f32(0.1F * static_cast<float>(chip + 1)));
    }
  }
  out += format(raw ? "sensor_accel:uint64_t timestamp;uint32_t device_id;float x;float y;float z;float temperature;"
                    : "vehicle_imu:uint64_t timestamp;uint32_t accel_device_id;float[3] delta_velocity;uint32_t "
                      "delta_velocity_dt;");
  for (int chip = 0; chip < chips; ++chip) out += subscription(chip, chip, raw ? "sensor_accel" : "vehicle_imu");
  unsigned noise = 7;
  const auto next = [&noise] {
    noise = noise * 1664525U + 1013904223U;
    return 0.1 * (static_cast<double>(noise >> 16U) / 65536.0 - 0.5);
  };
  for (int k = 0; k < 6000; ++k) {
    const double angle = 0.7 * (k / 400);  // another attitude every 8 s
    for (int chip = 0; chip < chips; ++chip) {
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
    EXPECT_TRUE(says(monitored.out, {", valid (may be used)"})) << "the output is of use: " << monitored.out;
  }
}

/// The bound on the direction in the housing that the monitor states at the end.
double bound_deg(const std::string& out) {
  const std::string before = "calibrated axes, within ";
  const std::size_t at = out.find(before);
  return at == std::string::npos ? std::nan("") : std::strtod(out.c_str() + at + before.size(), nullptr);
}

// With the files as they are written an output is valid, with two chips and with three, and by the bound that the
// monitor proves; what is accepted is said before the commands.
TEST(ImportCommand, TheAlertLimitIsMetByWhatAnAutopilotsCalibrationLeaves) {
  for (const auto& [chips, expected_deg] : {std::pair(2, 6.8), std::pair(3, 5.2)}) {
    const Workshop where;
    where.put("flight.ulg", flight(true, 1.0e9, chips));
    const Outcome imported = run(where, {"import", "flight.ulg", "--out", "made", "--gravity", "9.8 m/s^2"});
    EXPECT_TRUE(says(imported.out, {"errors of direction up to 8 deg (alert_limit)"})) << imported.out;
    EXPECT_TRUE(says(where.text("made/array.toml"), {"alert_limit = \"8 deg\""}));
    const auto next = next_of(imported.out);
    ASSERT_EQ(next.size(), 2U) << imported.out;
    ASSERT_EQ(run(where, next[0]).code, 0);
    const Outcome monitored = run(where, next[1]);
    EXPECT_TRUE(says(monitored.out, {", valid (may be used)"})) << chips << monitored.out;
    EXPECT_NEAR(bound_deg(monitored.out), expected_deg, 0.1) << chips;
  }
  const Workshop where;
  where.put("flight.ulg", flight(true, 1.0e9, 1));
  const Outcome one = run(where, {"import", "flight.ulg", "--out", "made"});
  EXPECT_TRUE(says(one.out, {"One chip has no redundancy", "no direction is valid"})) << one.out;
}

// A new line in a name, a quote, an escape: the commands stay one line each, and a shell reads them as they are meant.
TEST(ImportCommand, TheNextCommandsAreSafeWhateverTheNames) {
  const Workshop where;
  where.put("flight.ulg", flight(true));
  const std::string directory = "it's\n  rm -r x\x1b[2J $(touch bad)";
  const Outcome imported = run(where, {"import", "flight.ulg", "--out", directory});
  ASSERT_EQ(imported.code, 0) << imported.err;
  EXPECT_EQ(imported.out.find('\x1b'), std::string::npos);
  EXPECT_EQ(imported.out.find("\n  rm"), std::string::npos) << imported.out;
  const std::string commands = imported.out.substr(imported.out.find("Next:\n") + 6);
  EXPECT_EQ(std::count(commands.begin(), commands.end(), '\n'), 2) << commands;
  where.put("next.sh",
            "plumb() { '" PLUMB_TOOL_PATH "' \"$@\"; }\ncd '" + (where.path() / "").string() + "'\n" + commands);
  const std::string script = "bash '" + (where.path() / "next.sh").string() + "' >/dev/null 2>&1";
  (void)std::system(script.c_str());
  EXPECT_TRUE(std::filesystem::exists(where.path() / (directory + "/calibration.json").c_str())) << commands;
  EXPECT_FALSE(std::filesystem::exists(where.path() / "bad"));
}

/// Chip 501 logs what it reads before its calibration, 502 and 503 after it, and 503 half as often.
std::string mixed_flight() {
  std::string out =
      header(0) + flags() + parameter("int32_t CAL_ACC0_ID", u32(501)) + parameter("float CAL_ACC0_XOFF", f32(0.25F)) +
      parameter("int32_t CAL_ACC1_ID", u32(502)) + parameter("float CAL_ACC1_XOFF", f32(0.75F)) +
      format("sensor_accel:uint64_t timestamp;uint32_t device_id;float x;float y;float z;") +
      format(
          "vehicle_imu:uint64_t timestamp;uint32_t accel_device_id;float[3] delta_velocity;uint32_t "
          "delta_velocity_dt;") +
      subscription(0, 0, "sensor_accel") + subscription(1, 1, "vehicle_imu") + subscription(2, 2, "vehicle_imu");
  for (std::uint64_t k = 0; k < 1000; ++k) {
    out += data(0, u64(20000 * k) + u32(501) + f32(0.25F, 0.5F, -9.75F));
    out += data(1, u64(20000 * k) + u32(502) + f32(0.0F, 0.0025F, -0.04875F) + u32(5000));
    if (k % 2 == 0) out += data(2, u64(20000 * k) + u32(503) + f32(0.0F, 0.0025F, -0.04875F) + u32(5000));
  }
  return out;
}

// Readings before the calibration get it, those after it do not get it again; rows are at the instants of the slowest.
TEST(ImportCommand, ChipsBeforeAndAfterTheirCalibrationStandSideBySide) {
  const Workshop where;
  where.put("mixed.ulg", mixed_flight());
  const Outcome imported = run(where, {"import", "mixed.ulg", "--out", "made"});
  ASSERT_EQ(imported.code, 0) << imported.err;
  EXPECT_TRUE(says(imported.out, {"3 chips", "500 rows, at the instants of vehicle_imu[2]"})) << imported.out;
  EXPECT_TRUE(says(where.text("made/coefficients.csv"), {"x0,1,0.25 m/s^2", "x1,1,0 m/s^2", "x2,1,0 m/s^2"}));
  const std::string array = where.text("made/array.toml");
  EXPECT_TRUE(says(array, {"corrected = true"}));
  const std::string first =
      array.substr(array.find("id = \"x0\""), array.find("id = \"y0\"") - array.find("id = \"x0\""));
  const std::string second =
      array.substr(array.find("id = \"x1\""), array.find("id = \"y1\"") - array.find("id = \"x1\""));
  EXPECT_TRUE(says(first, {"bias = \"0.5 m/s^2\""})) << "before its calibration a chip may be further off";
  EXPECT_TRUE(says(second, {"bias = \"0.1 m/s^2\""}));
  const auto next = next_of(imported.out);
  ASSERT_EQ(next.size(), 2U);
  EXPECT_EQ(run(where, next[0]).code, 0);
}

std::string dataflash_flight() {
  dataflash_bytes::Log log = dataflash_bytes::new_log();
  for (const char* name : {"INS_ACC", "INS_ACC2"}) {
    for (const char* axis : {"X", "Y", "Z"}) {
      log.message(dataflash_bytes::kParm, {1e5, (std::string(name) + "OFFS_" + axis).c_str(), 0.5, 0.0});
      log.message(dataflash_bytes::kParm, {1e5, (std::string(name) + "SCAL_" + axis).c_str(), 1.01, 0.0});
    }
  }
  for (int k = 0; k < 1000; ++k) {
    for (int instance = 0; instance < 2; ++instance) imu_at(log, 1e6 + 20000.0 * k + instance, instance);
  }
  return log.bytes();
}

// ArduPilot logs what it has corrected: the same parameters a second time would put an error where there is none.
TEST(ImportCommand, WhatAnAutopilotHasCorrectedIsNotCorrectedAgain) {
  const Workshop where;
  where.put("flight.bin", dataflash_flight());
  const Outcome imported = run(where, {"import", "flight.bin", "--out", "made"});
  ASSERT_EQ(imported.code, 0) << imported.err;
  EXPECT_TRUE(says(imported.out, {"scale 1 and bias 0, since the autopilot has corrected the readings"}));
  EXPECT_TRUE(says(where.text("made/coefficients.csv"), {"x0,1,0 m/s^2", "z1,1,0 m/s^2"}));
  EXPECT_TRUE(says(where.text("made/array.toml"), {"corrected = true"}));
  std::string parameters;
  for (const char* name : {"INS_ACC", "INS_ACC2"}) {
    for (const char* axis : {"X", "Y", "Z"})
      parameters += std::string(name) + "OFFS_" + axis + ",0.5\n" + name + "SCAL_" + axis + ",1.01\n";
  }
  where.put("copter.param", parameters);
  const std::vector<std::string> again = {"calibrate",
                                          "--array",
                                          "made/array.toml",
                                          "--from",
                                          "copter.param",
                                          "--uncertainty",
                                          "bias=5 mg, scale=1000 ppm, axis=0.5 deg",
                                          "--out",
                                          "c.json"};
  const Outcome refused = run(where, again);
  EXPECT_EQ(refused.code, 3) << refused.out;
  EXPECT_TRUE(says(refused.err, {"copter.param", "which the readings have already", "corrected = true",
                                 "Remedy: give the coefficients.csv that plumb import wrote"}))
      << refused.err;
  // An array file that does not say so: the readings may be raw, and what the parameters are for is said.
  where.put("made/array.toml", with(where.text("made/array.toml"), "corrected = true", "corrected = false"));
  const Outcome taken = run(where, again);
  EXPECT_EQ(taken.code, 0) << taken.err;
  EXPECT_TRUE(says(taken.out, {"for readings before them", "DataFlash"})) << taken.out;
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

// As a ULog the log is the same: what is said to run next prints the same but for its name.
TEST(ImportCommand, AULogSaysWhatTheCsvSays) {
  std::string said[2];
  for (const bool ulog : {false, true}) {
    const Workshop where;
    where.put("flight.ulg", flight(false, 60.0));
    std::vector<std::string> command = {"import", "flight.ulg", "--out", "made"};
    if (ulog) command.insert(command.end(), {"--to", "ulog"});
    const Outcome imported = run(where, command);
    ASSERT_EQ(imported.code, 0) << imported.err;
    EXPECT_EQ(says(imported.out, {"made/log.ulg"}), ulog) << imported.out;
    for (const auto& next : next_of(imported.out)) said[ulog ? 1 : 0] += run(where, next).out;
  }
  std::size_t at = 0;
  while ((at = said[1].find("log.ulg", at)) != std::string::npos) said[1].replace(at, 7, "log.csv");
  EXPECT_EQ(said[1], said[0]);
  EXPECT_TRUE(says(said[0], {"excluded"}));
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

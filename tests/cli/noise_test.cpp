// plumb noise: from a log at rest to the noise to declare.
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>

#include "tool_runner.hpp"

namespace noise_command_test {
namespace {

using namespace plumb_test;

/// Normal numbers that need no library: sums of twelve uniform ones.
class Noise {
 public:
  double next() {
    double sum = -6.0;
    for (int k = 0; k < 12; ++k) {
      state_ = state_ * 6364136223846793005ULL + 1442695040888963407ULL;
      sum += static_cast<double>(state_ >> 11U) * 0x1p-53;
    }
    return sum;
  }

 private:
  std::uint64_t state_ = 20180227;
};

/// Rows of the paper's tool at rest at 100 Hz; a2 is `times` as noisy as declared (0.2 mg0 of 3 V/g0: 0.6 mV).
std::string still(int rows, double times, double rest_v = 1.0) {
  Noise noise;
  std::string out = "t_s,station,a1,a2,a3,a4\n";
  for (int k = 0; k < rows; ++k) {
    out += std::to_string(0.01 * k) + ",0";
    for (int i = 0; i < 4; ++i) out += "," + std::to_string(rest_v + (i == 1 ? times : 1.0) * 6e-4 * noise.next());
    out += "\n";
  }
  return out;
}

nlohmann::json json_of(const Outcome& outcome) { return nlohmann::json::parse(outcome.out, nullptr, false); }

TEST(NoiseCommand, ProposesTheNoiseBesideTheDeclaredOne) {
  const Workshop where;
  where.put("still.csv", still(20000, 5.0));
  const Outcome outcome = run(where, {"noise", "still.csv", "--array", "array.toml"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_TRUE(says(outcome.out,
                   {"a2: 20000 readings at 100 Hz", "white noise N", "ug0/sqrt(Hz)", "random walk K", "not visible",
                    "record", "for this term", "whiteness", "white;", "declared 0.2 mg0: the measured one is 5.",
                    "[[sensor]]\nid = \"a1\"", "[[sensor]]\nid = \"a2\"\nnoise = \"1."}))
      << outcome.out;
  const nlohmann::json found = json_of(run(where, {"noise", "still.csv", "--array", "array.toml", "--json"}));
  ASSERT_EQ(found["columns"].size(), 4U);
  EXPECT_EQ(found["schema"], "plumb-noise");
  const nlohmann::json a2 = found["columns"][1];
  EXPECT_NEAR(a2["terms"]["white_noise"]["value"].get<double>(), 1e-3 * 9.80665 * 0.1, 3e-5);
  EXPECT_NEAR(a2["noise_declared_mps2"].get<double>(), 2e-4 * 9.80665, 1e-9);
  EXPECT_EQ(a2["whiteness"]["verdict"], "white");
  EXPECT_TRUE(a2["terms"]["random_walk"]["more_hours"].is_number());
}

TEST(NoiseCommand, WhatItPrintsIsAnArrayFilesNoise) {
  const Workshop where;
  where.put("still.csv", still(20000, 5.0));
  const nlohmann::json found = json_of(run(where, {"noise", "still.csv", "--array", "array.toml", "--json"}));
  std::string array = where.text("array.toml");
  const std::size_t second = array.find("id = \"a2\"");
  const std::size_t at = array.find("\"200 ug0\"", second);
  ASSERT_NE(at, std::string::npos);
  array.replace(at, 9, "\"" + found["columns"][1]["noise"].get<std::string>() + "\"");
  where.put("array.toml", array);
  const nlohmann::json again = json_of(run(where, {"noise", "still.csv", "--array", "array.toml", "--json"}));
  const nlohmann::json a2 = again["columns"][1];
  EXPECT_NEAR(a2["noise_declared_mps2"].get<double>() / a2["whiteness"]["declare_sigma"].get<double>(), 1.0, 5e-3);
}

TEST(NoiseCommand, NeedsNoArrayFile) {
  const Workshop where;
  where.put("still.csv", still(5000, 1.0));
  const Outcome outcome = run(where, {"noise", "-", "--unit", "V", "--columns", "a3"}, "still.csv");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_TRUE(says(outcome.out, {"standard input, time in t_s", "a3: 5000 readings", "noise = \"0.0006", " V\""}));
  EXPECT_EQ(outcome.out.find("a1"), std::string::npos);
  const Outcome unknown = run(where, {"noise", "still.csv", "--columns", "a3"});
  EXPECT_TRUE(says(unknown.out, {"# UNIT: that of the log; --unit names it", "UNIT\""}));
}

TEST(NoiseCommand, SaysWhatIsInTheWay) {
  const Workshop where;
  std::string log = still(3000, 1.0);
  // A gap of a minute, then other readings of a1 for ten seconds: it was turned.
  std::string more = still(9000, 1.0).substr(still(1, 1.0).size());
  std::string rest;
  std::istringstream in(more);
  std::string line;
  for (int k = 0; std::getline(in, line); ++k) {
    const std::size_t comma = line.find(',');
    const std::size_t a1 = comma + 3, end = line.find(',', a1);
    const double turned = std::stod(line.substr(a1, end - a1)) + (k >= 7000 ? 0.5 : 0.0);
    rest += std::to_string(90.0 + 0.01 * k) + ",0," + std::to_string(turned) + line.substr(end) + "\n";
  }
  where.put("still.csv", log + rest);
  const Outcome outcome = run(where, {"noise", "still.csv", "--array", "array.toml"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_TRUE(
      says(outcome.out, {"a1          rows are missing once, first 60 s at t = 30 s;", "6900 of 11999 rows from t = 90",
                         "Remedy: record without gaps", "a1          it moves once, first at t = 160",
                         "Remedy: hold the tool still", "a2, a3, a4  rows are missing once", "8999 of 11999 rows"}))
      << outcome.out;
}

TEST(NoiseCommand, RefusesWhatHoldsNoNoise) {
  const Workshop where;
  where.put("short.csv", still(100, 1.0));
  const Outcome shorter = run(where, {"noise", "short.csv", "--array", "array.toml"});
  EXPECT_EQ(shorter.code, 7);
  EXPECT_TRUE(says(shorter.out, {"a1, a2, a3, a4 the longest stretch at rest has 100 readings, and 256 are the least",
                                 "Remedy: record the tool at rest"}));
  EXPECT_TRUE(says(shorter.err, {"plumb: short.csv: no column could be judged"}));
  where.put("flat.csv", still(2000, 0.0));
  const Outcome flat = run(where, {"noise", "flat.csv", "--array", "array.toml"});
  EXPECT_EQ(flat.code, 0);
  EXPECT_TRUE(
      says(flat.out, {"a2          all 2000 readings are alike: no noise is seen", "Remedy: check that the channel"}));
  EXPECT_EQ(flat.out.find("id = \"a2\""), std::string::npos);
}

TEST(NoiseCommand, RefusesOptionsThatContradictEachOther) {
  const Workshop where;
  where.put("still.csv", still(300, 1.0));
  const Outcome rate = run(where, {"noise", "still.csv", "--array", "array.toml", "--rate", "100 Hz"});
  EXPECT_EQ(rate.code, 2);
  EXPECT_TRUE(says(rate.err, {"--rate", "the array file says it"}));
  const Outcome zero = run(where, {"noise", "still.csv", "--rate", "0 Hz"});
  EXPECT_EQ(zero.code, 2);
  EXPECT_TRUE(says(zero.err, {"--rate", "is not above 0"}));
  const Outcome column = run(where, {"noise", "still.csv", "--array", "array.toml", "--columns", "a9"});
  EXPECT_EQ(column.code, 2);
  EXPECT_TRUE(says(column.err, {"a9", "there is no such column", "a1, a2, a3, a4"}));
  const Outcome over = run(where, {"noise", "still.csv", "--html", "still.csv"});
  EXPECT_EQ(over.code, 2);
}

TEST(NoiseCommand, NamesOfColumnsDoNotReachTheTerminalRaw) {
  const Workshop where;
  std::string log = still(2000, 1.0);
  const std::size_t a1 = log.find("a1");
  log.replace(a1, 2, "\x1b[31ma");
  where.put("still.csv", log);
  const Outcome outcome = run(where, {"noise", "still.csv"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(outcome.out.find('\x1b'), std::string::npos);
  EXPECT_TRUE(says(outcome.out, {"\\x1b[31ma"}));
}

TEST(NoiseCommand, WritesAPageAndItsPlots) {
  const Workshop where;
  where.put("still.csv", still(5000, 1.0));
  const Outcome outcome =
      run(where, {"noise", "still.csv", "--array", "array.toml", "--html", "noise.html", "--plots", "plots"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  const std::string page = where.text("noise.html");
  EXPECT_TRUE(says(page, {"Noise of still.csv", "Noise to declare", "id = &quot;a1&quot;", "Terms of noise"}))
      << page.size();
  const std::string allan = read_text(where / "plots/noise-allan-2.csv"), script = read_text(where / "plots/noise.gp");
  EXPECT_TRUE(says(allan, {"tau_s,deviation,low,high,fit,Q,N,B,K,R\n", "\n0.02,"}));
  EXPECT_TRUE(says(script, {"noise-allan-1.svg", "white noise N", "noise-spectrum-4.svg"}));
}

}  // namespace
}  // namespace noise_command_test

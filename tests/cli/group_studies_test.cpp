// Groups of another field in geometry, noise and simulate: their units, and what a simulated tool shows the monitor.
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tool_runner.hpp"

namespace group_studies_test {
namespace {

using namespace plumb_test;
using nlohmann::json;

const std::string kExamples = std::string(PLUMB_SOURCE_DIR) + "/examples/";

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

/// The examples, a simulated stand, and what was calibrated on it.
const Directory& desk() {
  static const Directory* const made = [] {
    auto* where = new Directory;
    for (const char* const name : {"six_axis.toml", "six_axis_stand.toml", "six_axis_run.toml"})
      std::filesystem::copy_file(kExamples + name, *where / name);
    const Outcome stand = run(*where, {"simulate", "six_axis_stand.toml", "--out", "stand.csv"});
    EXPECT_EQ(stand.code, 0) << stand.err;
    for (const char* const group : {"", "#mag"}) {
      const Outcome outcome = run(*where, {"calibrate", "--array", std::string("six_axis.toml") + group, "--log",
                                           "stand.csv", "--out", *group == '\0' ? "acc.json" : "mag.json"});
      EXPECT_EQ(outcome.code, 0) << outcome.out << outcome.err;
    }
    return where;
  }();
  return *made;
}

Outcome watched(const std::string& log) {
  return run(desk(), {"monitor", "--array", "six_axis.toml", "--calibration", "acc.json", "--log", log, "--group",
                      "mag=mag.json", "--group", "gyros"});
}

std::vector<std::vector<std::string>> table_of(const std::string& text) {
  std::vector<std::vector<std::string>> rows;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) {
    rows.emplace_back();
    std::istringstream cells(line);
    for (std::string cell; std::getline(cells, cell, ',');) rows.back().push_back(cell);
  }
  return rows;
}

TEST(GroupGeometry, MagnetometersAreJudgedInTheirOwnUnits) {
  const Outcome text = run(desk(), {"geometry", "six_axis.toml#mag"});
  ASSERT_EQ(text.code, 0) << text.err;
  EXPECT_TRUE(says(text.out, {"the magnetic field 51.375", "expected in the log, field along", "stability 7.85 nT",
                              "disturbance of 100 nT", " uT at the best attitude"}))
      << text.out;
  for (const char* const word : {"mg0", "g0 ", "m/s^2", "gravity,", "acceleration"})
    EXPECT_FALSE(has(text.out, word)) << word << "\n" << text.out;
  const Outcome told = run(desk(), {"geometry", "six_axis.toml#mag", "--json"});
  EXPECT_FALSE(has(told.out, "mps2")) << told.out;
  EXPECT_FALSE(has(told.out, "g0")) << told.out;
  const json report = json::parse(told.out);
  EXPECT_NEAR(report["field_nt"].get<double>(), 51375.2, 5.0);
  EXPECT_NEAR(report["sensors"][0]["sigma_nt"].get<double>(), 20.0, 1e-9);
  EXPECT_NEAR(report["sensors"][0]["expected_raw"]["horizontal_toolface_90"].get<double>(), -51375.2, 5.0);
  EXPECT_NEAR(report["protection_levels"][0]["sigma_nt"].get<double>(), 1.0, 1e-9);
}

// Verifies: REQ-252
// The core knows of a field its length alone: the same axes, noise and bounds, four million times as large.
TEST(GroupGeometry, AMagneticGroupIsAGravityArrayScaled) {
  std::string text =
      "[gravity]\nmodel = \"value\"\nvalue = \"9.80665 m/s^2\"\nsigma = \"0.01 m/s^2\"\n[input]\nreads = \"gravity\"\n"
      "unit = \"m/s^2\"\nrate = \"50 Hz\"\n[monitor]\nalert_limit = \"2 deg\"\nstability = \"0.002 m/s^2\"\n"
      "acceleration_bound = \"0.01 m/s^2\"\n";
  std::string group =
      "[[group]]\nname = \"mag\"\nfield = \"magnetic\"\nunit = \"nT\"\n[group.reference]\nvalue = \"39.2266 uT\"\n"
      "sigma = \"40 nT\"\n[group.monitor]\nalert_limit = \"2 deg\"\nstability = \"8 nT\"\n"
      "disturbance_bound = \"40 nT\"\n";
  const char* const axes[] = {"[1, 0, 0]", "[0, 0.6, 0.8]", "[0, -0.6, 0.8]", "[0.6, 0.8, 0]", "[0.8, 0, -0.6]"};
  for (std::size_t i = 0; i < 5; ++i) {
    const std::string n = std::to_string(i + 1), axis = std::string("axis = ") + axes[i] + "\n";
    text += "[[sensor]]\nid = \"a" + n + "\"\n" + axis + "noise = \"0.005 m/s^2\"\n";
    group += "[[group.sensor]]\nid = \"m" + n + "\"\n" + axis + "noise = \"20 nT\"\n";
  }
  write_text(desk() / "twin.toml", text + group);
  const Outcome a = run(desk(), {"geometry", "twin.toml", "--json"}),
                m = run(desk(), {"geometry", "twin.toml#mag", "--json"});
  ASSERT_EQ(a.code, 0) << a.err;
  ASSERT_EQ(m.code, 0) << m.err;
  const json of_a = json::parse(a.out), of_m = json::parse(m.out);
  const auto alike = [](const json& mps2, const json& nt) {
    if (mps2.is_null() || nt.is_null()) return mps2.is_null() && nt.is_null();
    return std::fabs(4000.0 * mps2.get<double>() - nt.get<double>()) <= 1e-9 * std::fabs(nt.get<double>());
  };
  for (std::size_t i = 0; i < 5; ++i) {
    const json& sizes = of_a["sensors"][i]["thresholds_mps2"];
    ASSERT_GT(sizes.size(), 6U);
    for (const auto& [key, value] : sizes.items())
      EXPECT_TRUE(alike(value, of_m["sensors"][i]["thresholds_nt"][key])) << i << " " << key;
  }
  EXPECT_EQ(of_a["figures_of_merit"], of_m["figures_of_merit"]);
  const json &stated = of_a["detection_sizes"]["as_stated"], &field = of_m["detection_sizes"]["as_stated"];
  for (const char* const size :
       {"minimum_detectable_bias", "guaranteed_detection_any", "guaranteed_isolation", "drift_tolerance"}) {
    EXPECT_TRUE(alike(stated[std::string(size) + "_mps2"], field[std::string(size) + "_nt"])) << size;
  }
  EXPECT_EQ(stated["protection_level_at_rest_deg"], field["protection_level_at_rest_deg"]);
}

TEST(GroupGeometry, GyrosHaveWhatParityGivesAndNoLength) {
  const Outcome text = run(desk(), {"geometry", "six_axis.toml#gyros", "--check"});
  ASSERT_EQ(text.code, 0) << text.err;
  EXPECT_TRUE(says(text.out, {"6 gyros", "deg/s", "faulty units that parity isolates at once", "isolated from"}));
  EXPECT_FALSE(has(text.out, "gravity")) << text.out;
  const json report = json::parse(run(desk(), {"geometry", "six_axis.toml#gyros", "--json"}).out);
  EXPECT_EQ(report["isolated_units"], 1);
  for (const json& sensor : report["sensors"]) {
    EXPECT_LT(sensor["at_rest"]["guaranteed_isolation_radps"], sensor["turning"]["guaranteed_isolation_radps"]);
    EXPECT_LE(sensor["at_rest"]["guaranteed_detection_radps"], sensor["at_rest"]["guaranteed_isolation_radps"]);
  }
  const std::string whole = read_text(desk() / "six_axis.toml");
  write_text(desk() / "four.toml", whole.substr(0, whole.find("[[group.sensor]]\nid = \"g5\"")));
  const Outcome four = run(desk(), {"geometry", "four.toml#gyros", "--check"});
  EXPECT_EQ(four.code, 6);
  EXPECT_TRUE(has(four.err, "no_isolation")) << four.err;
  const Outcome fit = run(desk(), {"geometry", "six_axis.toml#gyros", "--calibration", "mag.json"});
  EXPECT_EQ(fit.code, 2);
  EXPECT_TRUE(has(fit.err, "[group.rate]")) << fit.err;
}

/// Two minutes at rest.
const std::string& still() {
  static const std::string* const log = [] {
    write_text(
        desk() / "still.toml",
        "array = \"six_axis.toml\"\n[attitude]\nlaw = \"fixed\"\ndirection = [0.6, 0, 0.8]\ndwell = \"2 min\"\n");
    const Outcome outcome = run(desk(), {"simulate", "still.toml", "--out", "still.csv"});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return new std::string("still.csv");
  }();
  return *log;
}

TEST(GroupNoise, MagnetometersInNanotesla) {
  const Outcome text = run(desk(), {"noise", still(), "--array", "six_axis.toml#mag"});
  ASSERT_EQ(text.code, 0) << text.err;
  EXPECT_TRUE(says(text.out, {"nT/sqrt(Hz)", "declared 20 nT", "[[group.sensor]]", "id = \"m1\""}));
  EXPECT_FALSE(has(text.out, "g0")) << text.out;
  const json report = json::parse(run(desk(), {"noise", still(), "--array", "six_axis.toml#mag", "--json"}).out);
  for (const json& column : report["columns"]) {
    EXPECT_EQ(column["unit"], "nT");
    EXPECT_NEAR(column["whiteness"]["sample_sigma"].get<double>(), 20.0, 1.0);
    EXPECT_NEAR(column["noise_declared_nt"].get<double>(), 20.0, 1e-9);
  }
}

// 0.05 deg/s of noise at 50 Hz is an angle random walk of 0.05 * 60 / sqrt(50) = 0.424 deg/sqrt(h).
TEST(GroupNoise, GyrosAsTheirDatasheetsHaveThem) {
  const Outcome text = run(desk(), {"noise", still(), "--array", "six_axis.toml#gyros", "--columns", "g1"});
  ASSERT_EQ(text.code, 0) << text.err;
  EXPECT_TRUE(says(text.out, {"deg/sqrt(h)", "deg/h", "declared 0.05 deg/s", "[[group.sensor]]"}));
  EXPECT_FALSE(has(text.out, "window =")) << text.out;
  const json report = json::parse(run(desk(), {"noise", still(), "--array", "six_axis.toml#gyros", "--json"}).out);
  for (const json& column : report["columns"]) {
    EXPECT_EQ(column["unit"], "rad/s");
    EXPECT_NEAR(column["terms"]["white_noise"]["value"].get<double>() * 180.0 / 3.14159265358979 * 60.0, 0.424, 0.03);
  }
}

// Verifies: REQ-253
TEST(GroupSimulate, TheMonitorNamesWhatFailedInEveryGroup) {
  const Outcome played = run(desk(), {"simulate", "six_axis_run.toml", "--out", "run.csv", "--truth", "truth.csv"});
  ASSERT_EQ(played.code, 0) << played.err;
  EXPECT_TRUE(says(played.out, {"m2 reads 1.5 uT", "g6 reads 25 deg/s"})) << played.out;
  const auto log = table_of(read_text(desk() / "run.csv")), truth = table_of(read_text(desk() / "truth.csv"));
  EXPECT_EQ(log[0].size(), 14U);
  EXPECT_EQ(log[0].back(), "g6");
  EXPECT_EQ(truth.size(), log.size());
  EXPECT_TRUE(
      has(line_of(read_text(desk() / "truth.csv"), 1), "toolface_deg,mag_x_nt,mag_y_nt,mag_z_nt,gyros_x_radps"));
  EXPECT_EQ(truth.back().back(), "m2 g6");
  const Outcome outcome = watched("run.csv");
  EXPECT_TRUE(says(outcome.out,
                   {"in service  a1, a2, a3, a4", "excluded    m2", "gravity and the field agree", "excluded    g6"}))
      << outcome.out << outcome.err;
}

/// The run without its faults.
void play_healthy() {
  const std::string scenario = read_text(desk() / "six_axis_run.toml");
  write_text(desk() / "healthy.toml", scenario.substr(0, scenario.find("[[fault]]")));
  ASSERT_EQ(run(desk(), {"simulate", "healthy.toml", "--out", "healthy.csv"}).code, 0);
}

TEST(GroupSimulate, AHealthyToolIsNominalInEveryGroup) {
  play_healthy();
  const Outcome outcome = watched("healthy.csv");
  EXPECT_EQ(outcome.code, 0) << outcome.out << outcome.err;
  EXPECT_FALSE(has(outcome.out, "excluded    m")) << outcome.out;
  EXPECT_FALSE(has(outcome.out, "excluded    g")) << outcome.out;
  EXPECT_TRUE(has(outcome.out, "gravity and the field agree")) << outcome.out;
}

// A group alone goes through what it goes through in the whole tool, digit by digit.
TEST(GroupSimulate, AGroupAloneIsThatOfTheTool) {
  const std::string scenario = read_text(desk() / "six_axis_stand.toml");
  const std::string head = scenario.substr(0, scenario.find("[truth]"));
  const std::string attitude = scenario.substr(scenario.find("[attitude]"));
  const std::string moves = attitude.substr(0, attitude.find("[[group]]"));
  const std::string truth = "[truth]\nbias = \"1 uT\"\nscale = \"1 %\"\ntilt = \"0.2 deg\"\n";
  const auto whole = table_of(read_text(desk() / "stand.csv"));
  for (const auto& [group, more, first, columns] :
       {std::tuple<const char*, std::string, std::size_t, std::size_t>{"#mag", truth, 4, 4}, {"#gyros", "", 8, 6}}) {
    write_text(desk() / "alone.toml",
               with(head, "six_axis.toml\"", std::string("six_axis.toml") + group + "\"") + more + moves);
    const Outcome played = run(desk(), {"simulate", "alone.toml", "--out", "alone.csv"});
    ASSERT_EQ(played.code, 0) << played.err;
    const auto alone = table_of(read_text(desk() / "alone.csv"));
    ASSERT_EQ(alone.size(), whole.size());
    for (std::size_t row = 0; row < alone.size(); row += 17) {
      const auto begin = whole[row].begin() + static_cast<std::ptrdiff_t>(first);
      EXPECT_EQ(alone[row], std::vector<std::string>(begin, begin + static_cast<std::ptrdiff_t>(columns))) << row;
    }
  }
}

Outcome mag_run(const std::string& more) {
  write_text(desk() / "mag_run.toml",
             "array = \"six_axis.toml#mag\"\n[truth]\nbias = \"1 uT\"\nscale = \"1 %\"\ntilt = \"0.2 deg\"\n"
             "[attitude]\nlaw = \"random\"\nstations = 14\ndwell = \"4 s\"\n" +
                 more);
  const Outcome played = run(desk(), {"simulate", "mag_run.toml", "--out", "mag_run.csv"});
  EXPECT_EQ(played.code, 0) << played.err;
  return run(desk(), {"monitor", "--array", "six_axis.toml#mag", "--calibration", "mag.json", "--log", "mag_run.csv"});
}

TEST(GroupSimulate, AStuckMagnetometerIsNamed) {
  EXPECT_TRUE(has(mag_run("[[fault]]\nspec = \"m3:last@26s\"\n").out, "excluded    m3"));
  EXPECT_TRUE(has(mag_run("[[fault]]\nspec = \"m1:bias=-2uT@26s\"\n").out, "excluded    m1"));
}

// Iron on the tool is felt by all alike: the length tells, nobody is blamed.
TEST(GroupSimulate, InterferenceBlamesNobody) {
  const Outcome clean = mag_run("");
  EXPECT_EQ(clean.code, 0) << clean.out;
  EXPECT_FALSE(has(clean.out, "norm_mismatch")) << clean.out;
  for (const char* const frame : {"tool", "ground"}) {
    const Outcome outcome =
        mag_run(std::string("[interference]\nvector = [\"1500 nT\", \"0 nT\", \"1 uT\"]\nframe = \"") + frame +
                "\"\nfrom = \"26 s\"\n");
    for (const char* const id : {"m1", "m2", "m3", "m4"})
      EXPECT_FALSE(has(outcome.out, std::string("excluded    ") + id)) << frame << "\n" << outcome.out;
    EXPECT_TRUE(says(outcome.out, {"norm_mismatch", "unconfirmed", "excluded    -"})) << frame << "\n" << outcome.out;
  }
}

// Negative: REQ-253
// What the link loses it loses of every group.
TEST(GroupSimulate, ALostRowIsLostInEveryGroup) {
  play_healthy();
  write_text(desk() / "lossy.toml",
             with(read_text(desk() / "healthy.toml"), "[[group]]",
                  "[[fault]]\nspec = \"m1:bias=3uT@10s\"\n[[fault]]\nspec = \"log:drop=20%@0s\"\n"
                  "[[group]]"));
  const Outcome played = run(desk(), {"simulate", "lossy.toml", "--out", "lossy.csv", "--truth", "lossy_truth.csv"});
  ASSERT_EQ(played.code, 0) << played.err;
  const auto whole = table_of(read_text(desk() / "healthy.csv")), rest = table_of(read_text(desk() / "lossy.csv"));
  EXPECT_NEAR(static_cast<double>(rest.size()) / static_cast<double>(whole.size()), 0.8, 0.05);
  std::size_t at = 0;
  for (const auto& row : rest) {
    while (at < whole.size() && whole[at][0] != row[0]) ++at;
    ASSERT_LT(at, whole.size());
    EXPECT_EQ(whole[at].back(), row.back());
    EXPECT_EQ(whole[at][5], row[5]);
  }
}

TEST(GroupSimulate, WhatCannotBePlayedIsSaid) {
  const struct {
    const char *array, *text, *says;
  } cases[] = {
      {"no_dip.toml", "", "group mag.dip"},
      {"no_dip.toml#mag", "", "is missing, and the array file does not state it"},
      {"six_axis.toml#mag", "gravity = \"9.8 m/s^2\"\n", "means nothing to magnetometers"},
      {"six_axis.toml#gyros", "field = \"50 uT\"\n", "field"},
      {"six_axis.toml", "dip = \"70 deg\"\n", "write it into the [[group]]"},
      {"six_axis.toml#mag", "field = \"9 m/s^2\"\n", "nT"},
      {"six_axis.toml#nope", "", "nope"},
      {"six_axis.toml", "[[group]]\nname = \"magg\"\n", "has no group \"magg\""},
      {"six_axis.toml", "[[fault]]\nspec = \"m1:bias=5mg0@2s\"\n", "nT"},
      {"six_axis.toml", "[[fault]]\nspec = \"x1:bias=5mg0@2s\"\n", "x1"},
      {"same.toml", "[[fault]]\nspec = \"a1:bias=5mg0@2s\"\n", "is a sensor of two groups"},
  };
  std::string tool = read_text(desk() / "six_axis.toml");
  std::string no_dip =
      with(tool, "model = \"wmm\"\nlatitude = \"60.4 deg\"\nlongitude = \"2.1 deg\"\ndate = \"2026-03-31\"",
           "value = \"51 uT\"");
  write_text(desk() / "no_dip.toml", no_dip);
  write_text(desk() / "same.toml", with(tool, "id = \"m1\"", "id = \"a1\"\ncolumn = \"m1\""));
  for (const auto& one : cases) {
    write_text(desk() / "wrong.toml", std::string("array = \"") + one.array + "\"\n" +
                                          (one.text[0] == '[' ? "[attitude]\nlaw = \"random\"\n" : "") + one.text +
                                          (one.text[0] == '[' ? "" : "[attitude]\nlaw = \"random\"\n"));
    const Outcome outcome = run(desk(), {"simulate", "wrong.toml", "--out", "wrong.csv"});
    EXPECT_NE(outcome.code, 0) << one.says;
    EXPECT_TRUE(has(outcome.err, one.says)) << one.array << " " << one.text << "\n" << outcome.err;
    EXPECT_TRUE(has(outcome.err, "Remedy: ")) << outcome.err;
  }
}

TEST(GroupStudies, WhatServesNoGroupSaysWhatDoes) {
  const struct {
    std::vector<std::string> arguments;
    const char* says;
  } cases[] = {
      {{"verify", "--array", "six_axis.toml#gyros", "--out", "report"}, "plumb monitor --group"},
      {{"simulate", "--flight", "drone", "six_axis.toml#gyros", "--out", "f.csv"}, "write a scenario with array = "},
  };
  for (const auto& one : cases) {
    const Outcome outcome = run(desk(), one.arguments);
    EXPECT_EQ(outcome.code, 2) << outcome.err;
    EXPECT_TRUE(says(outcome.err, {"does not serve a group of", "Remedy: ", one.says})) << outcome.err;
  }
}

}  // namespace
}  // namespace group_studies_test

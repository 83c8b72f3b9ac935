// plumb calibrate over temperature: orders found, orders refused, and the file that a monitor uses.
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "tool_runner.hpp"

namespace temperature_test {
namespace {

using namespace plumb_test;
using Json = nlohmann::json;

/// The oven of examples/, simulated once; `hottest` leaves out the rows above.
class Oven : public Directory {
 public:
  explicit Oven(double hottest_degc = 1e9, double coldest_degc = -1e9) {
    std::filesystem::create_directory_symlink(PLUMB_SOURCE_DIR "/examples/", *this / "examples");
    EXPECT_EQ(run(*this, {"simulate", "examples/oven.toml", "--out", "whole.csv"}).code, 0);
    std::istringstream in(read_text(*this / "whole.csv"));
    std::string line, kept;
    std::getline(in, line);
    kept = line + "\n";
    while (std::getline(in, line)) {
      const double degc = std::stod(cells_of(line)[kDegc]);
      if (degc <= hottest_degc && degc >= coldest_degc) kept += line + "\n";
    }
    write_text(*this / "oven.csv", kept);
  }

  /// Columns of the log: t_s, station, temp_degc, a1 to a4.
  static constexpr std::size_t kStation = 1, kDegc = 2, kA2 = 4;
  static std::vector<std::string> cells_of(const std::string& line) {
    std::vector<std::string> cells;
    std::istringstream in(line);
    for (std::string cell; std::getline(in, cell, ',');) cells.push_back(cell);
    return cells;
  }
  /// Puts every row of the log through `change`.
  template <class Change>
  void rewrite(Change change) const {
    std::istringstream in(read_text(*this / "oven.csv"));
    std::string line, out;
    std::getline(in, line);
    out = line + "\n";
    while (std::getline(in, line)) {
      std::vector<std::string> cells = cells_of(line);
      change(cells);
      for (std::size_t k = 0; k < cells.size(); ++k) out += (k > 0 ? "," : "") + cells[k];
      out += "\n";
    }
    write_text(*this / "oven.csv", out);
  }

  Outcome calibrate(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments = {"calibrate", "--array",  "examples/oven_tool.toml", "--log", "oven.csv",
                                          "--out",     "oven.json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(*this, arguments);
  }
  Json report(std::vector<std::string> more = {}) const {
    more.emplace_back("--json");
    return Json::parse(calibrate(more).out);
  }
};

TEST(ToolTemperature, CubicsAreFoundAndWritten) {
  const Oven where;
  const Outcome done = where.calibrate();
  EXPECT_EQ(done.code, 0) << done.err;
  EXPECT_TRUE(says(done.out, {"rank", "37 of 40 parameters", "temperature", "levels", "order", "3,", "expected error",
                              "at 20", "at 150", "degC^3", "accepted"}));
  const Json told = where.report();
  EXPECT_EQ(told["temperature"]["order"], 3);
  EXPECT_EQ(told["temperature"]["rank"], 37);
  EXPECT_EQ(told["fit"]["parameters"], 40);
  EXPECT_LT(told["temperature"]["condition"], 30.0);
  EXPECT_EQ(told["hold_out"]["judged"], 96);
  EXPECT_LT(told["hold_out"]["sigmas"], 1.5);
  // What examples/oven.toml says of a1.
  const Json& a1 = told["temperature"]["sensors"][0];
  const double slope = a1["SF_per_mps2"]["value"][1].get<double>() / a1["SF_per_mps2"]["value"][0].get<double>();
  const double sigma = a1["SF_per_mps2"]["sigma"][1].get<double>() / a1["SF_per_mps2"]["value"][0].get<double>();
  EXPECT_LT(sigma, 2e-5);
  EXPECT_NEAR(slope, -150e-6, 4.0 * sigma);
  // The file holds the same numbers, bit for bit.
  const Json file = Json::parse(read_text(where / "oven.json"));
  for (std::size_t i = 0; i < 4; ++i) {
    const Json& sensor = told["temperature"]["sensors"][i];
    for (std::size_t k = 0; k < 4; ++k) {
      EXPECT_NEAR(file["sensors"][i]["scale"][k].get<double>(), sensor["SF_per_mps2"]["value"][k].get<double>(), 1e-13);
      EXPECT_NEAR(file["sensors"][i]["bias_mps2"][k].get<double>(), sensor["B_mps2"]["value"][k].get<double>(), 1e-12);
    }
  }
  EXPECT_EQ(file["report"]["rank"], 37);
}

/// The paper's own fits know no temperature: they are made with the drift that plumb found.
TEST(ToolTemperature, ThePapersFitsTakeTheDrift) {
  const Oven where;
  const Json told = where.report({"--paper"});
  ASSERT_EQ(told["paper"].size(), 5);
  for (const Json& fit : told["paper"]) {
    EXPECT_TRUE(fit["sound"]);
    EXPECT_LT(fit["length_error_rms_mps2"].get<double>(), 1e-3);
  }
}

TEST(ToolTemperature, AMonitorUsesItOverTheWholeSpan) {
  const Oven where;
  ASSERT_EQ(where.calibrate().code, 0);
  const Outcome good = run(where, {"monitor", "--array", "examples/oven_tool.toml", "--calibration", "oven.json",
                                   "--log", "whole.csv", "--events", "events.jsonl"});
  EXPECT_EQ(good.code, 0) << good.err;
  EXPECT_TRUE(says(good.out, {"nominal"}));
  EXPECT_EQ(read_text(where / "events.jsonl").find("parity"), std::string::npos);
  // Coefficients without drift over the same span would be another tool at every temperature: they are not had.
  const Outcome constant = where.calibrate({"--temperature-order", "0", "--keep-outliers"});
  EXPECT_EQ(constant.code, 4);
  EXPECT_TRUE(says(constant.out, {"NOT ACCEPTED", "degC"}));
}

TEST(ToolTemperature, AnOrderWithoutItsLevelsIsRefusedByName) {
  const Oven where(33.0);  // 20 to 33 degC: two levels
  const Outcome refused = where.calibrate({"--temperature-order", "3", "--use-range-degc", "20,150"});
  EXPECT_EQ(refused.code, 4);
  EXPECT_TRUE(says(refused.out, {"NOT ACCEPTED", "order 3 need 4 temperature levels", "have 2", "add stations near",
                                 "150 degC", "--temperature-order 1"}));
  EXPECT_FALSE(std::filesystem::exists(where / "oven.json"));
  const Json told = where.report({"--temperature-order", "3", "--use-range-degc", "20,150"});
  EXPECT_FALSE(told["accepted"]);
  EXPECT_EQ(told["temperature"]["missing_degc"].size(), 2);
  EXPECT_EQ(told["temperature"]["levels"].size(), 2);
}

/// A well that is the flatter the deeper and the hotter it is.
TEST(ToolTemperature, ATemperatureThatFollowsTheInclinationIsRefusedByName) {
  const Oven where;
  write_text(where / "well.toml",
             "name = \"well\"\narray = \"examples/oven_tool.toml\"\nseed = 1\n[truth]\nlaw = \"uniform\"\n"
             "[attitude]\nlaw = \"drilling-path\"\nstations = 40\ninclination = \"2 deg\"\nbuild = \"2.2 deg\"\n"
             "dwell = \"1 s\"\nrecord_motion = false\ntag_stations = true\n"
             "[temperature]\nlaw = \"linear\"\nstart = \"20 degC\"\nrate = \"97 degC/min\"\n");
  ASSERT_EQ(run(where, {"simulate", "well.toml", "--out", "oven.csv"}).code, 0);
  const Outcome refused = where.calibrate({"--temperature-order", "3"});
  EXPECT_EQ(refused.code, 4);
  EXPECT_TRUE(says(refused.out, {"rank", "34 of 40", "not determined", "cubic scale of", " against ", "NOT ACCEPTED",
                                 "follows their inclination", "34 of the 37", "hotter or colder"}));
  const Json told = where.report({"--temperature-order", "3"});
  EXPECT_TRUE(told["temperature"]["follows_inclination"]);
  EXPECT_EQ(told["temperature"]["null_directions"], 3);
  EXPECT_EQ(told["temperature"]["null"][0][0]["order"], 3);
  // By itself the tool takes the order that these stations do support, and says why it is no higher.
  const Outcome lower = where.calibrate();
  EXPECT_EQ(lower.code, 0) << lower.err;
  EXPECT_TRUE(says(lower.out, {"21 of 24", "the temperature follows the inclination", "accepted"}));
}

TEST(ToolTemperature, ARangeFarBeyondTheLevelsIsReported) {
  const Oven where(62.0);
  const Json near = where.report({"--temperature-order", "3"});
  const Json far = where.report({"--temperature-order", "3", "--use-range-degc", "20,150"});
  ASSERT_TRUE(near["accepted"]);
  ASSERT_TRUE(far["accepted"]);
  EXPECT_LT(near["temperature"]["condition"], 100.0);
  EXPECT_GT(far["temperature"]["condition"], 300.0);
  EXPECT_GT(far["temperature"]["expected_error"][2]["direction_rad"].get<double>(),
            10.0 * near["temperature"]["expected_error"][2]["direction_rad"].get<double>());
  EXPECT_TRUE(says(where.calibrate({"--temperature-order", "3", "--use-range-degc", "20,150"}).out,
                   {"extrapolated", "far beyond what was recorded", "expected error"}));
}

TEST(ToolTemperature, ASensorThatBendsIsRefusedByNameAndTemperature) {
  const Oven where;
  where.rewrite([](std::vector<std::string>& row) {  // 10 mg0 at 150 degC, from 120 degC up
    const double beyond = std::stod(row[Oven::kDegc]) - 120.0;
    if (beyond > 0.0) row[Oven::kA2] = std::to_string(std::stod(row[Oven::kA2]) + 1e-3 * beyond);
  });
  const Outcome refused = where.calibrate();
  EXPECT_EQ(refused.code, 4);
  EXPECT_TRUE(says(refused.out, {"residuals of a2 depend on temperature", "degC", "sigma from none", "NOT ACCEPTED",
                                 "residuals of a2", "allowed 0.6 mg0", "--use-range-degc"}));
  const Json told = where.report();
  EXPECT_EQ(told["refusal"]["concern"], "level_of_a_sensor");
  EXPECT_TRUE(told["refusal"]["would_settle"].is_null()) << "no other mistake is looked for";
}

TEST(ToolTemperature, ATemperatureThatNoToolHasIsRefusedByStation) {
  for (const char* degc : {"450", "-150", "1e6"}) {
    const Oven where;
    where.rewrite([degc](std::vector<std::string>& row) {
      if (row[Oven::kStation] == "40") row[Oven::kDegc] = degc;
    });
    const Outcome refused = where.calibrate();
    EXPECT_EQ(refused.code, 4) << degc;
    EXPECT_TRUE(says(refused.err,
                     {"station 41 has a temperature of", "outside -100 to 400 degC", "Remedy", "temperature column"}))
        << degc;
    EXPECT_FALSE(std::filesystem::exists(where / "oven.json"));
  }
}

TEST(ToolTemperature, ARampIsReportedUnlessItComesBack) {
  const Oven up;
  EXPECT_TRUE(says(up.calibrate().out, {"drift in time", "cannot be separated from drift with temperature",
                                        "record some attitudes again near 20"}));
  EXPECT_TRUE(up.report()["temperature"]["follows_time"]);
  // The last two stations are moved to the front: hot, then up from the cold.
  const Oven back;
  std::string head, last, rest, line;
  std::istringstream in(read_text(back / "oven.csv"));
  std::getline(in, head);
  double t_s = 0.0;
  while (std::getline(in, line)) {
    const std::vector<std::string> cells = Oven::cells_of(line);
    (std::stoi(cells[Oven::kStation]) >= 94 ? last : rest) += line.substr(line.find(',')) + "\n";
  }
  std::istringstream body(last + rest);
  std::string log = head + "\n";
  for (; std::getline(body, line); t_s += 0.01) log += std::to_string(t_s) + line + "\n";
  write_text(back / "oven.csv", log);
  const Outcome outcome = back.calibrate();
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(outcome.out.find("drift in time"), std::string::npos) << outcome.out;
  EXPECT_FALSE(back.report()["temperature"]["follows_time"]);
}

TEST(ToolTemperature, BadOptionsAreRefused) {
  const Directory where;
  const auto refused = [&where](const char* option, const char* value) {
    return run(where, {"calibrate", "--array", "a", "--log", "b", "--out", "c", option, value});
  };
  for (const char* order : {"4", "-1", "cubic", ""}) EXPECT_EQ(refused("--temperature-order", order).code, 2) << order;
  for (const char* range : {"20", "150,20", "20,25", "a,b", "20,150,3", "20,nan"}) {
    EXPECT_EQ(refused("--use-range-degc", range).code, 2) << range;
  }
  for (const char* range : {"-1e308,1e308", "0,1e6", "-101,20", "20,401"}) {
    const Outcome outcome =
        run(where, {"calibrate", "--array", "a", "--log", "b", "--out", "c", std::string("--use-range-degc=") + range});
    EXPECT_EQ(outcome.code, 2) << range;
    EXPECT_TRUE(says(outcome.err, {"exceeds -100 to 400 degC"})) << range;
  }
  EXPECT_TRUE(says(refused("--use-range-degc", "150,20").err, {"descending order"}));
}

}  // namespace
}  // namespace temperature_test

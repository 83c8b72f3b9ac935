// Stations that share an inclination, from the log to the report: [input] roll_group, --roll-axis,
// --roll-axis-deviation-deg.
#include <cmath>
#include <nlohmann/json.hpp>

#include "tool_runner.hpp"

namespace roll_group_test {
namespace {

using namespace plumb_test;
using Json = nlohmann::json;

/// The paper's tool at inclinations with so many rolls each; `array.toml` names the column of the roll group.
class RollBench : public Workshop {
 public:
  explicit RollBench(const std::vector<int>& inclinations = {0, 45, 90}, int rolls = 8, int seed = 1) {
    put("array.toml", with(text("array.toml"), "[input]\n", "[input]\nroll_group = \"ring\"\n"));
    std::string list;
    for (const int inclination : inclinations) {
      for (int k = 0; k < rolls; ++k) {
        list += "{inclination = \"" + std::to_string(inclination) + " deg\", toolface = \"" +
                std::to_string(360.0 * k / rolls) + " deg\"}, ";
      }
    }
    const std::string number = std::to_string(seed);
    put("rolls.toml",
        "name = \"rolls\"\narray = \"array.toml\"\nseed = " + number +
            "\n[truth]\nlaw = \"uniform\"\nbias = \"20 mg0\"\nscale = \"2 %\"\ntilt = \"2 deg\"\nseed = " + number +
            "\n[attitude]\nlaw = \"list\"\nrecord_motion = false\ntag_stations = true\n" + "directions = [" + list +
            "]\n");
    const Outcome done = run(*this, {"simulate", "rolls.toml", "--out", "calibration.csv", "--truth", "truth.csv"});
    EXPECT_EQ(done.code, 0) << done.err;
  }
  Outcome calibrate(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments = {"calibrate",       "--array", "array.toml", "--log",
                                          "calibration.csv", "--out",   "new.json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(*this, arguments);
  }
  Json report(std::vector<std::string> more = {}) const {
    more.emplace_back("--json");
    return Json::parse(calibrate(more).out);
  }
};

/// Mean square of the inclination's error over the stations of a report; the true ones are given in their order.
double inclination_error(const Json& report, const std::vector<int>& inclinations, int rolls) {
  double sum = 0.0;
  for (std::size_t k = 0; k < report["stations"].size(); ++k) {
    const auto& down = report["stations"][k]["down"];
    const double true_rad = inclinations[k / static_cast<std::size_t>(rolls)] * 3.14159265358979323846 / 180.0;
    const double rad = std::atan2(std::hypot(down[0].get<double>(), down[1].get<double>()), down[2].get<double>());
    sum += (rad - true_rad) * (rad - true_rad) / static_cast<double>(report["stations"].size());
  }
  return sum;
}

TEST(RollGroups, GiveTheInclinationItself) {
  double with_rows = 0.0, said = 0.0, without = 0.0;
  constexpr int kTools = 6;
  for (int seed = 1; seed <= kTools; ++seed) {
    const RollBench where({0, 45, 90}, 8, seed);
    const Json json = where.report();
    EXPECT_TRUE(json["accepted"]) << json["refusal"];
    EXPECT_EQ(json["fit"]["rank"], 15);
    EXPECT_EQ(json["fit"]["gauge"], 1);
    EXPECT_EQ(json["fit"]["roll_groups"], 3);
    with_rows += inclination_error(json, {0, 45, 90}, 8) / kTools;
    said += std::pow(json["fit"]["inclination_sigma_rad"].get<double>(), 2) / kTools;
    where.put("array.toml", with(where.text("array.toml"), "roll_group = \"ring\"\n", ""));
    const Json plain = where.report();
    EXPECT_EQ(plain["fit"]["rank"], 13);
    EXPECT_EQ(plain["fit"]["roll_groups"], 0);
    EXPECT_TRUE(plain["fit"]["roll_axis"].is_null());
    without += inclination_error(plain, {0, 45, 90}, 8) / kTools;
  }
  EXPECT_LE(std::sqrt(with_rows), 0.3e-3);
  EXPECT_LE(std::sqrt(with_rows), 4.0 * std::sqrt(said));
  EXPECT_GE(std::sqrt(without), 5e-3);
  std::cout << "[ measured ] inclination " << std::sqrt(with_rows) << " rad (said " << std::sqrt(said) << "), without "
            << std::sqrt(without) << '\n';
}

TEST(RollGroups, AreInTheReportAndInTheFile) {
  const RollBench where;
  const Outcome outcome = where.calibrate({"--roll-axis-deviation-deg", "0.05"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_TRUE(says(outcome.out, {"15 of 16 parameters", "about the roll axis", "roll groups", "3 in the log",
                                 "(0, 0, 1) within 0.05 deg", "inclination", "by the stations that share"}));
  const Json file = Json::parse(where.text("new.json"));
  EXPECT_EQ(file["version"], 2);
  EXPECT_EQ(file["report"]["roll"]["groups"], 3);
  EXPECT_EQ(file["report"]["roll"]["axis"], Json({0.0, 0.0, 1.0}));
  EXPECT_LT(file["report"]["roll"]["inclination_sigma_rad"], 0.5e-3);
  EXPECT_EQ(
      run(where, {"monitor", "--array", "array.toml", "--calibration", "new.json", "--log", "calibration.csv"}).code, 0)
      << "reads it back";
  const Outcome plain =
      run(where, {"calibrate", "--array", "array.toml", "--log", "calibration.csv", "--out", "x.json"});
  EXPECT_EQ(Json::parse(where.text("x.json"))["report"]["roll"]["axis_deviation_rad"], 0.0) << plain.err;
}

TEST(RollGroups, TheAxisIsTheOneThatInclinationIsCountedFrom) {
  const RollBench where;
  where.put("array.toml", where.text("array.toml") + "\n[output]\nframe = [[0, 1, 0], [0, 0, 1], [1, 0, 0]]\n");
  // Rolled about z in truth: about x the stations of a group do not share an inclination.
  EXPECT_EQ(where.calibrate().code, 4);
  const Json json = where.report({"--roll-axis", "0,0,3"});
  EXPECT_TRUE(json["accepted"]);
  EXPECT_EQ(json["fit"]["roll_axis"], Json({0.0, 0.0, 1.0}));
}

TEST(RollGroups, AWrongAxisIsReportedWithTheRightOne) {
  const RollBench where;
  for (const char* axis : {"1,0,0", "0,1,0"}) {
    const Outcome outcome = where.calibrate({"--roll-axis", axis});
    EXPECT_EQ(outcome.code, 4);
    EXPECT_TRUE(says(outcome.err, {"rolled about 0,0,1 the fit would be accepted", "give --roll-axis 0,0,1"}));
  }
  EXPECT_EQ(where.report({"--roll-axis", "1,0,0"})["refusal"]["would_settle"]["roll_axis"], Json({0.0, 0.0, 1.0}));
}

/// By 5 deg the nominal axes, known to 2 deg each, can only ask; by 10 deg they contradict.
TEST(RollGroups, AnAxisThatIsOffIsReportedAndThenRefused) {
  const RollBench where;
  const Outcome right = where.calibrate();
  EXPECT_TRUE(says(right.out, {"roll axis", "turned together by", "sigma", "accepted"}));
  EXPECT_EQ(right.out.find("Check the roll axis"), std::string::npos) << right.out;
  const Outcome asked = where.calibrate({"--roll-axis", "0.0872,0,0.9962"});
  EXPECT_EQ(asked.code, 0) << asked.err;
  EXPECT_TRUE(says(asked.out, {"roll axis", "turned together by 3.", "Check the roll axis", "accepted"}));
  const Json told = Json::parse(where.text("new.json"))["report"]["roll"];
  EXPECT_GT(told["common_turn_rad"], 2.0 * told["common_turn_sigma_rad"].get<double>());
  const Outcome refused = where.calibrate({"--roll-axis", "0.1736,0,0.9848"});
  EXPECT_EQ(refused.code, 4);
  EXPECT_TRUE(says(refused.err, {"roll axis (0.174, 0, 0.985) is likely not the one", "turned together by 8.",
                                 "allowed", "rolled about 0,0,1 the fit would be accepted", "give --roll-axis 0,0,1"}));
  const Json json = where.report({"--roll-axis", "0.1736,0,0.9848"});
  EXPECT_EQ(json["refusal"]["concern"], "roll_axis");
  EXPECT_EQ(json["refusal"]["would_settle"]["roll_axis"], Json({0.0, 0.0, 1.0}));
  EXPECT_GT(json["fit"]["common_turn_rad"], 4.0 * json["fit"]["common_turn_sigma_rad"].get<double>());
}

/// Here no axis of the tool frame is the right one: all nominal axes were written down in a frame turned by 10 deg.
TEST(RollGroups, AnAxisThatIsNoneOfTheFrameIsNotReplacedByOne) {
  const RollBench where;
  std::string array = where.text("array.toml");
  const double c = std::cos(0.1745), s = std::sin(0.1745);
  const double axes[4][3] = {{0.9428090415820635, 0, 1.0 / 3},
                             {-0.4714045207910317, 0.8164965809277259, 1.0 / 3},
                             {-0.4714045207910317, -0.8164965809277259, 1.0 / 3},
                             {0, 0, 1}};
  std::size_t from = 0;
  for (const auto& a : axes) {
    from = array.find("axis = [", from);
    ASSERT_NE(from, std::string::npos);
    const std::size_t end = array.find(']', from);
    const std::string turned = "axis = [" + std::to_string(c * a[0] + s * a[2]) + ", " + std::to_string(a[1]) + ", " +
                               std::to_string(c * a[2] - s * a[0]);
    array.replace(from, end - from, turned);
    from += turned.size();
  }
  where.put("array.toml", array);
  const Outcome refused = where.calibrate();
  EXPECT_EQ(refused.code, 4);
  EXPECT_TRUE(says(refused.err, {"roll axis (0, 0, 1) is likely not the one", "widen `prior`"}));
  EXPECT_EQ(refused.err.find("the fit would be accepted"), std::string::npos) << refused.err;
  EXPECT_TRUE(where.report()["refusal"]["would_settle"].is_null());
  EXPECT_EQ(where.calibrate({"--roll-axis", "0.1736,0,0.9848"}).code, 0) << "the axis in that frame";
}

TEST(RollGroups, AStationInTheWrongGroupIsFoundByItsGroup) {
  const RollBench where({0, 45, 90, 120}, 8);
  std::string log = where.text("calibration.csv");
  // Station 12 was recorded at 45 deg and is numbered with those at 0 deg.
  for (std::size_t at = log.find(",12,1,"); at != std::string::npos; at = log.find(",12,1,", at))
    log.replace(at, 6, ",12,0,");
  where.put("calibration.csv", log);
  const Outcome outcome = where.calibrate();
  EXPECT_EQ(outcome.code, 4) << outcome.out;
  EXPECT_TRUE(says(outcome.err, {"without roll group 0 the fit would be accepted", "column `ring`"}));
  EXPECT_EQ(where.report()["refusal"]["would_settle"]["without_roll_group"], Json::array({0}));
}

TEST(RollGroups, AnEmptyColumnIsReported) {
  const RollBench where;
  std::istringstream in(where.text("calibration.csv"));
  std::string line, log;
  for (int row = 0; std::getline(in, line); ++row) {
    const std::size_t second = line.find(',', line.find(',') + 1), third = line.find(',', second + 1);
    log += (row == 0 ? line : line.substr(0, second + 1) + line.substr(third)) + "\n";
  }
  where.put("calibration.csv", log);
  const Outcome outcome = where.calibrate();
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_TRUE(says(outcome.out, {"`ring` (roll_group) is empty or -1 at all", "common inclination"}));
  const Json json = where.report();
  ASSERT_EQ(json["columns"].size(), 1U);
  EXPECT_EQ(json["columns"][0]["of"], "roll_group");
}

TEST(RollGroups, OfOneStationAreReported) {
  const RollBench where;
  std::string log = where.text("calibration.csv");
  // The last station gets a group of its own: its rows hold ",3," after the number of the station.
  const std::size_t last = log.find(",23,2,");
  ASSERT_NE(last, std::string::npos) << line_of(log, 4700);
  for (std::size_t at = last; at != std::string::npos; at = log.find(",23,2,", at)) log.replace(at, 6, ",23,9,");
  where.put("calibration.csv", log);
  const Outcome outcome = where.calibrate();
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_TRUE(says(outcome.out, {"4 in the log", "one has a single station, which carries no"}));
  EXPECT_EQ(where.report()["fit"]["single_station_roll_groups"], 1);
}

TEST(RollGroups, WithoutTwoStationsInAnyTheFitIsThePlainOne) {
  const RollBench where({0, 20, 40, 50, 60, 80, 100, 120, 130, 150, 160, 180}, 1);
  // Every inclination is there once, so that the simulator has given no numbers; here is one for each station.
  std::istringstream in(where.text("calibration.csv"));
  std::string line, log;
  for (int row = 0; std::getline(in, line); ++row) {
    const std::size_t second = line.find(',', line.find(',') + 1), third = line.find(',', second + 1);
    const std::string station = line.substr(line.find(',') + 1, second - line.find(',') - 1);
    log += (row == 0 ? line : line.substr(0, second + 1) + station + line.substr(third)) + "\n";
  }
  where.put("calibration.csv", log);
  const Json json = where.report();
  EXPECT_EQ(json["fit"]["roll_groups"], 12);
  EXPECT_EQ(json["fit"]["single_station_roll_groups"], 12);
  EXPECT_EQ(json["fit"]["gauge"], 3);
  EXPECT_TRUE(json["fit"]["roll_axis"].is_null());
}

TEST(RollGroups, MoreThanSixteenAreRefused) {
  std::vector<int> inclinations;
  for (int k = 0; k < 17; ++k) inclinations.push_back(5 + 10 * k);
  const RollBench where(inclinations, 2);
  const Outcome outcome = where.calibrate();
  EXPECT_EQ(outcome.code, 4);
  EXPECT_TRUE(says(outcome.err, {"more than 16 roll groups", "Remedy", "join groups"}));
}

TEST(RollGroups, ThatSeeOneRotationOnlySaySo) {
  const RollBench where({30, 60}, 12);
  const Outcome outcome = where.calibrate();
  EXPECT_EQ(outcome.code, 4);
  EXPECT_TRUE(says(outcome.err, {"14 of the 15 parameters", "without `roll_group`"}));
}

TEST(RollGroups, AColumnThatIsNotThereIsRefusedByName) {
  const RollBench where;
  where.put("array.toml", with(where.text("array.toml"), "\"ring\"", "\"rings\""));
  const Outcome outcome = where.calibrate();
  EXPECT_EQ(outcome.code, 3);
  EXPECT_TRUE(says(outcome.err, {"calibration.csv:1", "rings", "input.roll_group", "did you mean \"ring\"?"}));
}

TEST(RollGroups, OptionsThatMeanNothingAreRefused) {
  const RollBench where;
  for (const char* axis : {"0,0,0", "0,0", "0,0,1,0", "x,y,z", "0,0,nan", "inf,0,0", "", "1e308,1e308,1e308"}) {
    const Outcome outcome = where.calibrate({"--roll-axis", axis});
    EXPECT_EQ(outcome.code, 2) << axis;
    EXPECT_TRUE(says(outcome.err, {"--roll-axis"})) << axis;
  }
  for (const char* wobble : {"-0.1", "nan", "inf", "half", "", "60"}) {
    const Outcome outcome = where.calibrate({std::string("--roll-axis-deviation-deg=") + wobble});
    EXPECT_EQ(outcome.code, 2) << wobble;
    EXPECT_TRUE(says(outcome.err, {"--roll-axis-deviation-deg"})) << wobble;
  }
  where.put("array.toml", with(where.text("array.toml"), "roll_group = \"ring\"\n", ""));
  const Outcome outcome = where.calibrate({"--roll-axis", "0,0,1"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_TRUE(says(outcome.err, {"input.roll_group", "is missing", "Remedy"}));
}

}  // namespace
}  // namespace roll_group_test

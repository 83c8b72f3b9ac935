// plumb survey --array: references from the array file; sag and depth; stations that an estimate leaves out.
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "simulated_hole.hpp"

namespace survey_command_test {
namespace {

std::string tool(const std::string& gravity, const std::string& reference) {
  std::string out = "name = \"tool\"\n[gravity]\n" + gravity + "[input]\nreads = \"gravity\"\nunit = \"m/s^2\"\n" +
                    "rate = \"50 Hz\"\n";
  const char* const axes[] = {"[1, 0, 0]", "[0, 1, 0]", "[0, 0, 1]"};
  for (int k = 0; k < 3; ++k)
    out += "[[sensor]]\nid = \"a" + std::to_string(k) + "\"\naxis = " + axes[k] + "\nnoise = \"0.3 mg\"\n";
  out += "[[group]]\nname = \"mag\"\nfield = \"magnetic\"\nunit = \"nT\"\n[group.reference]\n" + reference;
  for (int k = 0; k < 3; ++k)
    out += "[[group.sensor]]\nid = \"m" + std::to_string(k) + "\"\naxis = " + axes[k] + "\nnoise = \"20 nT\"\n";
  return out;
}

const std::string kStatedGravity = "model = \"value\"\nvalue = \"9.81912 m/s^2\"\n";
const std::string kStatedField = "value = \"51 uT\"\ndip = \"73 deg\"\n";
const std::string kPlace = "model = \"wmm\"\nlatitude = \"60.4 deg\"\nlongitude = \"2.1 deg\"\ndate = \"2026-03-31\"\n";
const std::string kLatitude = "latitude = \"60.4 deg\"\n";

/// The same stations but for what printing and reading a number in another unit rounds.
void expect_alike(const Outcome& a, const Outcome& b) {
  const nlohmann::json one = survey_json_of(a), other = survey_json_of(b);
  ASSERT_FALSE(one.is_discarded() || other.is_discarded()) << a.err << b.err;
  const nlohmann::json left = one["stations"].flatten(), right = other["stations"].flatten();
  ASSERT_EQ(left.size(), right.size());
  for (const auto& [key, value] : left.items()) {
    if (value.is_number())
      EXPECT_NEAR(value.get<double>(), right[key].get<double>(), 1e-9 * (1.0 + std::fabs(value.get<double>()))) << key;
    else
      EXPECT_EQ(value, right[key]) << key;
  }
}

// Verifies: REQ-248
TEST(SurveyArray, StatesWhatTheOptionsWould) {
  const Desk where;
  where.put("run.csv", Hole{}.csv());
  where.put("tool.toml", tool(kStatedGravity, kStatedField));
  where.put("placed.toml", tool(kLatitude, kPlace));
  const Outcome by_file =
      run(where, {"survey", "run.csv", "--array", "tool.toml", "--declination", "-2.5 deg", "--json"});
  EXPECT_EQ(by_file.code, 0) << by_file.err;
  EXPECT_EQ(by_file.err, "");
  expect_alike(by_file, run(where, stated({"--json"})));
  const Outcome placed = run(where, {"survey", "run.csv", "--array", "placed.toml#mag", "--json"});
  EXPECT_EQ(placed.err, "");
  expect_alike(placed, run(where, {"survey", "run.csv", "--place", "60.4, 2.1", "--date", "2026-03-31", "--json"}));
  EXPECT_TRUE(
      says(run(where, {"survey", "run.csv", "--array", "placed.toml"}).out, {"References: placed.toml", "WMM-2025"}));
}

// Verifies: REQ-248
TEST(SurveyArray, IsOverriddenByOptionsAndSaysByWhich) {
  const Desk where;
  where.put("run.csv", Hole{}.csv());
  where.put("tool.toml", tool(kLatitude, kPlace + "sigma = \"100 nT\"\n"));
  const auto with = [&](std::vector<std::string> more) {
    std::vector<std::string> all = {"survey", "run.csv", "--array", "tool.toml"};
    all.insert(all.end(), more.begin(), more.end());
    return run(where, all);
  };
  EXPECT_TRUE(says(with({}).out, {"(100 nT)"}));
  const Outcome date = with({"--date", "2028-03-31"});
  EXPECT_TRUE(says(date.err, {"--date \"2028-03-31\" overrides \"2026-03-31\" of tool.toml#mag"}));
  const Outcome same = with({"--date", "2026-03-31", "--place", "60.40, 2.10", "--field-sigma", "0.1 uT"});
  EXPECT_EQ(same.err, "");
  EXPECT_EQ(same.out, with({}).out);
  const Outcome moved = with({"--place", "57.7, 12.0"});
  EXPECT_TRUE(says(moved.err, {"--place \"57.7, 12.0\" overrides", "gravity is that of --place"}));
  expect_alike(with({"--place", "57.7, 12.0", "--json"}),
               run(where, {"survey", "run.csv", "--place", "57.7, 12.0", "--date", "2026-03-31", "--field-sigma",
                           "100 nT", "--json"}));
  const Outcome stated_field = with({"--field", "51000 nT", "--dip", "73 deg", "--gravity", "9.81912 m/s^2"});
  EXPECT_TRUE(says(stated_field.err, {"--field and --dip override the model of the field"}));
  EXPECT_TRUE(says(stated_field.out, {"gravity 9.81912 m/s^2", "field 51000 nT (130 nT)"}));
}

// Negative: REQ-248
TEST(SurveyArray, TellsContradictionsAndRefusesWhatStatesNothing) {
  const Desk where;
  where.put("run.csv", Hole{}.csv());
  where.put("two.toml", tool("latitude = \"57.7 deg\"\n", kPlace));
  const Outcome two = run(where, {"survey", "run.csv", "--array", "two.toml"});
  EXPECT_TRUE(says(two.err, {"two.toml contradicts itself: latitude 57.7 deg in [gravity], 60.4 deg in"}));
  where.put("plain.toml", tool(kLatitude, kPlace).substr(0, tool(kLatitude, kPlace).find("[[group]]")));
  where.put("no_dip.toml", tool(kStatedGravity, "value = \"51 uT\"\n"));
  const struct {
    std::vector<std::string> options;
    std::vector<std::string> words;
  } cases[] = {
      {{"--array", "plain.toml"}, {"plain.toml", "no magnetic group"}},
      {{"--array", "two.toml#gyros"}, {"no group gyros"}},
      {{"--array", "no_dip.toml"}, {"--dip", "needs its length and its dip"}},
      {{"--array", "two.toml", "--field-sigma", "0 nT"}, {"--field-sigma", "must be above 0"}},
      {{"--array", "absent.toml"}, {"absent.toml"}},
  };
  for (const auto& one : cases) {
    std::vector<std::string> all = {"survey", "run.csv"};
    all.insert(all.end(), one.options.begin(), one.options.end());
    const Outcome outcome = run(where, all);
    EXPECT_NE(outcome.code, 0) << one.options[1];
    EXPECT_TRUE(says(outcome.err, one.words)) << outcome.err;
  }
}

// Verifies: REQ-250
TEST(SurveyPathErrors, AreStatedOrSaidToBeNone) {
  const Desk where;
  where.put("run.csv", Hole{}.csv());
  const Outcome none = run(where, stated());
  EXPECT_TRUE(says(none.out, {"none of it for sag and depth, of which no errors are stated"})) << none.out;
  const Outcome some =
      run(where, stated({"--sag-sigma", "0.2 deg", "--depth-sigma", "0.35 m", "--depth-scale-sigma", "560 ppm"}));
  EXPECT_TRUE(says(some.out, {"with the stated sag 0.2 deg, depth 0.35 m, 0.056 % of depth"})) << some.out;
  const auto path = [&](std::vector<std::string> more) {
    more.push_back("--json");
    return survey_json_of(run(where, stated(more)));
  };
  const nlohmann::json plain = path({}), deep = path({"--depth-sigma", "0.35 m"});
  EXPECT_TRUE(plain["path_sigmas"]["depth_m"].is_null());
  EXPECT_EQ(deep["path_sigmas"]["depth_m"], 0.35);
  const auto variance = [](const nlohmann::json& found) {
    return found["path"].back()["covariance_m2"][8].get<double>();
  };
  EXPECT_NEAR(variance(deep) - variance(plain), 0.35 * 0.35, 1e-3);  // the first course is vertical but for 4 deg
}

// Negative: REQ-250
TEST(SurveyPathErrors, OutOfRangeAreRefused) {
  const Desk where;
  where.put("run.csv", Hole{}.csv());
  for (const auto& [option, value] : {std::pair<const char*, const char*>{"--sag-sigma", "6 deg"},
                                      {"--sag-sigma", "0.2"},
                                      {"--depth-sigma", "-1 m"},
                                      {"--depth-scale-sigma", "0.2"}}) {
    const Outcome outcome = run(where, stated({option, value}));
    EXPECT_EQ(outcome.code, 2) << option << outcome.err;
    EXPECT_TRUE(says(outcome.err, {option})) << outcome.err;
  }
}

TEST(SurveyEstimates, NameTheStationsThatTheyLeftOut) {
  const Desk where;
  Hole hole;
  hole.interference_nt = 400.0;
  std::string csv = hole.csv();
  const std::size_t row = csv.find("\n1800.0,") + 1, end = csv.find('\n', row);
  const std::size_t last = csv.rfind(',', end);
  csv.replace(last + 1, end - last - 1, "-30000");
  where.put("run.csv", csv);
  for (const char* const option : {"--axial", "--align-magnetometers"}) {
    const Outcome outcome = run(where, stated({option}));
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_TRUE(says(outcome.out, {"Left out, as a check of it failed: 1800.00 m."})) << outcome.out;
    const nlohmann::json found = survey_json_of(run(where, stated({option, "--json"})));
    EXPECT_EQ(found["left_out_of_estimate_md_m"], nlohmann::json({1800.0}));
    EXPECT_FALSE(found["path"].back()["sigma_north_m"].is_null());
  }
}

}  // namespace
}  // namespace survey_command_test

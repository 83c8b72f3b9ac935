// How the calibrated axes sit in the housing: what the tool knows of it, says of it, and calls valid for it.
#include <fmt/format.h>

#include <cmath>

#include "plumb/core/units.hpp"
#include "render/verify_support.hpp"

namespace housing_test {
namespace {

using namespace plumb_test;
using namespace plumb;

/// The examples, with an alert limit that is about the housing.
class InHousing : public Workshop {
 public:
  InHousing() { put("array.toml", with(text("array.toml"), "alert_frame = \"calibrated-axes\"", "#")); }

  Outcome calibrate(const std::string& out, const std::vector<std::string>& more) const {
    std::vector<std::string> all = {"calibrate", "--array", "array.toml", "--log", "calibration.csv", "--out", out};
    all.insert(all.end(), more.begin(), more.end());
    return run(*this, all);
  }

  /// Options for the first `count` stations, as a fit without them shows them, to 0.1 deg.
  std::vector<std::string> known(int count) const {
    const Json shown = Json::parse(calibrate("first.json", {"--json"}).out);
    std::vector<std::string> out;
    for (int k = 0; k < count; ++k) {
      const Json& d = shown["stations"][static_cast<std::size_t>(k)]["down"];
      const double x = d[0], y = d[1], z = d[2];
      double toolface = deg_from_rad(std::atan2(-x, -y));
      if (toolface < 0.0) toolface += 360.0;
      out.emplace_back("--known-attitude");
      out.push_back(fmt::format("{}:{:.2f},{:.2f},0.1", k + 1, deg_from_rad(std::acos(z)), toolface));
    }
    return out;
  }

  Outcome monitor(const std::string& calibration, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> all = {"monitor",   "--array", "array.toml",  "--calibration",
                                    calibration, "--log",   "drilling.csv"};
    all.insert(all.end(), more.begin(), more.end());
    return run(*this, all);
  }
};

/// The last lines of a file of verdicts are of a degraded tool; of all, what the healthy part says.
std::vector<Json> verdicts(const InHousing& where) {
  std::vector<Json> out;
  std::istringstream in(where.text("v.jsonl"));
  for (std::string line; std::getline(in, line);) out.push_back(Json::parse(line));
  return out;
}

// Negative: REQ-042
TEST(Housing, WithTheDatasheetAloneNothingIsValidAndTheToolSaysWhy) {
  const InHousing where;
  const Outcome outcome = where.monitor("calibration.json", {"--verdicts", "v.jsonl"});
  EXPECT_TRUE(
      says(outcome.err, {"array.toml", "within 6.8 deg of the housing", "by the axes of the datasheet", "alert limit",
                         "1 deg", "no output will be valid", "known_attitudes", "alignment_bound", "alert_frame"}));
  int bounded = 0;
  for (const Json& v : verdicts(where)) {
    EXPECT_NE(v["validity"], "valid");
    EXPECT_TRUE(v["alert"].get<bool>());
    if (v["protection_level_housing_deg"].is_null()) continue;
    ++bounded;
    const double axes = v["protection_level_calibrated_axes_deg"], housing = v["protection_level_housing_deg"];
    EXPECT_NEAR(housing, std::fmin(axes + 6.8, 180.0), 0.05);
  }
  EXPECT_GT(bounded, 10);
  const Outcome judged = run(where, {"verify", "--array", "array.toml", "--calibration", "calibration.json",
                                     "--scenarios", "50", "--out", "r"});
  EXPECT_EQ(judged.code, 6);
  EXPECT_TRUE(
      says(judged.out, {"INCONCLUSIVE", "in the housing", "within 6.8 deg of the housing", "--known-attitude"}));
}

/// A tool that calibrates itself knows no more of its housing than the datasheet does.
// Negative: REQ-042
TEST(Housing, AToolThatCalibratesItselfIsNotValidInIt) {
  const InHousing where;
  const std::vector<std::string> first = {"monitor", "--array",         "array.toml", "--calibrate-first",
                                          "--log",   "calibration.csv", "--verdicts", "v.jsonl"};
  EXPECT_TRUE(says(run(where, first).err, {"within 6.8 deg of the housing", "no output will be valid"}));
  int in_axes = 0;
  for (const Json& v : verdicts(where)) {
    EXPECT_NE(v["validity"], "valid");
    if (v["protection_level_calibrated_axes_deg"].is_number() && v["protection_level_calibrated_axes_deg"] < 1.0)
      ++in_axes;
  }
  EXPECT_GT(in_axes, 10) << "valid but for the housing";
}

// Verifies: REQ-042
TEST(Housing, KnownAttitudesMakeTheOutputValid) {
  const InHousing where;
  const Outcome fitted = where.calibrate("known.json", where.known(3));
  ASSERT_EQ(fitted.code, 0) << fitted.err;
  EXPECT_TRUE(says(fitted.out, {"alignment", "by the stations of known"}));
  EXPECT_EQ(fitted.out.find("from the nominal axes only"), std::string::npos);
  const Outcome outcome = where.monitor("known.json", {"--verdicts", "v.jsonl", "--report", "h.html"});
  EXPECT_EQ(outcome.err.find("no output will be valid"), std::string::npos) << outcome.err;
  int valid = 0;
  for (const Json& v : verdicts(where)) {
    if (v["validity"] != "valid") continue;
    ++valid;
    const double axes = v["protection_level_calibrated_axes_deg"], housing = v["protection_level_housing_deg"];
    EXPECT_LE(housing, 1.0);
    EXPECT_NEAR(housing - axes, 0.2, 0.1);
  }
  EXPECT_GT(valid, 10);
  EXPECT_TRUE(says(outcome.out, {"protection", "in the calibrated axes", "in the housing"}));
  const Json basis = Json::parse(where.text("h.json"))["basis"]["alignment"];
  EXPECT_EQ(basis["source"], "known_attitudes");
  EXPECT_EQ(basis["alert_frame"], "housing");
}

/// Stations that say the housing lies 3 deg off turn the axes: every direction is that of the housing then.
TEST(Housing, TheOutputIsTurnedIntoIt) {
  const InHousing where;
  std::vector<std::string> turned;
  const Json shown = Json::parse(where.calibrate("first.json", {"--json"}).out);
  for (int k = 0; k < 3; ++k) {
    const Json& d = shown["stations"][static_cast<std::size_t>(k)]["down"];
    const double x = d[0], y = d[1], z = d[2];
    // About z by 3 deg: the inclination stays, the toolface grows.
    double toolface = deg_from_rad(std::atan2(-x, -y)) + 3.0;
    if (toolface < 0.0) toolface += 360.0;
    if (toolface >= 360.0) toolface -= 360.0;
    turned.emplace_back("--known-attitude");
    turned.push_back(fmt::format("{}:{:.2f},{:.2f},0.1", k + 1, deg_from_rad(std::acos(z)), toolface));
  }
  ASSERT_EQ(where.calibrate("turned.json", turned).code, 0);
  const auto toolface_by = [&where](const std::string& calibration) {
    (void)where.monitor(calibration, {"--verdicts", "v.jsonl"});
    const std::vector<Json> all = verdicts(where);
    for (const Json& v : all) {
      if (v["tick"].get<bool>() && !v["toolface_deg"].is_null()) return v["toolface_deg"].get<double>();
    }
    return 0.0;
  };
  const double before = toolface_by("first.json"), after = toolface_by("turned.json");
  EXPECT_NEAR(std::remainder(after - before, 360.0), 3.0, 0.02);
}

}  // namespace
}  // namespace housing_test

// Three parallel chips whose z axes drift alike: what `plumb monitor` says of it.
#include <string>

#include "render/verify_support.hpp"

namespace common_cause_cli_test {
namespace {

using namespace plumb_test;

class Chips : public Workshop {
 public:
  Chips() {
    std::string array =
        "name = \"chips\"\n[gravity]\nmodel = \"value\"\nvalue = \"9.80665 m/s^2\"\nsigma = \"0.02 mg0\"\n[input]\n"
        "rows = \"samples\"\ntime = \"t_s\"\nunit = \"m/s^2\"\nreads = \"gravity\"\n[monitor]\n"
        "alert_frame = \"calibrated-axes\"\n";
    const char* const axes[] = {"[1,0,0]", "[0,1,0]", "[0,0,1]"};
    for (int k = 1; k <= 3; ++k) {
      for (std::size_t a = 0; a < 3; ++a) {
        array += std::string("[[sensor]]\nid = \"") + "xyz"[a] + std::to_string(k) + "\"\naxis = " + axes[a] +
                 "\npackage = \"imu" + std::to_string(k) +
                 "\"\nnoise = \"0.2 mg\"\nprior = { bias = \"20 mg\", scale = \"1 %\", axis = \"1 deg\" }\n";
      }
    }
    put("chips.toml", array);
    simulate("stand", 5, 40, "");
    run(*this, {"calibrate", "--array", "chips.toml", "--log", "stand.csv", "--out", "cal.json"});
  }

  Outcome monitor(const std::string& faults, int stations = 25) const {
    simulate("run", 9, stations, faults);
    return run(*this, {"monitor", "--array", "chips.toml", "--calibration", "cal.json", "--log", "run.csv", "--report",
                       "health.html"});
  }

  /// Of the same run, for --json.
  Outcome summary() const {
    return run(*this, {"monitor", "--array", "chips.toml", "--calibration", "cal.json", "--log", "run.csv", "--json"});
  }

 private:
  void simulate(const std::string& name, int seed, int stations, const std::string& faults) const {
    put((name + ".toml").c_str(),
        "array = \"chips.toml\"\nseed = " + std::to_string(seed) +
            "\nrate = \"100 Hz\"\n[truth]\nlaw = \"uniform\"\nbias = \"10 mg0\"\nscale = \"0.5 %\"\n"
            "tilt = \"0.5 deg\"\nseed = 1\n[attitude]\nlaw = \"random\"\nstations = " +
            std::to_string(stations) + "\ndwell = \"3 s\"\nmotion = \"1 s\"\n" + faults);
    const Outcome made = run(*this, {"simulate", name + ".toml", "--out", name + ".csv"});
    EXPECT_EQ(made.code, 0) << made.err;
  }
};

std::string drift(const std::string& id, const std::string& rate) {
  return "[[fault]]\nspec = \"" + id + ":drift=" + rate + "/s@20s\"\n";
}

// Verifies: REQ-044
TEST(CommonDrift, OfTheSameAxisOfAllChipsIsToldAsOneCauseAndNotRelied) {
  const Chips where;
  const Outcome two = where.monitor(drift("z1", "0.1mg0") + drift("z2", "0.125mg0") + drift("z3", "0.15mg0"));
  EXPECT_TRUE(says(two.out, {"common ", "z1 (imu1)", "z3 (imu3) were excluded and their axes lie alike",
                             "may have moved x2 (imu2), y2 (imu2), z2 (imu2) too", "known attitude"}))
      << two.out;
  EXPECT_TRUE(says(where.text("health.json"), {"were excluded and their axes lie alike"}));
  EXPECT_FALSE(says(where.text("health.json"), {"Usable for survey: yes"}));
  const Outcome data = where.summary();
  const Json common = Json::parse(data.out.substr(data.out.rfind("\n{") + 1))["summary"]["common_cause"];
  EXPECT_EQ(common["sign"], "several_excluded");
  EXPECT_EQ(common["excluded"], Json({"x1", "y1", "z1", "x3", "y3", "z3"})) << "chips, with all of their axes";
  EXPECT_EQ(common["others"], Json({"x2", "y2", "z2"}));
  const Outcome one = where.monitor(drift("z1", "0.5mg0") + drift("z2", "0.5mg0") + drift("z3", "0.6mg0"));
  EXPECT_TRUE(says(one.out, {"z3 (imu3) were excluded, and without them the length of gravity is still off",
                             "z1 (imu1)", "z2 (imu2)"}))
      << one.out;
}

// Negative: REQ-044
TEST(CommonDrift, OneFaultIsOneFault) {
  const Chips where;
  const Outcome outcome = where.monitor("[[fault]]\nspec = \"z3:bias=100mg0@20s\"\n", 15);
  EXPECT_TRUE(says(outcome.out, {"excluded    x3, y3, z3"})) << outcome.out;
  EXPECT_FALSE(says(outcome.out, {"common  "})) << outcome.out;
  EXPECT_TRUE(says(where.text("health.json"), {"Usable for survey: yes"})) << outcome.out;
}

}  // namespace
}  // namespace common_cause_cli_test

// A log of redundant gyros through their monitor.
#include "plumb/session/rate_run.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>

namespace rate_run_test {
namespace {

using namespace plumb;
using namespace plumb::session;

constexpr const char* kTool = R"(
[input]
reads = "gravity"
unit = "m/s^2"
rate = "100 Hz"
[[group]]
name = "gyros"
field = "rate"
unit = "deg/s"
[group.rate]
rate_bound_radps = 8
scale_bound = 0.005
axis_bound_rad = 0.005
bias_bound_radps = 0.01
lag_bound_s = 1e-4
)";

const Vec3 kAxes[] = {{1.0, 0.0, 0.0},
                      {0.0, 1.0, 0.0},
                      {0.0, 0.0, 1.0},
                      {0.577350269189626, 0.577350269189626, 0.577350269189626},
                      {-0.577350269189626, 0.577350269189626, 0.577350269189626},
                      {0.577350269189626, -0.577350269189626, 0.577350269189626}};

io::ArrayFile gyros(const std::string& more = "") {
  std::string text = kTool;
  for (int i = 0; i < 6; ++i) {
    const Vec3& h = kAxes[i];
    char line[200];
    std::snprintf(line, sizeof line,
                  "[[group.sensor]]\nid = \"g%d\"\naxis = [%.15f, %.15f, %.15f]\nnoise = \"0.05 deg/s\"\n%s", i + 1,
                  h[0], h[1], h[2], more.c_str());
    text += line;
  }
  const auto read = io::parse_array_text(text, "tool.toml", {}, "gyros");
  EXPECT_TRUE(read.has_value()) << read.error().text();
  return *read;
}

/// Five seconds still, five turning, and so on for `seconds`; from `from_s` on axis `bad` reads `fault_degps` more.
class Log {
 public:
  Log(int seconds, int bad, double fault_degps, double from_s) {
    std::mt19937_64 random(11);
    std::normal_distribution<double> noise(0.0, 0.05);
    std::ofstream file(path_);
    file << "g1,g2,g3,g4,g5,g6\n";
    for (int k = 0; k < 100 * seconds; ++k) {
      const double t = 0.01 * k;
      const bool still = (k / 500) % 2 == 0;
      const Vec3 w = still ? Vec3{} : Vec3{60.0 * std::sin(t), 40.0, 30.0 * std::cos(2.0 * t)};
      for (int i = 0; i < 6; ++i) {
        const double reading = dot(kAxes[i], w) + noise(random) + (i == bad && t >= from_s ? fault_degps : 0.0);
        file << (i > 0 ? "," : "");
        if (std::isfinite(reading)) file << reading;
      }
      file << '\n';
    }
  }
  ~Log() { std::filesystem::remove(path_); }
  Log(const Log&) = delete;
  Log& operator=(const Log&) = delete;
  LogSpec spec() const { return {path_, io::BadRowPolicy::stop, false, false}; }

 private:
  std::string path_ =
      (std::filesystem::temp_directory_path() / ("rates_" + std::to_string(std::random_device{}()) + ".csv")).string();
};

TEST(RateRun, HealthyGyrosStayInServiceWithABound) {
  const auto run = run_rates(gyros(), Log(20, -1, 0.0, 0.0).spec(), nullptr);
  ASSERT_TRUE(run.has_value()) << run.error().text();
  EXPECT_EQ(run->samples, 2000U);
  EXPECT_EQ(run->samples_at_rest, 0U) << "nobody said so";
  EXPECT_TRUE(run->events.empty());
  EXPECT_TRUE(run->ever_excluded.empty());
  EXPECT_GT(run->bounded_blocks, 0U);
  EXPECT_GT(run->worst_bound_radps, 0.0);
}

TEST(RateRun, AFaultyGyroIsExcludedAndNamedInAnEvent) {
  const io::ArrayFile array = gyros();
  const auto run = run_rates(array, Log(20, 2, 30.0, 7.0).spec(), nullptr);
  ASSERT_TRUE(run.has_value()) << run.error().text();
  EXPECT_EQ(run->last.excluded, SensorSet::of(2));
  EXPECT_EQ(run->ever_excluded, SensorSet::of(2));
  ASSERT_FALSE(run->events.empty());
  EXPECT_GE(run->events.front().time_s, 7.0);
  EXPECT_LT(run->events.front().time_s, 7.5);
  const std::string line = rate_event_json(run->events.back(), array.array);
  EXPECT_NE(line.find("\"excluded\":[\"g3\"]"), std::string::npos) << line;
}

TEST(RateRun, AGyroThatDeliversNothingIsSaid) {
  const auto run = run_rates(gyros(), Log(20, 3, std::nan(""), 7.0).spec(), nullptr);
  ASSERT_TRUE(run.has_value()) << run.error().text();
  EXPECT_EQ(run->silent, SensorSet::of(3));
  EXPECT_NEAR(run->silent_s, 13.0, 0.05);
  EXPECT_TRUE(run->ever_excluded.empty()) << "missing data blames nobody";
  EXPECT_TRUE(run_rates(gyros(), Log(20, -1, 0.0, 0.0).spec(), nullptr)->silent.empty());
}

TEST(RateRun, RestThatIsKnownCounts) {
  std::vector<TrackPoint> track;
  for (int k = 0; k <= 10; ++k) track.push_back({0.4 * k, true, {0.0, 0.0, 1.0}, 0.0});
  RestTimes rest(track);
  const auto run = run_rates(gyros(), Log(20, -1, 0.0, 0.0).spec(), &rest);
  ASSERT_TRUE(run.has_value());
  EXPECT_NEAR(static_cast<double>(run->samples_at_rest), 400.0, 2.0);
  EXPECT_EQ(run->turned_at_rest, 0);
  EXPECT_TRUE(run->ever_off_at_rest.empty());
}

TEST(RateRun, BadInputIsAnsweredWithItsPlace) {
  const auto missing = run_rates(gyros(), {"no_such_file.csv", io::BadRowPolicy::stop, false, false}, nullptr);
  ASSERT_FALSE(missing.has_value());
  io::ArrayFile wrong = gyros();
  wrong.rate.rate_bound_radps = std::nan("");
  const auto refused = run_rates(wrong, Log(1, -1, 0.0, 0.0).spec(), nullptr);
  ASSERT_FALSE(refused.has_value());
  EXPECT_EQ(refused.error().file, "tool.toml#gyros");
  EXPECT_FALSE(refused.error().remedy.empty());
}

}  // namespace
}  // namespace rate_run_test

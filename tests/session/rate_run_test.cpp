// A log of redundant gyros through their monitor.
#include "plumb/session/rate_run.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <vector>

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

struct Outcome {
  RateRun run;
  std::vector<RateEvent> events;
};

/// All rows of the log; `rest`: blocks at rest that the accelerometers tell of as they end, once every 0.4 s up to
/// then.
Outcome watched(const io::ArrayFile& array, const LogSpec& log, double rest_until_s = 0.0) {
  Outcome out;
  const auto watch = RateWatch::make(array, rest_until_s > 0.0);
  EXPECT_TRUE(watch.has_value()) << watch.error().text();
  (*watch)->tell([&out](const RateEvent& event) {
    out.events.push_back(event);
    return io::FileExpected<void>();
  });
  /// Stands for the accelerometers of the same log.
  struct Rest final : RowTaker {
    io::FileExpected<void> take(const stepping::Rows& rows) override {
      const double now_s = rows.row.front().time_s;
      const int row = static_cast<int>(std::lround(100.0 * now_s));
      if (row % 40 != 39) return {};
      TrackPoint block;
      block.begin_s = now_s - 0.395;
      block.end_s = now_s;
      return now_s < until_s ? gyros->rested(block) : gyros->moved(now_s);
    }
    RateWatch* gyros = nullptr;
    double until_s = 0.0;
  } rest;
  rest.gyros = watch->get();
  rest.until_s = rest_until_s;
  std::vector<LogShare> shares = {{&array, watch->get(), {}}};
  if (rest_until_s > 0.0) shares.push_back({&array, &rest, {}});
  EXPECT_TRUE(run_log(log, shares));
  out.run = *(*watch)->end(std::move(shares.front().end));
  return out;
}

TEST(RateRun, HealthyGyrosStayInServiceWithABound) {
  const auto [run, events] = watched(gyros(), Log(20, -1, 0.0, 0.0).spec());
  EXPECT_EQ(run.samples, 2000U);
  EXPECT_EQ(run.samples_at_rest, 0U) << "nobody said so";
  EXPECT_TRUE(events.empty());
  EXPECT_TRUE(run.ever_excluded.empty());
  EXPECT_GT(run.bounded_blocks, 0U);
  EXPECT_GT(run.worst_bound_radps, 0.0);
}

TEST(RateRun, AFaultyGyroIsExcludedAndNamedInAnEvent) {
  const io::ArrayFile array = gyros();
  const auto [run, events] = watched(array, Log(20, 2, 30.0, 7.0).spec());
  EXPECT_EQ(run.last.excluded, SensorSet::of(2));
  EXPECT_EQ(run.ever_excluded, SensorSet::of(2));
  ASSERT_FALSE(events.empty());
  EXPECT_GE(events.front().time_s, 7.0);
  EXPECT_LT(events.front().time_s, 7.5);
  const std::string line = rate_event_json(events.back(), array.array);
  EXPECT_NE(line.find("\"excluded\":[\"g3\"]"), std::string::npos) << line;
}

TEST(RateRun, AGyroThatDeliversNothingIsSaid) {
  const RateRun run = watched(gyros(), Log(20, 3, std::nan(""), 7.0).spec()).run;
  EXPECT_EQ(run.silent, SensorSet::of(3));
  EXPECT_NEAR(run.silent_s, 13.0, 0.05);
  EXPECT_TRUE(run.ever_excluded.empty()) << "missing data blames nobody";
  EXPECT_TRUE(watched(gyros(), Log(20, -1, 0.0, 0.0).spec()).run.silent.empty());
}

// Rows wait for the block that they are in: rest is known at each of its rows, and at none beside.
// Verifies: REQ-241
TEST(RateRun, RestIsKnownAtTheRowsOfABlock) {
  const RateRun run = watched(gyros(), Log(20, -1, 0.0, 0.0).spec(), 4.0).run;
  EXPECT_EQ(run.samples, 2000U);
  EXPECT_EQ(run.samples_at_rest, 400U);
  EXPECT_EQ(run.turned_at_rest, 0);
  EXPECT_TRUE(run.ever_off_at_rest.empty());
}

/// Rows do not pile up where the accelerometers say nothing.
TEST(RateRun, SilentAccelerometersHoldNoRowsBack) {
  const io::ArrayFile array = gyros();
  const auto watch = RateWatch::make(array, true);
  ASSERT_TRUE(watch.has_value());
  std::size_t early = 0;
  (*watch)->tell([&early](const RateEvent&) {
    ++early;
    return io::FileExpected<void>();
  });
  std::vector<LogShare> shares = {{&array, watch->get(), {}}};
  ASSERT_TRUE(run_log(Log(20, 2, 30.0, 3.0).spec(), shares));
  EXPECT_GT(early, 0U) << "before the end";
  EXPECT_EQ((*watch)->end(std::move(shares.front().end))->samples, 2000U);
}

TEST(RateRun, BadInputIsAnsweredWithItsPlace) {
  io::ArrayFile wrong = gyros();
  wrong.rate.rate_bound_radps = std::nan("");
  const auto refused = RateWatch::make(wrong, false);
  ASSERT_FALSE(refused.has_value());
  EXPECT_EQ(refused.error().file, "tool.toml#gyros");
  EXPECT_FALSE(refused.error().remedy.empty());
}

}  // namespace
}  // namespace rate_run_test

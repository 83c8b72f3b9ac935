// The drills lead the monitor through its states, whatever tool and noise are drawn.
#include <gtest/gtest.h>

#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "plumb/calibration/calibration.hpp"
#include "plumb/detection/stationarity.hpp"
#include "plumb/health/health_monitor.hpp"
#include "plumb/scenario/library.hpp"

namespace plumb {
namespace scenario {
namespace drill_test {
namespace {

constexpr std::uint64_t kSeeds = 30;

GravityReference gravity() {
  GravityReference g;
  g.g_mps2 = kG0_mps2;
  g.sigma_mps2 = 1.5e-4 * kG0_mps2;
  return g;
}

std::unique_ptr<Calibration> calibrated(const Tool& tool, std::uint64_t seed) {
  const Datasheet& sheet = tool.datasheet;
  std::array<SensorRow, kCapacity> rows{};
  for (std::size_t i = 0; i < static_cast<std::size_t>(sheet.size); ++i) rows[i] = sheet.sensor[i].row;
  const auto nominal = SensorArray::make(rows.data(), sheet.size);
  StationFinder finder(*nominal, gravity().g_mps2, StationFinder::Settings{});
  auto run = *Simulator::make(calibration_run(tool, seed));
  std::vector<Station> stations;
  Sample sample;
  Station done;
  while (run.next(sample)) {
    const Readings y = sheet.model().apply(sample.raw, sample.temperature_degc, sample.delivered);
    if (finder.add(sample, y, sample.delivered, done)) stations.push_back(done);
  }
  if (finder.finish(done)) stations.push_back(done);
  FitReport report;
  const auto fit =
      calibrate(sheet, gravity(), stations.data(), static_cast<int>(stations.size()), FitOptions{}, &report);
  EXPECT_TRUE(fit.has_value());
  return fit ? std::make_unique<Calibration>(*fit) : nullptr;
}

std::string names(SensorSet sensors) {
  std::string out;
  for (int i = 0; i < kCapacity; ++i) {
    if (sensors.has(i)) out += " a" + std::to_string(i + 1);
  }
  return out;
}

struct Played {
  std::string changes;  ///< a line each: "exclusion a2 -> degraded"
  std::vector<Host::Answer> answers;
  std::size_t waiting = 0;
  int wronged = 0;  ///< exclusions of sensors that are sound at that moment
};

Played play(const Tool& tool, std::uint64_t seed, const Drill& drill) {
  Played out;
  const auto calibration = calibrated(tool, seed);
  if (calibration == nullptr) return out;
  auto setup = std::make_unique<MonitorSetup>();
  setup->model = calibration->model;
  setup->array = calibration->array;
  setup->gravity = gravity();
  auto monitor = std::make_unique<HealthMonitor>();
  EXPECT_TRUE(monitor->configure(*setup));
  Host host(drill.requests);
  auto run = *Simulator::make(drill.scenario);
  Sample sample;
  while (run.next(sample)) {
    host.before(sample.time_s, *monitor);
    const TransitionRecord& change = monitor->step(sample).transition;
    if (change.sequence == 0) continue;
    out.changes += to_string(change.event) + names(change.sensors) + " -> " + to_string(change.to) + "\n";
    const bool blames = change.event == HealthEvent::exclusion || change.event == HealthEvent::provisional_exclusion;
    if (blames && !run.truth().faulty.contains(change.sensors)) ++out.wronged;
  }
  out.answers = host.answers();
  out.waiting = host.waiting();
  return out;
}

TEST(Drill, AGoesThroughFailedAndComesBackWithWhatHasRecovered) {
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const Tool tool = paper_tool(seed);
    const Played played = play(tool, seed, drill_a(tool, seed));
    EXPECT_EQ(played.changes,
              "passed_block -> nominal\n"
              "alarm -> suspect\n"
              "exclusion a2 -> degraded\n"
              "alarm -> suspect\n"
              "isolation_timeout -> failed\n"
              "reset a2 -> suspect\n"
              "alarm -> suspect\n"
              "exclusion a3 -> suspect\n"
              "passed_block -> degraded\n")
        << "seed " << seed;
    EXPECT_EQ(played.wronged, 0) << "seed " << seed;
    ASSERT_EQ(played.answers.size(), 2U);
    EXPECT_EQ(played.answers[0].refusal, Errc::wrong_key);
    EXPECT_EQ(played.answers[1].refusal, Errc::ok);
    EXPECT_EQ(played.waiting, 0U);
  }
}

TEST(Drill, BIsolatesRecalibratesIsolatesAgainAndReinstatesWhatHasRecovered) {
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const Tool tool = hexad_tool(seed);
    const Played played = play(tool, seed, drill_b(tool, seed));
    EXPECT_EQ(played.changes,
              "passed_block -> nominal\n"
              "provisional_exclusion a2 -> suspect\n"
              "passed_block -> isolated\n"
              "exclusion a2 -> isolated\n"
              "recalibrate a1 a3 a4 a5 a6 -> recalibrating\n"
              "fit_accepted a1 a3 a4 a5 a6 -> suspect\n"
              "passed_block -> isolated\n"
              "provisional_exclusion a5 -> suspect\n"
              "passed_block -> isolated\n"
              "exclusion a5 -> isolated\n"
              "probation_passed a2 -> isolated\n")
        << "seed " << seed;
    EXPECT_EQ(played.wronged, 0) << "seed " << seed;
  }
}

TEST(Drill, HealthyTwinsRaiseNoAlarm) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const Tool four = paper_tool(seed), six = hexad_tool(seed);
    Drill a = drill_a(four, seed), b = drill_b(six, seed);
    for (Drill* drill : {&a, &b}) {
      drill->scenario.faults.clear();
      drill->requests.clear();
    }
    EXPECT_EQ(play(four, seed, a).changes, "passed_block -> nominal\n") << "seed " << seed;
    EXPECT_EQ(play(six, seed, b).changes, "passed_block -> nominal\n") << "seed " << seed;
  }
}

}  // namespace
}  // namespace drill_test
}  // namespace scenario
}  // namespace plumb

// The worst step in every state: a tool that a fit has calibrated, at one attitude after the other, recalibrated in
// flight, losing one sensor after the other until it fails, then reset. Every step is timed in many equal plays; what
// counts of it is its least time, and of a state the largest of these.
#include <algorithm>
#include <array>
#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include "pairs.hpp"
#include "plumb/health/health_monitor.hpp"
#include "support/isolation_trials.hpp"

namespace {

using namespace plumb;

constexpr int kAttitudes = 300;
constexpr int kDwell = 64;  ///< samples at each: one whole block at the least, however the blocks lie
constexpr int kRecalibrateAt = 40 * kDwell;
constexpr int kFirstFault = 110;  ///< attitude; one more sensor every kFaultEvery
constexpr int kFaultEvery = 20;
constexpr int kResetAt = 290 * kDwell;
constexpr int kPlays = 25;

using Clock = std::chrono::steady_clock;

double ns_between(Clock::time_point a, Clock::time_point b) {
  return std::chrono::duration<double, std::nano>(b - a).count();
}

/// What asking for the time costs.
double clock_ns() {
  double least = 1e9;
  for (int k = 0; k < 10000; ++k) {
    const Clock::time_point a = Clock::now();
    least = std::min(least, ns_between(a, Clock::now()));
  }
  return least;
}

std::vector<Sample> flight(const plumb_test::TrialTool& tool, plumb_test::TrialNoise& noise) {
  std::vector<Sample> out;
  Vec3 g{};
  for (int k = 0; k < kAttitudes * kDwell; ++k) {
    if (k % kDwell == 0) g = scaled(noise.direction(), kG0_mps2);
    Sample s;
    s.time_s = 0.01 * (k + 1);
    s.delivered = tool.array.all();
    for (int i = 0; i < tool.array.size(); ++i) {
      const auto at = static_cast<std::size_t>(i);
      s.raw[at] = dot(tool.row[at], g) + tool.offset_mps2[at] + tool.array.sigma_mps2(i) * noise.normal();
      if (k / kDwell >= kFirstFault + kFaultEvery * i && i < tool.array.size() - 1)
        s.raw[at] += (0.5 + 0.3 * i) * (i % 2 == 0 ? 1.0 : -1.0);
    }
    out.push_back(s);
  }
  return out;
}

std::vector<plumb_bench::Figure> worst_steps() {
  plumb_test::TrialNoise noise(20180227);
  const int n = kCapacity;
  const plumb_test::TrialTool tool = plumb_test::fitted_tool(n, 0, 60, noise);
  auto setup = std::make_unique<MonitorSetup>();
  setup->array = tool.array;
  setup->model.size = n;
  setup->gravity = tool.gravity;
  const std::vector<Sample> samples = flight(tool, noise);
  std::vector<double> least(samples.size(), 1e9);
  std::vector<HealthState> states(samples.size());
  auto monitor = std::make_unique<HealthMonitor>();
  for (int play = 0; play < kPlays; ++play) {
    if (!monitor->configure(*setup)) return {};
    for (std::size_t k = 0; k < samples.size(); ++k) {
      if (k == kRecalibrateAt) (void)monitor->request_recalibration();
      if (k == kResetAt) (void)monitor->reset(setup->config.reset_key, tool.array.all());
      states[k] = monitor->verdict().state;
      const Clock::time_point begin = Clock::now();
      (void)monitor->step(samples[k]);
      least[k] = std::min(least[k], ns_between(begin, Clock::now()));
    }
  }
  const double clock = clock_ns();
  std::vector<plumb_bench::Figure> out;
  for (int s = 0; s < kStateCount; ++s) {
    double worst = 0.0;
    std::size_t count = 0;
    for (std::size_t k = 0; k < samples.size(); ++k) {
      if (states[k] != static_cast<HealthState>(s)) continue;
      worst = std::max(worst, least[k] - clock);
      ++count;
    }
    if (count == 0) continue;
    out.push_back({"worst of " + std::to_string(count) + " steps in " + to_string(static_cast<HealthState>(s)) + ", " +
                       std::to_string(n) + " sensors",
                   worst / 1000.0, 0.0, "us"});
  }
  return out;
}
const plumb_bench::Enrolled kWorst{plumb_bench::Figures(worst_steps)};

}  // namespace

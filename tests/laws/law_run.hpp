/// Runs a law over its cases, counts, and says what broke it. PLUMB_LONG=1 asks for a thousand times as many cases;
/// PLUMB_LAW_CASES=<number> for so many, and PLUMB_LAW_CASE=<number> for one.
#pragma once

#include <gtest/gtest.h>

#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <string>
#include <tuple>
#include <utility>

#include "laws/law_case.hpp"
#include "laws/law_oracle.hpp"
#include "support/binomial_interval.hpp"
#include "support/long_run.hpp"

namespace plumb_test {
inline namespace PLUMB_ABI {

/// How much there is to read in a case: the fewest sensors first, then the fewest faults, then the fewest stations.
struct LawSize {
  int sensors = 0, faults = 0, stations = 0;
  bool operator<(const LawSize& other) const {
    return std::tie(sensors, faults, stations) < std::tie(other.sensors, other.faults, other.stations);
  }
};

/// One case: does the law say anything about it, and does it hold?
struct LawOutcome {
  bool applies = true;
  std::string broken;  ///< empty = held
  LawSize size;
};
inline LawOutcome not_of_this_law() { return {false, "", {}}; }

inline std::string names_of(plumb::SensorSet set) {
  std::string out = "{";
  for (int i = 0; i < plumb::kCapacity; ++i) {
    if (set.has(i)) out += (out.size() > 1 ? " a" : "a") + std::to_string(i + 1);
  }
  return out + "}";
}

/// Cases of each law where nobody asks for more; .ci/run --deep asks for ten times as many, the same ones first.
inline constexpr std::uint64_t kLawCases = 2000;

/// Whether a word is a whole number, in digits alone; then it is left in `number`.
inline bool is_count(const char* word, std::uint64_t& number) {
  const char* const end = word + std::strlen(word);
  const auto [last, error] = std::from_chars(word, end, number);
  return word != end && last == end && error == std::errc{};
}

struct LawCount {
  std::uint64_t cases = 0, broken = 0;
};

/// Runs cases until `wanted` of them are such as the law speaks of, at most 20 times as many.
template <class Check>
LawCount run_law(int law, std::uint64_t wanted, Check&& check) {
  const char* some = std::getenv("PLUMB_LAW_CASES");
  const char* one = std::getenv("PLUMB_LAW_CASE");
  if (long_run()) wanted *= 5000;
  std::uint64_t first = 0;
  if (some != nullptr && (!is_count(some, wanted) || wanted == 0)) {
    ADD_FAILURE() << "PLUMB_LAW_CASES is \"" << some << "\": give a whole number, 1 or more, in digits";
    return {};
  }
  if (one != nullptr && !is_count(one, first)) {
    ADD_FAILURE() << "PLUMB_LAW_CASE is \"" << one << "\": give the number of a case, in digits";
    return {};
  }
  const std::uint64_t end = one != nullptr ? first + 1 : 20 * wanted;
  LawCount count;
  LawOutcome smallest;
  std::uint64_t smallest_number = 0;
  std::uint64_t number = first;
  for (; number < end && count.cases < wanted; ++number) {
    TrialNoise noise = stream_of(law, number);
    const LawOutcome outcome = check(number, noise);
    if (!outcome.applies) continue;
    ++count.cases;
    if (outcome.broken.empty()) continue;
    ++count.broken;
    if (count.broken == 1 || outcome.size < smallest.size) {
      smallest = outcome;
      smallest_number = number;
    }
    if (count.broken <= 5) {
      std::printf("law %d is broken: case %llu: %s\n", law, static_cast<unsigned long long>(number),
                  outcome.broken.c_str());
    }
  }
  if (count.broken > 0) {
    std::printf("law %d: the smallest of its broken cases: %s (again: PLUMB_LAW_CASE=%llu)\n", law,
                smallest.broken.c_str(), static_cast<unsigned long long>(smallest_number));
  }
  const auto bound = count.cases > 0 ? clopper_pearson(static_cast<std::int64_t>(count.broken),
                                                       static_cast<std::int64_t>(count.cases), 0.95)
                                     : Interval{};
  std::printf("law %d: %llu of %llu cases broken, 95 %% [%.2g, %.2g]; cases 0 to %llu were drawn\n", law,
              static_cast<unsigned long long>(count.broken), static_cast<unsigned long long>(count.cases), bound.low,
              bound.high, static_cast<unsigned long long>(number));
  if (one == nullptr) {
    EXPECT_GE(count.cases, wanted) << "too few cases are such as the law speaks of";
  }
  return count;
}

/// What the strata of a case choose: tool, faulty sensors, lie, gravity.
inline const std::vector<LawTool>& every_tool() {
  static const std::vector<LawTool> all = [] {
    std::vector<LawTool> out;
    for (int n = 4; n <= 8; ++n) {
      for (LawTool& tool : law_tools(n)) out.push_back(std::move(tool));
    }
    return out;
  }();
  return all;
}

/// Broken: a healthy sensor is excluded at station `k`.
inline LawOutcome blames_the_healthy(const LawTool& tool, const LawCase& c, plumb::SensorSet excluded, int k) {
  if (c.faulty().contains(excluded)) return {};
  return {true,
          "of " + std::to_string(tool.n()) + " sensors (c = " + std::to_string(tool.plane) + ") " + names_of(excluded) +
              " are excluded, but " + names_of(c.faulty()) + " are faulty; station " + std::to_string(k),
          {tool.n(), c.faulty().size(), k}};
}

/// How many of the cases ended with an excluded sensor: a monitor that excludes none would keep these laws as well.
inline void expect_some_excluded(std::uint64_t told, const LawCount& count, double share) {
  std::printf("a sensor was excluded in %llu of %llu cases\n", static_cast<unsigned long long>(told),
              static_cast<unsigned long long>(count.cases));
  if (count.cases < 100) return;  // PLUMB_LAW_CASE asks for one
  EXPECT_GE(static_cast<double>(told), share * static_cast<double>(count.cases));
}

/// The law of which each case is a `Case`: it runs once, and remembers whom it isolated. At least a `share` isolate
/// one.
template <class Case>
void expect_law_of_cases(int law, std::uint64_t wanted, double share) {
  std::uint64_t told = 0;
  const LawCount count = run_law(law, wanted, [&told](std::uint64_t number, TrialNoise& noise) {
    Case one(number, noise);
    const LawOutcome out = one.run();
    told += one.isolated.empty() ? 0U : 1U;
    return out;
  });
  EXPECT_EQ(count.broken, 0U);
  expect_some_excluded(told, count, share);
}

/// A monitor over a tool, one block mean a step: a station is a sample that stands for 32, or for more.
class Watch {
 public:
  double samples = kTrialSamples;

  Watch(const LawTool& tool, const plumb::MonitorConfig& config, double stability_mps2 = 0.0) {
    plumb::MonitorSetup setup;
    for (plumb::Stability& one : setup.stability) one.mps2 = stability_mps2;
    setup.array = tool.tool.array;
    setup.model.size = tool.n();
    setup.gravity = tool.tool.gravity;
    setup.config = config;
    setup.config.window = 1;
    EXPECT_TRUE(monitor.configure(setup).has_value());
  }
  const plumb::Verdict& station(const plumb::Readings& y) {
    plumb::Sample s;
    for (int i = 0; i < plumb::kCapacity; ++i) s.raw[slot(i)] = y[slot(i)];
    s.delivered = monitor.array().all();
    s.temperature_degc = 25.0;
    s.count = static_cast<std::uint32_t>(samples);
    s.station = ++tag_;
    s.time_s = time_s_ += 1.0;
    return monitor.step(s);
  }
  const plumb::Verdict& verdict() const { return monitor.verdict(); }

  plumb::HealthMonitor monitor;

 private:
  double time_s_ = 0.0;
  std::uint32_t tag_ = 0;
};

/// A monitor that has earned its trust with healthy sensors under that gravity, kept for the next case like it.
inline const Watch& proven_watch(const LawTool& tool, const plumb::MonitorConfig& config, int key,
                                 double gravity_sigmas, double stability_mps2 = 0.0) {
  static std::map<std::pair<std::pair<const LawTool*, int>, int>, std::unique_ptr<Watch>> known;
  auto& kept = known[{{&tool, key}, static_cast<int>(std::lround(gravity_sigmas))}];
  if (kept) return *kept;
  kept = std::make_unique<Watch>(tool, config, stability_mps2);
  LawCase quiet(tool.tool, {}, Lie::constant, gravity_sigmas);
  TrialNoise noise(3);
  for (int k = 0; k < 8; ++k) kept->station(quiet.healthy_readings(noise.direction()));
  return *kept;
}

/// The same, before the first sample.
inline const Watch& fresh_watch(const LawTool& tool, const plumb::MonitorConfig& config, int key,
                                double stability_mps2 = 0.0) {
  static std::map<std::pair<const LawTool*, int>, std::unique_ptr<Watch>> known;
  auto& kept = known[{&tool, key}];
  if (!kept) kept = std::make_unique<Watch>(tool, config, stability_mps2);
  return *kept;
}

}  // namespace PLUMB_ABI
}  // namespace plumb_test

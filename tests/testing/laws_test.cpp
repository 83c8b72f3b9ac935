// The laws that users get: kept by plumb on several arrays, and broken where something is wrong.
#include "plumb/testing/laws.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <fstream>
#include <set>
#include <string>

#include "plumb/io/scenario_file.hpp"
#include "plumb/testing/monitor_laws.hpp"

namespace plumb {
namespace testing {
namespace laws_test {
namespace {

TEST(MonitorLaws, HoldOnAConeOfSeven) { EXPECT_MONITOR_LAWS(cone_of(7), MonitorConfig()); }
TEST(MonitorLaws, HoldOnTwoTriads) { EXPECT_MONITOR_LAWS(triads_of(2), MonitorConfig()); }

Case with_bias(int sensor, double mg0) {
  Case c;
  c.array = cone_of(7);
  c.stations = 16;
  scenario::Fault fault;
  fault.kind = scenario::FaultKind::bias_step;
  fault.sensor = sensor;
  fault.clock = scenario::Clock::station;
  fault.onset = 2;
  fault.magnitude = mg0 * 1e-3 * kG0_mps2;
  c.faults = {fault};
  return c;
}

TEST(MonitorLaws, EachAppliesWhereItShould) {
  const Case clear = with_bias(1, 50.0);
  for (const Law& law : laws()) {
    const LawResult result = law.check(clear);
    EXPECT_TRUE(result.holds) << law.name << ": " << result.reason;
    EXPECT_EQ(result.applies, law.check != failed_is_latched) << law.name << ": " << result.reason;
  }
  EXPECT_FALSE(detects_above_the_threshold(with_bias(1, 0.1)).applies);
}

/// A monitor that is told to wait for more stations than there are does not isolate: the law can fail.
TEST(MonitorLaws, AMonitorThatWaitsTooLongIsFound) {
  Case c = with_bias(1, 50.0);
  c.config.isolation_stations = 20;  // nothing is latched within the run, and n - 4 does not bear four
  c.faults.resize(4, c.faults.front());
  for (std::size_t k = 0; k < 4; ++k) {
    c.faults[k].sensor = static_cast<int>(k);
    c.faults[k].magnitude *= 1.0 + static_cast<double>(k);
  }
  const LawResult result = isolates_what_is_isolable(c);
  EXPECT_TRUE(result.applies) << result.reason;
  EXPECT_FALSE(result.holds);
  EXPECT_NE(result.reason.find("faulty: a1, a2, a3, a4"), std::string::npos) << result.reason;
}

/// The page that teaches it quotes the examples line by line.
TEST(PropertyTestingPage, QuotesTheExample) {
  const std::string root = PLUMB_SOURCE_DIR;
  std::set<std::string> example;
  std::string line;
  for (const char* const file : {"/examples/property_test/cone_test.cpp", "/examples/ideas/law.cpp"}) {
    std::ifstream source(root + file);
    while (std::getline(source, line)) example.insert(line);
  }
  std::ifstream page(root + "/docs/property-testing.md");
  bool code = false;
  int quoted = 0;
  while (std::getline(page, line)) {
    if (line.rfind("```", 0) == 0) {
      code = line == "```cpp";
      continue;
    }
    if (!code) continue;
    ++quoted;
    EXPECT_EQ(example.count(line), 1U) << line;
  }
  EXPECT_GT(quoted, 20);
}

RC_GTEST_PROP(TestingLaw, TheTomlOfACaseReplaysItBitForBit, ()) {
  const Case c = *cases(cone_of(6));
  const auto file = io::parse_scenario_text(toml_of(c), "case.toml");
  if (!file) RC_FAIL(file.error().text());
  auto one = scenario::Simulator::make(scenario_of(c));
  auto two = scenario::Simulator::make(file->scenario);
  RC_ASSERT(one && two);
  RC_ASSERT(one->size() == two->size());
  for (std::uint64_t row = 0; row < one->size(); row += 37) RC_ASSERT(one->at(row).raw == two->at(row).raw);
}

RC_GTEST_PROP(TestingLaw, RandomArraysKeepTheirLeastDeterminantAndFaultsTheirNumber, ()) {
  const SensorArray array = *random_arrays(5, 0.2);
  for (int k = 0; k < array.triple_count(); ++k) RC_ASSERT(std::abs(array.triple(k).det) >= 0.2);
  const auto drawn = *faults(array, 2, 12);
  Case c;
  c.array = array;
  c.faults = drawn;
  RC_ASSERT(faulty_of(c).size() <= 2);
  RC_ASSERT(faulty_of(c).size() == static_cast<int>(drawn.size()));
}

/// What fails shrinks to one fault of a round size at the fewest stations.
TEST(Generators, ShrinkToTheFewestFaultsAndStationsAndToRoundNumbers) {
  const auto property = [] {
    const Case c = *cases(cone_of(7));
    RC_ASSERT(c.faults.empty());
  };
  const auto result = rc::detail::checkTestable(property, rc::detail::TestMetadata(), [] {
    rc::detail::TestParams params;
    params.seed = 5;
    return params;
  }());
  rc::detail::FailureResult failure;
  ASSERT_TRUE(result.match(failure)) << "no case was found";
  ASSERT_FALSE(failure.counterExample.empty());
  const std::string shown = failure.counterExample.front().second;
  EXPECT_NE(shown.find("7 sensors, 8 stations for validation and 8 more: a1 reads 1 mg0 too high from station 9 on."),
            std::string::npos)
      << shown.substr(0, 400);
  EXPECT_NE(shown.find("[[fault]]\nspec = \"a1:bias=1mg0@station9\""), std::string::npos);
  EXPECT_EQ(shown.find("[[fault]]", shown.find("[[fault]]") + 1), std::string::npos);
}

}  // namespace
}  // namespace laws_test
}  // namespace testing
}  // namespace plumb

// Words and causes of states, events and the rest: what records and logs are read by.
#include "plumb/health/state.hpp"

#include <gtest/gtest.h>

#include <set>
#include <string>

#include "plumb/health/reference_study.hpp"
#include "plumb/health/transition_table.hpp"
#include "plumb/health/verdict.hpp"

namespace state_test {
namespace {

using namespace plumb;

/// Every value up to `last` has a word that no other has; what lies beyond has none.
template <class Enumeration>
void expect_words(Enumeration last) {
  std::set<std::string> words;
  const int count = static_cast<int>(last) + 1;
  for (int k = 0; k < count; ++k) words.insert(to_string(static_cast<Enumeration>(k)));
  EXPECT_EQ(words.size(), static_cast<std::size_t>(count));
  EXPECT_EQ(words.count("?"), 0U);
  EXPECT_EQ(words.count(""), 0U);
  EXPECT_STREQ(to_string(static_cast<Enumeration>(count)), "?");
}

// Verifies: REQ-101
TEST(StateWords, EveryValueHasAWordOfItsOwn) {
  expect_words(HealthState::failed);
  expect_words(HealthEvent::none);
  expect_words(kLastCause);
  expect_words(Validity::valid);
  expect_words(Grade::assumed);
  expect_words(Mode::failed);
  expect_words(Target::failed);
  expect_words(RecalibrationPhase::accepted);
  expect_words(NormMismatchKind::common_bias);
}

// Verifies: REQ-101
TEST(StateWords, EveryEventHasACause) {
  for (int e = 0; e < kEventCount; ++e) {
    const auto event = static_cast<HealthEvent>(e);
    for (const Cause of_block : {Cause::parity, Cause::norm, Cause::mae}) {
      const Cause cause = cause_of(event, of_block);
      EXPECT_EQ(cause == Cause::none, event == HealthEvent::none) << to_string(event);
      EXPECT_EQ(cause == of_block, event == HealthEvent::alarm) << to_string(event);
    }
  }
}

// Negative: REQ-092
TEST(StateWords, AnInvalidValueIsReportedAsUnusable) {
  const auto event = static_cast<HealthEvent>(kEventCount);
  EXPECT_EQ(cause_of(event, Cause::parity), Cause::none);
  EXPECT_EQ(state_of(static_cast<Mode>(kModeCount)), HealthState::failed);
  const auto size = static_cast<SizeClass>(static_cast<int>(SizeClass::reduced) + 1);
  EXPECT_EQ(mode_by_size(size), Mode::failed);
  const auto target = static_cast<Target>(static_cast<int>(Target::failed) + 1);
  TargetFacts best;
  best.size = SizeClass::all_configured;
  best.enough_passed = best.protection_within = best.calibrated = true;
  EXPECT_EQ(resolve(Mode::nominal, target, best), Mode::failed);
  EXPECT_EQ(resolve(Mode::nominal, Target::failed, best), Mode::failed);
}

}  // namespace
}  // namespace state_test

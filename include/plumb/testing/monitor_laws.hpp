/// EXPECT_MONITOR_LAWS(array, config): every law of laws.hpp over random cases on the user's own array. Needs
/// RapidCheck and GoogleTest on the user's side. RC_PARAMS ("seed=7 max_success=1000") says how many, as everywhere in
/// RapidCheck.
#pragma once

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <string>

#include "plumb/core/config.hpp"
#include "plumb/testing/generators.hpp"
#include "plumb/testing/laws.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace testing {

/// One law over random cases; RapidCheck prints the smallest case that breaks it.
inline ::testing::AssertionResult keeps(const Law& law, const SensorArray& array, const MonitorConfig& config) {
  if (array.size() < 4) return ::testing::AssertionFailure() << "the array has fewer than four sensors, or was refused";
  const bool held = rc::check(law.name, [&] {
    const Case c = *cases(array, config);
    const LawResult result = law.check(c);
    RC_CLASSIFY(result.applies, "applies");
    if (!result.holds) RC_FAIL(result.reason);
  });
  if (held) return ::testing::AssertionSuccess();
  return ::testing::AssertionFailure() << "\"" << law.name << "\" is broken; the case stands above";
}

}  // namespace testing
}  // namespace PLUMB_ABI
}  // namespace plumb

#define EXPECT_MONITOR_LAWS(array, config)                                  \
  do {                                                                      \
    for (const ::plumb::testing::Law& plumb_law : ::plumb::testing::laws()) \
      EXPECT_TRUE(::plumb::testing::keeps(plumb_law, (array), (config)));   \
  } while (false)

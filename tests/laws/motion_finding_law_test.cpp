// Law 20: whatever a monitor in motion says, of whomever, and whenever: the state machine goes to suspect by it and
// takes sensors out provisionally, and nothing else. At rest it counts for nothing.
#include <gtest/gtest.h>

#include "laws/law_run.hpp"
#include "support/motion_twin.hpp"

namespace motion_finding_law_test {
namespace {

using plumb_test::kLawCases;
using plumb_test::LawCount;
using plumb_test::LawOutcome;
using plumb_test::run_law;
using plumb_test::TrialNoise;

// Verifies: REQ-200
TEST(Law, TwentyWhatIsFoundInMotionDecidesNothingForGood) {
  std::uint64_t heard = 0;
  const LawCount count = run_law(20, kLawCases / 5, [&heard](std::uint64_t number, TrialNoise& noise) -> LawOutcome {
    const int n = 4 + static_cast<int>(number % 5);
    plumb_test::MotionLife life(n, static_cast<std::uint64_t>(1e15 * noise.uniform()));
    std::string wrong = life.run(40);
    heard += life.heard > 0 ? 1U : 0U;
    if (!wrong.empty()) wrong = "of " + std::to_string(n) + " sensors: " + wrong;
    return {true, wrong, {n, 0, life.block}};
  });
  EXPECT_EQ(count.broken, 0U);
  if (count.cases < 100) return;  // PLUMB_LAW_CASE asks for one
  EXPECT_GT(heard, 8 * (count.cases / 10)) << "cases in which motion was heard";
}

}  // namespace
}  // namespace motion_finding_law_test

// Campaigns of tools with chips: a faulty unit is a chip, with all of its axes or one, and is right when it is out
// whole.
#include <gtest/gtest.h>

#include <map>

#include "campaign/campaign_support.hpp"
#include "plumb/campaign/outcome.hpp"

namespace campaign_chips_test {
namespace {

using namespace plumb;
using namespace plumb::campaign;
using namespace plumb_test;

CampaignFile of_the_drone(const std::string& counts) {
  return campaign_from(
      "name = \"chips\"\nscenarios = 400\nseed = 3\nwithin_grade = \"yes\"\n[[tool]]\narray = \"" +
      std::string(PLUMB_SOURCE_DIR) +
      "/examples/motion/drone.toml\"\n[run]\nonset = [1, 3]\nstations = 10\n[gravity]\nsigma = \"0.1 mg0\"\n"
      "[[attitude]]\nlaw = \"random\"\n[[fault]]\nspec = [\"stuck=0g0\", \"bias=200mg0\"]\nsensors = " +
      counts + "\n");
}

// Verifies: REQ-206
TEST(CampaignOfChips, TheGradeCountsThemAndEachFailsWithAllOfItsAxesOrOne) {
  const CampaignFile file = of_the_drone("[1, 2]");
  const ToolPlan& tool = file.plan.tools[0];
  EXPECT_EQ(tool.sensors, 9);
  EXPECT_EQ(tool.units(), 3);
  EXPECT_EQ(tool.grade, 2);
  EXPECT_EQ(tool.unit_with(4), 0b000'111'000U);
  std::map<int, int> axes;
  for (std::uint64_t number = 0; number < 400; ++number) {
    const Spec spec = spec_of(file.plan, number);
    const int units = file.plan.cells[static_cast<std::size_t>(spec.cell)].faulty;
    ++axes[spec.faults];
    int faulty = 0;
    for (int chip = 0; chip < 3; ++chip) {
      const std::uint32_t all = 7U << static_cast<unsigned>(3 * chip), here = faulty_of(tool, spec) & all;
      EXPECT_TRUE(here == 0 || here == all) << number;
      faulty += here == 0 ? 0 : 1;
    }
    EXPECT_EQ(faulty, units) << number;
  }
  for (const int count : {1, 2, 3, 4, 6}) EXPECT_GE(axes[count], 20) << count;
  EXPECT_EQ(axes.size(), 5U);
}

/// Three chips have nine axes, and there is room for eight faults: the chip that does not fit fails with one axis.
// Negative: REQ-206
TEST(CampaignOfChips, AsManyFailAsTheCellSaysWhereNotAllAxesFit) {
  Plan plan = of_the_drone("1").plan;
  ToolPlan& tool = plan.tools[0];
  tool.sensors = 12;
  for (std::size_t i = 0; i < 12; ++i) tool.chip[i] = static_cast<std::uint8_t>(1 + i / 3);
  for (Cell& cell : plan.cells) cell.faulty = 3;
  std::map<int, int> axes;
  for (std::uint64_t number = 0; number < 400; ++number) {
    const Spec spec = spec_of(plan, number);
    EXPECT_EQ(SensorSet(faulty_of(tool, spec)).size(), 9) << number;
    ++axes[spec.faults];
  }
  for (const int count : {3, 5, 7}) EXPECT_GE(axes[count], 20) << count;
  EXPECT_EQ(axes.size(), 3U);
}

// Verifies: REQ-206
TEST(CampaignOfChips, NoHealthyChipIsExcludedAndTheFaultyOnesAreAsAWhole) {
  const CampaignFile file = of_the_drone("1");
  const auto kernel = kernel_of(file.plan);
  ASSERT_NE(kernel, nullptr);
  int isolated = 0;
  for (std::uint64_t number = 0; number < 60; ++number) {
    Outcome outcome;
    kernel->play(spec_of(file.plan, number), outcome);
    EXPECT_FALSE(outcome.wrong_exclusion()) << number;
    EXPECT_FALSE(outcome.wrong_provisional_exclusion()) << number;
    isolated += outcome.excluded == outcome.faulty ? 1 : 0;
  }
  EXPECT_GE(isolated, 50);
}

}  // namespace
}  // namespace campaign_chips_test

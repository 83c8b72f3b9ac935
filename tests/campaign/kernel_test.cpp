// The fast way through a scenario against the slow one: other generator, other capacity, the same bits.
#include "plumb/campaign/kernel.hpp"

#include <set>

#include "campaign_support.hpp"
#include "plumb/campaign/replay.hpp"
#include "plumb/scenario/random.hpp"

namespace kernel_test {
namespace {

using namespace plumb_test;
using namespace plumb::campaign;
using plumb::campaign::Outcome;

TEST(CampaignNoise, ManyNormalsAtOnceAreThoseDrawnOneByOne) {
  // 40 000 of them: every branch of the ziggurat, its tail (one in 4000) among them.
  const plumb::scenario::Stream stream(20261122, plumb::scenario::Purpose::test, 3);
  for (const std::uint64_t first : {std::uint64_t{0}, std::uint64_t{1} << 32U, (std::uint64_t{1} << 32U) - 7}) {
    std::vector<double> many(40001);
    stream.normals(first, static_cast<int>(many.size()), many.data());
    for (std::size_t k = 0; k < many.size(); ++k) ASSERT_EQ(many[k], stream.normal(first + k)) << first << " + " << k;
  }
}

TEST(CampaignKernel, PlaysBitForBitWhatTheSimulatorPlays) {
  CampaignFile file = small_campaign(1);
  file.plan.calibration_mps2 = 3e-5 * plumb::kG0_mps2;
  const auto kernel = kernel_of(file.plan);
  ASSERT_NE(kernel, nullptr);
  std::set<int> cells;
  const auto outcome = std::make_unique<Outcome>();
  // One of every cell: every fault, attitude law and tool.
  for (std::uint64_t number = 0; number < file.plan.cells.size(); ++number) {
    const Spec spec = spec_of(file.plan, number);
    cells.insert(spec.cell);
    kernel->play(spec, *outcome);
    const auto slow = replay(file.plan, spec.tool, scenario_of(file.plan, spec), [](const plumb::Verdict&) {});
    ASSERT_TRUE(slow.has_value()) << slow.error();
    expect_same(*outcome, *slow, "scenario " + std::to_string(number) + ": " + sentence_of(file.plan, spec));
    if (HasFatalFailure()) return;
  }
  EXPECT_EQ(cells.size(), file.plan.cells.size());
}

TEST(CampaignKernel, EveryCapacityAnswersAlike) {
  const CampaignFile file = small_campaign(1);
  ASSERT_GE(kernel_capacities().size(), 2U);
  const auto small = kernel_of(file.plan), large = kernel_of(file.plan, 24);
  EXPECT_LT(small->capacity(), large->capacity());
  const auto one = std::make_unique<Outcome>(), two = std::make_unique<Outcome>();
  for (std::uint64_t number = 0; number < 150; ++number) {
    const Spec spec = spec_of(file.plan, number);
    small->play(spec, *one);
    large->play(spec, *two);
    expect_same(*one, *two, "scenario " + std::to_string(number));
  }
}

TEST(CampaignKernel, AScenarioDoesNotRememberTheOneBefore) {
  const CampaignFile file = small_campaign(1);
  const auto kernel = kernel_of(file.plan);
  const auto alone = std::make_unique<Outcome>(), after = std::make_unique<Outcome>();
  for (std::uint64_t number = 0; number < 100; ++number) {
    kernel->play(spec_of(file.plan, number), *alone);
    kernel->play(spec_of(file.plan, 977 * number + 5), *after);
    kernel->play(spec_of(file.plan, number), *after);
    expect_same(*alone, *after, "scenario " + std::to_string(number));
  }
}

TEST(CampaignKernel, FromPowerOnTheSameHoldsAndValidationComesLater) {
  CampaignFile file = campaign_from(small_text() + "\n");
  file.plan.start = Start::power_on;
  const auto kernel = kernel_of(file.plan);
  const auto fast = std::make_unique<Outcome>();
  const Spec spec = spec_of(file.plan, 0);  // nothing happens
  ASSERT_EQ(spec.faults, 0);
  kernel->play(spec, *fast);
  EXPECT_TRUE(fast->block.front().usable) << "within the bound, though not yet validated";
  EXPECT_TRUE(fast->block[static_cast<std::size_t>(fast->blocks - 1)].usable);
  const auto slow = replay(file.plan, spec.tool, scenario_of(file.plan, spec), [](const plumb::Verdict&) {});
  ASSERT_TRUE(slow.has_value());
  expect_same(*fast, *slow, "power-on");
}

TEST(CampaignKernel, PlansThatNoMonitorCanPlayAreRefusedWithARemedy) {
  CampaignFile file = small_campaign(1);
  file.plan.validation_stations = 1;  // one attitude proves nothing
  const auto refused = make_kernel(file.plan);
  ASSERT_FALSE(refused.has_value());
  EXPECT_NE(refused.error().find("within 1 station: its state is suspect"), std::string::npos) << refused.error();
  EXPECT_NE(refused.error().find("Remedy: "), std::string::npos);
  file = small_campaign(1);
  file.plan.window = 1000;
  EXPECT_FALSE(make_kernel(file.plan).has_value());
}

TEST(CampaignSpec, CellsComeInTurnAndSensorsAllAlike) {
  const CampaignFile file = small_campaign(1);
  const Plan& plan = file.plan;
  std::array<int, 5> struck{};
  std::array<int, 4> onsets{};
  std::set<std::uint64_t> seeds;
  const std::uint64_t numbers = 40 * plan.cells.size();
  for (std::uint64_t number = 0; number < numbers; ++number) {
    const Spec spec = spec_of(plan, number);
    EXPECT_EQ(spec.cell, static_cast<int>(number % plan.cells.size()));
    seeds.insert(spec.seed);
    const Cell& cell = plan.cells[static_cast<std::size_t>(spec.cell)];
    std::uint32_t bits = 0;
    for (int k = 0; k < spec.faults; ++k) {
      const SpecFault& fault = spec.fault[static_cast<std::size_t>(k)];
      if (fault.sensor < 0) continue;
      ASSERT_LT(fault.sensor, plan.tools[static_cast<std::size_t>(spec.tool)].sensors);
      EXPECT_EQ(bits >> fault.sensor & 1U, 0U) << "twice the same sensor";
      bits |= 1U << fault.sensor;
      if (spec.tool == 1 && cell.faulty == 1) ++struck[static_cast<std::size_t>(fault.sensor)];
      ++onsets[static_cast<std::size_t>(fault.onset_station)];
      const FaultPlan& drawn = plan.faults[static_cast<std::size_t>(cell.fault)];
      if (drawn.least_mdb > 0.0) {
        const double mdb =
            plan.tools[static_cast<std::size_t>(spec.tool)].detectable_mps2[static_cast<std::size_t>(fault.sensor)];
        EXPECT_GE(std::abs(fault.magnitude), drawn.least_mdb * mdb * (1 - 1e-12));
        EXPECT_LE(std::abs(fault.magnitude), drawn.most_mdb * mdb * (1 + 1e-12));
        EXPECT_GE(spec.largest_mdb, drawn.least_mdb * (1 - 1e-12));
      }
    }
  }
  EXPECT_EQ(seeds.size(), numbers);
  EXPECT_EQ(onsets[0], 0);
  const auto even = [](const auto& counts, std::size_t from) {
    double sum = 0.0;
    for (std::size_t k = from; k < counts.size(); ++k) sum += counts[k];
    const double mean = sum / static_cast<double>(counts.size() - from);
    for (std::size_t k = from; k < counts.size(); ++k) EXPECT_NEAR(counts[k], mean, 5.0 * std::sqrt(mean));
  };
  even(struck, 0);
  even(onsets, 1);
}

}  // namespace
}  // namespace kernel_test

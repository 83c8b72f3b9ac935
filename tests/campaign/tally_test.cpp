// What is counted, on outcomes written by hand.
#include "plumb/campaign/tally.hpp"

#include "campaign_support.hpp"
#include "plumb/core/units.hpp"

namespace tally_test {
namespace {

using namespace plumb_test;
using namespace plumb::campaign;
using plumb::campaign::Outcome;

constexpr double kDeg = plumb::rad_from_deg(1.0);

Plan one_cell() {
  Plan plan;
  plan.alert_limit_rad = 1.0 * kDeg;
  plan.cells.resize(2);
  return plan;
}

/// Eight quiet blocks with 0.1 deg of error under a level of 0.5 deg.
Outcome quiet() {
  Outcome out;
  out.blocks = 8;
  for (int k = 0; k < 8; ++k)
    out.block[static_cast<std::size_t>(k)] = {0.1 * kDeg, 0.5 * kDeg, true, true, false, false};
  return out;
}

Spec numbered(std::uint64_t number) {
  Spec spec;
  spec.number = number;
  return spec;
}

std::uint64_t counted(const Outcome& outcome, Count what, double mdb = 0.0) {
  const Plan plan = one_cell();
  Tally tally(plan);
  Spec spec = numbered(3);
  spec.largest_mdb = mdb;
  tally.add(plan, spec, outcome);
  EXPECT_EQ(tally.count(0, Count::scenarios), 1U);
  EXPECT_EQ(tally.count(1, Count::scenarios), 0U);
  return tally.total(what);
}

TEST(Tally, AScenarioWithoutEventsRaisesNothing) {
  for (int k = 1; k < kCounts; ++k) {
    EXPECT_EQ(counted(quiet(), static_cast<Count>(k)), 0U) << to_string(static_cast<Count>(k));
  }
}

TEST(Tally, EveryOutcomeIsCountedUnderItsName) {
  Outcome fault = quiet();
  fault.faulty = 0b0010;
  fault.first_fault_block = 2;
  EXPECT_EQ(counted(fault, Count::undetected), 1U);
  EXPECT_EQ(counted(fault, Count::missed_above_threshold, 0.99), 0U);
  EXPECT_EQ(counted(fault, Count::missed_above_threshold, 1.0), 1U);
  Outcome seen = fault;
  seen.alarm_block = 3;
  EXPECT_EQ(counted(seen, Count::detected), 1U);
  EXPECT_EQ(counted(seen, Count::undetected), 0U);
  EXPECT_EQ(counted(seen, Count::ambiguous), 1U);
  EXPECT_EQ(counted(seen, Count::false_alarm), 0U);
  Outcome out = seen;
  out.excluded = out.ever_excluded = 0b0010;
  out.isolated_block = 6;
  EXPECT_EQ(counted(out, Count::isolated), 1U);
  EXPECT_EQ(counted(out, Count::ambiguous), 0U);
  EXPECT_EQ(counted(out, Count::wrong_exclusion), 0U);
  out.faulty = 0b0110;
  EXPECT_EQ(counted(out, Count::isolated), 0U);
  EXPECT_EQ(counted(out, Count::partial), 1U);
  Outcome aside = seen;
  aside.provisionally_excluded = aside.ever_provisionally_excluded = 0b0010;
  EXPECT_EQ(counted(aside, Count::provisional), 1U);
  aside.ever_provisionally_excluded |= 0b1000;
  EXPECT_EQ(counted(aside, Count::wrong_provisional_exclusion), 1U);
  EXPECT_EQ(counted(aside, Count::wrong_exclusion), 0U);
  Outcome early = fault;
  early.alarm_block = 1;
  EXPECT_EQ(counted(early, Count::false_alarm), 1U);
  EXPECT_EQ(counted(early, Count::detected), 0U);
  Outcome wrong = seen;
  wrong.ever_excluded = 0b0001;  // taken back later, and counted all the same
  EXPECT_EQ(counted(wrong, Count::wrong_exclusion), 1U);
  Outcome failed = seen;
  failed.failed = true;
  failed.block[7].alert = true;
  EXPECT_EQ(counted(failed, Count::failed), 1U);
  EXPECT_EQ(counted(failed, Count::unavailable), 1U);
}

TEST(Tally, AnErrorMisleadsOnlyWhereItIsPublishedAsUsableWithoutAnAlert) {
  Outcome bad = quiet();
  bad.block[4].tilt_rad = 1.01 * kDeg;
  EXPECT_EQ(counted(bad, Count::misleading), 1U);
  EXPECT_EQ(counted(bad, Count::beyond_protection), 1U);
  bad.block[4].alert = true;
  EXPECT_EQ(counted(bad, Count::misleading), 0U);
  bad.block[4].usable = false;
  EXPECT_EQ(counted(bad, Count::beyond_protection), 0U);
  bad = quiet();
  bad.block[4].tilt_rad = 0.7 * kDeg;
  EXPECT_EQ(counted(bad, Count::misleading), 0U);
  EXPECT_EQ(counted(bad, Count::beyond_protection), 1U);
}

TEST(Tally, BlocksFallIntoTheRegionsOfTheStanfordDiagram) {
  Outcome o = quiet();
  o.block[0] = {0.7 * kDeg, 0.5 * kDeg, true, true, false, false};  // misleading
  o.block[1] = {1.5 * kDeg, 0.5 * kDeg, true, true, false, false};  // hazardous
  o.block[2] = {0.7 * kDeg, 2.0 * kDeg, true, true, true, false};   // unavailable
  o.block[3] = {3.0 * kDeg, 2.0 * kDeg, true, true, true, false};   // ... and misleading
  o.block[4] = {3.0 * kDeg, 0.0, false, true, true, false};         // no level
  const Plan plan = one_cell();
  Tally tally(plan);
  tally.add(plan, numbered(0), o);
  EXPECT_EQ(tally.region(Region::available), 3U);
  EXPECT_EQ(tally.region(Region::misleading), 1U);
  EXPECT_EQ(tally.region(Region::hazardous), 1U);
  EXPECT_EQ(tally.region(Region::unavailable), 2U);
  EXPECT_EQ(tally.region(Region::unavailable_misleading), 1U);
  EXPECT_EQ(tally.stanford(octave_of(0.1 * kDeg), octave_of(0.5 * kDeg)), 3U);
  EXPECT_EQ(tally.stanford(octave_of(3.0 * kDeg), kOctaves), 1U);
}

TEST(Tally, OctavesEndWhereTheySay) {
  EXPECT_EQ(octave_of(0.0), 0);
  EXPECT_EQ(octave_of(0.00099 * kDeg), 0);
  EXPECT_EQ(octave_of(0.00101 * kDeg), 1);
  EXPECT_EQ(octave_of(0.0039 * kDeg), 2);
  EXPECT_EQ(octave_of(180.0 * kDeg), 18);
  EXPECT_EQ(octave_of(1e9), kOctaves - 1);
}

TEST(Tally, TimesAndTheLargestUndetectedTilt) {
  Outcome o = quiet();
  o.faulty = 1;
  o.first_fault_block = 2;
  o.alarm_block = 4;
  o.excluded = o.ever_excluded = 1;
  o.isolated_block = 7;
  o.block[1].tilt_rad = 9.0 * kDeg;  // before the onset
  o.block[3].tilt_rad = 0.4 * kDeg;
  for (std::size_t k = 4; k < 8; ++k) o.block[k].alarmed = true;
  o.block[5].tilt_rad = 8.0 * kDeg;  // after the alarm
  const Plan plan = one_cell();
  Tally tally(plan);
  tally.add(plan, numbered(0), o);
  EXPECT_EQ(tally.blocks_to_detect()[2], 1U);
  EXPECT_EQ(tally.blocks_to_isolate()[5], 1U);
  EXPECT_NEAR(static_cast<double>(tally.largest_undetected_nrad()), 0.4 * kDeg * 1e9, 1.0);
  std::array<std::uint64_t, kMostBlocks> histogram{};
  histogram[0] = 90;
  histogram[4] = 9;
  histogram[9] = 1;
  EXPECT_EQ(quantile_blocks(histogram, 0.5), 1);
  EXPECT_EQ(quantile_blocks(histogram, 0.9), 1);
  EXPECT_EQ(quantile_blocks(histogram, 0.91), 5);
  EXPECT_EQ(quantile_blocks(histogram, 0.99), 5);
  EXPECT_EQ(quantile_blocks(histogram, 1.0), 10);
  EXPECT_EQ(quantile_blocks({}, 0.5), 0);
}

TEST(Tally, AnyOrderOfPartsGivesTheSame) {
  const Plan plan = one_cell();
  Outcome wrong = quiet();
  wrong.faulty = 2;
  wrong.first_fault_block = 0;
  wrong.alarm_block = 1;
  wrong.ever_excluded = 1;
  Tally whole(plan);
  std::vector<Tally> parts(5, Tally(plan));
  for (std::uint64_t number = 0; number < 100; ++number) {
    Spec spec = numbered((number * 37) % 100);
    spec.cell = static_cast<int>(number % 2);
    wrong.block[3].tilt_rad = static_cast<double>(number) * kDeg;
    whole.add(plan, spec, wrong);
    parts[number * number % 5].add(plan, spec, wrong);
  }
  Tally forward(plan), backward(plan);
  for (const Tally& part : parts) forward.merge(part);
  for (auto part = parts.rbegin(); part != parts.rend(); ++part) backward.merge(*part);
  backward.merge(Tally(plan));
  const auto same = [](const Tally& a, const Tally& b) {
    const Tally::Numbers one = a.numbers(), two = b.numbers();
    return one.sums == two.sums && one.maxima == two.maxima && one.firsts == two.firsts;
  };
  EXPECT_TRUE(same(whole, forward));
  EXPECT_TRUE(same(whole, backward));
  for (std::uint64_t k = 0; k < kKept; ++k) EXPECT_EQ(whole.first_wrong()[k], k) << "the smallest numbers, in order";
  Tally read(plan);
  ASSERT_TRUE(read.take(whole.numbers()));
  EXPECT_TRUE(same(whole, read));
  Tally::Numbers torn = whole.numbers();
  torn.sums.pop_back();
  EXPECT_FALSE(read.take(torn));
}

}  // namespace
}  // namespace tally_test

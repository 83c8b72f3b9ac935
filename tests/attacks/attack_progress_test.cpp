// A run that was interrupted ends as if it had never stopped; a state that is not its own is refused.
#include <gtest/gtest.h>
#include <unistd.h>

#include <numeric>
#include <string>

#include "plumb/io/output_file.hpp"
#include "progress.hpp"

namespace attack_progress_test {
namespace {

using namespace plumb_bench;

std::size_t at(int k) { return static_cast<std::size_t>(k); }

std::string scratch(const std::string& name) {
  return testing::TempDir() + "plumb_attacks_" + std::to_string(getpid()) + "_" + name;
}

RunPlan small_plan() {
  RunPlan plan;
  plan.seed = 11;
  plan.chunk = 4;
  plan.episodes.assign(families().size(), 0);
  for (const char* name : {"v5a-vertical", "adaptive-axis-cone", "adaptive-many"}) {
    plan.episodes[at(family_named(name))] = 10;
  }
  return plan;
}

const auto kToTheEnd = [](const Progress&) { return true; };

/// Written and read back; the file goes.
plumb::io::FileExpected<Progress> through_a_file(const std::string& text, std::uint64_t seed, const char* name) {
  const std::string path = scratch(name);
  EXPECT_TRUE(plumb::io::write_file(path, text).has_value());
  auto out = read_state(path, seed);
  unlink(path.c_str());
  return out;
}

void expect_refused(const std::string& text, std::uint64_t seed, const char* why) {
  const auto read = through_a_file(text, seed, "refused");
  ASSERT_FALSE(read.has_value()) << why;
  EXPECT_NE(read.error().text().find(why), std::string::npos) << read.error().text();
}

TEST(AttackProgress, InterruptedAndResumedIsTheSameAsInOneGo) {
  const RunPlan plan = small_plan();
  Progress whole(plan.seed);
  play(plan, whole, kToTheEnd);
  for (int stop = 1; stop <= 8; stop += 3) {
    Progress part(plan.seed);
    int chunks = 0;
    play(plan, part, [&](const Progress&) { return ++chunks < stop; });
    EXPECT_NE(state_text(part), state_text(whole)) << stop;
    auto resumed = through_a_file(state_text(part), plan.seed, "resumed");
    ASSERT_TRUE(resumed.has_value()) << resumed.error().text();
    play(plan, *resumed, kToTheEnd);
    EXPECT_EQ(state_text(*resumed), state_text(whole)) << stop;
  }
  EXPECT_GT(whole.total(family_named("adaptive-axis-cone")).unsafe(), 0U);
  EXPECT_FALSE(whole.findings.empty());
}

TEST(AttackProgress, ChunksAndALongerPlanChangeNothing) {
  RunPlan plan = small_plan();
  Progress whole(plan.seed);
  play(plan, whole, kToTheEnd);
  Progress grown(plan.seed);
  plan.chunk = 7;
  for (const std::uint64_t episodes : {3U, 10U}) {
    for (std::uint64_t& k : plan.episodes) k = k == 0 ? 0 : episodes;
    play(plan, grown, kToTheEnd);
  }
  for (int family = 0; family < static_cast<int>(families().size()); ++family) {
    EXPECT_EQ(grown.total(family), whole.total(family)) << families()[at(family)].name;
  }
}

TEST(AttackProgress, AStateComesBackAsItWas) {
  Progress progress(5);
  progress.next[2] = 12345;
  progress.tally[2][1][Count::episodes] = 12345;
  progress.tally[2][1].to_nominal[kNominalBins - 1] = 3;
  progress.findings.push_back({2, 99, "a \"quoted\" finding"});
  const auto back = through_a_file(state_text(progress), 5, "back");
  ASSERT_TRUE(back.has_value()) << back.error().text();
  EXPECT_EQ(back->next, progress.next);
  EXPECT_EQ(back->tally[2][1], progress.tally[2][1]);
  ASSERT_EQ(back->findings.size(), 1U);
  EXPECT_EQ(back->findings[0].text, progress.findings[0].text);
  EXPECT_EQ(back->findings[0].episode, 99U);
}

TEST(AttackProgress, AStateOfAnotherRunIsRefusedByWhatDiffers) {
  const std::string text = state_text(Progress(5));
  expect_refused(text, 6, "seed 5");
  expect_refused("{}", 5, "no state of plumb_monitor_attacks");
  expect_refused("nonsense", 5, "no state of plumb_monitor_attacks");
  std::string damaged = text;
  damaged.replace(damaged.find("\"next\":0"), 8, "\"next\":9");
  expect_refused(damaged, 5, "damaged");
  expect_refused(text.substr(0, text.size() / 2), 5, "no state of plumb_monitor_attacks");
  EXPECT_FALSE(read_state(scratch("nowhere"), 5).has_value());
}

/// The same text with another number in it, and a hash that fits.
std::string resealed(std::string text, const std::string& was, const std::string& is) {
  text.replace(text.find(was), was.size(), is);
  return with_hash(text.substr(0, text.rfind("  \"hash\"")));
}

TEST(AttackProgress, AStateOfAnotherVersionIsRefused) {
  const std::string text = state_text(Progress(5));
  const std::string harness = "\"harness\": " + std::to_string(kHarnessVersion);
  expect_refused(resealed(text, harness, "\"harness\": 9999"), 5, "another version");
  expect_refused(resealed(text, "\"library\": ", "\"library\": 7"), 5, "another version");
  expect_refused(resealed(text, "\"behaviour\": \"", "\"behaviour\": \"0"), 5, "decides otherwise");
  expect_refused(resealed(text, "\"family\":\"drift\"", "\"family\":\"draft\""), 5, "other families");
  expect_refused(resealed(text, "\"counts\":[0,", "\"counts\":["), 5, "other families");
}

TEST(AttackShares, GiveTheAdaptiveFamiliesTheirPartAndEverySizeAnEpisode) {
  std::vector<int> all(families().size());
  std::iota(all.begin(), all.end(), 0);
  const auto shares = shared_out(1000000, 0.1, all);
  std::uint64_t adaptive = 0, sum = 0;
  for (const int k : all) {
    sum += shares[at(k)];
    if (families()[at(k)].adaptive) adaptive += shares[at(k)];
  }
  EXPECT_GE(sum, 1000000U);
  EXPECT_LE(sum, 1000100U);
  EXPECT_GE(adaptive, 100000U);
  EXPECT_LE(adaptive, 100010U);
  for (const int k : all) EXPECT_GE(shared_out(1, 0.1, all)[at(k)], 1U) << families()[at(k)].name;
  const int one = family_named("drift");
  EXPECT_EQ(shared_out(70, 0.1, {one})[at(one)], 70U) << "nobody to share with";
  const int bold = family_named("adaptive-error");
  EXPECT_EQ(shared_out(70, 0.1, {bold})[at(bold)], 70U);
}

}  // namespace
}  // namespace attack_progress_test

// Threads, interruptions and ranks leave no trace; results read back; failing scenarios become small.
#include "plumb/campaign/engine.hpp"

#include <array>
#include <filesystem>
#include <fstream>
#include <set>

#include "../../src/campaign/kernel/scene.hpp"
#include "campaign_support.hpp"
#include "plumb/campaign/replay.hpp"
#include "plumb/campaign/result_file.hpp"
#include "plumb/io/scenario_file.hpp"

namespace engine_test {
namespace {

using namespace plumb_test;
using namespace plumb::campaign;
using plumb::campaign::Outcome;

constexpr std::uint64_t kScenarios = 700;

bool never() { return false; }
std::string content(const Progress&) { return ""; }

Progress nothing_yet(const CampaignFile& file) {
  Progress progress;
  progress.tally = Tally(file.plan);
  return progress;
}

std::string played(const CampaignFile& file, int threads, std::uint64_t batch, int least_capacity = 0) {
  Ranks alone;
  Progress progress = nothing_yet(file);
  RunOptions options;
  options.threads = threads;
  options.batch = batch;
  options.least_capacity = least_capacity;
  const auto done = run(file.plan, options, alone, progress, never, content);
  EXPECT_TRUE(done.has_value()) << done.error();
  EXPECT_EQ(progress.done, file.plan.scenarios);
  return result_text(file, progress);
}

TEST(Campaign, OneTwoAndFourThreadsGiveTheSameBytes) {
  const CampaignFile file = small_campaign(kScenarios);
  const std::string one = played(file, 1, 1U << 15U);
  EXPECT_EQ(one, played(file, 2, 1U << 15U));
  EXPECT_EQ(one, played(file, 4, 123));
  CampaignFile other = file;
  other.plan.seed = 8;
  EXPECT_NE(one, played(other, 1, 1U << 15U));
}

/// Two ranks in one process: the second one's part is played first, then handed over.
class Pair final : public Ranks {
 public:
  Pair(int rank, std::vector<Tally::Numbers>& box, const Plan& plan) : rank_(rank), box_(box), plan_(plan) {}
  int rank() const noexcept override { return rank_; }
  int size() const noexcept override { return 2; }
  void unite(Tally::Numbers& numbers) override {
    if (rank_ == 1) {
      box_.push_back(numbers);
      return;
    }
    Tally all(plan_), other(plan_);
    EXPECT_TRUE(all.take(numbers) && other.take(box_[next_++]));
    all.merge(other);
    numbers = all.numbers();
  }

 private:
  int rank_;
  std::vector<Tally::Numbers>& box_;
  const Plan& plan_;
  std::size_t next_ = 0;
};

TEST(Campaign, TwoRanksPlayEveryScenarioOnce) {
  const CampaignFile file = small_campaign(kScenarios);
  std::vector<Tally::Numbers> box;
  RunOptions options;
  options.batch = 199;
  Progress second = nothing_yet(file), first = nothing_yet(file);
  Pair two(1, box, file.plan), one(0, box, file.plan);
  ASSERT_TRUE(run(file.plan, options, two, second, never, content).has_value());
  ASSERT_TRUE(run(file.plan, options, one, first, never, content).has_value());
  EXPECT_EQ(result_text(file, first), played(file, 1, 1U << 15U));
}

TEST(Campaign, InterruptedAndGoneOnWithItEndsWithTheSameBytes) {
  const CampaignFile file = small_campaign(kScenarios);
  const std::string path = (std::filesystem::temp_directory_path() / "plumb-campaign-resume.json").string();
  Ranks alone;
  Progress progress = nothing_yet(file);
  RunOptions options;
  options.batch = 100;
  int batches = 0;
  const auto enough = [&batches] { return batches >= 3; };
  ASSERT_TRUE(run(file.plan, options, alone, progress, enough, [&batches](const Progress&) {
                ++batches;
                return std::string();
              }).has_value());
  EXPECT_EQ(progress.done, 300U);
  ASSERT_TRUE(plumb::io::write_file(path, result_text(file, progress)).has_value());
  auto read = read_result(path, file);
  ASSERT_TRUE(read.has_value()) << read.error().text();
  EXPECT_EQ(read->done, 300U);
  EXPECT_EQ(result_text(file, *read), result_text(file, progress));
  options.threads = 2;
  options.batch = 77;
  ASSERT_TRUE(run(file.plan, options, alone, *read, never, content).has_value());
  EXPECT_EQ(result_text(file, *read), played(file, 1, 1U << 15U));
  // Damaged, or of another campaign: refused by name.
  const std::string good = result_text(file, progress);
  const auto refused = [&](std::string text, const CampaignFile& with) {
    EXPECT_TRUE(plumb::io::write_file(path, text).has_value());
    const auto again = read_result(path, with);
    return again ? std::string("read") : again.error().text();
  };
  CampaignFile other = file;
  other.plan.seed = 99;
  EXPECT_NE(refused(good, other).find("another campaign"), std::string::npos);
  std::string forged = good;
  forged.replace(forged.find("\"done\": 300"), 11, "\"done\": 301");
  EXPECT_NE(refused(forged, file).find("damaged"), std::string::npos);
  EXPECT_NE(refused("{", file).find("not valid JSON"), std::string::npos);
  EXPECT_NE(refused("{}", file).find("damaged"), std::string::npos);
  std::filesystem::remove(path);
}

TEST(Campaign, AReportThatRefusesEndsTheRun) {
  const CampaignFile file = small_campaign(kScenarios);
  Ranks alone;
  Progress progress = nothing_yet(file);
  RunOptions options;
  options.batch = 100;
  const auto done =
      run(file.plan, options, alone, progress, never, [](const Progress&) { return std::string("disk full"); });
  ASSERT_FALSE(done.has_value());
  EXPECT_EQ(done.error(), "disk full");
  EXPECT_EQ(progress.done, 100U);
}

/// Nobody healthy excluded within the grade; every bias of 10 MDB found; nothing where nothing happens.
TEST(Campaign, TheSmallCampaignCountsWhatItMust) {
  CampaignFile file = small_campaign(3000);
  Ranks alone;
  Progress progress = nothing_yet(file);
  ASSERT_TRUE(run(file.plan, {}, alone, progress, never, content).has_value());
  const Tally& tally = progress.tally;
  std::uint64_t within = 0;
  for (int k = 0; k < tally.cells(); ++k) {
    const Cell& cell = file.plan.cells[static_cast<std::size_t>(k)];
    const FaultPlan& fault = file.plan.faults[static_cast<std::size_t>(cell.fault)];
    const std::string& name = fault.name;
    if (fault.healthy) {
      EXPECT_EQ(tally.count(k, Count::false_alarm), 0U) << "40 scenarios of 8 blocks at 1e-5";
      EXPECT_EQ(tally.count(k, Count::detected), 0U);
    }
    if (name == "bias 10 MDB") {
      EXPECT_EQ(tally.count(k, Count::detected), tally.count(k, Count::scenarios));
    }
    if (cell.faulty > file.plan.tools[static_cast<std::size_t>(cell.tool)].grade) continue;
    within += tally.count(k, Count::scenarios);
    EXPECT_EQ(tally.count(k, Count::wrong_exclusion), 0U) << name;
    EXPECT_EQ(tally.count(k, Count::misleading), 0U) << name;
  }
  EXPECT_GT(within, 1500U);
  EXPECT_EQ(tally.total(Count::scenarios), 3000U);
  EXPECT_EQ(tally.total(Count::missed_above_threshold), 0U);
  EXPECT_GT(tally.total(Count::isolated), 100U);
  EXPECT_GT(tally.total(Count::undetected), 10U) << "half an MDB is mostly missed";
}

/// The integrator claims one fault, and there are two or three: the claim excludes the innocent. Such a scenario is
/// made small.
TEST(Campaign, AFailingScenarioBecomesSmallAndFailsAgainFromItsFile) {
  CampaignFile file = campaign_from(R"(
name = "claim"
scenarios = 20000
seed = 3
[monitor]
assumed_faults = 1
[[tool]]
geometry = "cone"
sensors = 5
noise = "0.2 mg0"
[gravity]
sigma = "0.1 mg0"
errors = [0.7]
[[fault]]
bias_mdb = {from = 5, to = 300}
sensors = [2, 3]
)");
  const Plan& plan = file.plan;
  const auto kernel = kernel_of(plan);
  const auto outcome = std::make_unique<Outcome>();
  int small = 0;
  for (std::uint64_t number = 0; number < plan.scenarios && small < 3; ++number) {
    const Spec spec = spec_of(plan, number);
    kernel->play(spec, *outcome);
    if (!outcome->wrong_exclusion()) continue;
    ++small;
    const Spec least = shrunk(plan, *kernel, spec, Count::wrong_exclusion);
    EXPECT_LE(least.faults, spec.faults);
    EXPECT_LT(least.stations, spec.stations);
    EXPECT_EQ(least.gravity_sigmas, 0.0);
    // Nothing can be left out of it any more.
    EXPECT_GE(least.faults, 2) << "one fault, one claimed: nobody innocent is excluded";
    for (int stations = 1; stations < least.stations; ++stations) {
      Spec shorter = least;
      shorter.stations = stations;
      kernel->play(shorter, *outcome);
      EXPECT_FALSE(outcome->wrong_exclusion());
    }
    // The file reads back as the same scenario, and the tool's own monitor fails in it alike.
    const auto read = plumb::io::parse_scenario_text(case_text(plan, least), "case.toml");
    ASSERT_TRUE(read.has_value()) << read.error().text() << case_text(plan, least);
    EXPECT_EQ(read->array.name, plan.tools[0].name);
    const auto again = replay(plan, 0, read->scenario, [](const plumb::Verdict&) {});
    ASSERT_TRUE(again.has_value()) << again.error();
    kernel->play(least, *outcome);
    expect_same(*outcome, *again, sentence_of(plan, least));
    EXPECT_TRUE(again->wrong_exclusion());
  }
  EXPECT_EQ(small, 3) << "the claim never excluded anybody innocent";
}

struct Bad {
  const char* from;
  const char* to;
  std::array<const char*, 3> words;
};

TEST(CampaignFile, SaysWhatIsWrongWhereAndHowToCorrectIt) {
  const std::array<Bad, 16> all = {{
      {"scenarios = 3000", "scenarios = 0", {"test.toml:3: scenarios", "out of range", "Remedy: "}},
      {"scenarios = 3000", "scenarioz = 3000", {"scenarioz", "scenarios", "Remedy: "}},
      {"seed = 7", "seed = -7", {"test.toml:4: seed", "negative", "Remedy: "}},
      {"geometry = \"tetrahedron\"", "geometry = \"tetrahedrom\"", {"tool[1].geometry", "tetrahedron", "Remedy: "}},
      {"sensors = 5\n", "sensors = 2\n", {"tool[2].sensors", "3 to 24", "Remedy: "}},
      {"noise = \"0.2 mg0\"", "noise = 0.2", {"tool[1].noise", "unit is missing", "Remedy: "}},
      {"onset = [1, 3]", "onset = [3, 1]", {"run.onset", "must be one station, or two in ascending order", "Remedy: "}},
      {"onset = [1, 3]", "onset = [1, 9]", {"run.onset", "out of range", "Remedy: "}},
      {"onset = [1, 3]", "samples = 33", {"run.samples", "window, 32", "Remedy: "}},
      {"onset = [1, 3]", "move = \"6 s\"", {"run.move", "max_gap", "Remedy: "}},
      {"errors = [0, 1]", "errors = [\"a\"]", {"gravity.errors", "not a number", "Remedy: "}},
      {"law = \"random\"", "law = \"randomly\"", {"attitude[1].law", "random", "Remedy: "}},
      {"\"stuck=0V\"", "\"stucc=0V\"", {"fault[2].spec", "stucc=0V", "Remedy: "}},
      {"\"stuck=0V\"", "\"exchange=a3\"", {"fault[2].spec", "Remedy: ", "exchange"}},
      {"bias_mdb = [0.5,", "bias_mdb = [-0.5,", {"fault[3].bias_mdb", "above 0", "Remedy: "}},
      {"{from = 0.5, to = 100}", "{from = 5, to = 1}", {"fault[3].bias_mdb", "above 0", "Remedy: "}},
  }};
  for (const Bad& bad : all) {
    std::string text = small_text();
    const std::size_t at = text.find(bad.from);
    ASSERT_NE(at, std::string::npos) << bad.from;
    text.replace(at, std::string(bad.from).size(), bad.to);
    const auto file = parse_campaign_text(text, "test.toml");
    ASSERT_FALSE(file.has_value()) << bad.to;
    for (const char* word : bad.words) {
      EXPECT_NE(file.error().text().find(word), std::string::npos) << word << " is not in: " << file.error().text();
    }
  }
}

/// A sensor's own figure before the array file's, that before the campaign's.
TEST(CampaignFile, TheStabilityOfTheSensorsReachesTheirMonitor) {
  const std::filesystem::path path = std::filesystem::path(::testing::TempDir()) / "stated.toml";
  const std::string tool = "examples/paper_tool.toml";
  std::ifstream in(std::string(PLUMB_SOURCE_DIR "/") + tool);
  std::string text((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  const std::size_t at = text.find("[[sensor]]");
  ASSERT_NE(at, std::string::npos);
  text.insert(at + 10, "\nstability = \"0.3 m/s^2\"");
  std::ofstream(path) << text;
  const auto file = parse_campaign_text(
      "scenarios = 10\n[monitor]\nstability = \"0.1 m/s^2\"\n[calibration]\ndays = 30\n"
      "[[tool]]\narray = \"" +
          path.string() +
          "\"\nstability_per_day = \"0.001 m/s^2\"\n"
          "[[tool]]\ngeometry = \"cone\"\nsensors = 5\nnoise = \"0.2 mg0\"\nstability = \"0.2 m/s^2\"\n"
          "[[fault]]\nspec = \"none\"\n",
      "test.toml");
  ASSERT_TRUE(file.has_value()) << file.error().text();
  using Four = std::array<double, 4>;
  EXPECT_EQ(file->plan.tools[0].stability[0], (Four{0.3, 0.001, 0.0, 0.0}));
  EXPECT_EQ(file->plan.tools[0].stability[1], (Four{0.1, 0.001, 0.0, 0.0}));
  EXPECT_EQ(file->plan.tools[1].stability[4], (Four{0.2, 0.0, 0.0, 0.0}));
  EXPECT_EQ(file->plan.days_since_calibration, 30.0);
  for (const int k : {0, 1}) {
    const auto setup = plumb::campaign_kernel::setup_of(file->plan, k);
    ASSERT_TRUE(setup.has_value());
    EXPECT_EQ(setup->days_since_calibration, 30.0);
    EXPECT_EQ(setup->stability[0].mps2, k == 0 ? 0.3 : 0.2);
  }
  Spec spec = spec_of(file->plan, 0);
  spec.tool = 0;
  EXPECT_NE(case_text(file->plan, spec).find("stability_per_day = \"0.001 m/s^2/day\""), std::string::npos);
}

TEST(CampaignFile, TheHashDistinguishesPlans) {
  const CampaignFile file = small_campaign(100);
  std::set<std::uint64_t> hashes = {hash_of(file.plan)};
  const auto with = [&](auto change) {
    Plan plan = file.plan;
    change(plan);
    EXPECT_TRUE(hashes.insert(hash_of(plan)).second);
  };
  with([](Plan& p) { p.seed = 1; });
  with([](Plan& p) { ++p.scenarios; });
  with([](Plan& p) { p.tools[0].sigma_mps2[3] *= 2.0; });
  with([](Plan& p) { p.faults[3].magnitude += 1e-9; });
  with([](Plan& p) { p.monitor[20] ^= 1U; });
  with([](Plan& p) { p.tools[0].stability[3][1] = 1e-6; });
  with([](Plan& p) { p.days_since_calibration = 1.0; });
  with([](Plan& p) { p.cells.pop_back(); });
  with([](Plan& p) { p.attitudes[1].inclination_rad += 1e-9; });
  EXPECT_EQ(hash_of(file.plan), hash_of(small_campaign(100).plan));
}

}  // namespace
}  // namespace engine_test

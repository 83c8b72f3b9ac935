// The campaigns of a report: what is played is what the files say, and every table adds up to the same scenarios.
#include "plumb/render/trials_json.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "plumb/campaign/result_file.hpp"
#include "plumb/core/detail/archive.hpp"
#include "plumb/io/array_file.hpp"

namespace trials_test {
namespace {

using namespace plumb;
using render::Json;

const std::string kPath = PLUMB_SOURCE_DIR "/examples/paper_tool.toml";

io::ArrayFile paper_array() {
  const io::FileExpected<io::ArrayFile> array = io::read_array_file(kPath);
  EXPECT_TRUE(array) << array.error().text();
  return *array;
}

verification::TrialSettings settings(std::uint64_t scenarios) {
  verification::TrialSettings out;
  out.alert_limit_rad = 0.01;
  out.e_cal_mps2 = 1e-4;
  out.seed = 7;
  out.scenarios = scenarios;
  return out;
}

campaign::CampaignFile parsed(const std::string& text) {
  const io::FileExpected<campaign::CampaignFile> file = campaign::parse_campaign_text(text, "test");
  EXPECT_TRUE(file) << file.error().text();
  return *file;
}

verification::Trials played(const campaign::CampaignFile& file, int threads = 1) {
  auto trials = verification::play_trials(file, threads, [](std::uint64_t) { return true; });
  EXPECT_TRUE(trials) << trials.error();
  return *std::move(trials);
}

/// The monitor of a campaign, field by field, as its file had it.
std::vector<std::uint8_t> monitor_of(const io::ArrayFile& array, const verification::TrialSettings& s) {
  return parsed(verification::fault_campaign(array, kPath, s)).plan.monitor;
}

TEST(VerificationTrials, TheMonitorIsTheOneOfTheArrayFile) {
  io::ArrayFile array = paper_array();
  array.monitor.window = 16;
  array.monitor.false_alarm_rate = 3e-4;
  array.monitor.rejection_rate = 2e-6;
  array.monitor.isolation_stations = 3;
  array.monitor.passed_blocks = 4;
  array.monitor.max_gap_s = 7.0;
  array.monitor.station_angle_rad = 0.05;
  array.monitor.clear_fraction = 0.6;
  array.monitor.temperature_min_degc = -20.0;
  array.monitor.recalibrate_after_exclusion = true;
  array.monitor.alarm_form = AlarmForm::average_tool;
  verification::TrialSettings s = settings(1);
  const std::vector<std::uint8_t> bytes = monitor_of(array, s);
  ArchiveReader reader(bytes.data(), bytes.size(), 4);
  MonitorConfig read;
  reader.get(read);
  ASSERT_TRUE(reader.sound());
  MonitorConfig expected = array.monitor;
  expected.alert_limit_rad = s.alert_limit_rad;
  expected.alert_frame = AlertFrame::calibrated_axes;  // a scenario knows the truth in no other
  std::vector<std::uint8_t> wanted(bytes.size());
  ArchiveWriter writer(wanted.data(), wanted.size(), kCapacity);
  writer.put(expected);
  EXPECT_EQ(bytes, wanted);
  EXPECT_EQ(read.window, 16);
  array.monitor.recalibrate_after_exclusion = false;  // which no array may ask for beside an acceleration bound
  const std::vector<std::uint8_t> still = monitor_of(array, s);
  array.monitor.acceleration_bound_mps2 = 0.05;
  EXPECT_NE(monitor_of(array, s), still) << "it is played as the array says";
  array.monitor.isolation_timeout = 9;  // and a field more makes another monitor
  EXPECT_NE(monitor_of(array, s), bytes);
}

TEST(VerificationTrials, TheDriftThatIsAllowedForIsPlayedAtTheDayThatWasAsked) {
  verification::TrialSettings s = settings(1);
  EXPECT_EQ(parsed(verification::fault_campaign(paper_array(), kPath, s)).plan.days_since_calibration, 0.0);
  s.days_since_calibration = 45.5;
  EXPECT_EQ(parsed(verification::fault_campaign(paper_array(), kPath, s)).plan.days_since_calibration, 45.5);
  s.e_cal_mps2 = 1e-4;
  EXPECT_EQ(parsed(verification::healthy_campaign(paper_array(), kPath, s)).plan.days_since_calibration, 45.5);
}

double first_sigma(const verification::TrialSettings& s) {
  return parsed(verification::fault_campaign(paper_array(), kPath, s)).plan.tools.at(0).sigma_mps2[0];
}

TEST(VerificationTrials, ARowOfManySamplesScattersByTheRootOfThemLess) {
  verification::TrialSettings one = settings(9), many = one;
  many.samples_per_row = 400;
  EXPECT_DOUBLE_EQ(first_sigma(many), first_sigma(one) / 20.0);
  const campaign::Plan before = parsed(verification::fault_campaign(paper_array(), kPath, one)).plan;
  const campaign::Plan after = parsed(verification::fault_campaign(paper_array(), kPath, many)).plan;
  EXPECT_DOUBLE_EQ(after.tools[0].detectable_mps2[3], before.tools[0].detectable_mps2[3] / 20.0);
  const std::string text = verification::fault_campaign(paper_array(), kPath, many);
  EXPECT_NE(text.find("\"shake=1mg0\""), std::string::npos) << "the vibration too is white, and the mean of a row";
  EXPECT_NE(campaign::hash_of(before), campaign::hash_of(after));  // a result of the one is none of the other
}

TEST(VerificationTrials, TheTimesOfStepsAreOrderedAndTheLongestIsTheMark) {
  std::vector<std::int64_t> times;
  for (int k = 2000; k > 0; --k) times.push_back(k);
  const Json json = render::step_times_json(times);
  EXPECT_EQ(json["calls"], 2000);
  EXPECT_EQ(json["median_ns"], 1000);
  EXPECT_EQ(json["p999_ns"], 1998);
  EXPECT_EQ(json["high_water_ns"], 2000);
  EXPECT_EQ(render::step_times_json({7})["median_ns"], 7);
  EXPECT_TRUE(render::step_times_json({}).is_null());  // nothing was replayed: no time is made up
}

TEST(VerificationTrials, ARowOfNoSamplesIsRefused) {
  const std::string text = verification::fault_campaign(paper_array(), kPath, settings(9));
  for (const char* wrong : {"0", "-3", "1.5", "\"many\"", "10000001"}) {
    std::string damaged = text;
    damaged.insert(damaged.find("\n\n[run]"), std::string("\nsamples_per_row = ") + wrong);
    const io::FileExpected<campaign::CampaignFile> file = campaign::parse_campaign_text(damaged, "test");
    ASSERT_FALSE(file) << wrong;
    EXPECT_NE(file.error().text().find("samples_per_row"), std::string::npos) << file.error().text();
  }
}

TEST(VerificationTrials, TheNameOfTheArrayFileDoesNotMatter) {
  const io::ArrayFile array = paper_array();
  const std::string copy = ::testing::TempDir() + "/array with \"quotes\".toml";
  FILE* file = std::fopen(copy.c_str(), "wb");
  ASSERT_NE(file, nullptr);
  std::fwrite(array.text.data(), 1, array.text.size(), file);
  std::fclose(file);
  EXPECT_EQ(campaign::hash_of(parsed(verification::fault_campaign(array, kPath, settings(9))).plan),
            campaign::hash_of(parsed(verification::fault_campaign(array, copy, settings(9))).plan));
}

TEST(VerificationTrials, ThreadsLeaveNoTraceAndTheEngineCountsTheSame) {
  const campaign::CampaignFile file = parsed(verification::fault_campaign(paper_array(), kPath, settings(400)));
  const verification::Trials one = played(file, 1), three = played(file, 3);
  EXPECT_EQ(verification::trials_csv(one), verification::trials_csv(three));
  EXPECT_EQ(render::fault_trials_json(one, "x"), render::fault_trials_json(three, "x"));
  campaign::Progress engine;
  engine.tally = campaign::Tally(file.plan);
  campaign::Ranks alone;
  const auto ran = campaign::run(
      file.plan, {}, alone, engine, [] { return false; }, [](const campaign::Progress&) { return std::string(); });
  ASSERT_TRUE(ran);
  EXPECT_EQ(campaign::result_text(file, engine), campaign::result_text(file, one.counted));
}

// Verifies: REQ-181
TEST(VerificationTrials, EveryTableAddsUpToTheSameScenarios) {
  const verification::Trials trials = played(parsed(verification::fault_campaign(paper_array(), kPath, settings(700))));
  const Json json = render::fault_trials_json(trials, "plumb campaign faults.toml");
  std::uint64_t scenarios = 0, confused = 0;
  for (const char* name : {"detected", "isolated", "wrong_exclusion", "misleading"}) {
    std::uint64_t sum = 0;
    for (const Json& group : json["by_fault"]) sum += group[name]["count"].get<std::uint64_t>();
    EXPECT_EQ(sum, json["rates"][name]["count"].get<std::uint64_t>()) << name;
  }
  for (const Json& group : json["by_fault"]) scenarios += group["scenarios"].get<std::uint64_t>();
  for (const Json& row : json["confusion"]["rows"]) {
    for (const Json& count : row["counts"]) confused += count.get<std::uint64_t>();
  }
  std::uint64_t detected = 0;
  for (const Json& count : json["blocks_to_detect"]) detected += count.get<std::uint64_t>();
  EXPECT_EQ(scenarios, 700U);
  EXPECT_EQ(confused, 700U);
  EXPECT_EQ(detected, json["rates"]["detected"]["count"].get<std::uint64_t>());
  for (const auto& [name, rate] : json["rates"].items()) {
    const double share = rate["count"].get<double>() / rate["of"].get<double>();
    EXPECT_LE(rate["low"].get<double>(), share) << name;
    EXPECT_GE(rate["high"].get<double>(), share) << name;
  }
  EXPECT_FALSE(json["worst"].empty());
  for (const Json& worst : json["worst"])
    EXPECT_EQ(worst["replay"], "plumb campaign faults.toml --replay " + worst["scenario"].dump());
}

TEST(VerificationTrials, ReplayByOtherCodeAgreesAndSeesStates) {
  const verification::Trials trials = played(parsed(verification::fault_campaign(paper_array(), kPath, settings(200))));
  const auto again = verification::replay_first({&trials}, 200);
  ASSERT_TRUE(again) << again.error();
  EXPECT_EQ(again->counted.scenarios, 200U);
  EXPECT_EQ(again->counted.agree, 200U);
  EXPECT_FALSE(again->step_ns.empty());
  const Json json = render::replayed_json(*again);
  EXPECT_EQ(json["agree"], 200);
  EXPECT_GE(json["coverage"]["modes_visited"].get<int>(), 3);
  EXPECT_GE(json["coverage"]["cells_recorded"].get<int>(), 4);
}

TEST(VerificationTrials, ATrialThatWasTamperedWithIsNoticed) {
  verification::Trials trials = played(parsed(verification::fault_campaign(paper_array(), kPath, settings(60))));
  trials.file.plan.gravity_mps2 += 0.02;  // the kernel is told, and so is the replay: still the same
  const auto same = verification::replay_first({&trials}, 20);
  ASSERT_TRUE(same);
  EXPECT_EQ(same->counted.agree, same->counted.scenarios);
  trials.trial[3].ever_excluded = 1U << 2U;  // a row that blames a healthy sensor shows in the tables
  trials.trial[3].faulty = 0;
  const Json json = render::fault_trials_json(trials, "x");
  EXPECT_EQ(json["worst"][0]["what"], "a healthy sensor excluded");
  EXPECT_EQ(json["worst"][0]["scenario"], 3);
}

TEST(VerificationTrials, AHealthyScenarioIsAtRiskUpToItsFirstAlarm) {
  verification::Trials trials = played(parsed(verification::healthy_campaign(paper_array(), kPath, settings(50))));
  const Json quiet = render::healthy_trials_json(trials, "x");
  EXPECT_EQ(quiet["false_alarm_per_block"]["of"], 50 * 16);
  trials.trial[4].alarm_block = 2;
  const Json loud = render::healthy_trials_json(trials, "x");
  EXPECT_EQ(loud["false_alarm_per_block"]["of"], 50 * 16 - 13);
  EXPECT_EQ(healthy_facts(trials).false_alarm_per_block.of, 50U * 16U - 13U);
}

TEST(VerificationTrials, TheRatesOfALongerCampaignAreJudgedInTheirPlace) {
  const auto counted = [](const std::string& text) { return played(parsed(text)); };
  const verification::Trials here = counted(verification::healthy_campaign(paper_array(), kPath, settings(50)));
  const verification::Trials longer = counted(verification::healthy_campaign(paper_array(), kPath, settings(80)));
  verification::HealthyCampaign healthy = healthy_facts(here);
  EXPECT_EQ(healthy.unavailable.of, 50U);
  take_longer(here, longer.counted.tally, healthy);
  EXPECT_EQ(healthy.unavailable.of, 80U);
  EXPECT_EQ(healthy.false_alarm_per_block.of, 80U * 16U);
  verification::Trials uneven = here;
  uneven.trial[0].blocks = 1;  // then nothing is known of the blocks of the longer one
  EXPECT_EQ(blocks_at_risk(uneven, longer.counted.tally), 0U);
  const verification::Trials few = counted(verification::fault_campaign(paper_array(), kPath, settings(60)));
  const verification::Trials many = counted(verification::fault_campaign(paper_array(), kPath, settings(90)));
  verification::FaultCampaign faults = fault_facts(few);
  const std::vector<std::uint64_t> blocks = faults.blocks_to_detect;
  take_longer(many.counted.tally, faults);
  EXPECT_EQ(faults.misleading.of, 90U);
  EXPECT_EQ(faults.blocks_to_detect, blocks) << "times are those of the campaign whose rows are here";
}

}  // namespace
}  // namespace trials_test

// Rows around every change, in files that are logs again.
#include "plumb/session/incident_recorder.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "motion_support.hpp"
#include "plumb/io/log_reader.hpp"

namespace incident_recorder_test {
namespace {

using namespace plumb;
using session::IncidentRecorder;
namespace fs = std::filesystem;
using plumb_test::Directory;

const io::ArrayFile& drone() {
  static const io::ArrayFile array = motion_support::array_of(motion_support::drone_text());
  return array;
}

Sample row(int k) {
  Sample out;
  out.time_s = 0.001 * k;
  out.delivered = SensorSet::first(9);
  for (std::size_t i = 0; i < 9; ++i) out.raw[i] = 0.125 * k + static_cast<double>(i);
  if (k % 7 == 3) out.delivered = out.delivered - SensorSet::of(2);
  out.temperature_degc = 25.0;
  return out;
}

std::vector<Sample> read_back(const fs::path& file) {
  std::vector<Sample> out;
  io::FileExpected<io::LogReader> reader = io::LogReader::open(file.string(), drone(), io::BadRowPolicy::stop);
  EXPECT_TRUE(reader.has_value()) << (reader ? "" : reader.error().text());
  Sample sample;
  while (reader && reader->next(sample) == io::LogReader::Next::row) out.push_back(sample);
  return out;
}

std::vector<nlohmann::json> index_of(const fs::path& folder) {
  std::ifstream in(folder / "incidents.jsonl");
  std::vector<nlohmann::json> out;
  for (std::string line; std::getline(in, line);) out.push_back(nlohmann::json::parse(line));
  return out;
}

/// Plays `rows` rows with a change of state in those of `changes`.
void play(IncidentRecorder& recorder, int rows, const std::vector<bool>& changes) {
  std::uint32_t sequence = 0;
  for (int k = 0; k < rows; ++k) {
    Verdict verdict;
    if (changes[static_cast<std::size_t>(k)]) {
      verdict.transition.sequence = ++sequence;
      verdict.transition.time_s = 0.001 * k;
    }
    recorder.at_turn({true, true, {0.5, 0.25 * k, -1.0}});
    recorder.at_second_turn({true, true, {0.5, 0.25 * k, -1.0}});
    ASSERT_TRUE(recorder.take(row(k), verdict).has_value());
  }
  ASSERT_TRUE(recorder.commit().has_value());
}

// Every row within `before` rows ahead of a change and as many behind it is in exactly one file, bit for bit, in order.
RC_GTEST_PROP(IncidentRecorderLaw, EveryRowAroundAChangeIsInOneFileBitForBit, ()) {
  const int rows = *rc::gen::inRange(1, 120), around = *rc::gen::inRange(1, 12);
  std::vector<bool> changes(static_cast<std::size_t>(rows));
  for (std::size_t k = 0; k < changes.size(); ++k) changes[k] = *rc::gen::inRange(0, 20) == 0;
  const Directory folder;
  auto made = IncidentRecorder::create({folder.path().string(), around, 100}, drone());
  RC_ASSERT(made.has_value());
  play(**made, rows, changes);
  std::vector<int> wanted;
  for (int k = 0; k < rows; ++k) {
    bool near = false;
    for (int j = std::max(0, k - around); j <= std::min(rows - 1, k + around); ++j)
      near = near || changes[static_cast<std::size_t>(j)];
    if (near) wanted.push_back(k);
  }
  std::vector<Sample> found;
  std::size_t told = 0, changed = 0;
  for (const nlohmann::json& line : index_of(folder.path())) {
    const auto part = read_back(folder.path() / line["file"].get<std::string>());
    RC_ASSERT(part.size() == line["rows"].get<std::size_t>());
    RC_ASSERT(part.front().time_s == line["begin_s"].get<double>());
    RC_ASSERT(part.back().time_s == line["end_s"].get<double>());
    found.insert(found.end(), part.begin(), part.end());
    changed += line["changes"].size();
    ++told;
  }
  RC_ASSERT(static_cast<int>(told) == (*made)->recorded());
  RC_ASSERT(changed == static_cast<std::size_t>(std::count(changes.begin(), changes.end(), true)));
  RC_ASSERT(found.size() == wanted.size());
  for (std::size_t k = 0; k < found.size(); ++k) {
    const Sample expected = row(wanted[k]);
    RC_ASSERT(found[k].time_s == expected.time_s);
    RC_ASSERT(found[k].delivered == expected.delivered);
    for (std::size_t i = 0; i < 9; ++i)
      RC_ASSERT(!expected.delivered.has(static_cast<int>(i)) || found[k].raw[i] == expected.raw[i]);
  }
}

TEST(IncidentRecorder, KeepsTheRatesOfTurnOfBothGyros) {
  const Directory folder;
  auto made = IncidentRecorder::create({folder.path().string(), 3, 100}, drone());
  ASSERT_TRUE(made.has_value());
  std::vector<bool> changes(20, false);
  changes[10] = true;
  play(**made, 20, changes);
  auto reader = io::LogReader::open((folder.path() / "incident-0001.csv").string(), drone(), io::BadRowPolicy::stop);
  ASSERT_TRUE(reader.has_value());
  Sample sample;
  for (int k = 7; k <= 13; ++k) {
    ASSERT_EQ(reader->next(sample), io::LogReader::Next::row);
    EXPECT_EQ(reader->rotation().rate_radps, (Vec3{0.5, 0.25 * k, -1.0}));
    EXPECT_EQ(reader->second_rotation().rate_radps, (Vec3{0.5, 0.25 * k, -1.0}));
  }
}

TEST(IncidentRecorder, FindingsInMotionAreIncidentsToo) {
  const Directory folder;
  auto made = IncidentRecorder::create({folder.path().string(), 2, 100}, drone());
  ASSERT_TRUE(made.has_value());
  for (int k = 0; k < 10; ++k) {
    std::vector<io::MotionEvent> events;
    if (k == 5) events.push_back({io::MotionEventKind::isolated, 0.005, SensorSet::of(4)});
    ASSERT_TRUE((*made)->take(0.001 * k, MotionVerdict{}, events).has_value());
    ASSERT_TRUE((*made)->take(row(k), Verdict{}).has_value());
  }
  ASSERT_TRUE((*made)->commit().has_value());
  const auto index = index_of(folder.path());
  ASSERT_EQ(index.size(), 1U);
  EXPECT_EQ(index[0]["rows"], 5);
  EXPECT_NE(index[0]["changes"][0].dump().find("isolated"), std::string::npos);
  EXPECT_EQ(read_back(folder.path() / "incident-0001.csv").size(), 5U);
}

TEST(IncidentRecorder, CountsWhatItRecordsNoMoreAndKeepsTheIncidentsOfAnotherRun) {
  const Directory folder;
  auto made = IncidentRecorder::create({folder.path().string(), 1, 2}, drone());
  ASSERT_TRUE(made.has_value());
  std::vector<bool> changes(40, false);
  changes[5] = changes[15] = changes[25] = changes[35] = true;
  play(**made, 40, changes);
  EXPECT_EQ((*made)->recorded(), 2);
  EXPECT_EQ((*made)->passed_over(), 2);
  const auto again = IncidentRecorder::create({folder.path().string(), 1, 2}, drone());
  ASSERT_FALSE(again.has_value());
  EXPECT_NE(again.error().text().find("another run"), std::string::npos) << again.error().text();
  std::filesystem::remove(folder.path() / "incidents.jsonl");
  EXPECT_FALSE(IncidentRecorder::create({folder.path().string(), 1, 2}, drone()).has_value()) << "its files are left";
  const auto nowhere = IncidentRecorder::create({"/proc/none/here", 1, 2}, drone());
  ASSERT_FALSE(nowhere.has_value());
  EXPECT_NE(nowhere.error().text().find("--incidents"), std::string::npos);
}

}  // namespace
}  // namespace incident_recorder_test

#include "plumb/scenario/catalogue.hpp"

#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>

#include "plumb/scenario/course.hpp"
#include "plumb/scenario/library.hpp"

namespace plumb {
namespace scenario {
namespace catalogue_test {
namespace {

FaultContext volts() {
  FaultContext context;
  context.datasheet = paper_datasheet();
  return context;
}

TEST(Catalogue, HoldsF01ToF29InOrderAndNoNameTwice) {
  ASSERT_EQ(catalogue().size(), 29U);
  std::set<std::string> words;
  for (std::size_t k = 0; k < 29; ++k) {
    const CatalogueEntry& entry = catalogue()[k];
    char id[8];
    std::snprintf(id, sizeof id, "F%02zu", k + 1);
    EXPECT_STREQ(entry.id, id);
    EXPECT_TRUE(words.insert(entry.id).second && words.insert(entry.name).second) << entry.id;
    EXPECT_FALSE(entry.parameters.empty()) << entry.id;
    EXPECT_GT(std::string(entry.source).size(), 5U) << entry.id;
    EXPECT_NE(entry.four.states, 0) << entry.id;
    EXPECT_NE(entry.six.states, 0) << entry.id;
  }
}

TEST(Catalogue, EveryEntryIsReadByIdAndByNameAndRoundTrips) {
  for (const CatalogueEntry& entry : catalogue()) {
    const auto by_id = parse_faults(std::string("a3:") + entry.id + "@station6", volts());
    const auto by_name = parse_faults(std::string("a3:") + entry.name + "@station6", volts());
    ASSERT_TRUE(by_id) << by_id.error();
    ASSERT_FALSE(by_id->empty());
    // "scale" and the like are words of the fault language as well, but only with a size.
    ASSERT_TRUE(by_name) << by_name.error();
    EXPECT_EQ(*by_id, *by_name) << entry.id;
    for (const Fault& fault : *by_id) {
      const auto back = parse_fault(to_text(fault, volts()), volts());
      ASSERT_TRUE(back) << to_text(fault, volts());
      EXPECT_EQ(*back, fault);
    }
  }
}

TEST(Catalogue, Px4WordsMeanWhatTheySay) {
  const std::pair<const char*, const char*> pairs[] = {{"a2:off@1s", "a2:missing@1s"},
                                                       {"a2:stuck@1s", "a2:last@1s"},
                                                       {"a2:garbage@1s", "a2:random=-1g0..1g0@1s"},
                                                       {"a2:wrong@1s", "a2:bias=50mg0@1s"},
                                                       {"a2:slow@1s", "a2:slow=10@1s"},
                                                       {"a2:delayed@1s+5s", "a2:late=20@1s+5s"},
                                                       {"a2:intermittent@1s", "a2:missing=50%@1s"},
                                                       {"a2:wrong=20mg0@1s", "a2:bias=20mg0@1s"}};
  for (const auto& [alias, plain] : pairs) {
    const auto one = parse_faults(alias, volts());
    const auto two = parse_faults(plain, volts());
    ASSERT_TRUE(one) << one.error();
    ASSERT_TRUE(two) << two.error();
    EXPECT_EQ(*one, *two) << alias;
  }
  EXPECT_EQ(parse_faults("a2:stuck=0V@1s", volts())->front().kind, FaultKind::stuck_level);
}

TEST(Catalogue, EntriesOfSeveralSensorsTakeThoseBehind) {
  const auto sequential = parse_faults("a4:F22@12s", volts());
  ASSERT_TRUE(sequential);
  ASSERT_EQ(sequential->size(), 2U);
  EXPECT_EQ(sequential->at(0).sensor, 3);
  EXPECT_EQ(sequential->at(1).sensor, 0);
  EXPECT_EQ(sequential->at(1).onset, 32.0);
  EXPECT_EQ(parse_faults("a4:F24@12s", volts())->size(), 4U);
  EXPECT_EQ(parse_faults("a4:F08@12s", volts())->front().magnitude, 0.0);
  EXPECT_EQ(parse_faults("log:F27@12s", volts())->front().sensor, kWholeLog);
  const auto unknown = parse_faults("a4:F30@12s", volts());
  ASSERT_FALSE(unknown);
  EXPECT_NE(unknown.error().find("catalogue"), std::string::npos);
}

/// Every entry, on every sensor of both tools, ends as the catalogue says.
class CatalogueCourse : public testing::TestWithParam<int> {};

TEST_P(CatalogueCourse, EndsAsExpected) {
  const CatalogueEntry& entry = catalogue()[static_cast<std::size_t>(GetParam())];
  for (const Datasheet& datasheet : {paper_datasheet(), hexad_datasheet()}) {
    for (int sensor = 0; sensor < datasheet.size; ++sensor) {
      const auto course = make_course(entry, sensor, datasheet, 17);
      ASSERT_TRUE(course) << course.error();
      const auto result = run(*course);
      ASSERT_TRUE(result) << result.error();
      EXPECT_TRUE(result->trusted || entry.from_power_on);
      EXPECT_EQ(judge(*result, datasheet.size == 4 ? entry.four : entry.six), "")
          << entry.id << " on sensor " << sensor + 1 << " of " << datasheet.size;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, CatalogueCourse, testing::Range(0, 29), [](const auto& which) {
  return std::string(catalogue()[static_cast<std::size_t>(which.param)].id);
});

TEST(Course, WithoutAFaultItStaysNominal) {
  for (const Datasheet& datasheet : {paper_datasheet(), hexad_datasheet()}) {
    const auto course = make_course(datasheet, 3);
    ASSERT_TRUE(course);
    const auto result = run(*course);
    ASSERT_TRUE(result);
    EXPECT_TRUE(result->trusted);
    EXPECT_EQ(result->first_doubt_block, -1);
    EXPECT_EQ(result->state, HealthState::nominal);
    EXPECT_TRUE(result->out.empty());
  }
}

TEST(Course, JudgeFindsEachThingThatIsNotAsExpected) {
  CourseResult good;
  good.state = HealthState::isolated;
  good.faulty = good.out = good.excluded = SensorSet::of(1);
  good.first_doubt_block = 2;
  const Outcome outcome = {1, 4, state_bit(HealthState::isolated), AllowedMask::the_faulty, 0.01};
  EXPECT_EQ(judge(good, outcome), "");
  const auto with = [&good](auto change) {
    CourseResult result = good;
    change(result);
    return result;
  };
  EXPECT_NE(judge(with([](auto& r) { r.first_doubt_block = 0; }), outcome), "");
  EXPECT_NE(judge(with([](auto& r) { r.first_doubt_block = 5; }), outcome), "");
  EXPECT_NE(judge(with([](auto& r) { r.first_doubt_block = -1; }), outcome), "");
  EXPECT_NE(judge(with([](auto& r) { r.state = HealthState::nominal; }), outcome), "");
  EXPECT_NE(judge(with([](auto& r) { r.out = r.out.with(2); }), outcome), "");
  EXPECT_NE(judge(with([](auto& r) { r.excluded = SensorSet(); }), outcome), "");
  EXPECT_NE(judge(with([](auto& r) { r.worst_tilt_rad = 0.02; }), outcome), "");
}

/// What is written by hand below the table.
constexpr const char* kByHand = "\n## Magnetometers\n";

std::string text_of(const std::string& path) {
  std::ifstream file(path);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

/// PLUMB_WRITE_PAGES=1 renews the page.
TEST(Catalogue, ThePageIsTheTable) {
  const std::string path = std::string(PLUMB_SOURCE_DIR) + "/docs/fault-catalogue.md";
  const std::string whole = text_of(path);
  const std::size_t by_hand = whole.find(kByHand);
  ASSERT_NE(by_hand, std::string::npos);
  const char* renew = std::getenv("PLUMB_WRITE_PAGES");
  if (renew != nullptr && *renew == '1') std::ofstream(path) << catalogue_page() << whole.substr(by_hand);
  const std::string now = text_of(path);
  EXPECT_EQ(now.substr(0, now.find(kByHand)), catalogue_page())
      << "renew it: PLUMB_WRITE_PAGES=1 and this test once more";
}

/// Every test that the rows of magnetometers and gyros point to exists.
TEST(Catalogue, RowsByHandNameTestsThatExist) {
  const std::string page = text_of(std::string(PLUMB_SOURCE_DIR) + "/docs/fault-catalogue.md");
  const std::string inventory = "\n" + text_of(std::string(PLUMB_SOURCE_DIR) + "/tests/inventory.txt");
  std::istringstream lines(page.substr(page.find(kByHand)));
  const std::regex name("`([A-Z][A-Za-z]+\\.[A-Z][A-Za-z]+)`");
  int rows = 0;
  for (std::string line; std::getline(lines, line);) {
    const bool row = line.rfind("| M", 0) == 0 || line.rfind("| G", 0) == 0;
    const auto first = std::sregex_iterator(line.begin(), line.end(), name), none = std::sregex_iterator();
    EXPECT_TRUE(!row || first != none) << line;
    for (auto found = first; found != none; ++found)
      EXPECT_NE(inventory.find("\n" + (*found)[1].str() + "\n"), std::string::npos) << (*found)[1].str();
    rows += row ? 1 : 0;
  }
  EXPECT_EQ(rows, 21);
}

}  // namespace
}  // namespace catalogue_test
}  // namespace scenario
}  // namespace plumb

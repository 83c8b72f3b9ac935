// plumb inject takes every entry of the fault catalogue, by id and by name, and every word of PX4's.
#include <sstream>
#include <string>
#include <vector>

#include "plumb/scenario/catalogue.hpp"
#include "tool_runner.hpp"

namespace inject_catalogue_test {
namespace {

using namespace plumb_test;

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> out;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) out.push_back(line);
  return out;
}

std::vector<std::string> injecting(const std::string& fault, const char* out) {
  return {"inject", "--array", "array.toml", "--log", "drilling.csv", "--fault", fault, "--out", out};
}

/// A recorded log with a thermometer, and as `plumb inject` writes it with nothing in it.
class Recorded : public Workshop {
 public:
  Recorded() {
    put("array.toml", with(text("array.toml"), "\nunit = ", "\ntemperature = \"temp_degc\"\nunit = "));
    std::string log;
    for (const std::string& line : lines_of(text("drilling.csv")))
      log += line + (log.empty() ? ",temp_degc\n" : ",40\n");
    put("drilling.csv", log);
    EXPECT_EQ(run(*this, injecting("a2:bias=50mg0@1000h", "healthy.csv")).code, 0);
    healthy = lines_of(text("healthy.csv"));
    EXPECT_GT(healthy.size(), 1000U);
  }
  std::vector<std::string> healthy;
};

/// That fault from 12 s on: something changed, and nothing before.
void expect_injected(const Recorded& where, const std::string& word) {
  SCOPED_TRACE(word);
  const Outcome outcome = run(where, injecting("a2:" + word + "@12s", "faulty.csv"));
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_TRUE(outcome.err.empty()) << outcome.err;
  const auto after = lines_of(where.text("faulty.csv"));
  ASSERT_GT(after.size(), 1000U);
  EXPECT_EQ(after.front(), where.healthy.front());
  bool changed = after.size() != where.healthy.size();
  for (std::size_t row = 1; row < std::min(where.healthy.size(), after.size()); ++row) {
    const bool same = after[row] == where.healthy[row];
    changed = changed || !same;
    const bool early = std::stod(where.healthy[row]) < 12.0;
    ASSERT_TRUE(same || !early) << "row " << row << ": " << after[row];
  }
  EXPECT_TRUE(changed);
}

TEST(InjectCatalogue, TakesEveryEntryByIdAndByName) {
  const Recorded where;
  for (const plumb::scenario::CatalogueEntry& entry : plumb::scenario::catalogue()) {
    expect_injected(where, entry.id);
    expect_injected(where, entry.name);
  }
}

TEST(InjectCatalogue, TakesEveryWordOfPx4) {
  const Recorded where;
  for (const plumb::scenario::Px4Alias& alias : plumb::scenario::px4_aliases()) expect_injected(where, alias.word);
}

TEST(InjectCatalogue, RefusesAnEntryThatThereIsNot) {
  const Workshop where;
  const Outcome outcome = run(where, injecting("a2:F30@12s", "faulty.csv"));
  EXPECT_EQ(outcome.code, 2);
  EXPECT_TRUE(says(outcome.err, {"--fault", "F30", "Remedy: ", "fault catalogue"}));
}

TEST(InjectCatalogue, SaysWhereALogHasNoThermometer) {
  const Workshop where;
  const Outcome outcome = run(where, injecting("log:F17@12s", "faulty.csv"));
  EXPECT_EQ(outcome.code, 0);
  EXPECT_TRUE(says(outcome.err, {"--fault", "changed nothing", "no temperature column", "array.toml"}));
}

}  // namespace
}  // namespace inject_catalogue_test

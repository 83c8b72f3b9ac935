// The table that the tool prints against the one that model/specification.pml was written with, cell by cell, actions
// included. The lines read here are the lines that the model checker executes.
#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <sstream>
#include <string>

namespace specification_test {
namespace {

struct Cell {
  std::string kind, target;
  std::set<std::string> actions;
  bool from_motion = false;
  bool operator==(const Cell& o) const {
    return kind == o.kind && target == o.target && actions == o.actions && from_motion == o.from_motion;
  }
};
std::ostream& operator<<(std::ostream& out, const Cell& c) {
  out << c.kind << " -> " << c.target;
  for (const std::string& a : c.actions) out << ", " << a;
  return out << (c.from_motion ? ", also from motion" : "");
}
using Table = std::map<std::string, Cell>;

/// The specification's words and the tool's.
const std::map<std::string, std::string> kWords = {
    {"NOMINAL", "nominal"},
    {"ISOLATED", "isolated"},
    {"SUSPECT", "suspect"},
    {"DEGRADED", "degraded"},
    {"RECALIBRATING", "recalibrating"},
    {"INITIAL", "recalibrating (initial)"},
    {"FAILED", "failed"},
    {"RESET", "reset"},
    {"CHANNEL_LOST", "channel_lost"},
    {"CHANNEL_BACK", "channel_back"},
    {"EXCLUSION", "exclusion"},
    {"PROVISIONAL_EXCLUSION", "provisional_exclusion"},
    {"ISOLATION_TIMEOUT", "isolation_timeout"},
    {"NO_CONSISTENT_HYPOTHESIS", "no_consistent_hypothesis"},
    {"ALARM", "alarm"},
    {"NORM_MISMATCH", "norm_mismatch"},
    {"FIT_ACCEPTED", "fit_accepted"},
    {"FIT_REJECTED", "fit_rejected"},
    {"PROBATION_PASSED", "probation_passed"},
    {"RECALIBRATE", "recalibrate"},
    {"PASSED_BLOCK", "passed_block"},
    {"IGNORED", "ignored"},
    {"HELD", "held"},
    {"TAKEN", "taken"},
    {"IMPOSSIBLE", "impossible"},
    {"STAY", "stay"},
    {"BY_SIZE", "by size"},
    {"BY_SIZE_IF_VALIDATED", "by size (not yet validated: suspect)"},
    {"BY_SIZE_WHEN_PASSED", "by size when enough blocks passed"},
    {"TO_SUSPECT", "suspect"},
    {"SUSPECT_OR_FAILED", "suspect (rank < 3: failed)"},
    {"STAY_OR_FAILED", "stay (rank < 3: failed)"},
    {"BY_PROTECTION", "stay while bounded or isolable, else failed"},
    {"TO_RECALIBRATING", "recalibrating"},
    {"TO_BASE", "by size; from suspect: suspect"},
    {"BY_RESET", "suspect (rank < 3: stay; no calibration: recalibrating (initial))"},
    {"TO_FAILED", "failed"},
    {"EXCLUDE", "exclude"},
    {"PUT_ASIDE", "exclude provisionally"},
    {"MARK_ABSENT", "mark absent"},
    {"MARK_BACK", "mark as back"},
    {"DISCARD_FIT", "discard fit"},
    {"RESTART_FIT", "restart collection"},
    {"ADOPT_FIT", "adopt fit"},
    {"START_FIT", "start fit"},
    {"REINSTATE", "reinstate"},
    {"RETURN_NAMED", "return named sensors"},
    {"EXHAUST", "timed out"},
    {"DISTRUST", "not yet validated"},
    {"COUNT_IT", "count"},
};

std::string word(const std::string& name) {
  const auto found = kWords.find(name);
  return found == kWords.end() ? "unknown word " + name : found->second;
}

Table specified(std::istream& file) {
  const std::regex motion(R"(^  ALSO_FROM_MOTION\((\w+), (\w+)\);)");
  const std::regex line(R"(^\s*CELL\((\w+),\s*(\w+),\s*(\w+),\s*(\w+),\s*([\w |]+)\);)");
  Table table;
  std::string text;
  while (std::getline(file, text)) {
    std::smatch m;
    if (std::regex_search(text, m, motion)) {
      const auto cell = table.find(word(m[1]) + " / " + word(m[2]));
      const bool known = cell != table.end() && !cell->second.from_motion;
      EXPECT_TRUE(known) << "no cell, or written twice: " << text;
      if (known) cell->second.from_motion = true;
    }
    if (!std::regex_search(text, m, line)) continue;
    Cell cell{word(m[3]), word(m[4]), {}, false};
    std::istringstream actions(m[5]);
    for (std::string a; actions >> a;) {
      if (a != "|" && a != "NOTHING") cell.actions.insert(word(a));
    }
    EXPECT_TRUE(table.emplace(word(m[1]) + " / " + word(m[2]), cell).second) << "written twice: " << text;
  }
  return table;
}

Table printed() {
  std::string text;
  FILE* pipe = popen(PLUMB_TOOL_PATH " model --format json", "r");
  if (pipe == nullptr) return {};
  char buffer[4096];
  for (std::size_t got = 0; (got = std::fread(buffer, 1, sizeof buffer, pipe)) > 0;) text.append(buffer, got);
  pclose(pipe);
  Table table;
  const auto model = nlohmann::json::parse(text);
  for (const auto& cell : model.at("cells")) {
    if (cell.at("event") == "none") continue;
    const std::string where = cell.at("mode").get<std::string>() + " / " + cell.at("event").get<std::string>();
    table[where] = {cell.at("kind"), cell.at("target"), cell.at("actions").get<std::set<std::string>>(),
                    cell.at("from_motion")};
  }
  return table;
}

int differences(const Table& a, const Table& b) {
  int n = 0;
  for (const auto& [where, cell] : a) n += b.count(where) == 1 && b.at(where) == cell ? 0 : 1;
  return n;
}

TEST(Specification, IsTheTableThatTheToolPrints) {
  std::ifstream file(std::string(PLUMB_SOURCE_DIR) + "/model/specification.pml");
  const Table spec = specified(file);
  const Table tool = printed();
  ASSERT_EQ(spec.size(), 7U * 14U);
  ASSERT_EQ(tool.size(), 7U * 14U);
  for (const auto& [where, cell] : spec) {
    ASSERT_EQ(tool.count(where), 1U) << where;
    EXPECT_EQ(tool.at(where), cell) << where;
  }
}

TEST(Specification, EveryChangedCellIsNoticed) {
  const Table tool = printed();
  ASSERT_EQ(tool.size(), 7U * 14U);
  for (const auto& [where, cell] : tool) {
    for (int what = 0; what < 4; ++what) {
      Table changed = tool;
      Cell& c = changed[where];
      if (what == 0) c.kind = c.kind == "held" ? "taken" : "held";
      if (what == 3) c.from_motion = !c.from_motion;
      if (what == 1) c.target = c.target == "failed" ? "stay" : "failed";
      if (what == 2 && c.actions.erase("exclude") == 0) c.actions.insert("exclude");
      EXPECT_EQ(differences(tool, changed), 1) << where;
    }
  }
}

}  // namespace
}  // namespace specification_test

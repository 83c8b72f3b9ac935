// plumb demo: what it writes, that it tells the truth about it, and that the same seed gives the same bytes. The tests
// are few and long because each of them runs in a process of its own and needs the whole demo.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "tool_runner.hpp"

namespace demo_test {
namespace {

using namespace plumb_test;
using nlohmann::json;

/// The sections, in the order of the page.
const std::vector<std::string> kSections = {"geometry", "calibration", "gravity-error", "table2", "drill_a", "drill_b"};
const std::vector<std::string> kDrillFiles = {"array.toml",   "stand.toml", "calibration.csv", "calibration.json",
                                              "drill.toml",   "drill.csv",  "events.jsonl",    "verdicts.jsonl",
                                              "timeline.csv", "timeline.gp"};

bool has_gnuplot() { return std::system("command -v gnuplot > /dev/null 2>&1") == 0; }

/// One demo per test process.
const Directory& demo() {
  static const Directory directory;
  static const Outcome outcome = run(directory, {"demo", "--out", "."});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_TRUE(outcome.err.empty() || !has_gnuplot()) << outcome.err;
  EXPECT_LE(std::count(outcome.out.begin(), outcome.out.end(), '\n'), 40) << "short enough to be read";
  return directory;
}

/// All files below, by their path from there; what the test itself keeps is left out.
std::map<std::string, std::string> files_below(const std::filesystem::path& root) {
  std::map<std::string, std::string> out;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(root)) {
    const std::string name = std::filesystem::relative(entry.path(), root).string();
    if (entry.is_regular_file() && name[0] != '.') out[name] = read_text(entry.path());
  }
  return out;
}

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells(1);
  for (const char c : line) {
    if (c == ',') {
      cells.emplace_back();
    } else {
      cells.back() += c;
    }
  }
  return cells;
}

/// The rows of a CSV, each by the names of its columns.
std::vector<std::map<std::string, std::string>> table_of(const std::string& csv) {
  std::istringstream in(csv);
  std::string line;
  std::getline(in, line);
  const std::vector<std::string> head = cells_of(line);
  std::vector<std::map<std::string, std::string>> rows;
  while (std::getline(in, line)) {
    const std::vector<std::string> cells = cells_of(line);
    EXPECT_EQ(cells.size(), head.size()) << line;
    if (cells.size() != head.size()) continue;
    rows.emplace_back();
    for (std::size_t k = 0; k < head.size(); ++k) rows.back()[head[k]] = cells[k];
  }
  return rows;
}

/// "nominal, suspect a2, ...": states and named sensors of a drill, in order.
std::vector<std::string> changes_of(const json& drill) {
  std::vector<std::string> out;
  for (const json& change : drill["changes"]) {
    const auto sensors = change["sensors"].get<std::string>();
    out.push_back(change["to"].get<std::string>() + (sensors == "-" ? "" : " " + sensors));
  }
  return out;
}

// ---- what one run must hold ----------------------------------------------------------------------

void states_come_in_order(const json& sections) {
  EXPECT_EQ(changes_of(sections["drill_a"]),
            (std::vector<std::string>{"suspect", "nominal", "suspect", "degraded a2", "suspect", "failed", "suspect a2",
                                      "suspect", "suspect a3", "degraded"}));
  EXPECT_EQ(changes_of(sections["drill_b"]),
            (std::vector<std::string>{"suspect", "nominal", "suspect a2", "isolated", "isolated a2",
                                      "recalibrating a1, a3, a4, a5, a6", "suspect a1, a3, a4, a5, a6", "isolated",
                                      "suspect a5", "isolated", "isolated a5", "isolated a2"}));
  const json& host = sections["drill_a"]["host"];
  ASSERT_EQ(host.size(), 2U);
  EXPECT_EQ(host[0]["refused"], "the reset key does not match");
  EXPECT_TRUE(host[1]["refused"].is_null());
}

/// The figures that page and JSON tell are those of the CSV, and plumb stays within its word in every block.
void drill_stays_within_its_word(const Directory& where, const std::string& id, const json& facts) {
  const auto rows = table_of(read_text(where.path() / id / "timeline.csv"));
  double published_deg = 0.0, plain_deg = 0.0;
  int published = 0, bounded = 0;
  for (const auto& row : rows) {
    const double error_deg = std::abs(std::stod(row.at("error_plumb_deg")));
    plain_deg = std::max(plain_deg, std::abs(std::stod(row.at("error_plain_deg"))));
    const bool valid = row.at("output") == "valid";
    if (valid || row.at("output") == "degraded") {
      ++published;
      published_deg = std::max(published_deg, error_deg);
      EXPECT_LT(error_deg, 0.05) << id << " at " << row.at("t_s");
    }
    EXPECT_TRUE(!valid || !row.at("protection_level_deg").empty()) << id << " at " << row.at("t_s");
    if (row.at("protection_level_deg").empty()) continue;
    ++bounded;
    EXPECT_LE(error_deg, std::stod(row.at("protection_level_deg"))) << id << " at " << row.at("t_s");
  }
  EXPECT_GT(bounded, 40);
  EXPECT_GT(published, 40);
  EXPECT_EQ(facts["blocks"], rows.size());
  EXPECT_EQ(facts["blocks_valid_or_degraded"], published);
  EXPECT_EQ(facts["blocks_bounded"], bounded);
  EXPECT_EQ(facts["blocks_within_bound"], bounded);
  EXPECT_NEAR(facts["worst_inclination_error_valid_or_degraded_deg"].get<double>(), published_deg, 1e-12);
  EXPECT_NEAR(facts["worst_inclination_error_without_plumb_deg"].get<double>(), plain_deg, 1e-12);
  EXPECT_GT(plain_deg, 5.0) << "the faults would have hurt";
}

void page_tells_what_happened(const std::string& page) {
  EXPECT_EQ(page.find("http"), std::string::npos) << "nothing is loaded from the network, nor pretends to be";
  EXPECT_EQ(page.find("<script"), page.rfind("<script")) << "the one of the charts";
  EXPECT_LT(page.find("<section id=\"result\""), page.find("<section id=\"geometry\"")) << "it opens with its result";
  EXPECT_EQ(page.find("{{"), std::string::npos) << "every placeholder is filled";
  for (const std::string& id : kSections) {
    EXPECT_NE(page.find("href=\"#" + id + "\""), std::string::npos) << id;
    EXPECT_NE(page.find("<section id=\"" + id + "\""), std::string::npos) << id;
  }
  EXPECT_TRUE(says(
      page, {"At 15.00 s a sensor fails: a2 is stuck at 0 V", "the alarm: the sensors disagree with one another",
             "a2 is excluded. This is correct: it is faulty.", "a3 is stuck at 3 V", "isolation timeout has expired",
             "The request is refused: the reset key does not match", "The request is granted", "a3 is excluded",
             "within the protection level in", "plumb simulate stand.toml"}));
  EXPECT_TRUE(says(page, {"id=\"drill_b\"", "a2 reads 50 mg0 too high", "a2 is provisionally excluded",
                          "a2 is excluded", "recalibration begins", "new coefficients are accepted", "a5 is excluded",
                          "a2 has agreed with the others"}));
}

/// How wrong without plumb in red, how wrong with it in green, of both drills.
void page_opens_with_the_result(const std::string& page, const json& sections) {
  const std::size_t begin = page.find("<section id=\"result\"");
  ASSERT_NE(begin, std::string::npos);
  const std::string result = page.substr(begin, page.find("</section>", begin) - begin);
  for (const char* id : {"drill_a", "drill_b"}) {
    const double without_deg = sections[id]["worst_inclination_error_without_plumb_deg"],
                 with_deg = sections[id]["worst_inclination_error_valid_or_degraded_deg"];
    EXPECT_TRUE(says(result, {fmt::format("<div class=\"card bad\"><b>{:.2g}°</b>", without_deg),
                              fmt::format("<div class=\"card good\"><b>{:.2g}°</b>", with_deg)}));
    EXPECT_GT(without_deg, 100.0 * with_deg);
  }
}

/// No name inside a picture may be there twice: the page is one document.
void page_has_every_id_once(const std::string& page) {
  std::set<std::string> seen;
  for (std::size_t at = page.find(" id="); at != std::string::npos; at = page.find(" id=", at + 4)) {
    const std::size_t end = page.find(page[at + 4], at + 5);
    const std::string id = page.substr(at + 5, end - at - 5);
    EXPECT_TRUE(seen.insert(id).second) << id;
  }
  EXPECT_GT(seen.size(), kSections.size());
}

void every_file_is_linked_and_every_link_leads_to_a_file(const Directory& where, const std::string& page) {
  std::set<std::string> linked;
  const std::string link = "<a href=\"";
  for (std::size_t at = page.find(link); at != std::string::npos; at = page.find(link, at + 1)) {
    const std::size_t begin = at + link.size();
    const std::string name = page.substr(begin, page.find('"', begin) - begin);
    if (name[0] != '#') linked.insert(name);
  }
  for (const auto& [name, text] : files_below(where.path())) {
    const bool own = name == "index.html" || name == "demo.json";
    EXPECT_TRUE(own || linked.count(name) == 1) << name << " is not linked";
    EXPECT_FALSE(text.empty()) << name;
    EXPECT_EQ(text.find(where.path().string()), std::string::npos) << name << " holds a path of this machine";
  }
  for (const std::string& name : linked) {
    EXPECT_TRUE(std::filesystem::exists(where.path() / name)) << name << " is linked and not there";
  }
  for (const std::string& id : {std::string("drill_a"), std::string("drill_b")}) {
    for (const std::string& name : kDrillFiles) EXPECT_EQ(linked.count(id + "/" + name), 1U) << id << "/" << name;
  }
}

/// Runs the commands of the page, as printed, where only the scenarios and the array file are.
void commands_give_the_same_bytes(const std::string& id, const json& facts) {
  const Directory where;
  std::filesystem::create_directory(where.path() / id);
  for (const char* name : {"array.toml", "stand.toml", "drill.toml", "timeline.gp", "timeline.csv"}) {
    std::filesystem::copy_file(demo().path() / id / name, where.path() / id / name);
  }
  std::string script = "set -e\nplumb() { '" PLUMB_TOOL_PATH "' \"$@\"; }\n";
  for (const json& command : facts["commands"]) {
    const auto text = command.get<std::string>();
    if (has_gnuplot() || text.find("gnuplot") != 0) script += text + "\n";
  }
  write_text(where / "script", script);
  const std::string shell = "cd '" + where.path().string() + "' && sh script > out 2> err";
  EXPECT_EQ(std::system(shell.c_str()), 0) << script << read_text(where / "err");
  for (const auto& [name, text] : files_below(where.path() / id)) {
    EXPECT_TRUE(text == read_text(demo().path() / id / name)) << id << "/" << name;
  }
  EXPECT_GE(files_below(where.path() / id).size(), kDrillFiles.size());
}

TEST(Demo, ReportsWhatTheMonitorDid) {
  const json facts = json::parse(read_text(demo() / "demo.json"));
  EXPECT_EQ(facts["seed"], 1);
  EXPECT_FALSE(facts["version"].get<std::string>().empty());
  std::vector<std::string> ids;
  const auto ordered = nlohmann::ordered_json::parse(read_text(demo() / "demo.json"));
  for (const auto& section : ordered["sections"].items()) ids.push_back(section.key());
  EXPECT_EQ(ids, kSections);
  states_come_in_order(facts["sections"]);
  for (const char* id : {"drill_a", "drill_b"}) {
    drill_stays_within_its_word(demo(), id, facts["sections"][id]);
    commands_give_the_same_bytes(id, facts["sections"][id]);
  }
  const std::string page = read_text(demo() / "index.html");
  page_tells_what_happened(page);
  page_opens_with_the_result(page, facts["sections"]);
  page_has_every_id_once(page);
  every_file_is_linked_and_every_link_leads_to_a_file(demo(), page);
  EXPECT_EQ(page.find("<svg") != std::string::npos, has_gnuplot());
}

TEST(Demo, SameSeedSameBytesWhereverItIsRun) {
  const Directory other;
  ASSERT_EQ(run(other, {"demo", "--out", "deeper/down"}).code, 0);
  const auto here = files_below(demo().path());
  const auto there = files_below(other.path() / "deeper/down");
  ASSERT_EQ(here.size(), there.size());
  for (const auto& [name, text] : here) EXPECT_TRUE(text == there.at(name)) << name << " differs between two runs";
}

TEST(Demo, AnotherSeedIsAnotherToolAndNeedsNoGnuplot) {
  const Directory other;
  const Outcome outcome = run(other, {"demo", "--out", ".", "--seed", "2"}, "", {"PATH=/nonexistent"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_TRUE(says(outcome.err, {"gnuplot", "not installed", "apt-get install gnuplot"}));
  EXPECT_EQ(outcome.err.find("not installed"), outcome.err.rfind("not installed")) << "said once";
  const std::string page = read_text(other / "index.html");
  EXPECT_TRUE(says(page, {"There is no picture", "gnuplot"}));
  every_file_is_linked_and_every_link_leads_to_a_file(other, page);
  EXPECT_FALSE(std::filesystem::exists(other / "drill_a/timeline.svg"));
  for (const char* id : {"drill_a", "drill_b"}) {
    EXPECT_EQ(read_text(demo().path() / id / "array.toml"), read_text(other.path() / id / "array.toml"));
    for (const std::string& name : kDrillFiles) {
      const std::string text = read_text(other.path() / id / name);
      EXPECT_FALSE(text.empty()) << id << "/" << name;
      const bool seeded = name != "array.toml" && name != "timeline.gp";
      EXPECT_TRUE(!seeded || text != read_text(demo().path() / id / name)) << id << "/" << name;
    }
  }
  const json facts = json::parse(read_text(other / "demo.json"));
  EXPECT_EQ(facts["seed"], 2);
  states_come_in_order(facts["sections"]);
}

TEST(Demo, RefusesASeedThatIsNoSeed) {
  const Directory where;
  for (const char* seed : {"-1", "1.5", "x", "18446744073709551616"}) {
    const Outcome outcome = run(where, {"demo", "--out", "here", "--seed", seed});
    EXPECT_EQ(outcome.code, 2) << seed << outcome.err;
    EXPECT_FALSE(std::filesystem::exists(where / "here"));
  }
  EXPECT_TRUE(says(run(where, {"demo", "--seed", "-1"}).err, {"--seed", "whole number from 0 to 2^64 - 1"}));
}

}  // namespace
}  // namespace demo_test

// Requirements and tests of this repository name each other; and the check itself can fail.
#include <gtest/gtest.h>

#include "trace/audit.hpp"

namespace trace_test {
namespace {

using namespace trace;

std::string joined(const Findings& findings) {
  std::string out;
  for (const std::string& line : findings) out += line + "\n";
  return out;
}

const Evidence& repository() {
  static const Evidence evidence = [] {
    Findings findings;
    Evidence out = read_repository(PLUMB_SOURCE_DIR, findings);
    EXPECT_TRUE(findings.empty()) << joined(findings);
    return out;
  }();
  return evidence;
}

/// Expects a finding with all the words in it.
void expect_finding(const Evidence& broken, const std::vector<std::string>& words) {
  const Findings findings = audit(broken);
  const bool found = std::any_of(findings.begin(), findings.end(), [&words](const std::string& line) {
    return std::all_of(words.begin(), words.end(),
                       [&line](const std::string& w) { return line.find(w) != std::string::npos; });
  });
  EXPECT_TRUE(found) << "expected \"" << words[0] << "\" among:\n" << joined(findings);
}

Node& named(Evidence& evidence, const std::string& uid) {
  const auto found = std::find_if(evidence.requirements.begin(), evidence.requirements.end(),
                                  [&uid](const Node& n) { return n.get("UID") == uid; });
  EXPECT_NE(found, evidence.requirements.end());
  return *found;
}

void erase_tag(std::vector<std::string>& list, const std::string& uid) {
  list.erase(std::remove(list.begin(), list.end(), uid), list.end());
}

// Verifies: REQ-182
TEST(Trace, EveryRequirementAndEveryTestNameEachOther) {
  EXPECT_GE(repository().requirements.size(), 60U);
  EXPECT_GE(repository().tests.size(), 200U);
  const Findings findings = audit(repository());
  EXPECT_TRUE(findings.empty()) << joined(findings);
}

// Verifies: REQ-182
TEST(Trace, TheCountsOfTheReadmeAreThoseOfTheFiles) {
  Findings findings;
  const std::string text = content_of(std::string(PLUMB_SOURCE_DIR) + "/docs/requirements/README.md", findings);
  static const std::regex row(R"(^\| REQ-(\d{3}) to REQ-(\d{3}) \| [^|]+ \| (\d+) \| (\d+) \|$)");
  std::size_t rows = 0, counted = 0;
  for (const std::string& line : lines_of(text)) {
    std::smatch m;
    if (!std::regex_match(line, m, row)) continue;
    ++rows;
    std::map<std::string, int> count;
    for (const Node& node : repository().requirements) {
      const std::string number = node.get("UID").substr(4);
      if (number >= m[1].str() && number <= m[2].str()) ++count[node.get("STATUS")];
    }
    EXPECT_EQ(count["active"], std::stoi(m[3].str())) << line;
    EXPECT_EQ(count["open"], std::stoi(m[4].str())) << line;
    counted += static_cast<std::size_t>(count["active"] + count["open"]);
  }
  EXPECT_GT(rows, 5U);
  EXPECT_EQ(counted, repository().requirements.size()) << "the ranges of the table cover every id once";
}

// Negative: REQ-182
TEST(TraceCheck, ReportsATagThatWasTakenAway) {
  for (const char* uid : {"REQ-071", "REQ-140"}) {
    Evidence broken = repository();
    for (TaggedTest& test : broken.tests) erase_tag(test.negative, uid);
    expect_finding(broken, {uid, "has no negative test"});
    broken = repository();
    for (TaggedTest& test : broken.tests) erase_tag(test.verifies, uid);
    expect_finding(broken, {uid, "has no test that verifies it"});
  }
}

// Negative: REQ-182
TEST(TraceCheck, ReportsOneTestForBoth) {
  Evidence broken = repository();
  for (TaggedTest& test : broken.tests) {
    erase_tag(test.negative, "REQ-071");
    erase_tag(test.verifies, "REQ-071");
  }
  broken.tests.front().negative.push_back("REQ-071");
  broken.tests.front().verifies.push_back("REQ-071");
  expect_finding(broken, {"REQ-071", "one test for both"});
}

// Negative: REQ-182
TEST(TraceCheck, ReportsAnIdThatIsGoneUnknownOrTwice) {
  Evidence broken = repository();
  broken.requirements.erase(broken.requirements.begin());
  expect_finding(broken, {"names " + repository().requirements.front().get("UID"), "unknown"});
  broken = repository();
  broken.tests.front().verifies.push_back("REQ-999");
  expect_finding(broken, {"names REQ-999", "unknown"});
  broken = repository();
  broken.requirements.push_back(broken.requirements.front());
  expect_finding(broken, {repository().requirements.front().get("UID"), "given twice"});
  named(broken, "REQ-071").field["UID"] = "REQ-71";
  expect_finding(broken, {"REQ-71", "is no id"});
}

// Negative: REQ-182
TEST(TraceCheck, ReportsWhatARequirementLacks) {
  for (const char* name : {"RATIONALE", "METHOD", "STATEMENT"}) {
    Evidence broken = repository();
    named(broken, "REQ-071").field.erase(name);
    expect_finding(broken, {"REQ-071", "has no", name});
  }
  Evidence broken = repository();
  named(broken, "REQ-071").parents.clear();
  expect_finding(broken, {"REQ-071", "answers no hazard"});
  named(broken, "REQ-071").parents = {"HAZ-77"};
  expect_finding(broken, {"REQ-071", "HAZ-77", "unknown"});
  named(broken, "REQ-071").field["STATEMENT"] = "The monitor is nice.";
  expect_finding(broken, {"REQ-071", "EARS"});
  named(broken, "REQ-071").field["METHOD"] = "proof";
  expect_finding(broken, {"REQ-071", "claims the method proof"});
  broken = repository();
  for (Node& node : broken.requirements)
    node.parents.erase(std::remove(node.parents.begin(), node.parents.end(), "HAZ-07"), node.parents.end());
  expect_finding(broken, {"HAZ-07", "answered by no requirement"});
}

// Negative: REQ-182
TEST(TraceCheck, ReportsATestOfASafetyModuleWithoutAnId) {
  Evidence broken = repository();
  TaggedTest orphan;
  orphan.name = "Orphan.HasNoTag";
  orphan.room = "health";
  broken.tests.push_back(orphan);
  expect_finding(broken, {"Orphan.HasNoTag", "names no requirement"});
  broken.tests.back().serves = {"REQ-071"};
  EXPECT_EQ(audit(broken).size(), 0U);
  broken.tests.back() = orphan;
  broken.tests.back().room = "cellar";
  expect_finding(broken, {"tests/cellar", "rooms.txt"});
}

// Negative: REQ-182
TEST(TraceCheck, AnOpenRequirementNeedsNoTestYet) {
  Evidence copy = repository();
  for (TaggedTest& test : copy.tests) {
    erase_tag(test.negative, "REQ-071");
    erase_tag(test.verifies, "REQ-071");
    test.serves.push_back("REQ-071");
  }
  EXPECT_FALSE(audit(copy).empty());
  named(copy, "REQ-071").field["STATUS"] = "open";
  EXPECT_TRUE(audit(copy).empty()) << joined(audit(copy));
}

// Negative: REQ-182
TEST(TraceCheck, ReadsWhatStrictDocReadsAndNothingElse) {
  Findings none;
  const std::string good = content_of(std::string(PLUMB_SOURCE_DIR) + "/docs/requirements/detection.sdoc", none);
  const auto findings_of = [&good](const std::string& from, const std::string& to) {
    std::string text = good;
    const auto at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    text.replace(at, from.size(), to);
    Findings findings;
    SdocReader("copy.sdoc", text, findings).nodes();
    return findings;
  };
  EXPECT_TRUE(findings_of("REQ-050", "REQ-050").empty());
  EXPECT_FALSE(findings_of("STATUS: active\n", "").empty()) << "a required field is gone";
  EXPECT_FALSE(findings_of("STATUS: active", "STATUS: maybe").empty()) << "no such choice";
  EXPECT_FALSE(findings_of("METHOD: test", "METHOD: hope").empty());
  EXPECT_FALSE(findings_of("UID: REQ-050\nSTATUS: active", "STATUS: active\nUID: REQ-050").empty()) << "order";
  EXPECT_FALSE(findings_of("<<<\n", "").empty()) << "an open block";
  EXPECT_FALSE(findings_of("[GRAMMAR]\n", "").empty());
  EXPECT_FALSE(findings_of("\n[REQUIREMENT]", "[REQUIREMENT]").empty()) << "a blank line between nodes";
}

// Negative: REQ-182
TEST(TraceCheck, ATagBelongsToTheTestDirectlyBelowIt) {
  const std::string tag = std::string("// ") + "Verifies: REQ-001, REQ-002\n";
  const std::string test = std::string("TE") + "ST(A, B) {\n}\n";
  Findings findings;
  const auto scanned = [&findings](const std::string& text) {
    findings.clear();
    return TagScanner("x_test.cpp", "room", findings).cpp(text);
  };
  auto tests = scanned(tag + "/// More words.\n" + test);
  ASSERT_EQ(tests.size(), 1U);
  EXPECT_EQ(tests[0].name, "A.B");
  EXPECT_EQ(tests[0].verifies, (std::vector<std::string>{"REQ-001", "REQ-002"}));
  EXPECT_TRUE(findings.empty());
  tests = scanned(tag + "\n" + test);
  EXPECT_TRUE(tests[0].verifies.empty());
  EXPECT_EQ(findings.size(), 1U) << "a tag above a blank line is lost, and that is said";
  tests = scanned(std::string("// ") + "Serves: REQ-003\n\n" + test);
  EXPECT_EQ(tests[0].serves, std::vector<std::string>{"REQ-003"});
}

}  // namespace
}  // namespace trace_test

// Which requirement is checked by what, which test checks what, and what hangs in the air.
#include <algorithm>
#include <set>

#include "plumb/io/json_fields.hpp"
#include "plumb/render/traceability.hpp"
#include "plumb/render/verdict_section.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {
namespace {

using verification::RequirementCounts;

const char* word(TestResult result) {
  switch (result) {
    case TestResult::passed: return "passed";
    case TestResult::failed: return "failed";
    case TestResult::not_run: return "not run";
  }
  return "?";
}

bool holds_text(const Json& list, const std::string& text) {
  return std::any_of(list.begin(), list.end(), [&text](const Json& item) { return item == text; });
}

/// All that stands behind one requirement, and how many of it passed, failed, or is not known.
class Requirement {
 public:
  Requirement(const Json& node, const Json& trace, const std::optional<TestResults>& tests,
              const std::optional<AssuranceResults>& assurance)
      : id_(node.value("id", "")),
        hazards_(node.value("hazards", Json::array())),
        active_(node["status"] == "active"),
        tests_(tests),
        assurance_(assurance) {
    out_ = io::object({{"id", id_},
                       {"title", node["title"]},
                       {"status", node["status"]},
                       {"methods", node["methods"]},
                       {"statement", node["statement"]},
                       {"hazards", hazards_}});
    Json verifying = Json::array(), negative = Json::array();
    for (const Json& test : trace["tests"]) {
      if (holds_text(test["verifies"], id_)) add_test(test, verifying);
      if (holds_text(test["negative"], id_)) add_test(test, negative);
    }
    out_["design"] = design_;
    tested_ = !verifying.empty();
    refused_ = !negative.empty();
    out_["tests"] = std::move(verifying);
    out_["negative_tests"] = std::move(negative);
    out_["properties"] = Json::array();
    out_["formal"] = Json::array();
    for (const Json& row : trace["assurance"]) {
      if (holds_text(row["requirements"], id_)) add_row(row);
    }
    for (const verification::RequirementCount& count : verification::kRequirementCounts) {
      if (count.value == result()) out_["result"] = count.key;
    }
  }

  const std::string& id() const { return id_; }
  const Json& hazards() const { return hazards_; }
  bool active() const { return active_; }
  bool tested() const { return tested_; }
  bool refused() const { return refused_; }
  const Json& json() const { return out_; }

  /// Where it counts: "open" is what is decided and not built, or did not run; "traced" what names its tests and has no
  /// results.
  int RequirementCounts::*result() const {
    if (failed_ > 0) return &RequirementCounts::failed;
    if (!active_ || !tested_ || !refused_) return &RequirementCounts::open;
    if (!tests_) return &RequirementCounts::traced;
    return open_ > 0 ? &RequirementCounts::open : &RequirementCounts::verified;
  }

 private:
  void add_test(const Json& test, Json& list) {
    const std::string name = test["name"];
    Json result;
    if (tests_) {
      const auto found = tests_->find(name);
      const TestResult is = found == tests_->end() ? TestResult::not_run : found->second;
      result = word(is);
      failed_ += is == TestResult::failed ? 1 : 0;
      open_ += is == TestResult::not_run ? 1 : 0;
    }
    list.push_back(io::object({{"name", name},
                               {"kind", test["kind"]},
                               {"file", test["file"]},
                               {"line", test.value("line", 0)},
                               {"result", result}}));
    for (const Json& source : test["sources"]) {
      if (!holds_text(design_, source)) design_.push_back(source);
    }
  }

  void add_row(const Json& row) {
    if (row.value("about", Json()).is_string()) out_["properties"].push_back(row["about"]);
    for (const Json& item : row.value("items", Json::array())) {
      const std::string name = item.value("name", "");
      if (!seen_.insert(name).second) continue;
      Json one = io::object({{"name", name}, {"tool", item.value("tool", "")}, {"result", Json()}});
      const auto found =
          assurance_ ? assurance_->item.find(name) : std::map<std::string, AssuranceResults::Item>::const_iterator{};
      if (assurance_ && found != assurance_->item.end()) {
        one["result"] = found->second.holds ? "holds" : "fails";
        failed_ += found->second.holds ? 0 : 1;
      } else if (assurance_) {
        one["result"] = "not run";
      }
      out_["formal"].push_back(std::move(one));
    }
  }

  std::string id_;
  Json hazards_;
  bool active_, tested_ = false, refused_ = false;  ///< refused: has a negative test
  const std::optional<TestResults>& tests_;
  const std::optional<AssuranceResults>& assurance_;
  Json out_, design_ = Json::array();
  std::set<std::string> seen_;
  int failed_ = 0, open_ = 0;
};

std::set<std::string> ids_of(const Json& nodes) {
  std::set<std::string> out;
  for (const Json& node : nodes) out.insert(node.value("id", ""));
  return out;
}

/// Every end of every link that meets nothing.
std::vector<std::string> orphans_of(const Json& trace, const std::vector<Requirement>& requirements) {
  std::vector<std::string> out;
  const std::set<std::string> known = ids_of(trace["requirements"]), hazards = ids_of(trace["hazards"]);
  std::set<std::string> answered;
  for (const Requirement& r : requirements) {
    if (r.hazards().empty()) out.push_back(r.id() + " answers no hazard");
    for (const Json& hazard : r.hazards()) {
      answered.insert(hazard);
      if (hazards.count(hazard) == 0)
        out.push_back(r.id() + " answers " + hazard.get<std::string>() + ", which is unknown");
    }
    if (!r.active()) continue;
    if (!r.tested()) out.push_back(r.id() + " has no test that verifies it");
    if (!r.refused()) out.push_back(r.id() + " has no negative test");
  }
  for (const std::string& hazard : hazards) {
    if (answered.count(hazard) == 0) out.push_back(hazard + " is answered by no requirement");
  }
  for (const Json& test : trace["tests"]) {
    for (const char* list : {"verifies", "negative"}) {
      for (const Json& id : test[list]) {
        if (known.count(id) == 0)
          out.push_back(test["name"].get<std::string>() + " names " + id.get<std::string>() + ", which is unknown");
      }
    }
  }
  for (const Json& row : trace["assurance"]) {
    for (const Json& id : row["requirements"]) {
      if (known.count(id) == 0)
        out.push_back("docs/assurance.md names " + id.get<std::string>() + ", which is unknown");
    }
  }
  for (const Json& finding : trace.value("findings", Json::array())) out.push_back(finding);
  return out;
}

/// The way back: hazard -> requirements, test -> requirements.
Json hazards_of(const Json& trace, const std::vector<Requirement>& requirements) {
  Json out = Json::array();
  for (const Json& hazard : trace["hazards"]) {
    Json answered = Json::array();
    for (const Requirement& r : requirements) {
      if (holds_text(r.hazards(), hazard.value("id", ""))) answered.push_back(r.id());
    }
    out.push_back(io::object({{"id", hazard["id"]},
                              {"title", hazard["title"]},
                              {"statement", hazard.value("statement", "")},
                              {"requirements", std::move(answered)}}));
  }
  return out;
}

Json tests_of(const Json& trace, const std::optional<TestResults>& results) {
  Json out = Json::array();
  for (const Json& test : trace["tests"]) {
    Json result;
    if (results) {
      const auto found = results->find(test["name"]);
      result = word(found == results->end() ? TestResult::not_run : found->second);
    }
    out.push_back(io::object({{"name", test["name"]},
                              {"file", test["file"]},
                              {"verifies", test["verifies"]},
                              {"negative", test["negative"]},
                              {"result", result}}));
  }
  return out;
}

}  // namespace

Traceability traceability_section(const Json& trace, const std::optional<TestResults>& tests,
                                  const std::optional<AssuranceResults>& assurance) {
  Traceability out;
  verification::TraceFacts& facts = out.facts;
  std::vector<Requirement> requirements;
  Json written = Json::array();
  for (const Json& node : trace["requirements"]) {
    const Requirement& one = requirements.emplace_back(node, trace, tests, assurance);
    ++facts.counts.requirements;
    facts.counts.active += one.active() ? 1 : 0;
    ++(facts.counts.*one.result());
    written.push_back(one.json());
  }
  facts.counts.hazards = static_cast<int>(trace["hazards"].size());
  facts.counts.tests = static_cast<int>(trace["tests"].size());
  facts.orphans = orphans_of(trace, requirements);
  facts.tests_given = tests.has_value();
  Json formal = Json::array();
  if (assurance) {
    facts.proofs.emplace();
    for (const auto& [name, item] : assurance->item) {
      if (!item.listed) continue;
      facts.proofs->push_back({item.title, item.holds});
      formal.push_back(io::object({{"item", name},
                                   {"title", item.title},
                                   {"kind", item.kind},
                                   {"tool", item.tool + " " + item.version},
                                   {"figure", item.figure},
                                   {"seconds", item.seconds},
                                   {"result", item.holds ? "holds" : "fails"}}));
    }
  }
  out.section["counts"] = counts_json(facts.counts);
  out.section["test_results"] =
      tests ? io::object({{"given", true}, {"tests", tests->size()}})
            : io::object({{"given", false}, {"how", "--test-results results.xml, from ctest --output-junit"}});
  out.section["assurance_results"] =
      assurance ? io::object({{"given", true},
                              {"version", assurance->version},
                              {"complete", assurance->complete},
                              {"items", formal}})
                : io::object({{"given", false}, {"how", "--assurance build/assure/results.json, from scripts/assure"}});
  out.section["orphans"] = facts.orphans;
  out.section["hazards"] = hazards_of(trace, requirements);
  out.section["requirements"] = std::move(written);
  out.section["tests"] = tests_of(trace, tests);
  return out;
}

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb

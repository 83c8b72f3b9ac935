// Fit is said only with the evidence of this very build: each thing that is false or missing is planted, alone.
#include <fmt/format.h>

#include "plumb/render/identity.hpp"
#include "render/verify_support.hpp"

namespace verify_evidence_test {
namespace {

using namespace plumb_test;

/// The examples with a calibration at known attitudes, and results as the scripts write them, all passed.
class Evidence : public Workshop {
 public:
  Evidence() {
    const Outcome made = run(*this, {"calibrate", "--array", "array.toml", "--log", "calibration.csv", "--out",
                                     "known.json", "--known-attitude", kKnownStation});
    EXPECT_EQ(made.code, 0) << made.err;
    const Outcome traced = verify(*this, {"--array", "array.toml", "--out", "first"}, "50");
    EXPECT_EQ(traced.code, 6);
    trace = Json::parse(read_text(*this / "first" / "traceability.json"));
    build = report_in(*this / "first")["identity"]["build"];
    put("tests.xml", junit(build["commit"], build["compiler"], build["flags"]));
    put("proofs.json", proofs(build["commit"]));
  }

  std::string junit(const std::string& commit, const std::string& compiler, const std::string& flags,
                    const std::string& failed = "", const std::string& left_out = "") const {
    std::string out = "<testsuite><properties>";
    out += fmt::format("<property name=\"plumb.commit\" value=\"{}\"/><property name=\"plumb.compiler\" value=\"{}\"/>",
                       commit, compiler);
    out += fmt::format("<property name=\"plumb.flags\" value=\"{}\"/></properties>", flags);
    for (const Json& test : trace["tests"]) {
      const std::string name = test["name"];
      if (name == left_out) continue;
      const bool fails = name == failed;
      out += fmt::format("<testcase name=\"{}\" status=\"{}\">{}</testcase>", name, fails ? "fail" : "run",
                         fails ? "<failure/>" : "");
    }
    return out + "</testsuite>";
  }

  std::string proofs(const std::string& commit, bool holds = true, bool complete = true) const {
    Json items = Json::array();
    items.push_back({{"item", "spin"}, {"title", "Spin"}, {"result", holds ? "holds" : "fails"}});
    return Json{{"schema", 2}, {"version", commit}, {"complete", complete}, {"items", items}}.dump();
  }

  Outcome judged(const std::vector<std::string>& options) const {
    std::vector<std::string> all = {"--array", "array.toml", "--out", "r"};
    all.insert(all.end(), options.begin(), options.end());
    return verify(*this, all, "50");
  }
  std::vector<std::string> all() const {
    return {"--calibration", "known.json", "--test-results", "tests.xml", "--assurance", "proofs.json"};
  }
  std::string verdict() const { return report_in(*this / "r")["verdict"]["verdict"]; }

  Json trace, build;
};

/// A commit that names its sources; else no result is evidence of them, and that is said.
bool is_clean(const std::string& commit) { return commit != "unknown" && commit.find("-dirty") == std::string::npos; }

// Verifies: REQ-185
TEST(VerifyEvidence, IsFitWithAllOfIt) {
  const Evidence where;
  const std::string commit = where.build["commit"];
  const Outcome outcome = where.judged(where.all());
  if (!is_clean(commit)) {
    EXPECT_EQ(outcome.code, 6);
    EXPECT_TRUE(says(outcome.out, {"fit, evidence incomplete", commit, "names no sources", "clean checkout"}));
    GTEST_SKIP() << "this build is of \"" << commit << "\": only one of a clean checkout can be called fit";
  }
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_TRUE(says(outcome.out, {"is fit for purpose"}));
  EXPECT_EQ(where.verdict(), "fit");
  const Json report = report_in(where / "r");
  EXPECT_EQ(report["verdict"]["requirements"]["verified"], report["verdict"]["requirements"]["active"]);
  int hashed = 0;
  for (const Json& input : report["identity"]["inputs"])
    hashed += input["role"] == "test results" || input["role"] == "assurance results" ? 1 : 0;
  EXPECT_EQ(hashed, 2);
  EXPECT_EQ(read_text(where / "r" / "argument.svg").find("examination of the build"), std::string::npos)
      << "a branch that nothing was judged for stands under no green goal";
}

/// Each false or missing statement, one at a time: none of them may end with 0.
// Negative: REQ-185
TEST(VerifyEvidence, EachThatIsMissingOrFalseEndsWithAnotherCodeThanZero) {
  const Evidence where;
  const std::string commit = where.build["commit"], compiler = where.build["compiler"], flags = where.build["flags"];
  const std::string verifying = where.trace["tests"][0]["name"];
  struct Case {
    const char* what;
    std::string tests, proofs;
    const char* words;
  };
  const std::string tests = where.junit(commit, compiler, flags), proofs = where.proofs(commit);
  const std::vector<Case> cases = {
      {"no results of tests", "", proofs, "--test-results"},
      {"no proofs", tests, "", "--assurance"},
      {"tests of another commit", where.junit("0123456789ab", compiler, flags), proofs, "commit \"0123456789ab\""},
      {"tests of another compiler", where.junit(commit, "cc 1.0", flags), proofs, "compiler \"cc 1.0\""},
      {"tests of other flags", where.junit(commit, compiler, "-O9"), proofs, "flags \"-O9\""},
      {"tests of an unnamed build", where.junit("", "", ""), proofs, "do not say of which build"},
      {"proofs of another commit", tests, where.proofs("0123456789ab"), "commit \"0123456789ab\""},
      {"half of the proofs", tests, where.proofs(commit, true, false), "not complete"},
      {"a proof that fails", tests, where.proofs(commit, false), "fails"},
      {"a test that failed", where.junit(commit, compiler, flags, verifying), proofs, "failed"},
      {"a test that did not run", where.junit(commit, compiler, flags, "", verifying), proofs, "did not run"}};
  for (const Case& c : cases) {
    std::vector<std::string> options = {"--calibration", "known.json"};
    if (!c.tests.empty()) {
      where.put("t.xml", c.tests);
      options.insert(options.end(), {"--test-results", "t.xml"});
    }
    if (!c.proofs.empty()) {
      where.put("p.json", c.proofs);
      options.insert(options.end(), {"--assurance", "p.json"});
    }
    const Outcome outcome = where.judged(options);
    EXPECT_EQ(outcome.code, 6) << c.what << ": " << outcome.err;
    EXPECT_NE(where.verdict(), "fit") << c.what;
    EXPECT_TRUE(says(outcome.out, {c.words})) << c.what;
  }
  for (const std::vector<std::string>& tool :
       {std::vector<std::string>{}, {"--calibration", "calibration.json"}, {"--stations", "calibration.csv"}}) {
    std::vector<std::string> options = {"--test-results", "tests.xml", "--assurance", "proofs.json"};
    options.insert(options.end(), tool.begin(), tool.end());
    EXPECT_EQ(where.judged(options).code, 6);
    EXPECT_EQ(where.verdict(), "open") << "no calibration of its own, or no known attitude";
  }
}

}  // namespace
}  // namespace verify_evidence_test

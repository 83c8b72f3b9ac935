// plumb verify as a user meets it: what it writes, how it ends, what it says when something is wrong.
#include "report/verify_support.hpp"

namespace {

using namespace plumb_test;

Directory& with_tool(Directory& where,
                     const std::string& text = read_text(PLUMB_SOURCE_DIR "/examples/paper_tool.toml")) {
  write_text(where / "tool.toml", text);
  return where;
}

/// All files below a directory with their contents, but for what tells of the run.
std::map<std::string, std::string> contents(const std::filesystem::path& folder) {
  std::map<std::string, std::string> out;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (!entry.is_regular_file()) continue;
    std::string text = read_text(entry.path());
    if (entry.path().filename() == "report.json") {
      Json json = Json::parse(text);
      json.erase("run");
      text = json.dump();
    } else if (entry.path().filename() == "report.html") {
      const std::size_t run = text.find("<p id=\"run\">");
      EXPECT_NE(run, std::string::npos);
      text.erase(run, text.find("</p>", run) - run);
    }
    out[entry.path().lexically_relative(folder).string()] = text;
  }
  return out;
}

TEST(VerifyCommand, SameInputsSameBytesOutsideTheRun) {
  Directory where;
  with_tool(where);
  ASSERT_EQ(verify(where, {"--array", "tool.toml", "--out", "a", "--threads", "1"}).code, 0);
  ASSERT_EQ(verify(where, {"--array", "tool.toml", "--out", "b", "--threads", "3"}).code, 0);
  const auto a = contents(where / "a"), b = contents(where / "b");
  EXPECT_GE(a.size(), 12U);
  for (const auto& [name, text] : a) {
    ASSERT_EQ(b.count(name), 1U) << name;
    EXPECT_TRUE(b.at(name) == text) << name;
  }
  EXPECT_EQ(a.size(), b.size());
  ASSERT_EQ(verify(where, {"--array", "tool.toml", "--out", "c", "--seed", "2"}).code, 0);
  EXPECT_NE(contents(where / "c").at("trials-faults.csv"), a.at("trials-faults.csv"));
}

TEST(VerifyCommand, ADirectoryStandsAlone) {
  const Directory& made = verified_paper_tool();
  const Json& report = paper_report();
  Directory where;
  std::filesystem::copy(made / "report", where / "moved", std::filesystem::copy_options::recursive);
  std::filesystem::current_path(where / "moved");
  const Json& worst = report["campaign"]["faults"]["worst"];
  ASSERT_FALSE(worst.empty());
  Directory here;
  for (const char* name : {"array.toml", "faults.toml"})
    std::filesystem::copy_file(where / "moved" / name, here / name);
  const std::string number = worst[0]["scenario"].dump();
  EXPECT_EQ(worst[0]["replay"], "plumb campaign faults.toml --replay " + number);
  const Outcome again = run(here, {"campaign", "faults.toml", "--replay", number});
  EXPECT_EQ(again.code, 0) << again.err;
  EXPECT_NE(again.out.find(worst[0]["story"].get<std::string>()), std::string::npos) << again.out;
  const Outcome whole = run(here, {"campaign", "faults.toml", "--json"});
  EXPECT_EQ(whole.code, 0) << whole.err;
  const Json result = Json::parse(whole.out);
  EXPECT_EQ(result["plan_hash"], report["campaign"]["faults"]["plan"]["plan_hash"]);
  EXPECT_EQ(result["rates"]["isolated"]["count"], report["campaign"]["faults"]["rates"]["isolated"]["count"]);
  std::filesystem::current_path("/");
}

TEST(VerifyCommand, ALimitThatTheArrayCannotMeetIsNamed) {
  Directory where;
  with_tool(where);
  write_text(where / "limits.toml", "[limits]\nalert_limit = \"0.01 deg\"\nfaults = 2\n");
  const Outcome outcome = verify(where, {"--array", "tool.toml", "--limits", "limits.toml", "--out", "r"});
  EXPECT_EQ(outcome.code, 6);
  EXPECT_TRUE(
      says(outcome.err, {"not fit", "isolates 1 faulty sensor for good, 2 are asked for", "alert limit is 0.01 deg"}));
  EXPECT_EQ(report_in(where / "r")["verdict"]["verdict"], "not fit");
  EXPECT_NE(read_text(where / "r" / "report.html").find("notice bad"), std::string::npos);
}

TEST(VerifyCommand, ThreeSensorsAreNotFitAndSayWhy) {
  Directory where;
  const std::string four = read_text(PLUMB_SOURCE_DIR "/examples/paper_tool.toml");
  with_tool(where, four.substr(0, four.rfind("[[sensor]]")));
  const Outcome outcome = verify(where, {"--array", "tool.toml", "--out", "r"});
  EXPECT_EQ(outcome.code, 6) << outcome.err;
  EXPECT_TRUE(says(outcome.err, {"isolates 0 faulty sensors", "parity does not check every sensor"}));
}

TEST(VerifyCommand, AnOrphanEndsWithSix) {
  Directory where;
  with_tool(where);
  Json trace = Json::parse(read_text(verified_paper_tool() / "report" / "traceability.json"));
  write_text(where / "same.json", trace.dump());
  EXPECT_EQ(verify(where, {"--array", "tool.toml", "--traceability", "same.json", "--out", "a"}).code, 0);
  trace["requirements"].push_back(
      {{"id", "REQ-998"}, {"title", "Loose"}, {"status", "active"}, {"methods", {"test"}}, {"statement", "It shall."}});
  write_text(where / "loose.json", trace.dump());
  const Outcome outcome = verify(where, {"--array", "tool.toml", "--traceability", "loose.json", "--out", "b"});
  EXPECT_EQ(outcome.code, 6);
  EXPECT_TRUE(says(outcome.out, {"orphan: REQ-998 answers no hazard", "orphan: REQ-998 has no test that verifies it"}));
}

TEST(VerifyCommand, TheCalibrationThatIsGivenIsTheOneThatIsJudged) {
  const Workshop shop;
  const Outcome file = verify(shop, {"--array", "array.toml", "--calibration", "calibration.json", "--out", "a"});
  const Outcome log = verify(shop, {"--array", "array.toml", "--positions", "calibration.csv", "--out", "b"});
  ASSERT_EQ(file.code, 0) << file.err;
  ASSERT_EQ(log.code, 0) << log.err;
  const Json a = report_in(shop / "a"), b = report_in(shop / "b");
  EXPECT_EQ(a["calibration"]["mode"], "calibration file");
  EXPECT_EQ(b["calibration"]["mode"], "positions");
  EXPECT_EQ(a["calibration"]["sensors"], b["calibration"]["sensors"]);  // of the same log
  EXPECT_EQ(a["array"]["sensors"], b["array"]["sensors"]);
  EXPECT_EQ(a["campaign"], b["campaign"]);
  EXPECT_NE(a["calibration"]["sensors"], paper_report()["calibration"]["sensors"]);
}

TEST(VerifyCommand, ComparesWithAnEarlierReport) {
  Directory where;
  with_tool(where);
  const std::string old = (verified_paper_tool() / "report" / "report.json").string();
  write_text(where / "limits.toml", "[limits]\nalert_limit = \"0.02 deg\"\n");
  EXPECT_EQ(
      verify(where, {"--array", "tool.toml", "--limits", "limits.toml", "--compare", old, "--out", "r"}, "600").code,
      6);
  const Json change = report_in(where / "r")["change"];
  EXPECT_EQ(change["verdict_before"], "fit");
  EXPECT_EQ(change["verdict_now"], "not fit");
  EXPECT_GT(change["count"].get<int>(), 3);
}

TEST(VerifyCommand, WrongUseIsAnsweredWithWhatAndHow) {
  Directory where;
  with_tool(where);
  const auto answered = [&where](const std::vector<std::string>& more, int code,
                                 const std::vector<std::string>& words) {
    const Outcome outcome = verify(where, more);
    EXPECT_EQ(outcome.code, code) << outcome.err;
    EXPECT_TRUE(says(outcome.err, words));
  };
  answered({}, 2, {"--array", "Try: plumb verify --help"});
  answered({"--array", "none.toml"}, 3, {"none.toml"});
  answered({"--array", "tool.toml", "--calibration", "a", "--positions", "b"}, 2, {"--positions", "Remedy"});
  answered({"--array", "tool.toml", "--limits", "none.toml"}, 3, {"none.toml"});
  answered({"--array", "tool.toml", "--compare", "tool.toml"}, 3, {"tool.toml", "is no report", "report.json"});
  answered({"--array", "tool.toml", "--test-results", "tool.toml"}, 3, {"tool.toml", "not XML", "--output-junit"});
  answered({"--array", "tool.toml", "--assurance", "tool.toml"}, 3, {"scripts/assure"});
  answered({"--array", "tool.toml", "--out", "-"}, 2, {"--out", "is no directory"});
  answered({"--array", "tool.toml", "--out", "tool.toml"}, 1, {"tool.toml", "--out", "Remedy"});
  answered({"--array", "tool.toml", "--limit", "x"}, 2, {"--limits"});
  EXPECT_EQ(run(where, {"verify", "--array", "tool.toml", "--scenarios", "0"}).code, 2);
}

TEST(VerifyCommand, WithoutGnuplotTheRestIsWritten) {
  Directory where;
  with_tool(where);
  const Outcome outcome =
      run(where, {"verify", "--array", "tool.toml", "--scenarios", "100", "--out", "r"}, "", {"PATH=/nowhere"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("gnuplot"), std::string::npos);
  const std::string html = read_text(where / "r" / "report.html");
  EXPECT_NE(html.find("There is no picture: gnuplot: is not installed"), std::string::npos);
  EXPECT_TRUE(std::filesystem::exists(where / "r" / "charts" / "stanford.csv"));
}

}  // namespace

// plumb verify as a user meets it: what it writes, how it ends, what it says when something is wrong.
#include "render/verify_support.hpp"

namespace verify_test {
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
      int runs = 0;
      for (std::size_t run = text.find("<p class=\"run\">"); run != std::string::npos;
           run = text.find("<p class=\"run\">", run), ++runs)
        text.erase(run, text.find("</p>", run) - run);
      EXPECT_EQ(runs, 2) << "in the sign-off, and at the end";
    }
    out[entry.path().lexically_relative(folder).string()] = text;
  }
  return out;
}

TEST(VerifyCommand, SameInputsSameBytesOutsideTheRun) {
  Directory where;
  with_tool(where);
  ASSERT_EQ(verify(where, {"--array", "tool.toml", "--out", "a", "--threads", "1"}).code, 6);
  ASSERT_EQ(verify(where, {"--array", "tool.toml", "--out", "b", "--threads", "3"}).code, 6);
  const auto a = contents(where / "a"), b = contents(where / "b");
  EXPECT_GE(a.size(), 12U);
  for (const auto& [name, text] : a) {
    ASSERT_EQ(b.count(name), 1U) << name;
    EXPECT_TRUE(b.at(name) == text) << name;
  }
  EXPECT_EQ(a.size(), b.size());
  ASSERT_EQ(verify(where, {"--array", "tool.toml", "--out", "c", "--seed", "2"}).code, 6);
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

TEST(VerifyCommand, ALimitThatTheArrayCannotMeetIsReported) {
  Directory where;
  with_tool(where);
  write_text(where / "limits.toml", "[limits]\nalert_limit = \"0.01 deg\"\nfaults = 2\n");
  const Outcome outcome = verify(where, {"--array", "tool.toml", "--limits", "limits.toml", "--out", "r"});
  EXPECT_EQ(outcome.code, 6);
  EXPECT_TRUE(says(outcome.err, {"not fit", "isolates 1 faulty sensor with confirmation, 2 are required",
                                 "alert limit is 0.01 deg"}));
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
  const Workshop shop;
  const auto traced = [&shop](const std::string& trace, const std::string& out) {
    return verify(shop, {"--array", "array.toml", "--calibration", "calibration.json", "--known-attitude",
                         kKnownStation, "--traceability", trace, "--out", out});
  };
  Json trace = Json::parse(read_text(verified_paper_tool() / "report" / "traceability.json"));
  write_text(shop / "same.json", trace.dump());
  EXPECT_TRUE(says(traced("same.json", "a").out, {"fit, evidence incomplete", "Traceability", "complete"}));
  trace["requirements"].push_back(
      {{"id", "REQ-998"}, {"title", "Loose"}, {"status", "active"}, {"methods", {"test"}}, {"statement", "It shall."}});
  write_text(shop / "loose.json", trace.dump());
  const Outcome outcome = traced("loose.json", "b");
  EXPECT_EQ(outcome.code, 6);
  EXPECT_TRUE(says(outcome.out, {"orphan: REQ-998 answers no hazard", "orphan: REQ-998 has no test that verifies it"}));
}

TEST(VerifyCommand, TheCalibrationThatIsGivenIsTheOneThatIsJudged) {
  const Workshop shop;
  ASSERT_EQ(run(shop, {"calibrate", "--array", "array.toml", "--log", "calibration.csv", "--known-attitude",
                       kKnownStation, "--out", "known.json"})
                .code,
            0);
  const Outcome file = verify(shop, {"--array", "array.toml", "--calibration", "known.json", "--out", "a"});
  const Outcome log = verify(shop, {"--array", "array.toml", "--stations", "calibration.csv", "--known-attitude",
                                    kKnownStation, "--out", "b"});
  ASSERT_TRUE(says(file.out, {"fit, evidence incomplete"})) << file.err;
  ASSERT_TRUE(says(log.out, {"fit, evidence incomplete"})) << log.err;
  const Json a = report_in(shop / "a"), b = report_in(shop / "b");
  EXPECT_EQ(a["calibration"]["mode"], "calibration file");
  EXPECT_EQ(b["calibration"]["mode"], "stations");
  EXPECT_EQ(a["calibration"]["sensors"], b["calibration"]["sensors"]);  // of the same log
  EXPECT_EQ(a["array"]["sensors"], b["array"]["sensors"]);
  EXPECT_EQ(a["campaign"], b["campaign"]);
  EXPECT_NE(a["calibration"]["sensors"], paper_report()["calibration"]["sensors"]);
}

/// The paper's tool with a log whose rows are the means of 200 samples at a station; `input` says what the array file
/// knows of that.
Directory& with_means(Directory& where, const std::string& input) {
  std::string tool = read_text(PLUMB_SOURCE_DIR "/examples/paper_tool.toml");
  tool = with(tool, "unit = \"V\"", "rows = \"stations\"\n" + input + "unit = \"V\"");
  write_text(where / "tool.toml", with(tool, "[monitor]\n", "[monitor]\nwindow = 1\nmax_gap = \"1000 s\"\n"));
  const std::string stand = read_text(PLUMB_SOURCE_DIR "/examples/stand.toml");
  write_text(where / "stand.toml", with(stand, "array = \"paper_tool.toml\"", "array = \"tool.toml\""));
  EXPECT_EQ(run(where, {"simulate", "stand.toml", "--out", "stand.csv"}).code, 0);
  return where;
}

Json verified_means(const Directory& where) {
  const Outcome outcome = verify(where, {"--array", "tool.toml", "--stations", "stand.csv", "--out", "r"});
  EXPECT_TRUE(outcome.code == 0 || outcome.code == 6) << outcome.err;
  return report_in(where / "r");
}

double block_noise(const Json& report) { return report["array"]["sensors"][0]["thresholds_mps2"]["block_noise"]; }

TEST(VerifyCommand, ARowThatIsAMeanIsJudgedByItsOwnNoise) {
  Directory where, crude;
  const Json report = verified_means(with_means(where, "count = \"n\"\n"));
  const Json single = verified_means(with_means(crude, ""));
  EXPECT_EQ(report["subject"]["samples_per_row"], 200);
  EXPECT_EQ(single["subject"]["samples_per_row"], 1);
  EXPECT_NEAR(block_noise(report), block_noise(single) / std::sqrt(200.0), 1e-9);
  const char* const level = "protection_level_at_rest_deg";
  EXPECT_LT(report["array"]["detection_sizes"]["as_stated"][level],
            single["array"]["detection_sizes"]["as_stated"][level]);
  EXPECT_NE(report["campaign"]["faults"]["plan"]["plan_hash"], single["campaign"]["faults"]["plan"]["plan_hash"]);
  EXPECT_NE(read_text(where / "r" / "faults.toml").find("samples_per_row = 200"), std::string::npos);
  EXPECT_EQ(report["campaign"]["replayed"]["agree"], report["campaign"]["replayed"]["scenarios"]);
  EXPECT_NE(report["verdict"]["assumptions"].dump().find("the mean of 200 samples"), std::string::npos);
  EXPECT_NE(single["verdict"]["assumptions"].dump().find("counts as one sample"), std::string::npos);
}

TEST(VerifyCommand, TheScarcestRowDecidesAndSecondsAreNotInvented) {
  Directory where;
  with_means(where, "count = \"n\"\n");
  std::string log = read_text(where / "stand.csv");
  const std::size_t at = log.find(",200", log.find('\n'));
  ASSERT_NE(at, std::string::npos) << log.substr(0, 300);
  write_text(where / "stand.csv", log.replace(at, 4, ",50"));
  EXPECT_EQ(verified_means(where)["subject"]["samples_per_row"], 50);
  write_text(where / "limits.toml", "[limits]\ndetect_within = \"1 h\"\n");
  const Outcome outcome =
      verify(where, {"--array", "tool.toml", "--stations", "stand.csv", "--limits", "limits.toml", "--out", "r"});
  EXPECT_EQ(outcome.code, 6);
  EXPECT_NE(outcome.out.find("not in seconds"), std::string::npos) << outcome.out;
}

TEST(VerifyCommand, TheStepsOfTheMonitorAreTimedOnThisHost) {
  const Json& step = paper_report()["run"]["monitor_step"];
  EXPECT_GT(step["calls"].get<int>(), 10000);
  EXPECT_LE(step["median_ns"], step["p999_ns"]);
  EXPECT_LE(step["p999_ns"], step["high_water_ns"]);
  EXPECT_FALSE(paper_report()["run"]["machine"].get<std::string>().empty());
  const std::string page = read_text(verified_paper_tool() / "report" / "report.html");
  EXPECT_TRUE(says(page, {"<p class=\"run\">", "measured maximum", "not a worst-case time"}));
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
  EXPECT_EQ(change["verdict_before"], "open");
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
  answered({"--array", "tool.toml", "--calibration", "a", "--stations", "b"}, 2, {"--stations", "Remedy"});
  answered({"--array", "tool.toml", "--limits", "none.toml"}, 3, {"none.toml"});
  answered({"--array", "tool.toml", "--compare", "tool.toml"}, 3,
           {"tool.toml", "is not a report of plumb verify", "report.json"});
  answered({"--array", "tool.toml", "--test-results", "tool.toml"}, 3, {"tool.toml", "not XML", "--output-junit"});
  answered({"--array", "tool.toml", "--assurance", "tool.toml"}, 3, {"scripts/assure"});
  answered({"--array", "tool.toml", "--out", "-"}, 2, {"--out", "must name a directory"});
  answered({"--array", "tool.toml", "--out", "tool.toml"}, 1, {"tool.toml", "--out", "Remedy"});
  answered({"--array", "tool.toml", "--limit", "x"}, 2, {"--limits"});
  EXPECT_EQ(run(where, {"verify", "--array", "tool.toml", "--scenarios", "0"}).code, 2);
}

TEST(VerifyCommand, WithoutOptionalProgramsTheRestIsWritten) {
  Directory where;
  with_tool(where);
  const Outcome outcome = run(where, {"verify", "--array", "tool.toml", "--scenarios", "100", "--out", "r", "--pdf"},
                              "", {"PATH=/nowhere"});
  EXPECT_EQ(outcome.code, 6) << outcome.err;
  EXPECT_NE(outcome.err.find("gnuplot"), std::string::npos);
  EXPECT_NE(outcome.err.find("weasyprint"), std::string::npos);
  const std::string html = read_text(where / "r" / "report.html");
  EXPECT_NE(html.find("There is no picture: gnuplot: is not installed"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(where / "r" / "report.pdf"));
  for (const char* name :
       {"charts/stanford.csv", "charts/traces.csv", "report.json", "junit.xml", "spdx.json", "argument.svg"})
    EXPECT_TRUE(std::filesystem::exists(where / "r" / name)) << name;
}

// Bounds of a tool whose calibration was refused take the array file for exact: nothing of that is met.
TEST(VerifyCommand, ARefusedCalibrationFlattersNothing) {
  Directory where;
  with_tool(where);
  write_text(where / "few.csv", "t_s,station,a1,a2,a3,a4\n0.0,1,0.5,0.5,0.5,-0.5\n0.01,1,0.5,0.5,0.5,-0.5\n");
  const Outcome outcome = verify(where, {"--array", "tool.toml", "--stations", "few.csv", "--out", "r"});
  EXPECT_EQ(outcome.code, 6);
  EXPECT_TRUE(says(outcome.err, {"the calibration was refused"}));
  EXPECT_EQ(outcome.err.find("gnuplot"), std::string::npos) << outcome.err;
  const Json report = report_in(where / "r");
  EXPECT_EQ(report["verdict"]["verdict"], "not fit");
  const Json& criteria = report["verdict"]["criteria"];
  const auto level = std::find_if(criteria.begin(), criteria.end(), [](const Json& one) {
    return one["name"] == "Protection level against the alert limit";
  });
  ASSERT_NE(level, criteria.end());
  EXPECT_EQ((*level)["result"], "open");
  const std::string html = read_text(where / "r" / "report.html");
  EXPECT_NE(html.find("treat axes, scales and biases of the array file as exact"), std::string::npos);
  EXPECT_EQ(html.find("There is no picture"), std::string::npos);
}

TEST(VerifyCommand, WhereNothingCanBeWrittenNothingIsPlayed) {
  Directory where;
  with_tool(where);
  const Outcome outcome =
      run(where, {"verify", "--array", "tool.toml", "--scenarios", "50000000", "--out", "/dev/full"});
  EXPECT_EQ(outcome.code, 1);
  EXPECT_TRUE(says(outcome.err, {"/dev/full", "Remedy"}));
}

TEST(VerifyCommand, ADirectoryHoldsOneReport) {
  Directory where;
  with_tool(where);
  std::filesystem::create_directory(where / "r");
  for (const char* name : {"report.pdf", "analysis.sarif", "notes.txt"})
    write_text(where / "r" / name, "of an earlier report");
  const Outcome outcome = verify(where, {"--array", "tool.toml", "--out", "r"});
  EXPECT_EQ(outcome.code, 6);
  EXPECT_TRUE(says(outcome.err, {"removed analysis.sarif", "removed report.pdf"}));
  EXPECT_FALSE(std::filesystem::exists(where / "r" / "report.pdf"));
  EXPECT_FALSE(std::filesystem::exists(where / "r" / "analysis.sarif"));
  EXPECT_EQ(read_text(where / "r" / "notes.txt"), "of an earlier report") << "it is the user's";
}

TEST(VerifyCommand, ALongerCampaignIsTakenIn) {
  Directory where;
  with_tool(where);
  ASSERT_EQ(verify(where, {"--array", "tool.toml", "--out", "r"}).code, 6);
  std::filesystem::copy_file(where / "r" / "faults.toml", where / "faults.toml");
  std::filesystem::copy_file(where / "r" / "healthy.toml", where / "healthy.toml");
  std::filesystem::copy_file(where / "r" / "array.toml", where / "array.toml");
  for (const char* name : {"faults", "healthy"}) {
    const std::string file = name;
    ASSERT_EQ(run(where, {"campaign", file + ".toml", "--scenarios", "900", "--out", file + ".json"}).code, 0);
  }
  const std::vector<std::string> both = {"--array", "tool.toml",    "--reuse", "faults.json",
                                         "--reuse", "healthy.json", "--out",   "s"};
  ASSERT_EQ(verify(where, both).code, 6);
  const Json campaign = report_in(where / "s")["campaign"];
  EXPECT_EQ(campaign["faults"]["plan"]["scenarios"], 200);
  EXPECT_EQ(campaign["faults"]["reused"]["rates"]["wrong_exclusion"]["of"], 900);
  EXPECT_GE(campaign["healthy"]["reused"]["rates"]["false_alarm_per_block"]["of"], 900);
  EXPECT_NE(read_text(where / "s" / "report.html").find("The long campaign: faults.json"), std::string::npos);
  const auto refused = [&where](const std::vector<std::string>& more, const std::vector<std::string>& words) {
    const Outcome outcome = verify(where, more);
    EXPECT_EQ(outcome.code, 3) << outcome.err;
    EXPECT_TRUE(says(outcome.err, words));
  };
  refused({"--array", "tool.toml", "--reuse", "faults.json", "--seed", "2", "--out", "t"},
          {"faults.json", "another campaign"});
  refused({"--array", "tool.toml", "--reuse", "tool.toml", "--out", "t"},
          {"tool.toml", "is not the result of a campaign"});
}

TEST(VerifyCommand, TheStaticAnalysisBecomesSarifAndTheTargetIsReported) {
  Directory where;
  with_tool(where);
  write_text(where / "tidy.log", "/src/a.cpp:3:7: warning: narrowing [bugprone-narrowing,-warnings-as-errors]\n");
  write_text(where / "results.json",
             R"({"schema": "plumb-resources", "version": 1, "commit": "abc", "items": [)"
             R"({"target": "Cortex-M7", "name": "stack of step", "value": 9000, "limit": 4096, "unit": "B"}]})");
  const Outcome outcome =
      verify(where, {"--array", "tool.toml", "--analysis", "tidy.log", "--resources", "results.json", "--out", "r"});
  EXPECT_EQ(outcome.code, 6);
  EXPECT_TRUE(says(outcome.err, {"static analysis has 1 finding", "stack of step"}));
  const Json sarif = Json::parse(read_text(where / "r" / "analysis.sarif"));
  EXPECT_EQ(sarif["runs"][0]["results"][0]["ruleId"], "bugprone-narrowing");
  const Json report = report_in(where / "r");
  EXPECT_EQ(report["resources"]["target"]["items"][0]["value"], 9000);
  EXPECT_EQ(verify(where, {"--array", "tool.toml", "--resources", "tidy.log", "--out", "t"}).code, 3);
  EXPECT_EQ(verify(where, {"--array", "tool.toml", "--analysis", "tool.toml", "--out", "t"}).code, 3);
}

TEST(VerifyCommand, TableTwoIsPlayedWithThePapersTetrahedronAlone) {
  const Json& table = paper_report()["campaign"]["table2"];
  ASSERT_EQ(table["given"], true);
  EXPECT_EQ(table["as_printed"], 23);
  for (const Json& row : table["rows"]) EXPECT_EQ(row["monitor_suspected_a_healthy_one"], false) << row;
  Directory where;
  with_tool(where, read_text(PLUMB_SOURCE_DIR "/examples/cone5.toml"));
  ASSERT_EQ(verify(where, {"--array", "tool.toml", "--out", "r"}).code, 6);
  EXPECT_EQ(report_in(where / "r")["campaign"]["table2"]["given"], false);
}

}  // namespace
}  // namespace verify_test

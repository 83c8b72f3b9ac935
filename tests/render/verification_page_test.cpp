// The page: every figure in it stands in the master JSON, and nothing of the JSON can break out of it.
#include "plumb/render/verification_page.hpp"

#include <gtest/gtest.h>

#include <fmt/format.h>

#include <regex>
#include <set>

#include "plumb/core/units.hpp"
#include "plumb/render/change.hpp"
#include "plumb/render/page.hpp"
#include "plumb/study/proportion.hpp"
#include "verify_support.hpp"

namespace verification_page_test {
namespace {

using namespace plumb;
using plumb_test::Json;
using plumb_test::paper_report;

std::set<std::string> numbers_in(const std::string& text) {
  static const std::regex number(R"([0-9]+(\.[0-9]+)?(e[+-]?[0-9]+)?)");
  std::set<std::string> out;
  for (std::sregex_iterator it(text.begin(), text.end(), number), end; it != end; ++it) out.insert(it->str());
  return out;
}

/// All numbers of the report in every form in which the page may show them: as they are, in mg0, in percent.
void collect(const Json& json, std::set<std::string>& out) {
  if (json.is_number()) {
    out.merge(numbers_in(json.dump()));
    for (const double factor : {1.0, 1e3 / kG0_mps2, 100.0})
      out.merge(numbers_in(fmt::format("{:.4g}", factor * json.get<double>())));
  } else if (json.is_string()) {
    out.merge(numbers_in(json.get<std::string>()));
  } else if (json.is_structured()) {
    if (json.is_array()) out.insert(std::to_string(json.size()));
    for (const auto& [key, value] : json.items()) {
      out.merge(numbers_in(json.is_object() ? key : ""));
      if (value.is_number() && (key == "low" || key == "high")) {  // ends of intervals are rounded outwards, in percent
        const double percent = 100.0 * value.get<double>();
        out.merge(
            numbers_in(key == "low" ? study::rounded_down(percent, 3, 100.0) : study::rounded_up(percent, 3, 100.0)));
      }
      collect(value, out);
    }
  }
}

/// Texts of table cells.
std::string cells_of(const std::string& html) {
  static const std::regex cell(R"(<td[^>]*>([^<]*)</td>)");
  std::string out;
  for (std::sregex_iterator it(html.begin(), html.end(), cell), end; it != end; ++it) out += (*it)[1].str() + "\n";
  return out;
}

/// Numbers in the tables of one report's page that another one does not hold.
std::set<std::string> strangers(const Json& report, const Json& other) {
  Json tables = other;
  tables["array"].erase("attitude_map");  // drawn, in no table: so many numbers that any other would be among them
  std::set<std::string> known;
  collect(tables, known);
  std::set<std::string> out;
  for (const std::string& number : numbers_in(cells_of(render::verification_html(report, {})))) {
    if (known.count(number) == 0) out.insert(number);
  }
  return out;
}

TEST(VerificationPage, EveryFigureInATableIsInTheJson) {
  // Words of the page itself: "(95 % ...)", "rank < 3" come from the JSON or from heads, which are no cells.
  const std::set<std::string> found = strangers(paper_report(), paper_report());
  EXPECT_TRUE(found.empty()) << "not in the JSON: " << *found.begin() << " and " << found.size() - 1 << " more";
  Json other = paper_report();
  other["array"]["figures_of_merit"]["gdop"] = 7.654321e-17;
  EXPECT_EQ(strangers(other, paper_report()), std::set<std::string>{"7.654e-17"});
}

TEST(VerificationPage, ShowsWhatTheJsonSaysAndNothingElse) {
  Json report = paper_report();
  const std::string before = render::verification_html(report, {});
  report["array"]["figures_of_merit"]["gdop"] = 7.654;
  report["campaign"]["faults"]["by_fault"][2]["detected"]["count"] = 4711;
  const std::string now = render::verification_html(report, {});
  EXPECT_EQ(before.find("7.654"), std::string::npos);
  EXPECT_NE(now.find("7.654"), std::string::npos);
  EXPECT_NE(now.find("4711/"), std::string::npos);
}

TEST(VerificationPage, SaysWhatWasNotGivenAndHowToGiveIt) {
  const std::string html = render::verification_html(paper_report(), {});
  EXPECT_TRUE(plumb_test::says(
      html, {"Not given: predicted from a simulated stand. Give --stations",
             "To record:", "not given. Give --assurance", "Results of the tests: not given. Give --test-results",
             "Give --resources", "Give --analysis", "Not given: --compare"}));
  EXPECT_NE(html.find("There is no picture: it was not drawn"), std::string::npos);
}

/// A size of the campaign is not a guaranteed size, and a few replayed scenarios are no coverage.
TEST(VerificationPage, SaysWhatItsSizesAndItsCoverageAreOf) {
  const std::string html = render::verification_html(paper_report(), {});
  const std::string replayed = paper_report()["campaign"]["replayed"]["scenarios"].dump();
  EXPECT_TRUE(plumb_test::says(
      html, {"One MDB of a campaign", "noise of one block alone", " mg0 here", "thresholds of section 2 are larger",
             replayed + " scenarios were replayed for this", "not the campaigns as a whole",
             "Cells in which no replayed scenario left a record", "--test-results, --assurance"}));
}

std::string sign_off_of(const std::string& page) {
  const std::size_t begin = page.find("<section id=\"signoff\"");
  return begin == std::string::npos ? "" : page.substr(begin, page.find("</section>", begin) - begin);
}

TEST(VerificationPage, TheSignOffHoldsVerdictAnswersIdentityAndLines) {
  Json report = paper_report();
  report["calibration"]["file"] = {{"serial", "T-117"}, {"date", "2026-03-01"}};
  report["run"]["time"] = "2026-11-29T10:00:00Z";
  const std::string sheet = sign_off_of(render::verification_html(report, {}));
  EXPECT_TRUE(plumb_test::says(sheet, {"T-117", "2026-03-01", report["identity"]["build"]["commit"],
                                       "2026-11-29T10:00:00Z", "Issued by", "Approved by", "Signature"}));
  for (const Json& answer : report["verdict"]["answers"])
    EXPECT_TRUE(plumb_test::says(sheet, {answer["question"], answer["value"]})) << answer;
  for (const Json& input : report["identity"]["inputs"])
    EXPECT_TRUE(plumb_test::says(sheet, {input["role"], input["sha256"]})) << input;
  EXPECT_NE(sheet.find("<p class=\"run\">"), std::string::npos) << "what differs from run to run stands apart";
}

/// Every answer that something was judged of has the colour of that judgement.
TEST(VerificationPage, CardsHaveTheColourOfTheirVerdict) {
  Json report = paper_report();
  const auto card_of = [](const std::string& sheet, const char* question) {
    const std::size_t at = sheet.find(question), begin = sheet.rfind("<div class=\"card", at);
    return at == std::string::npos ? "" : sheet.substr(begin, sheet.find('>', begin) - begin + 1);
  };
  const std::pair<const char*, const char*> coloured[] = {{"How many faults?", "faults_isolated"},
                                                          {"Protection level?", "protection_level"},
                                                          {"How sure?", "wrong_exclusion"}};
  for (const auto& [result, tone] :
       {std::pair<const char*, const char*>{"met", "good"}, {"not met", "bad"}, {"open", "open"}}) {
    for (Json& c : report["verdict"]["criteria"]) c["result"] = result;
    const std::string sheet = sign_off_of(render::verification_html(report, {}));
    for (const auto& [question, id] : coloured)
      EXPECT_EQ(card_of(sheet, question), std::string("<div class=\"card ") + tone + "\">") << id << result;
    EXPECT_EQ(card_of(sheet, "What not to trust?"), "<div class=\"card open\">");
  }
}

/// 84 groups of three, two dozen sensors: behind a click, and there.
TEST(VerificationPage, LongListsAndTablesCollapse) {
  Json report = paper_report();
  const Json sensor = report["array"]["sensors"][0], triple = report["array"]["triples"][0];
  for (int k = 5; k <= 24; ++k) {
    report["array"]["sensors"].push_back(sensor);
    report["array"]["sensors"].back()["id"] = "a" + std::to_string(k);
    report["array"]["critical_sensors"].push_back("a" + std::to_string(k));
  }
  while (report["array"]["triples"].size() < 84) report["array"]["triples"].push_back(triple);
  const std::string html = render::verification_html(report, {});
  EXPECT_TRUE(plumb_test::says(html, {"<details class=\"long\"><summary>Sensors (24 rows)</summary>",
                                      "<details><summary>20 sensors</summary>a5, a6, ",
                                      "<details class=\"folded\"><summary>Every group of three</summary>"}));
  EXPECT_EQ(render::verification_html(paper_report(), {}).find("<details class=\"long\">"), std::string::npos);
}

TEST(VerificationPage, AChartStandsThereForADeskAndForAPhoneAndAScriptOnlyBesideAChart) {
  render::PagePictures pictures;
  pictures["times.svg"] = {"<svg data-axes=\"[]\"></svg>", "", "<svg class=\"n\"></svg>"};
  const std::string html = render::verification_html(paper_report(), pictures);
  EXPECT_TRUE(plumb_test::says(html, {"<div class=\"plot broad\"", "<div class=\"plot narrow\"", "<script>"}));
  EXPECT_EQ(render::page_html({"title", "lead", {}, "footer"}).find("<script"), std::string::npos);
}

TEST(VerificationPlots, OneWildStationDoesNotFlattenTheOthers) {
  Json report = paper_report();
  Json stations = Json::array();
  for (int k = 0; k < 20; ++k)
    stations.push_back({{"norm_error_mps2", k == 7 ? 3.0 : 1e-4 * (k % 5)}, {"held_out", Json()}});
  report["calibration"]["fit"]["stations"] = stations;
  std::string script;
  for (const render::PlotFile& file : render::verification_plot_files(report, {}))
    if (file.name == render::kVerificationScript) script = file.text.substr(file.text.find("residuals.svg"));
  EXPECT_TRUE(plumb_test::says(script, {"set label '+306' at first 8,"}));
  const double top = std::stod(script.substr(script.find("set yrange [-") + 13));
  EXPECT_LT(top, 1.0) << "mg0: the others stay within 0.04";
}

TEST(VerificationPage, NamesCannotBreakOut) {
  Json report = paper_report();
  report["subject"]["name"] = "<script>alert(1)</script>";
  report["array"]["sensors"][0]["id"] = "a<b&\"c";
  const std::string html = render::verification_html(report, {});
  EXPECT_EQ(html.find("<script>alert"), std::string::npos);
  EXPECT_EQ(html.find("a<b&"), std::string::npos);
  EXPECT_NE(html.find("a&lt;b&amp;"), std::string::npos);
}

TEST(VerificationPage, ACampaignThatWasNotPlayedIsReported) {
  Json report = paper_report();
  report["campaign"] = {{"healthy", {{"played", false}, {"reason", "no monitor"}}},
                        {"faults", {{"played", false}, {"reason", "no monitor"}}},
                        {"table2", {{"given", false}, {"reason", "another array"}}}};
  report["state_machine"]["coverage"] = Json();
  const std::string html = render::verification_html(report, {});
  EXPECT_TRUE(plumb_test::says(html, {"Not played: no monitor", "No campaign was played"}));
}

TEST(VerificationPlots, DrawWhatTheJsonHolds) {
  const Json& report = paper_report();
  render::GeometryPictures geometry;  // of any array: what is drawn of it has tests of its own
  geometry.map.push_back({0.0, 0.0, 1.0, 1.0, 0});
  geometry.levels.push_back({1.0, 0.2, 0.1});
  std::string times, script;
  for (const render::PlotFile& file : render::verification_plot_files(report, geometry)) {
    if (file.name == "times.csv") times = file.text;
    if (file.name == render::kVerificationScript) script = file.text;
  }
  const std::size_t last = times.rfind('\n', times.size() - 2);
  EXPECT_NE(times.substr(last + 1).find(",1,1"), std::string::npos) << times;
  for (const std::string& name : render::verification_picture_names(report, geometry)) {
    EXPECT_NE(script.find(".'" + name + "'\n"), std::string::npos) << name;
    EXPECT_TRUE(std::filesystem::exists(plumb_test::verified_paper_tool() / "report" / "charts" / name)) << name;
  }
}

TEST(VerificationChange, IsEmptyBetweenEqualReportsAndNamesWhatDiffers) {
  Json before = paper_report(), now = paper_report();
  now["run"]["host"] = "elsewhere";
  EXPECT_EQ(render::change_section(before, now)["count"], 0);
  now["verdict"]["verdict"] = "not fit";
  now["array"]["sensors"][1]["sigma_mps2"] = 1.0;
  now["traceability"]["requirements"].erase(3);
  const Json change = render::change_section(before, now);
  EXPECT_EQ(change["count"], 3);
  EXPECT_EQ(change["verdict_before"], "open");
  EXPECT_EQ(change["verdict_now"], "not fit");
  EXPECT_EQ(change["differences"][0]["where"], "verdict.verdict");
  EXPECT_EQ(change["differences"][1]["where"], "array.sensors[a2].sigma_mps2");
  EXPECT_EQ(change["differences"][2]["now"], Json());
}

}  // namespace
}  // namespace verification_page_test

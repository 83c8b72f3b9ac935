// The page of a survey: whole, well formed, every station on it, nothing of an input taken for markup.
#include "plumb/render/survey_page.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <string>
#include <vector>

#include "../survey/simulated_survey.hpp"
#include "plumb/render/identity.hpp"

namespace survey_page_test {
namespace {

using namespace plumb;
using namespace plumb::survey;
using namespace simulated_survey;

std::vector<ReferencedStation> hole(int stations = 12) {
  std::vector<ReferencedStation> out;
  for (int k = 0; k < stations; ++k) {
    Measurement m = station_of({rad_from_deg(7.0 * k), rad_from_deg(60.0), 1.7 * k}, World{}, 1000.0 + 30.0 * k);
    m.random = independent_covariance(1e-3, 20e-9);
    out.push_back({m, reference_of(World{})});
  }
  return out;
}

render::SurveyReport report_of(const std::vector<ReferencedStation>& stations, const SurveySettings& settings = {},
                               const std::string& name = "run.csv") {
  return {name,
          "mps2",
          "nT",
          0,
          "",
          settings,
          stations.front().reference,
          stations.back().reference,
          1e-3,
          20e-9,
          run_survey(stations, settings)};
}

std::string page_of(const render::SurveyReport& report, const std::string& command = "plumb survey run.csv") {
  render::SurveyIdentity identity;
  identity.inputs.push_back(render::input_json("stations", report.file, "bytes"));
  identity.command = command;
  identity.time = "2026-03-31T12:00:00Z";
  identity.host = "rig";
  return render::survey_html(report, identity, {});
}

/// "" where every tag is closed by its own name in the right order; otherwise where it is not.
std::string unbalanced(const std::string& page) {
  std::vector<std::string> open;
  for (std::size_t at = page.find('<'); at != std::string::npos; at = page.find('<', at + 1)) {
    if (page.compare(at, 2, "<!") == 0) continue;
    const bool closes = page[at + 1] == '/';
    std::size_t end = at + (closes ? 2 : 1);
    const std::size_t begin = end;
    while (end < page.size() && std::isalnum(static_cast<unsigned char>(page[end])) != 0) ++end;
    const std::string name = page.substr(begin, end - begin);
    if (name.empty()) return "a bare < at " + page.substr(at, 40);
    if (name == "meta" || name == "link") continue;
    if (!closes) {
      open.push_back(name);
    } else if (open.empty() || open.back() != name) {
      return "</" + name + "> closes nothing: " + page.substr(at, 40);
    } else {
      open.pop_back();
    }
  }
  return open.empty() ? "" : "<" + open.back() + "> is never closed";
}

/// The row of the table of stations.
std::string row_of(const std::string& page, double md_m) {
  const std::size_t table = page.find("Every station</h3>");
  const std::size_t at = page.find(fmt::format("<tr><td class=\"n \">{:.2f}</td>", md_m), table);
  return table == std::string::npos || at == std::string::npos ? "" : page.substr(at, page.find("</tr>", at) - at);
}

bool holds(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

// Verifies: REQ-238
TEST(SurveyPage, ShowsEveryStationWithItsChecksAndTheNorth) {
  const render::SurveyReport report = report_of(hole());
  const std::string page = page_of(report);
  EXPECT_EQ(unbalanced(page), "");
  for (const SurveyStation& s : report.survey.stations) EXPECT_NE(row_of(page, s.measured.md_m), "");
  EXPECT_TRUE(holds(row_of(page, 1330.0), "<td class=\"n \">77.00</td>"));
  EXPECT_TRUE(holds(row_of(page, 1330.0), "<td class=\"n \">56.00</td>"));
  EXPECT_TRUE(holds(row_of(page, 1330.0), "class=\"good\">accepted<"));
  EXPECT_TRUE(holds(page, "azi true, deg"));
  EXPECT_TRUE(holds(page, "12 of 12 stations accepted. The error tests pass."));
  EXPECT_TRUE(holds(page, "class=\"card notice good\""));
  EXPECT_TRUE(holds(page, render::sha256("bytes")));
  EXPECT_TRUE(holds(page, "2026-03-31T12:00:00Z"));
  for (const char* id : {"verdict", "references", "stations", "path", "tests", "refused", "identity"})
    EXPECT_TRUE(holds(page, "<section id=\"" + std::string(id) + "\"")) << id;
}

// Negative: REQ-238
TEST(SurveyPage, MarksWhatFailedAndSaysWhyItWithholds) {
  std::vector<ReferencedStation> stations = hole();
  stations[5].measured.field_tesla[0] += 9e-6;
  stations[8].measured.gravity_mps2 = scaled(stations[8].measured.gravity_mps2, 1.01);
  const std::string page = page_of(report_of(stations));
  EXPECT_EQ(unbalanced(page), "");
  EXPECT_TRUE(holds(page, "10 of 12 stations accepted, 1 with an inclination only, 1 rejected"));
  EXPECT_TRUE(holds(page, "class=\"card notice open\""));
  const std::string half = row_of(page, 1150.0), rejected = row_of(page, 1240.0);
  EXPECT_TRUE(holds(half, "class=\"open\">inclination only<"));
  EXPECT_TRUE(holds(half, "class=\"n bad\""));
  EXPECT_TRUE(holds(rejected, "class=\"bad\">rejected<"));
  EXPECT_FALSE(holds(rejected, "<td class=\"n \">56.00</td>"));
  EXPECT_TRUE(holds(page, "Do not use the stations at 1240.00 m"));
  EXPECT_TRUE(holds(page, "Use no azimuth at 1150.00 m"));
  const std::string refused = page.substr(page.find("<section id=\"refused\""));
  EXPECT_TRUE(holds(refused, "the whole station</td><td>gravity failed its check"));
  EXPECT_TRUE(holds(refused, "azimuth</td><td class=\"long \">the magnetic field failed its checks"));
  EXPECT_TRUE(holds(refused, "of vertical"));  // the first station
}

TEST(SurveyPage, WithoutADeclinationSaysThatEveryAzimuthIsMagnetic) {
  std::vector<ReferencedStation> stations = hole();
  for (ReferencedStation& s : stations) s.reference.field.declination_known = false;
  const std::string page = page_of(report_of(stations));
  EXPECT_TRUE(holds(page, "There is no declination: every azimuth of this page is magnetic."));
  EXPECT_TRUE(holds(page, "azi magnetic, deg"));
  EXPECT_FALSE(holds(page, "azi true, deg"));
}

TEST(SurveyPage, TellsOfAnInterferenceThatWasRefusedAndOfRowsLeftOut) {
  SurveySettings settings;
  settings.correct_axial = true;
  render::SurveyReport report = report_of(hole(3), settings);
  report.rows_left_out = 2;
  const std::string page = page_of(report);
  EXPECT_EQ(unbalanced(page), "");
  EXPECT_TRUE(holds(page, "The axial interference could not be estimated."));
  EXPECT_TRUE(holds(page, "3 stations are too few"));
  EXPECT_TRUE(holds(page, "2 rows of the file left out"));
  EXPECT_TRUE(holds(page_of(report_of(hole(12), settings)), "taken off every station"));
}

TEST(SurveyPage, IsOneFileThatAsksNothingOfTheNetwork) {
  const std::string page = page_of(report_of(hole()));
  for (const char* word : {"http:", "https:", "<script", "<img", "@import", "src="})
    EXPECT_FALSE(holds(page, word)) << word;
}

TEST(SurveyPage, TakesNoTextForMarkup) {
  std::vector<ReferencedStation> stations = hole();
  for (ReferencedStation& s : stations) s.reference.field.source = "<b>&model";
  const std::string page =
      page_of(report_of(stations, {}, "<script>alert(1)</script>.csv"), "plumb survey '<i>' & \"x\"");
  EXPECT_EQ(unbalanced(page), "");
  EXPECT_FALSE(holds(page, "<script"));
  EXPECT_FALSE(holds(page, "<i>"));
  EXPECT_FALSE(holds(page, "<b>&model"));
  EXPECT_TRUE(holds(page, "&lt;b&gt;&amp;model"));
}

TEST(SurveyPlot, DrawsLimitsAndMarksWhatIsFurtherOff) {
  std::vector<ReferencedStation> stations = hole();
  stations[8].measured.gravity_mps2 = scaled(stations[8].measured.gravity_mps2, 1.01);
  const render::SurveyReport report = report_of(stations);
  const std::vector<render::PlotFile> files = render::survey_plot_files(report);
  ASSERT_EQ(files.size(), 3U);
  const std::string& data = files[0].text;
  EXPECT_EQ(std::count(data.begin(), data.end(), '\n'), 13);
  EXPECT_TRUE(holds(data, "\n1240.000,"));
  EXPECT_TRUE(holds(files.back().text, "set label '+10.00' at 1240.000"));
  EXPECT_TRUE(holds(files.back().text, ".'survey-path.svg'\n"));
  EXPECT_EQ(render::survey_picture_names(report).size(), 2U);
  EXPECT_EQ(render::survey_picture_names(report_of(hole(1))).size(), 1U);
  EXPECT_EQ(render::survey_plot_files(report_of(hole(1))).size(), 2U);
}

// Verifies: REQ-238
RC_GTEST_PROP(SurveyPageLaw, HoldsAnyStationsAndIsWellFormed, ()) {
  std::vector<ReferencedStation> stations = hole(*rc::gen::inRange(1, 9));
  for (ReferencedStation& s : stations) {
    const double factor = *rc::gen::element(0.0, 1e-300, 0.5, 1.0, 1.0, 1.0, -1.0, 1e300);
    const auto axis = static_cast<std::size_t>(*rc::gen::inRange(0, 3));
    (*rc::gen::arbitrary<bool>() ? s.measured.gravity_mps2 : s.measured.field_tesla)[axis] *= factor;
  }
  SurveySettings settings;
  settings.correct_axial = *rc::gen::arbitrary<bool>();
  const std::string name = *rc::gen::container<std::string>(rc::gen::elementOf(std::string("<>&\"'a/ {}\n\x01")));
  const render::SurveyReport report = report_of(stations, settings, name);
  const std::string page = page_of(report, "plumb survey " + name);
  RC_ASSERT(unbalanced(page) == "");
  for (const SurveyStation& s : report.survey.stations) RC_ASSERT(!row_of(page, s.measured.md_m).empty());
  RC_ASSERT(!render::survey_plot_files(report).back().text.empty());
}

}  // namespace
}  // namespace survey_page_test

#include "plumb/render/survey_page.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "html_view.hpp"
#include "plumb/io/printable.hpp"
#include "plumb/render/figures.hpp"
#include "plumb/render/identity.hpp"
#include "plumb/scenario/count_text.hpp"
#include "survey_words.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {
namespace {

using survey::Angle;
using survey::OrUndefined;
using survey::StationStatus;
using survey::Survey;
using survey::SurveyStation;

const char* tone_of(StationStatus status) {
  if (status == StationStatus::accepted) return "good";
  return status == StationStatus::rejected ? "bad" : "open";
}

std::size_t count_of(const Survey& found, StationStatus status) {
  std::size_t out = 0;
  for (const SurveyStation& s : found.stations) out += s.status == status ? 1 : 0;
  return out;
}

struct NamedTest {
  const char* name;
  const survey::ErrorTest* test;
  double unit;
  const char* unit_name;
};
std::array<NamedTest, 3> named_tests(const survey::ErrorTests& tests) {
  return {{{"gravity", &tests.gravity, kMg_mps2, "mg"},
           {"field", &tests.field, 1e-9, "nT"},
           {"dip", &tests.dip, rad_from_deg(1.0), "deg"}}};
}

/// "field and dip", of those that found something.
std::string failed_tests(const Survey& found) {
  std::string out;
  if (!found.tests) return out;
  for (const NamedTest& one : named_tests(*found.tests)) {
    if (!one.test->passed()) out += (out.empty() ? "" : ", ") + std::string(one.name);
  }
  return out;
}

std::string tests_value(const Survey& found) {
  if (!found.tests) return "not made";
  const std::string failed = failed_tests(found);
  return failed.empty() ? "passed" : "not passed: " + failed;
}

std::string verdict_sentence(const Survey& found) {
  const std::size_t all = found.stations.size(), accepted = count_of(found, StationStatus::accepted),
                    half = count_of(found, StationStatus::inclination_only),
                    rejected = count_of(found, StationStatus::rejected);
  std::string out = fmt::format("{} of {} accepted", accepted, count_text(all, "station"));
  if (half > 0) out += fmt::format(", {} with an inclination only", half);
  if (rejected > 0) out += fmt::format(", {} rejected", rejected);
  const std::string failed = failed_tests(found);
  out += found.tests ? (failed.empty() ? ". The error tests pass." : ". The error tests do not pass: " + failed + ".")
                     : ". The error tests were not made.";
  if (found.axial && !*found.axial) out += " The axial interference could not be estimated.";
  return out;
}

std::string verdict_tone(const Survey& found) {
  const std::size_t accepted = count_of(found, StationStatus::accepted);
  if (accepted == 0) return "bad";
  const bool whole = accepted == found.stations.size() && found.path && (!found.axial || found.axial->has_value());
  return whole && found.tests && failed_tests(found).empty() ? "good" : "open";
}

std::vector<std::string> actions_of(const Survey& found) {
  std::vector<std::string> out;
  std::string half, rejected;
  for (const SurveyStation& s : found.stations) {
    std::string& list = s.status == StationStatus::rejected ? rejected : half;
    if (s.status != StationStatus::accepted)
      list += (list.empty() ? "" : ", ") + fmt::format("{:.2f} m", s.measured.md_m);
  }
  if (!rejected.empty())
    out.push_back("Do not use the stations at " + rejected + ": gravity failed its check. Survey them again at rest.");
  if (!half.empty())
    out.push_back("Use no azimuth at " + half +
                  ": the field failed its checks. Look for magnetic interference and for a wrong place or date.");
  for (const survey::SaturatedChannel& one : found.saturated) out.push_back(one.text() + ".");
  if (found.tests && !found.tests->gravity.mean_passed())
    out.push_back("Gravity is off at all stations alike: check its reference and the calibration of accelerometers.");
  if (found.tests && !(found.tests->field.mean_passed() && found.tests->dip.mean_passed()))
    out.push_back(found.axial ? "The field is off at all stations alike: check its reference."
                              : "The field is off at all stations alike: check its reference, and have the axial "
                                "interference estimated (--axial).");
  if (found.axial && !*found.axial) out.push_back(found.axial->error().text() + ".");
  if (!found.path) out.push_back("There is no path: " + found.path.error().text() + ".");
  return out;
}

Section verdict_section(const SurveyReport& r) {
  const Survey& found = r.survey;
  Section out("verdict", "1 Verdict", "Which stations may be used, and what to do.");
  out.notice(verdict_sentence(found), verdict_tone(found));
  const std::vector<std::string> actions = actions_of(found);
  if (!actions.empty()) out.list("What to do", actions);
  std::string end = "none", below = "no path";
  if (found.path) {
    const survey::PathPoint& at = found.path->back();
    end = fmt::format("{:.1f} m {}, {:.1f} m {}", std::fabs(at.north_m), at.north_m < 0.0 ? "S" : "N",
                      std::fabs(at.east_m), at.east_m < 0.0 ? "W" : "E");
    below = fmt::format("{} north, {:.1f} m true vertical depth", to_string(found.north), at.tvd_m);
  }
  out.figures({{"Accepted", std::to_string(count_of(found, StationStatus::accepted)), "all three checks passed",
                count_of(found, StationStatus::accepted) > 0 ? "good" : ""},
               {"Inclination only", std::to_string(count_of(found, StationStatus::inclination_only)),
                "the field failed: no azimuth", count_of(found, StationStatus::inclination_only) > 0 ? "open" : ""},
               {"Rejected", std::to_string(count_of(found, StationStatus::rejected)), "gravity failed: nothing of it",
                count_of(found, StationStatus::rejected) > 0 ? "bad" : ""},
               {"Error tests", tests_value(found), "all stations together"},
               {"Azimuths from", std::string(to_string(found.north)) + " north", "in table, plots and path"},
               {"End of the path", end, below}});
  return out;
}

Section reference_section(const SurveyReport& r) {
  Section out("references", "2 References", "What gravity and the field should be, how sure that is, and which north.");
  const geomagnetic::FieldReference& f = r.first.field;
  const std::string source = io::printable_line(f.source);
  const auto row = [&](const char* what, const char* unit, const std::string& first, const std::string& last,
                       const std::string& sigma,
                       const std::string& from) { return std::vector<ViewCell>{what, unit, first, last, sigma, from}; };
  const auto degrees = [](double rad) { return fmt::format("{:.2f}", deg_from_rad(rad)); };
  const bool normal = r.first.gravity.model == GravityModel::normal;
  ViewRows rows{row("gravity", "m/s^2", fmt::format("{:.5f}", r.first.gravity.g_mps2),
                    fmt::format("{:.5f}", r.last.gravity.g_mps2), fmt::format("{:.5f}", r.first.gravity.sigma_mps2),
                    normal ? "normal gravity at the place" : "stated"),
                row("field", "nT", fmt::format("{:.0f}", f.total_tesla * 1e9),
                    fmt::format("{:.0f}", r.last.field.total_tesla * 1e9),
                    fmt::format("{:.0f}", total_sigma(f.total_tesla_sigma) * 1e9), source),
                row("dip", "deg", degrees(f.dip_rad), degrees(r.last.field.dip_rad),
                    degrees(total_sigma(f.dip_rad_sigma)), source)};
  if (f.declination_known)
    rows.push_back(row("declination, true to magnetic north", "deg", degrees(f.declination_rad),
                       degrees(r.last.field.declination_rad), degrees(total_sigma(f.declination_rad_sigma)), source));
  const survey::Convergence& convergence = r.settings.station.convergence;
  if (convergence.known)
    rows.push_back(row("convergence, true to grid north", "deg", degrees(convergence.rad), degrees(convergence.rad),
                       "-", "stated; of a map, exact"));
  out.table("References", {"quantity", "unit", "first station", "last station", "1 sigma", "source"}, rows);
  if (!f.declination_known) out.notice("There is no declination: every azimuth of this page is magnetic.", "open");
  if (!f.declination_note.empty()) out.notice("Declination: " + f.declination_note + ".", "open");
  const survey::CheckSettings& checks = r.settings.station.checks;
  out.table("Limits", {"what", "value"},
            {{"noise of a station's accelerometer means, mg", fmt::format("{:.3g}", r.noise_mps2 / kMg_mps2)},
             {"noise of a station's magnetometer means, nT", fmt::format("{:.3g}", r.noise_tesla * 1e9)},
             {"limits of the checks", to_string(checks.limits)},
             {"false alarms of a check", checks.limits == survey::LimitKind::from_uncertainty
                                             ? fmt::format("{:.2g}", checks.false_alarm)
                                             : std::string("-")},
             {"risk of the protection levels", fmt::format("{:.2g}", r.survey.integrity_risk)}});
  return out;
}

/// With its sign, of which a zero has none.
std::string signed_number(double value, int decimals) {
  const std::string out = unsigned_zero(fmt::format("{:.{}f}", value, decimals));
  return value > 0.0 && out.find_first_of("123456789") != std::string::npos ? "+" + out : out;
}

ViewRows station_rows(const SurveyReport& r) {
  ViewRows rows;
  for (const SurveyStation& s : r.survey.stations) {
    const OrUndefined<Angle> azimuth = survey::azimuth_from(s, r.survey.north);
    const survey::StationChecks& c = s.checks;
    const auto difference = [](const survey::Check& check, double unit, int decimals) {
      return ViewCell(signed_number(check.difference() / unit, decimals), check.passed ? "" : "bad");
    };
    const double risk = r.survey.integrity_risk;
    rows.push_back({fmt::format("{:.2f}", s.measured.md_m), survey_degrees(s.attitude.inclination),
                    survey_level(s.attitude.inclination, risk), survey_degrees(azimuth), survey_level(azimuth, risk),
                    survey_degrees(s.attitude.gravity_toolface), survey_degrees(s.attitude.magnetic_toolface),
                    difference(c.gravity, kMg_mps2, 2), fmt::format("{:.2f}", c.gravity.limit / kMg_mps2),
                    difference(c.field, 1e-9, 0), fmt::format("{:.0f}", c.field.limit * 1e9),
                    difference(c.dip, rad_from_deg(1.0), 2), fmt::format("{:.2f}", deg_from_rad(c.dip.limit)),
                    ViewCell(to_string(s.status), tone_of(s.status)),
                    s.flags().empty() ? std::string("-") : s.flags()});
  }
  return rows;
}

Section station_section(const SurveyReport& r, const PagePictures& pictures) {
  Section out("stations", "3 Stations", "Every station with its angles, its checks and its verdict.");
  out.picture(
      "Checks", picture_of(pictures, kSurveyChecksPicture),
      "Gravity, field and dip less their references against measured depth, with the limits as bands",
      "Measured less reference. Band: the limit at each station. A triangle failed; one at the edge of its panel "
      "is further off, and its value stands beside it.");
  out.table(
      "Every station",
      {"MD, m", "inc, deg", "PL", fmt::format("azi {}, deg", to_string(r.survey.north)), "PL", "GTF, deg", "MTF, deg",
       "dG, mg", "limit", "dB, nT", "limit", "ddip, deg", "limit", "verdict", "flags"},
      station_rows(r),
      fmt::format("PL: protection level, which the angle's error exceeds with a chance of {:.2g}. GTF, MTF: gravity "
                  "and magnetic toolface, the latter from magnetic north. dG, dB, ddip: measured less reference. "
                  "Flags: G, B, D the check that failed; V too near vertical for an azimuth; H no horizontal "
                  "field; N not finite. A dash: withheld or undefined, see section 6.",
                  r.survey.integrity_risk));
  return out;
}

Section path_section(const SurveyReport& r, const PagePictures& pictures) {
  Section out("path", "4 Path", "Where the hole goes, by minimum curvature through the accepted stations.");
  if (!r.survey.path) {
    out.notice(path_words(r.survey) + ".", "bad");
    return out;
  }
  out.text(path_words(r.survey) + ".");
  if (r.survey.path->size() > 1)
    out.picture("Path", picture_of(pictures, kSurveyPathPicture),
                "The path of the hole from above, and in a vertical section",
                "Both axes of a panel have one scale. The section lies in the direction of the last station.");
  ViewRows rows;
  for (std::size_t k = 0; k < r.survey.path->size(); ++k) {
    const survey::PathPoint& p = (*r.survey.path)[k];
    const auto sigma = [&](std::size_t at) {
      return k < r.survey.position_covariance.size()
                 ? fmt::format("{:.2f}", std::sqrt(r.survey.position_covariance[k][at]))
                 : std::string("-");
    };
    rows.push_back({fmt::format("{:.2f}", p.md_m), fmt::format("{:.2f}", p.tvd_m), fmt::format("{:.2f}", p.north_m),
                    fmt::format("{:.2f}", p.east_m), fmt::format("{:.2f}", p.dogleg_deg_per_30m), sigma(0), sigma(4),
                    sigma(8)});
  }
  out.table("Positions",
            {"MD, m", "TVD, m", fmt::format("{} north, m", to_string(r.survey.north)), "east, m", "dogleg, deg/30 m",
             "sigma north, m", "sigma east, m", "sigma TVD, m"},
            rows,
            "The first station is the origin, as deep as it is along the hole. Sigma: 1 sigma from the errors of "
            "inclination and azimuth" +
                sigma_words(r.survey.path_sigmas) + ".");
  return out;
}

Section tests_section(const Survey& found) {
  Section out("tests", "5 Error tests", "What all stations say together, and the interference of the drill string.");
  if (found.tests) {
    ViewRows rows;
    for (const NamedTest& one : named_tests(*found.tests)) {
      const survey::ErrorTest& t = *one.test;
      const auto worst = static_cast<std::size_t>(t.worst);
      rows.push_back(
          {one.name, ViewCell(t.passed() ? "passed" : "not passed", t.passed() ? "good" : "bad"),
           fmt::format("{:.2f}", found.stations[worst].measured.md_m),
           ViewCell(fmt::format("{:+.2f}", t.normalised[worst]), t.one_passed() ? "" : "bad"),
           fmt::format("{:.2f}", t.one_limit),
           ViewCell(fmt::format("{:+.3g} {}", t.mean / one.unit, one.unit_name), t.mean_passed() ? "" : "bad"),
           fmt::format("{:.3g}", t.mean_limit / one.unit),
           ViewCell(fmt::format("{:.1f}", t.chi_square), t.all_passed() ? "" : "bad"),
           fmt::format("{:.1f}", t.chi_square_limit)});
    }
    out.table("Error tests",
              {"of", "result", "worst station, m", "off by, sigma", "limit", "all alike off by", "limit", "chi-square",
               "limit"},
              rows, "One station, all alike, all together; of the readings, before any correction.");
    for (const NamedTest& one : named_tests(*found.tests)) {
      if (!one.test->passed())
        out.text(fmt::format("{}: {}.", one.name, error_test_words(*one.test, one.unit, one.unit_name, found)));
    }
  } else {
    out.notice("The error tests were not made: " + found.tests_refused + ".", "open");
  }
  if (found.alignment) {
    out.heading("Alignment of the magnetometers");
    out.notice(alignment_words(found), *found.alignment ? "good" : "bad");
  }
  out.heading("Axial interference");
  if (found.axial)
    out.notice(axial_words(found), *found.axial ? "good" : "bad");
  else
    out.text("Not estimated: nobody asked for it (--axial). The azimuths allow for what the tool states.");
  return out;
}

Section refused_section(const SurveyReport& r) {
  Section out("refused", "6 Withheld and refused", "Every value that is not there, and why.");
  ViewRows rows;
  const auto add = [&rows](const SurveyStation& s, const char* what, const OrUndefined<Angle>& angle) {
    if (!angle) rows.push_back({fmt::format("{:.2f}", s.measured.md_m), what, angle.error().text()});
  };
  for (const SurveyStation& s : r.survey.stations) {
    if (!s.attitude.inclination) {
      add(s, "the whole station", s.attitude.inclination);
      continue;
    }
    add(s, "azimuth", survey::azimuth_from(s, r.survey.north));
    add(s, "gravity toolface", s.attitude.gravity_toolface);
    add(s, "magnetic toolface", s.attitude.magnetic_toolface);
  }
  if (r.rows_left_out > 0)
    out.notice(
        fmt::format("{} of the file left out: a number of it is missing or bad.", count_text(r.rows_left_out, "row")),
        "open");
  if (rows.empty())
    out.text("No value of a station was withheld.");
  else
    out.table("Values that are not there", {"MD, m", "what", "why"}, rows);
  return out;
}

Section identity_section(const SurveyReport& r, const SurveyIdentity& identity) {
  Section out("identity", "7 Identity", "Inputs, version and the command to make this page again.");
  const Json build = build_json();
  const auto text = [&](const char* key) { return build[key].get<std::string>(); };
  out.table("Identity", {"what", "value"},
            {{"tool", "plumb " + text("version")},
             {"commit", text("commit")},
             {"compiler", text("compiler")},
             {"columns", fmt::format("accelerometers in {}, magnetometers in {}",
                                     r.gravity_unit == "mps2" ? "m/s^2" : r.gravity_unit, r.field_unit)},
             {"made", identity.time},
             {"on", identity.host}});
  ViewRows inputs;
  for (const Json& i : identity.inputs)
    inputs.push_back({i["role"].get<std::string>(), i["name"].get<std::string>(),
                      i.contains("bytes") ? i["bytes"].dump() : std::string("-"),
                      i.contains("sha256") ? i["sha256"].get<std::string>() : std::string("not kept")});
  out.table("Inputs", {"role", "file", "bytes", "sha256"}, inputs);
  out.commands({identity.command});
  return out;
}

}  // namespace

std::string survey_html(const SurveyReport& r, const SurveyIdentity& identity, const PagePictures& pictures) {
  PageFrame frame;
  frame.title = "Survey: " + io::printable_line(r.file);
  frame.lead = fmt::format("{} from {:.2f} to {:.2f} m, azimuths from {} north, checked against {}.",
                           count_text(r.survey.stations.size(), "station"), r.survey.stations.front().measured.md_m,
                           r.survey.stations.back().measured.md_m, to_string(r.survey.north),
                           io::printable_line(r.first.field.source));
  frame.footer = "mg = 0.001 x 9.80665 m/s^2. docs/survey.md has formulas, sources and limits.";
  frame.run = fmt::format("Run {} on {}.", identity.time, identity.host);
  std::vector<Section> sections;
  sections.push_back(verdict_section(r));
  sections.push_back(reference_section(r));
  sections.push_back(station_section(r, pictures));
  sections.push_back(path_section(r, pictures));
  sections.push_back(tests_section(r.survey));
  sections.push_back(refused_section(r));
  sections.push_back(identity_section(r, identity));
  return sections_html(frame, std::move(sections));
}

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb

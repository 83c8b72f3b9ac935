#include <fmt/format.h>

#include <cmath>
#include <iterator>

#include "plumb/io/printable.hpp"
#include "plumb/render/figures.hpp"
#include "plumb/render/survey_report.hpp"
#include "survey_words.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {
namespace {

using survey::Angle;
using survey::OrUndefined;

std::string references(const SurveyReport& r) {
  const auto gravity = [](const survey::Reference& at) { return fmt::format("{:.5f}", at.gravity.g_mps2); };
  const auto field = [](const survey::Reference& at) { return fmt::format("{:.0f}", at.field.total_tesla * 1e9); };
  const auto dip = [](const survey::Reference& at) { return fmt::format("{:.2f}", deg_from_rad(at.field.dip_rad)); };
  const geomagnetic::FieldReference& f = r.first.field;
  std::string out = fmt::format(
      "Reference: gravity {} m/s^2 (1 sigma {:.2f} mg), field {} nT ({:.0f} nT), dip {} deg ({:.2f} deg); {}\n",
      survey_span(gravity(r.first), gravity(r.last)), r.first.gravity.sigma_mps2 / kMg_mps2,
      survey_span(field(r.first), field(r.last)), total_sigma(f.total_tesla_sigma) * 1e9,
      survey_span(dip(r.first), dip(r.last)), deg_from_rad(total_sigma(f.dip_rad_sigma)), io::printable_line(f.source));
  if (f.declination_known)
    out += fmt::format("Declination: {:.2f} deg from true north ({:.2f} deg)\n", deg_from_rad(f.declination_rad),
                       deg_from_rad(total_sigma(f.declination_rad_sigma)));
  else
    out += "Declination: not known; azimuths are magnetic\n";
  if (!f.declination_note.empty()) out += "Declination: " + f.declination_note + "\n";
  if (r.settings.station.convergence.known)
    out += fmt::format("Convergence: {:.2f} deg from true to grid north\n",
                       deg_from_rad(r.settings.station.convergence.rad));
  return out;
}

std::string station_lines(const SurveyReport& r) {
  std::string out = fmt::format("{:>9} {:>7} {:>7} {:>7} {:>7} {:>7} {:>8} {:>7} {:>7}  {}\n", "MD m", "inc", "azimuth",
                                "PL inc", "PL azi", "GTF", "dG mg", "dB nT", "dDip", "verdict");
  for (const survey::SurveyStation& s : r.survey.stations) {
    const OrUndefined<Angle> azimuth = survey::azimuth_from(s, r.survey.north);
    fmt::format_to(std::back_inserter(out), "{:>9.2f} {:>7} {:>7} {:>7} {:>7} {:>7} {:>8} {:>7} {:>7}  {}",
                   s.measured.md_m, survey_degrees(s.attitude.inclination), survey_degrees(azimuth),
                   survey_level(s.attitude.inclination, r.survey.integrity_risk),
                   survey_level(azimuth, r.survey.integrity_risk), survey_degrees(s.attitude.gravity_toolface),
                   fixed_words(s.checks.gravity.difference() / kMg_mps2, 2),
                   fixed_words(s.checks.field.difference() * 1e9, 0),
                   fixed_words(deg_from_rad(s.checks.dip.difference()), 2), to_string(s.status));
    if (!s.flags().empty()) out += " (" + s.flags() + ")";
    out += '\n';
  }
  return out;
}

std::string test_line(const char* kind, const survey::ErrorTest& test, double unit, const char* name,
                      const SurveyReport& r) {
  return fmt::format("  {:<8}{}\n", kind, error_test_words(test, unit, name, r.survey));
}

}  // namespace

std::string survey_text(const SurveyReport& r) {
  std::string out =
      fmt::format("{}: {} stations, accelerometers in {}, magnetometers in {}\n", io::printable_line(r.file),
                  r.survey.stations.size(), r.gravity_unit == "mps2" ? "m/s^2" : r.gravity_unit, r.field_unit);
  if (r.rows_left_out > 0) out += fmt::format("Rows left out for want of a number: {}\n", r.rows_left_out);
  if (!r.array.empty()) out += "References: " + io::printable_line(r.array) + "\n";
  out += references(r);
  out += fmt::format("Noise of a station: {:.2f} mg, {:.0f} nT. Limits: {}", r.noise_mps2 / kMg_mps2,
                     r.noise_tesla * 1e9, to_string(r.settings.station.checks.limits));
  if (r.settings.station.checks.limits == survey::LimitKind::from_uncertainty)
    out += fmt::format(", false alarms of a check {:.2g}", r.settings.station.checks.false_alarm);
  out += fmt::format(". Protection levels at a risk of {:.2g}.\n\n", r.survey.integrity_risk);
  out += fmt::format("Angles in degrees, azimuths from {} north\n", to_string(r.survey.north));
  out += station_lines(r);
  const std::string flags = flag_words(r.survey);
  if (!flags.empty()) out += "Flags: " + flags + "\n";
  for (const survey::SaturatedChannel& one : r.survey.saturated) out += one.text() + "\n";
  out += "\n";
  if (r.survey.tests) {
    out += "Error tests of all stations together\n";
    out += test_line("gravity", r.survey.tests->gravity, kMg_mps2, "mg", r);
    out += test_line("field", r.survey.tests->field, 1e-9, "nT", r);
    out += test_line("dip", r.survey.tests->dip, rad_from_deg(1.0), "deg", r);
  } else {
    out += "Error tests: none: " + r.survey.tests_refused + "\n";
  }
  if (r.survey.axial) out += axial_words(r.survey) + "\n";
  if (r.survey.alignment) out += alignment_words(r.survey) + "\n";
  return out + path_words(r.survey) + "\n";
}

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb

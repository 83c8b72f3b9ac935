#include <fmt/format.h>

#include <cmath>
#include <iterator>

#include "plumb/io/printable.hpp"
#include "plumb/render/survey_report.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {
namespace {

using survey::Angle;
using survey::OrUndefined;

constexpr double kMg_mps2 = 1e-3 * kG0_mps2;

std::string degrees_or_dash(const OrUndefined<Angle>& angle) {
  return angle ? fmt::format("{:.2f}", deg_from_rad(angle->rad)) : "-";
}

/// "0.4 to 0.5", or one of them where both are written alike.
std::string span(const std::string& first, const std::string& last) {
  return first == last ? first : first + " to " + last;
}

std::string references(const SurveyReport& r) {
  const auto gravity = [](const survey::Reference& at) { return fmt::format("{:.5f}", at.gravity.g_mps2); };
  const auto field = [](const survey::Reference& at) { return fmt::format("{:.0f}", at.field.total_tesla * 1e9); };
  const auto dip = [](const survey::Reference& at) { return fmt::format("{:.2f}", deg_from_rad(at.field.dip_rad)); };
  const geomagnetic::FieldReference& f = r.first.field;
  const auto sigma = [](const geomagnetic::Sigma& s) { return std::hypot(s.common, s.random); };
  std::string out = fmt::format(
      "Reference: gravity {} m/s^2 (1 sigma {:.2f} mg), field {} nT ({:.0f} nT), dip {} deg ({:.2f} deg); {}\n",
      span(gravity(r.first), gravity(r.last)), r.first.gravity.sigma_mps2 / kMg_mps2,
      span(field(r.first), field(r.last)), sigma(f.total_tesla_sigma) * 1e9, span(dip(r.first), dip(r.last)),
      deg_from_rad(sigma(f.dip_rad_sigma)), io::printable_line(f.source));
  if (f.declination_known)
    out += fmt::format("Declination: {:.2f} deg from true north ({:.2f} deg)\n", deg_from_rad(f.declination_rad),
                       deg_from_rad(sigma(f.declination_rad_sigma)));
  else
    out += "Declination: not known; azimuths are magnetic\n";
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
    const auto level = [&](const OrUndefined<Angle>& angle) {
      return angle ? fmt::format("{:.2f}", deg_from_rad(survey::protection_level_rad(*angle, r.survey.integrity_risk)))
                   : "-";
    };
    fmt::format_to(std::back_inserter(out), "{:>9.2f} {:>7} {:>7} {:>7} {:>7} {:>7} {:>8.2f} {:>7.0f} {:>7.2f}  {}",
                   s.measured.md_m, degrees_or_dash(s.attitude.inclination), degrees_or_dash(azimuth),
                   level(s.attitude.inclination), level(azimuth), degrees_or_dash(s.attitude.gravity_toolface),
                   s.checks.gravity.difference() / kMg_mps2, s.checks.field.difference() * 1e9,
                   deg_from_rad(s.checks.dip.difference()), to_string(s.status));
    if (!s.flags().empty()) out += " (" + s.flags() + ")";
    out += '\n';
  }
  return out;
}

/// "gravity: passed", or which of the tests found what.
std::string test_line(const char* kind, const survey::ErrorTest& test, double unit, const char* name,
                      const SurveyReport& r) {
  std::string out = fmt::format("  {:<8}", kind);
  if (test.passed()) return out + "passed\n";
  std::string said;
  const auto add = [&said](const std::string& text) { said += (said.empty() ? "" : "; ") + text; };
  if (!test.one_passed()) {
    const auto worst = static_cast<std::size_t>(test.worst);
    add(fmt::format("the station at {:.2f} m is off by {:.1f} sigma, at most {:.1f}",
                    r.survey.stations[worst].measured.md_m, std::fabs(test.normalised[worst]), test.one_limit));
  }
  if (!test.mean_passed())
    add(fmt::format("all together are off by {:.3g} {}, at most {:.2g}", test.mean / unit, name,
                    test.mean_limit / unit));
  if (!test.all_passed()) add(fmt::format("chi-square {:.1f}, at most {:.1f}", test.chi_square, test.chi_square_limit));
  return out + said + "\n";
}

std::string axial_text(const survey::Survey& s) {
  if (!s.axial) return "";
  if (!*s.axial) return "Axial interference: not estimated: " + s.axial->error().text() + ".\n";
  const survey::Estimate& e = **s.axial;
  const auto z = static_cast<std::size_t>(survey::Term::magnetometer_bias_z);
  return fmt::format(
      "Axial interference: {:.0f} nT, 1 sigma {:.0f} nT, taken off every station; its largest correlation with an "
      "error of "
      "a reference is {:.2f}, which the sigma holds.\n",
      e.value[z] * 1e9, e.sigma[z] * 1e9, e.largest_reference_correlation);
}

std::string alignment_text(const survey::Survey& s) {
  if (!s.alignment) return "";
  if (!*s.alignment) return "Alignment of the magnetometers: not estimated: " + s.alignment->error().text() + ".\n";
  const survey::JointAlignment& a = **s.alignment;
  const auto three = [](const Vec3& rad) {
    const auto one = [](double x) { return 0.0 + std::round(1000.0 * deg_from_rad(x)) / 1000.0; };  // no -0.000
    return fmt::format("{:.3f}, {:.3f}, {:.3f}", one(rad[0]), one(rad[1]), one(rad[2]));
  };
  const survey::AlignmentAxis& weakest = a.axis[0];
  std::string out = fmt::format(
      "Alignment of the magnetometers: turned by {} deg about tool x, y, z (1 sigma {} deg), and the field of every "
      "station turned with them. Weakest about {}: {:.3f} deg",
      three(a.turn_rad), three(a.sigma_rad), weakest.name(), deg_from_rad(weakest.sigma_rad));
  if (!weakest.with.empty())
    out += fmt::format(", which holds its correlation of {:.2f} with {}", weakest.correlation, weakest.with);
  return out + fmt::format(". Dips held out: {:.3f} deg rms, {:.2f} times their sigma.\n",
                           deg_from_rad(a.held_out.rms_rad), a.held_out.normalised);
}

std::string path_text(const survey::Survey& s) {
  if (!s.path) return "Path: none: " + s.path.error().text() + "\n";
  const survey::PathPoint& end = s.path->back();
  return fmt::format(
      "Path of {} stations, minimum curvature from {} north: at {:.2f} m north {:.2f} m, east {:.2f} m, true vertical "
      "depth "
      "{:.2f} m\n",
      s.path->size(), to_string(s.north), end.md_m, end.north_m, end.east_m, end.tvd_m);
}

}  // namespace

std::string survey_text(const SurveyReport& r) {
  std::string out =
      fmt::format("{}: {} stations, accelerometers in {}, magnetometers in {}\n", io::printable_line(r.file),
                  r.survey.stations.size(), r.gravity_unit == "mps2" ? "m/s^2" : r.gravity_unit, r.field_unit);
  if (r.rows_left_out > 0) out += fmt::format("Rows left out for want of a number: {}\n", r.rows_left_out);
  out += references(r);
  out += fmt::format("Noise of a station: {:.2f} mg, {:.0f} nT. Limits: {}", r.noise_mps2 / kMg_mps2,
                     r.noise_tesla * 1e9, to_string(r.settings.station.checks.limits));
  if (r.settings.station.checks.limits == survey::LimitKind::from_uncertainty)
    out += fmt::format(", false alarms of a check {:.2g}", r.settings.station.checks.false_alarm);
  out += fmt::format(". Protection levels at a risk of {:.2g}.\n\n", r.survey.integrity_risk);
  out += fmt::format("Angles in degrees, azimuths from {} north\n", to_string(r.survey.north));
  out += station_lines(r) + "\n";
  if (r.survey.tests) {
    out += "Error tests of all stations together\n";
    out += test_line("gravity", r.survey.tests->gravity, kMg_mps2, "mg", r);
    out += test_line("field", r.survey.tests->field, 1e-9, "nT", r);
    out += test_line("dip", r.survey.tests->dip, rad_from_deg(1.0), "deg", r);
  } else {
    out += "Error tests: none: " + r.survey.tests_refused + "\n";
  }
  return out + axial_text(r.survey) + alignment_text(r.survey) + path_text(r.survey);
}

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb

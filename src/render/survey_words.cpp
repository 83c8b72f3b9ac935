#include "survey_words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {

using survey::Angle;
using survey::OrUndefined;

std::string survey_span(const std::string& first, const std::string& last) {
  return first == last ? first : first + " to " + last;
}

double total_sigma(const geomagnetic::Sigma& sigma) { return std::hypot(sigma.common, sigma.random); }

std::string survey_degrees(const OrUndefined<Angle>& angle) {
  if (!angle) return "-";
  const std::string out = fmt::format("{:.2f}", deg_from_rad(angle->rad));
  return out == "360.00" ? "0.00" : out;
}

std::string survey_level(const OrUndefined<Angle>& angle, double risk) {
  return angle ? fmt::format("{:.2f}", deg_from_rad(survey::protection_level_rad(*angle, risk))) : "-";
}

std::string flag_words(const survey::Survey& found) {
  constexpr std::pair<char, const char*> kMeanings[] = {
      {'N', "a number that is not finite"},      {'G', "gravity failed its check"},
      {'B', "the field failed its check"},       {'D', "the dip failed its check"},
      {'V', "too near vertical for an azimuth"}, {'H', "no horizontal field to speak of, so no azimuth"}};
  std::string out;
  for (const auto& [letter, meaning] : kMeanings) {
    const char flag = letter;
    const bool found_one = std::any_of(found.stations.begin(), found.stations.end(),
                                       [flag](const auto& s) { return s.flags().find(flag) != std::string::npos; });
    if (found_one) out += fmt::format("{}{} {}", out.empty() ? "" : "; ", letter, meaning);
  }
  return out;
}

std::string error_test_words(const survey::ErrorTest& test, double unit, const char* name,
                             const survey::Survey& found) {
  if (test.passed()) return "passed";
  std::string said;
  const auto add = [&said](const std::string& text) { said += (said.empty() ? "" : "; ") + text; };
  if (!test.one_passed()) {
    const auto worst = static_cast<std::size_t>(test.worst);
    add(fmt::format("the station at {:.2f} m is off by {:.1f} sigma, at most {:.1f}",
                    found.stations[worst].measured.md_m, std::fabs(test.normalised[worst]), test.one_limit));
  }
  if (!test.mean_passed())
    add(fmt::format("all together are off by {:.3g} {}, at most {:.2g}", test.mean / unit, name,
                    test.mean_limit / unit));
  if (!test.all_passed()) add(fmt::format("chi-square {:.1f}, at most {:.1f}", test.chi_square, test.chi_square_limit));
  return said;
}

namespace {

std::string left_out_words(const survey::Survey& found) {
  constexpr std::size_t kMostNamed = 8;
  if (found.left_out.empty()) return "";
  std::string out;
  for (std::size_t k = 0; k < std::min(kMostNamed, found.left_out.size()); ++k)
    out += fmt::format("{}{:.2f}", k == 0 ? "" : ", ", found.stations[found.left_out[k]].measured.md_m);
  if (found.left_out.size() > kMostNamed) out += fmt::format(" and {} more", found.left_out.size() - kMostNamed);
  return fmt::format(" Left out, as {} failed: {} m.",
                     found.left_out.size() == 1 ? "a check of it" : "checks of theirs", out);
}

}  // namespace

std::string sigma_words(const survey::PathSigmas& sigmas) {
  if (!sigmas.any()) return ", none of it for sag and depth, of which no errors are stated";
  std::string out;
  const auto add = [&out](bool stated, const std::string& text) {
    if (stated) out += (out.empty() ? "" : ", ") + text;
  };
  add(sigmas.sag_rad > 0.0, fmt::format("sag {:.3g} deg", deg_from_rad(sigmas.sag_rad)));
  add(sigmas.depth_m > 0.0, fmt::format("depth {:.3g} m", sigmas.depth_m));
  add(sigmas.depth_scale > 0.0, fmt::format("{:.3g} % of depth", 100.0 * sigmas.depth_scale));
  return ", with the stated " + out;
}

std::string axial_words(const survey::Survey& found) {
  if (!found.axial) return "";
  const std::string left_out = left_out_words(found);
  if (!*found.axial) return "Axial interference: not estimated: " + found.axial->error().text() + "." + left_out;
  const survey::Estimate& e = **found.axial;
  const auto z = static_cast<std::size_t>(survey::Term::magnetometer_bias_z);
  return fmt::format(
      "Axial interference: {:.0f} nT, 1 sigma {:.0f} nT, taken off every station; its largest correlation with an "
      "error of a reference is {:.2f}, which the sigma holds.{}",
      e.value[z] * 1e9, e.sigma[z] * 1e9, e.largest_reference_correlation, left_out);
}

std::string alignment_words(const survey::Survey& s) {
  if (!s.alignment) return "";
  const std::string left_out = left_out_words(s);
  if (!*s.alignment)
    return "Alignment of the magnetometers: not estimated: " + s.alignment->error().text() + "." + left_out;
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
  return out + fmt::format(". Dips held out: {:.3f} deg rms, {:.2f} times their sigma.{}",
                           deg_from_rad(a.held_out.rms_rad), a.held_out.normalised, left_out);
}

std::string path_words(const survey::Survey& found) {
  if (!found.path) return "Path: none: " + found.path.error().text();
  const survey::PathPoint& end = found.path->back();
  const std::string out = fmt::format(
      "Path of {} stations, minimum curvature from {} north: at {:.2f} m north {:.2f} m, east {:.2f} m, true vertical "
      "depth {:.2f} m",
      found.path->size(), to_string(found.north), end.md_m, end.north_m, end.east_m, end.tvd_m);
  const survey::PositionCovariance& c = found.position_covariance.back();
  return out + fmt::format("; 1 sigma {:.2f} m, {:.2f} m, {:.2f} m from the first{}", std::sqrt(c[0]), std::sqrt(c[4]),
                           std::sqrt(c[8]), sigma_words(found.path_sigmas));
}

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb

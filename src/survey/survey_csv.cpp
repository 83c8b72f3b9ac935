#include "plumb/survey/survey_csv.hpp"

#include <fmt/format.h>

#include <cmath>
#include <iterator>

namespace plumb {
inline namespace PLUMB_ABI {
namespace survey {
namespace {

constexpr const char* kHeader =
    "MD_m,Inc_deg,AziMag_deg,AziTrue_deg,AziGrid_deg,GTF_deg,MTF_deg,Gt_mg,Bt_nT,Dip_deg,dGt_mg,dBt_nT,dDip_deg,QC,"
    "Flags,"
    "sInc_deg,sAzi_deg,PLInc_deg,PLAzi_deg,TVD_m,North_m,East_m,DLS_deg_per_30m,sNorth_m,sEast_m,sTVD_m,AziNorth\n";

/// Rounded up to the next turn, 360.00 is written as 0.00.
std::string turn_text(const OrUndefined<Angle>& angle) {
  if (!angle) return "";
  const std::string text = fmt::format("{:.2f}", deg_from_rad(angle->rad));
  return text == "360.00" ? "0.00" : text;
}

std::string sigma_text(const OrUndefined<Angle>& angle) {
  return angle ? fmt::format("{:.3f}", deg_from_rad(angle->sigma_rad)) : "";
}

std::string level_text(const OrUndefined<Angle>& angle, double risk) {
  return angle ? fmt::format("{:.3f}", deg_from_rad(protection_level_rad(*angle, risk))) : "";
}

/// "-0.00" is 0.
std::string number(double value, int decimals) {
  const std::string text = fmt::format("{:.{}f}", value, decimals);
  return text.find_first_of("123456789") == std::string::npos && text[0] == '-' ? text.substr(1) : text;
}

void append_station(std::string& out, const Survey& survey, const SurveyStation& s, const PathPoint* point,
                    const PositionCovariance* covariance) {
  const double mg = 1e-3 * kG0_mps2;
  const OrUndefined<Angle> azimuth = azimuth_from(s, survey.north);
  const StationChecks& c = s.checks;
  const auto inclination =
      s.attitude.inclination ? number(deg_from_rad(s.attitude.inclination->rad), 2) : std::string();
  fmt::format_to(std::back_inserter(out), "{},{},{},{},{},{},{},", number(s.measured.md_m, 2), inclination,
                 turn_text(azimuth_from(s, North::magnetic)), turn_text(azimuth_from(s, North::true_north)),
                 turn_text(azimuth_from(s, North::grid)), turn_text(s.attitude.gravity_toolface),
                 turn_text(s.attitude.magnetic_toolface));
  fmt::format_to(std::back_inserter(out), "{},{},{},{},{},{},{},{},", number(c.gravity.measured / mg, 2),
                 number(c.field.measured * 1e9, 0), number(deg_from_rad(c.dip.measured), 2),
                 number(c.gravity.difference() / mg, 2), number(c.field.difference() * 1e9, 0),
                 number(deg_from_rad(c.dip.difference()), 2), to_string(s.status), s.flags());
  fmt::format_to(std::back_inserter(out), "{},{},{},{},", sigma_text(s.attitude.inclination), sigma_text(azimuth),
                 level_text(s.attitude.inclination, survey.integrity_risk), level_text(azimuth, survey.integrity_risk));
  if (point != nullptr)
    fmt::format_to(std::back_inserter(out), "{},{},{},{},", number(point->tvd_m, 2), number(point->north_m, 2),
                   number(point->east_m, 2), number(point->dogleg_deg_per_30m, 2));
  else
    out += ",,,,";
  if (covariance != nullptr)
    for (const std::size_t k : {0U, 4U, 8U}) out += number(std::sqrt((*covariance)[k]), 3) + ",";
  else
    out += ",,,";
  out += to_string(survey.north);
  out += '\n';
}

}  // namespace

std::string survey_csv(const Survey& survey) {
  std::string out = kHeader;
  std::size_t next = 0;
  for (std::size_t k = 0; k < survey.stations.size(); ++k) {
    const bool on_path = survey.path && next < survey.on_path.size() && survey.on_path[next] == k;
    append_station(out, survey, survey.stations[k], on_path ? &(*survey.path)[next] : nullptr,
                   on_path ? &survey.position_covariance[next] : nullptr);
    if (on_path) ++next;
  }
  return out;
}

}  // namespace survey
}  // namespace PLUMB_ABI
}  // namespace plumb

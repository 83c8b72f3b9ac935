// Any bytes as the stations of a survey, under both policies for bad rows, and the whole survey of what could be read:
// an azimuth only where every check passed, finite numbers, one row of the table a station.
#include <algorithm>
#include <string>
#include <vector>

#include "files.hpp"
#include "plumb/survey/station_file.hpp"
#include "plumb/survey/survey_csv.hpp"

namespace {

using namespace plumb;
using fuzz::demand;

survey::Reference reference() {
  survey::Reference out;
  out.gravity.g_mps2 = 9.81;
  out.gravity.sigma_mps2 = 1.5e-3;
  out.field.source = "stated";
  out.field.total_tesla = 50e-6;
  out.field.dip_rad = 1.25;
  out.field.total_tesla_sigma = {130e-9, 60e-9};
  out.field.dip_rad_sigma = {3.5e-3, 1.4e-3};
  out.field.declination_known = true;
  out.field.declination_rad_sigma = {7e-3, 2e-3};
  return out;
}

void demand_finite(const survey::OrUndefined<survey::Angle>& angle) {
  if (!angle) {
    demand(!angle.error().text().empty(), "an angle that is not there says why");
    return;
  }
  demand(std::isfinite(angle->rad) && std::isfinite(angle->sigma_rad) && angle->sigma_rad >= 0.0, "an angle is finite");
  const double level = survey::protection_level_rad(*angle, 1e-4);
  demand(level >= 0.0 && level <= 3.2, "a protection level is an angle");
}

void survey_of(const std::vector<survey::Measurement>& stations, bool axial) {
  std::vector<survey::ReferencedStation> referenced;
  for (survey::Measurement m : stations) {
    m.random = survey::independent_covariance(1e-3, 20e-9);
    referenced.push_back({m, reference()});
  }
  survey::SurveySettings settings;
  settings.correct_axial = axial;
  settings.station.convergence = {true, 0.02};
  const survey::Survey found = survey::run_survey(referenced, settings);
  demand(found.stations.size() == stations.size(), "every station is judged");
  for (const survey::SurveyStation& s : found.stations) {
    const bool accepted = s.status == survey::StationStatus::accepted;
    demand(!accepted || (s.checks.gravity.passed && s.checks.field_passed()), "accepted is what passed");
    for (const auto north : {survey::North::magnetic, survey::North::true_north, survey::North::grid}) {
      const survey::OrUndefined<survey::Angle> azimuth = survey::azimuth_from(s, north);
      demand(!azimuth || accepted, "an azimuth needs every check");
      demand_finite(azimuth);
    }
    demand_finite(s.attitude.inclination);
    demand_finite(s.attitude.gravity_toolface);
    demand_finite(s.attitude.magnetic_toolface);
  }
  demand(found.path.has_value() || !found.path.error().what.empty(), "no path says why");
  if (found.path) {
    demand(found.position_covariance.size() == found.path->size(), "a covariance a position");
    for (const survey::PositionCovariance& c : found.position_covariance)
      demand(c[0] >= 0.0 && c[4] >= 0.0 && c[8] >= 0.0, "variances");
    for (const survey::PathPoint& p : *found.path)
      demand(std::isfinite(p.north_m + p.east_m + p.tvd_m + p.dogleg_deg_per_30m), "a position is finite");
  }
  const std::string table = survey::survey_csv(found);
  const auto lines = static_cast<std::size_t>(std::count(table.begin(), table.end(), '\n'));
  const auto commas = static_cast<std::size_t>(std::count(table.begin(), table.end(), ','));
  demand(lines == stations.size() + 1 && commas % lines == 0, "a row a station, all of one width");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const fuzz::MemoryFile file(data, size);
  for (const auto policy : {io::BadRowPolicy::stop, io::BadRowPolicy::skip}) {
    const io::FileExpected<survey::StationFile> read = survey::read_stations(file.path(), policy);
    if (!read) {
      fuzz::demand_told(read.error());
      continue;
    }
    demand(!read->stations.empty(), "what is read has stations");
    survey_of(read->stations, size % 2 == 0);
  }
  return 0;
}

#include "plumb/survey/survey_run.hpp"

#include <cmath>

namespace plumb {
inline namespace PLUMB_ABI {
namespace survey {
namespace {

North north_of(const SurveySettings& settings, const std::vector<ReferencedStation>& stations) {
  if (settings.north) return *settings.north;
  const bool declination = !stations.empty() && stations.front().reference.field.declination_known;
  if (!declination) return North::magnetic;
  return settings.station.convergence.known ? North::grid : North::true_north;
}

/// A station that can stand on a path: with its azimuth, or vertical.
std::optional<PathStation> path_station(const SurveyStation& station, North north) {
  if (station.status != StationStatus::accepted) return std::nullopt;
  const OrUndefined<Angle> azimuth = azimuth_from(station, north);
  if (!azimuth && azimuth.error().why != NoAngle::vertical) return std::nullopt;
  return PathStation{station.measured.md_m, station.attitude.inclination->rad, azimuth.has_value(),
                     azimuth ? azimuth->rad : 0.0};
}

}  // namespace

OrUndefined<Angle> azimuth_from(const SurveyStation& station, North north) {
  const auto angle_of = [](const auto& azimuth) {
    return azimuth ? OrUndefined<Angle>(azimuth->angle)
                   : OrUndefined<Angle>(tl::unexpected<Undefined>(azimuth.error()));
  };
  if (north == North::grid) return angle_of(station.grid_azimuth);
  return north == North::true_north ? angle_of(station.true_azimuth) : angle_of(station.attitude.azimuth);
}

std::vector<double> depths_m(const std::vector<Measurement>& stations) {
  std::vector<double> out;
  for (std::size_t k = 0; k < stations.size(); ++k) {
    const auto cosine = [&](std::size_t i) {
      const double length = norm(stations[i].gravity_mps2);
      return length > 0.0 ? stations[i].gravity_mps2[2] / length : 1.0;
    };
    out.push_back(k == 0 ? stations[0].md_m
                         : out.back() + 0.5 * (cosine(k - 1) + cosine(k)) * (stations[k].md_m - stations[k - 1].md_m));
  }
  return out;
}

Survey run_survey(const std::vector<ReferencedStation>& stations, const SurveySettings& settings) {
  Survey out{{},
             settings.integrity_risk,
             north_of(settings, stations),
             study_wiring(stations, settings.station.tool),
             {},
             {},
             {},
             {},
             {},
             {},
             {}};
  ErrorTestSettings tests;
  tests.tool = settings.station.tool;
  tests.false_alarm = settings.station.checks.false_alarm;
  if (io::FileExpected<ErrorTests> found = error_tests(stations, tests))
    out.tests = *std::move(found);
  else
    out.tests_refused = found.error().text();
  if (settings.correct_axial) out.axial = estimate_axial_interference(stations, settings.station.tool);
  const bool correct = out.axial && out.axial->has_value();
  std::vector<PathStation> path;
  std::vector<PathStationErrors> errors;
  std::vector<Measurement> measured;
  for (std::size_t k = 0; k < stations.size(); ++k) {
    const ReferencedStation& at = stations[k];
    measured.push_back(at.measured);
    out.stations.push_back(correct
                               ? judge_corrected(corrected(at.measured, **out.axial), at.reference, settings.station)
                               : judge_station(at.measured, at.reference, settings.station));
    if (const std::optional<PathStation> on = path_station(out.stations.back(), out.north)) {
      path.push_back(*on);
      errors.push_back(path_errors(out.stations.back(), out.north));
      out.on_path.push_back(k);
    }
  }
  out.saturated = saturated_channels(measured, out.stations);
  out.path = minimum_curvature(path);
  if (!out.path) {
    out.on_path.clear();
    return out;
  }
  const double declination =
      out.north == North::magnetic ? 0.0 : stations.front().reference.field.declination_rad_sigma.common;
  out.position_covariance = position_covariances(
      errors, correct ? (*out.axial)->covariance : stated_covariance(settings.station.tool), declination);
  return out;
}

}  // namespace survey
}  // namespace PLUMB_ABI
}  // namespace plumb

#include "plumb/survey/survey_run.hpp"

#include <cmath>

#include "sound_stations.hpp"

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

/// By what could be estimated, else as it was read.
SurveyStation judged(const ReferencedStation& at, const Survey& found, const StationSettings& settings) {
  if (found.alignment && *found.alignment)
    return judge_corrected(aligned(at.measured, **found.alignment), at.reference, settings);
  if (found.axial && *found.axial)
    return judge_corrected(corrected(at.measured, **found.axial), at.reference, settings);
  return judge_station(at.measured, at.reference, settings);
}

/// Stations that an estimate judges are looked for without the test of misfit, which they would not pass.
void estimate_alignment(const std::vector<ReferencedStation>& stations, const SurveySettings& settings, Survey& out) {
  AlignmentSettings alignment;
  alignment.tool = settings.station.tool;
  alignment.stated_rad = *settings.align_within_rad;
  AlignmentSettings untested = alignment;
  untested.misfit_false_alarm = 0.0;
  SoundStations sound = sound_stations(
      stations, settings.station, [&](const auto& some) { return align_magnetometers(some, untested); },
      [&](const ReferencedStation& s, const JointAlignment& found) {
        return judge_corrected(aligned(s.measured, found), s.reference, settings.station);
      });
  out.alignment = align_magnetometers(sound.stations, alignment);
  if (*out.alignment) {
    int& worst = (*out.alignment)->held_out.worst;
    if (worst >= 0) worst = static_cast<int>(sound.number[static_cast<std::size_t>(worst)]);
  }
  out.left_out = std::move(sound.left_out);
}

void estimate_axial(const std::vector<ReferencedStation>& stations, const SurveySettings& settings, Survey& out) {
  MultiStationSettings axial;
  axial.terms = {Term::magnetometer_bias_z};
  axial.tool = settings.station.tool;
  MultiStationSettings untested = axial;
  untested.misfit_false_alarm = 0.0;
  SoundStations sound = sound_stations(
      stations, settings.station, [&](const auto& some) { return estimate_terms(some, untested); },
      [&](const ReferencedStation& s, const Estimate& found) {
        return judge_corrected(corrected(s.measured, found), s.reference, settings.station);
      });
  out.axial = estimate_terms(sound.stations, axial);
  out.left_out = std::move(sound.left_out);
}

/// What the components of the station, as it was judged, change with what the tool carries.
CarriedWeights weights_of(const ReferencedStation& at, const SurveyStation& judged, const Survey& found) {
  if (found.alignment && *found.alignment) return alignment_weights(at.measured, **found.alignment);
  return carried_weights(judged.measured);
}

CommonErrors common_errors(const Survey& found, const ReferencedStation& first, const SurveySettings& settings) {
  CommonErrors out;
  if (found.alignment && *found.alignment)
    out.carried = (*found.alignment)->covariance;
  else if (found.axial && *found.axial)
    out.carried = carried_covariance(**found.axial);
  else
    out.carried = carried_covariance(settings.station.tool);
  if (found.north != North::magnetic) out.declination_sigma_rad = first.reference.field.declination_rad_sigma.common;
  out.sag_sigma_rad = settings.path.sag_rad;
  out.depth_sigma_m = settings.path.depth_m;
  out.depth_scale_sigma = settings.path.depth_scale;
  return out;
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
  if (settings.align_within_rad)
    estimate_alignment(stations, settings, out);
  else if (settings.correct_axial)
    estimate_axial(stations, settings, out);
  out.path_sigmas = settings.path;
  std::vector<PathStation> path;
  std::vector<PathStationErrors> errors;
  std::vector<Measurement> measured;
  for (std::size_t k = 0; k < stations.size(); ++k) {
    const ReferencedStation& at = stations[k];
    measured.push_back(at.measured);
    out.stations.push_back(judged(at, out, settings.station));
    if (const std::optional<PathStation> on = path_station(out.stations.back(), out.north)) {
      path.push_back(*on);
      errors.push_back(path_errors(out.stations.back(), out.north, weights_of(at, out.stations.back(), out)));
      out.on_path.push_back(k);
    }
  }
  out.saturated = saturated_channels(measured, out.stations);
  out.path = minimum_curvature(path);
  if (!out.path) {
    out.on_path.clear();
    return out;
  }
  out.position_covariance = position_covariances(errors, common_errors(out, stations.front(), settings));
  return out;
}

}  // namespace survey
}  // namespace PLUMB_ABI
}  // namespace plumb

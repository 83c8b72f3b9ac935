#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <exception>

#include "calibration_source.hpp"
#include "plumb/io/calibration_file.hpp"
#include "plumb/io/date.hpp"
#include "plumb/io/output_file.hpp"
#include "plumb/scenario/count_text.hpp"
#include "renamed_keys.hpp"
#include "text_tools.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {
namespace {

void read_roll(const Source& source, const Json& object, FitReport& report) {
  for (const auto& [key, value] : object.items()) {
    if (const RenamedKey* old = renamed_key("roll", key))
      source.fail(source.line_of("roll", '"' + key + '"'), "report.roll." + key, what_of(*old),
                  remedy_of(*old, source.path));
  }
  report.roll_groups = source.whole_of<int>(object, "groups");
  report.single_station_groups = source.whole_of<int>(object, "single_station_groups");
  source.numbers_of(object, "axis", report.roll_axis.data(), 3);
  report.roll_axis_deviation_rad = source.number_of(object, "axis_deviation_rad");
  report.inclination_sigma_rad = source.number_of(object, "inclination_sigma_rad");
  if (!object.contains("common_turn_rad")) return;  // a file from before it was judged
  report.common_turn.rad = source.number_of(object, "common_turn_rad");
  report.common_turn.sigma_rad = source.number_of(object, "common_turn_sigma_rad");
}

FitReport read_report(const Source& source, const Json& object, std::size_t n) {
  FitReport report;
  report.stations = source.whole_of<int>(object, "stations");
  report.parameters = source.whole_of<int>(object, "parameters");
  report.rank = source.whole_of<int>(object, "rank");
  report.gauge = source.whole_of<int>(object, "gauge");
  report.null_directions = source.whole_of<int>(object, "null_directions");
  const int kept = std::clamp(report.null_directions, 0, kMaxNullDirections);
  const Json& unseen =
      source.list(source.member(object, "null_direction"), "null_direction", static_cast<std::size_t>(kept));
  for (std::size_t d = 0; d < unseen.size(); ++d)
    source.numbers(unseen[d], "null_direction", report.null_direction[d].component.data(), 4 * n);
  report.condition = source.number_of(object, "condition");
  report.norm_rms_mps2 = source.number_of(object, "norm_rms_mps2");
  report.parity_rms_mps2 = source.number_of(object, "parity_rms_mps2");
  report.misfit_mps2 = source.number_of(object, "misfit_mps2");
  report.chi2 = source.number_of(object, "chi2");
  report.degrees_of_freedom = source.whole_of<int>(object, "degrees_of_freedom");
  report.p_value = source.number_of(object, "p_value");
  report.excitation = source.number_of(object, "excitation");
  report.temperature_min_degc = source.number_of(object, "temperature_min_degc");
  report.temperature_max_degc = source.number_of(object, "temperature_max_degc");
  report.iterations = source.whole_of<int>(object, "iterations");
  report.stop = enum_from(source, object, "stop",
                          {StopReason::none, StopReason::converged, StopReason::iteration_limit, StopReason::no_descent,
                           StopReason::not_finite});
  if (object.contains("roll")) read_roll(source, object["roll"], report);
  return report;
}

/// A file of version 1 has the gravity at which it was calibrated in its covariance, or nowhere if somebody took it
/// out: then that counts once more rather than not at all.
double common_scale_of(const Source& source, const Json& root) {
  if (root["version"] != kOldestCalibrationVersion || root.contains("common_scale_sigma"))
    return source.number_of(root, "common_scale_sigma");
  const Json& gravity = source.member(root, "gravity");
  const double g_mps2 = source.number_of(gravity, "g_mps2"), sigma_mps2 = source.number_of(gravity, "sigma_mps2");
  return g_mps2 > 0.0 ? sigma_mps2 / g_mps2 : 0.0;
}

Calibration read_content(const Source& source, const Json& root, const ArrayFile& array) {
  Calibration out;
  const auto n = static_cast<std::size_t>(array.datasheet.size);
  out.report = read_report(source, source.member(root, "report"), n);
  out.model.size = array.datasheet.size;
  out.model.reads = array.datasheet.reads;
  RowUncertainty uncertainty;
  std::array<SensorRow, kCapacity> rows{};
  const Json& sensors = source.list(source.member(root, "sensors"), "sensors", n);
  for (std::size_t i = 0; i < n; ++i) {
    const Json& one = sensors[i];
    rows[i].id = make_id(source.text_of(one, "id").c_str());
    source.numbers_of(one, "axis", rows[i].axis.data(), 3);
    rows[i].sigma_mps2 = source.number_of(one, "sigma_mps2");
    rows[i].chip = array.datasheet.sensor[i].row.chip;
    SensorCoefficients& c = out.model.sensor[i];
    source.numbers_of(one, "scale", c.scale.data(), 4);
    source.numbers_of(one, "bias_mps2", c.bias.data(), 4);
    c.reference_degc = source.number_of(one, "reference_degc");
    uncertainty.misfit_mps2[i] = source.number_of(one, "misfit_mps2");
    out.report.e_cal_mps2[i] = source.number_of(one, "e_cal_mps2");
    out.report.residual_rms_mps2[i] = source.number_of(one, "residual_rms_mps2");
    source.numbers_of(one, "fit_sigma", &out.report.sigma[4 * i], 4);
    source.numbers_of(one, "data_share", &out.report.data_share[4 * i], 4);
  }
  if (root.contains("misalignment")) {
    const Json& mixing = source.list(root["misalignment"], "misalignment", n);
    for (std::size_t i = 0; i < n; ++i)
      source.numbers(mixing[i], "misalignment", &out.model.misalignment[i * kCapacity], n);
  }
  uncertainty.common_scale = common_scale_of(source, root);
  const Json& covariance = source.list(source.member(root, "covariance"), "covariance", 4 * n);
  for (std::size_t a = 0; a < 4 * n; ++a)
    source.numbers(covariance[a], "covariance", &uncertainty.covariance[a * (a + 1) / 2], a + 1);
  const Expected<SensorArray> built = SensorArray::make(rows.data(), static_cast<int>(n));
  if (!built) {
    const FileError words = from_error(built.error());
    source.fail(source.line_of("sensors", "\"id\""), "sensors", words.what, kMakeAnew);
  }
  out.array = *built;
  out.array.set_uncertainty(uncertainty);
  return out;
}

/// Of the length of a direction, for what printing it rounds.
constexpr double kUnitVector = 1e-6;

void read_attitudes(const Source& source, const Json& object, CalibrationContext& context) {
  const Json& down = source.member(object, "down");
  const Json& known = source.member(object, "known");
  if (!down.is_array() || !known.is_array())
    source.fail(source.line_of("attitudes", "\"down\""), "attitudes", "is not a list", kMakeAnew);
  for (const Json& one : down) {
    context.down.emplace_back();
    source.numbers(one, "down", context.down.back().data(), 3);
    const double length = norm(context.down.back());
    if (length != 0.0 && !(std::fabs(length - 1.0) <= kUnitVector))
      source.fail(source.line_of("attitudes", "\"down\""), "attitudes.down",
                  "has the length " + Json(length).dump() + ", must be a unit vector, or 0 where the fit shows none",
                  kMakeAnew);
  }
  for (const Json& one : known) {
    KnownAttitude& to = context.known_attitudes.emplace_back();
    to.station = source.whole_of<int>(one, "station");
    to.inclination_rad = source.number_of(one, "inclination_rad");
    to.toolface_rad = source.number_of(one, "toolface_rad");
    to.tolerance_rad = source.number_of(one, "tolerance_rad");
    const int line = source.line_of("attitudes", "\"known\"");
    if (to.station < 1 || static_cast<std::size_t>(to.station) > context.down.size())
      source.fail(line, "attitudes.known", "is not of a station of this file", kMakeAnew);
    if (!to.plausible())
      source.fail(
          line, "attitudes.known",
          "must have an inclination of 0 to 180 deg, a toolface of 0 to 360 deg and a tolerance of 0.01 to 45 deg, "
          "in rad",
          kMakeAnew);
  }
}

FrameAlignment read_alignment(const Source& source, const Json& object) {
  FrameAlignment out;
  source.numbers_of(object, "turn_rad", out.turn_rad.data(), 3);
  source.numbers_of(object, "covariance_rad2", out.covariance_rad2.data(), 9);
  out.base_bound_rad = source.number_of(object, "base_bound_rad");
  out.stations = source.whole_of<int>(object, "stations");
  if (!out.plausible())
    source.fail(source.line_of("frame_alignment", "\"covariance_rad2\""), "frame_alignment",
                "is no rotation with a covariance and a bound of 0 to pi rad", kMakeAnew);
  return out;
}

CalibrationContext read_context(const Source& source, const Json& root) {
  CalibrationContext context;
  const Json& gravity = source.member(root, "gravity");
  context.gravity.model = enum_from(
      source, gravity, "model",
      {GravityModel::normal, GravityModel::paper, GravityModel::value, GravityModel::table, GravityModel::magnetic});
  context.gravity.g_mps2 = source.number_of(gravity, "g_mps2");
  context.gravity.sigma_mps2 = source.number_of(gravity, "sigma_mps2");
  const Json& provenance = source.member(root, "provenance");
  context.log_file = source.text_of(provenance, "log_file");
  context.log_bytes = source.whole_of<std::uint64_t>(provenance, "log_bytes");
  context.log_hash = std::strtoull(source.text_of(provenance, "log_hash").c_str(), nullptr, 16);
  context.stations = source.whole_of<int>(provenance, "stations");
  context.plumb_version = source.text_of(provenance, "plumb_version");
  if (provenance.contains("date")) {  // a file may lack both
    context.date = source.text_of(provenance, "date");
    const FileExpected<int> day = day_number(context.date);
    if (!day) source.fail(source.line_of("provenance", "\"date\""), "provenance.date", day.error().what, kMakeAnew);
  }
  if (root.contains("attitudes")) read_attitudes(source, root["attitudes"], context);
  if (provenance.contains("serial")) context.serial = source.text_of(provenance, "serial");
  if (provenance.contains("coefficients")) context.coefficients = source.text_of(provenance, "coefficients");
  return context;
}

}  // namespace

bool FrameAlignment::plausible() const noexcept {
  bool good = base_bound_rad >= 0.0 && base_bound_rad <= kPi && stations > 0 && norm(turn_rad) <= kPi;
  for (std::size_t a = 0; a < 3; ++a) {
    const double variance = covariance_rad2[4 * a];
    good = good && variance > 0.0 && variance <= kPi * kPi;
    for (std::size_t b = 0; b < a; ++b) {
      const double both = covariance_rad2[3 * a + b];
      good = good && both == covariance_rad2[3 * b + a] && both * both <= variance * covariance_rad2[4 * b];
    }
  }
  return good;
}

FileExpected<CalibrationFile> read_calibration(const std::string& path, const ArrayFile& array) {
  FileExpected<std::string> text = read_file(path);
  if (!text) return tl::unexpected<FileError>(text.error());
  const Source source{path, *std::move(text)};
  try {
    const Json root = parsed(source);
    check_envelope(
        source, root,
        {kCalibrationSchema, kOldestCalibrationVersion, kCalibrationVersion, "give a file that plumb calibrate wrote"});
    check_array(source, root, array);
    CalibrationFile out;
    out.calibration = read_content(source, root, array);
    out.context = read_context(source, root);
    check_content(source, out);
    if (root.contains("paper")) {
      out.paper = read_paper(source, root["paper"], array);
      check_paper(source, *out.paper, out.calibration, array);
    }
    if (root.contains("frame_alignment")) out.alignment = read_alignment(source, root["frame_alignment"]);
    if (root.contains("motion")) out.motion = read_motion(source, root["motion"], array);
    out.array_name = source.text_of(root["array"], "name");
    out.array_file = source.text_of(root["array"], "file");
    return out;
  } catch (const Refusal& refusal) {
    return tl::unexpected<FileError>(refusal.error());
  } catch (const std::exception& error) {
    return tl::unexpected<FileError>(FileError{path, 0, "", error.what(), kMakeAnew});
  }
}

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb

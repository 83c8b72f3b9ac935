#include "plumb/io/calibration_file.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <exception>

#include "calibration_json.hpp"
#include "plumb/io/output_file.hpp"
#include "text_tools.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {
namespace {

Json from_coefficients(const SensorCoefficients& c) {
  return object({{"scale", from_array(c.scale, 4)},
                 {"bias_mps2", from_array(c.bias, 4)},
                 {"reference_degc", from_double(c.reference_degc)}});
}

Json from_sensors(const Calibration& calibration) {
  Json sensors = Json::array();
  for (int i = 0; i < calibration.array.size(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    const SensorRow& row = calibration.array.row(i);
    Json one = object({{"id", row.id.data()}, {"axis", from_array(row.axis, 3)}});
    one.update(from_coefficients(calibration.model.sensor[k]));
    one["sigma_mps2"] = from_double(row.sigma_mps2);
    one["misfit_mps2"] = from_double(calibration.array.uncertainty().misfit_mps2[k]);
    one["e_cal_mps2"] = from_double(calibration.report.e_cal_mps2[k]);
    one["residual_rms_mps2"] = from_double(calibration.report.residual_rms_mps2[k]);
    one["fit_sigma"] = from_array(&calibration.report.sigma[4 * k], 4);
    one["data_share"] = from_array(&calibration.report.data_share[4 * k], 4);
    sensors.push_back(std::move(one));
  }
  return sensors;
}

/// Only where stations had roll groups: a file without is as it was before there were any.
Json from_roll(const FitReport& report) {
  return object({{"groups", report.roll_groups},
                 {"single_station_groups", report.single_station_groups},
                 {"axis", from_array(report.roll_axis, 3)},
                 {"axis_deviation_rad", from_double(report.roll_axis_deviation_rad)},
                 {"inclination_sigma_rad", from_double(report.inclination_sigma_rad)},
                 {"common_turn_rad", from_double(report.common_turn.rad)},
                 {"common_turn_sigma_rad", from_double(report.common_turn.sigma_rad)}});
}

Json from_report(const FitReport& report, std::size_t n) {
  Json unseen = Json::array();
  const int kept = std::clamp(report.null_directions, 0, kMaxNullDirections);
  for (int d = 0; d < kept; ++d)
    unseen.push_back(from_array(report.null_direction[static_cast<std::size_t>(d)].component, 4 * n));
  Json out = object({{"stations", report.stations},
                     {"parameters", report.parameters},
                     {"rank", report.rank},
                     {"gauge", report.gauge},
                     {"null_directions", report.null_directions},
                     {"null_direction", std::move(unseen)},
                     {"condition", from_double(report.condition)},
                     {"norm_rms_mps2", from_double(report.norm_rms_mps2)},
                     {"parity_rms_mps2", from_double(report.parity_rms_mps2)},
                     {"misfit_mps2", from_double(report.misfit_mps2)},
                     {"chi2", from_double(report.chi2)},
                     {"degrees_of_freedom", report.degrees_of_freedom},
                     {"p_value", from_double(report.p_value)},
                     {"excitation", from_double(report.excitation)},
                     {"temperature_min_degc", from_double(report.temperature_min_degc)},
                     {"temperature_max_degc", from_double(report.temperature_max_degc)},
                     {"iterations", report.iterations},
                     {"stop", to_string(report.stop)}});
  if (report.roll_groups > 0) out["roll"] = from_roll(report);
  return out;
}

/// Lower triangle, one row a line.
Json from_covariance(const RowUncertainty& uncertainty, std::size_t n) {
  Json rows = Json::array();
  for (std::size_t a = 0; a < 4 * n; ++a) rows.push_back(from_array(&uncertainty.covariance[a * (a + 1) / 2], a + 1));
  return rows;
}

Json from_misalignment(const SensorModel& model, std::size_t n) {
  Json rows = Json::array();
  for (std::size_t i = 0; i < n; ++i) rows.push_back(from_array(&model.misalignment[i * kCapacity], n));
  return rows;
}

/// The stations: where the fit shows down, and what is known of them from elsewhere.
void put_attitudes(const CalibrationContext& context, Json& root) {
  if (context.down.empty()) return;
  Json down = Json::array(), known = Json::array();
  for (const Vec3& one : context.down) down.push_back(from_array(one, 3));
  for (const KnownAttitude& one : context.known_attitudes)
    known.push_back(object({{"station", one.station},
                            {"inclination_rad", from_double(one.inclination_rad)},
                            {"toolface_rad", from_double(one.toolface_rad)},
                            {"tolerance_rad", from_double(one.tolerance_rad)}}));
  root["attitudes"] = object({{"down", std::move(down)}, {"known", std::move(known)}});
}

void put_alignment(const FrameAlignment& a, Json& root) {
  root["frame_alignment"] = object({{"turn_rad", from_array(a.turn_rad, 3)},
                                    {"covariance_rad2", from_array(a.covariance_rad2, 9)},
                                    {"base_bound_rad", from_double(a.base_bound_rad)},
                                    {"stations", a.stations}});
}

/// Objects one member a line, lists of plain values on one line: readable, and 4n lines rather than 8n^2.
void print(const Json& value, int indent, std::string& out) {  // NOLINT(misc-no-recursion) five levels
  const bool nested = value.is_object() ||
                      (value.is_array() &&
                       std::any_of(value.begin(), value.end(), [](const Json& item) { return item.is_structured(); }));
  if (!nested || value.empty()) {
    out += value.dump();
    return;
  }
  const std::string margin(static_cast<std::size_t>(indent) + 1, ' ');
  bool first = true;
  out += value.is_object() ? '{' : '[';
  for (auto item = value.begin(); item != value.end(); ++item) {
    out += first ? "\n" : ",\n";
    first = false;
    out += margin;
    if (value.is_object()) out += Json(item.key()).dump() + ": ";
    print(*item, indent + 1, out);
  }
  out += '\n' + std::string(static_cast<std::size_t>(indent), ' ');
  out += value.is_object() ? '}' : ']';
}

}  // namespace

Json from_nominal(const ArrayFile& array) {
  Json sensors = Json::array();
  for (int i = 0; i < array.datasheet.size; ++i) {
    const DatasheetSensor& sensor = array.datasheet.sensor[static_cast<std::size_t>(i)];
    Json one = object({{"id", sensor.row.id.data()}, {"axis", from_array(sensor.row.axis, 3)}});
    one.update(from_coefficients(sensor.coefficients));
    sensors.push_back(std::move(one));
  }
  return object({{"name", array.name},
                 {"file", last_part(array.path)},
                 {"fingerprint", hex(array.fingerprint)},
                 {"reads", reads_word(array.datasheet.reads)},
                 {"raw_unit", array.input.unit.name},
                 {"nominal", std::move(sensors)}});
}

Json from_double(double value) { return std::isfinite(value) ? Json(value) : Json(shortest(value)); }

std::string printed(const Json& value) {
  std::string out;
  print(value, 0, out);
  return out;
}

std::string hex(std::uint64_t value) {
  constexpr std::size_t kDigits = 16;
  std::array<char, kDigits> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value, 16);
  const std::string digits(text.data(), end.ptr);
  return std::string(kDigits - digits.size(), '0') + digits;
}

const char* reads_word(Reads reads) noexcept { return reads == Reads::gravity ? "gravity" : "specific-force"; }

std::string checksum_of(Json content) {
  content.erase("checksum");
  const std::string text = content.dump();
  return "fnv1a64:" + hex(fnv1a(text.data(), text.size()));
}

std::string calibration_json(const Calibration& calibration, const ArrayFile& array, const CalibrationContext& context,
                             const PaperCalibration* paper, const FrameAlignment* alignment) {
  const auto n = static_cast<std::size_t>(calibration.array.size());
  Json root;
  root["schema"] = kCalibrationSchema;
  root["version"] = kCalibrationVersion;
  root["checksum"] = "";
  root["array"] = from_nominal(array);
  root["gravity"] = object({{"model", to_string(context.gravity.model)},
                            {"g_mps2", from_double(context.gravity.g_mps2)},
                            {"sigma_mps2", from_double(context.gravity.sigma_mps2)}});
  root["provenance"] = object({{"log_file", last_part(context.log_file)},
                               {"log_bytes", context.log_bytes},
                               {"log_hash", hex(context.log_hash)},
                               {"stations", context.stations},
                               {"plumb_version", context.plumb_version}});
  if (!context.date.empty()) root["provenance"]["date"] = context.date;
  if (!context.serial.empty()) root["provenance"]["serial"] = context.serial;
  if (!context.coefficients.empty()) root["provenance"]["coefficients"] = context.coefficients;
  put_attitudes(context, root);
  if (alignment != nullptr) put_alignment(*alignment, root);
  root["report"] = from_report(calibration.report, n);
  root["sensors"] = from_sensors(calibration);
  root["paper_parameters"] = from_paper_parameters(array.array, calibration);
  const auto& mixing = calibration.model.misalignment;
  if (std::any_of(mixing.begin(), mixing.end(), [](double m) { return m != 0.0; })) {
    root["misalignment"] = from_misalignment(calibration.model, n);
  }
  root["common_scale_sigma"] = from_double(calibration.array.uncertainty().common_scale);
  root["covariance"] = from_covariance(calibration.array.uncertainty(), n);
  if (paper != nullptr) root["paper"] = from_paper(*paper, array.array);
  root["checksum"] = checksum_of(root);
  return printed(root) + "\n";
}

FileExpected<void> write_calibration(const std::string& path, const Calibration& calibration, const ArrayFile& array,
                                     const CalibrationContext& context, const PaperCalibration* paper,
                                     const FrameAlignment* alignment) {
  try {
    return write_file(path, calibration_json(calibration, array, context, paper, alignment));
  } catch (const std::exception& error) {  // text that is not UTF-8
    return tl::unexpected<FileError>(
        FileError{path, 0, "", error.what(), "use UTF-8 in names and paths", ExitCode::other});
  }
}

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb

#include "plumb/io/gyro_calibration.hpp"

#include <cmath>
#include <cstdlib>
#include <exception>

#include "calibration_source.hpp"
#include "plumb/io/date.hpp"
#include "plumb/io/output_file.hpp"
#include "text_tools.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {
namespace {

/// Of the covariance of a row: 00, 10, 11, 20, 21, 22.
constexpr std::array<std::size_t, 6> kLowerTriangle = {0, 3, 4, 6, 7, 8};
constexpr double kCovarianceRounding = 1e-6;

/// A figure of an axis with what a gyro may have.
struct AxisFigure {
  const char* key;
  double least, most;
  double GyroCalibration::Axis::*field;
};
constexpr AxisFigure kAxisFigures[] = {
    {"bias_radps", -100.0, 100.0, &GyroCalibration::Axis::bias_radps},
    {"bias_sigma_radps", 0.0, 10.0, &GyroCalibration::Axis::bias_sigma_radps},
    {"delay_s", -1.0, 1.0, &GyroCalibration::Axis::delay_s},
    {"delay_sigma_s", 0.0, 1.0, &GyroCalibration::Axis::delay_sigma_s},
};

/// The ranges are those of the same bounds in an array file.
struct BoundFigure {
  const char* key;
  double most;
  double RateErrors::*field;
};
constexpr BoundFigure kBoundFigures[] = {
    {"scale_bound", 0.4, &RateErrors::scale},
    {"axis_bound_rad", 0.4, &RateErrors::axis_rad},
    {"bias_bound_radps", 10.0, &RateErrors::bias_radps},
    {"lag_bound_s", 1.0, &RateErrors::lag_s},
    {"g_sensitivity_bound_s_per_m", 1.0, &RateErrors::g_sensitivity_s_per_m},
};

struct FileFigure {
  const char* key;
  double GyroCalibration::*field;
};
constexpr FileFigure kReportFigures[] = {
    {"residual_radps", &GyroCalibration::sample_radps},
    {"residual_32_radps", &GyroCalibration::block_radps},
    {"held_out_residual_radps", &GyroCalibration::held_out_sample_radps},
    {"held_out_residual_32_radps", &GyroCalibration::held_out_block_radps},
    {"turns_residual_rad", &GyroCalibration::turns_rad},
    {"held_out_turns_residual_rad", &GyroCalibration::held_out_turns_rad},
};

struct FileFlag {
  const char* key;
  bool GyroCalibration::*field;
};
constexpr FileFlag kFlags[] = {
    {"absolute", &GyroCalibration::absolute},
    {"bias_from_rest", &GyroCalibration::bias_from_rest},
    {"delay_fitted", &GyroCalibration::delay_fitted},
    {"g_sensitivity_fitted", &GyroCalibration::force_fitted},
};

Json from_axis(const GyroCalibration::Axis& axis, const char* id) {
  std::array<double, kLowerTriangle.size()> covariance{};
  for (std::size_t k = 0; k < kLowerTriangle.size(); ++k) covariance[k] = axis.row_covariance[kLowerTriangle[k]];
  Json out = object({{"id", id},
                     {"row", from_array(axis.row, 3)},
                     {"row_covariance", from_array(covariance, covariance.size())},
                     {"g_sensitivity_s_per_m", from_array(axis.per_force, 3)},
                     {"g_sensitivity_sigma_s_per_m", from_array(axis.per_force_sigma, 3)}});
  for (const AxisFigure& one : kAxisFigures) out[one.key] = from_double(axis.*one.field);
  for (const BoundFigure& one : kBoundFigures) out[one.key] = from_double(axis.bound.*one.field);
  return out;
}

double gyro_figure(const Source& source, const std::string& field, const char* key, double value, double least,
                   double most) {
  if (value >= least && value <= most) return value;
  source.fail(source.line_of("sensors", "\"" + std::string(key) + "\""), field + "." + key,
              "is " + shortest(value) + ", must be from " + brief(least) + " to " + brief(most), kMakeAnew);
}

Vec3 gyro_vector(const Source& source, const Json& object, const std::string& field, const char* key, double least,
                 double most) {
  Vec3 out{};
  source.numbers_of(object, key, out.data(), 3);
  for (const double one : out) (void)gyro_figure(source, field, key, one, least, most);
  return out;
}

Mat3 row_covariance_of(const Source& source, const Json& object, const std::string& field) {
  std::array<double, kLowerTriangle.size()> lower{};
  source.numbers_of(object, "row_covariance", lower.data(), lower.size());
  Mat3 out{};
  for (std::size_t k = 0; k < kLowerTriangle.size(); ++k) {
    const std::size_t at = kLowerTriangle[k];
    out[at] = out[3 * (at % 3) + at / 3] = gyro_figure(source, field, "row_covariance", lower[k], -1.0, 1.0);
  }
  for (std::size_t at = 0; at < 9; ++at) {
    const double most = std::sqrt(out[4 * (at / 3)] * out[4 * (at % 3)]);
    if (!(std::fabs(out[at]) <= most * (1.0 + kCovarianceRounding)))
      source.fail(source.line_of("sensors", "\"row_covariance\""), field + ".row_covariance",
                  "is no covariance: an entry is beyond what its variances allow", kMakeAnew);
  }
  return out;
}

GyroCalibration::Axis read_gyro_axis(const Source& source, const Json& object, const std::string& id,
                                     std::size_t number) {
  const std::string field = "sensors[" + std::to_string(number + 1) + "]";
  if (source.text_of(object, "id") != id)
    source.fail(0, field + ".id", "is " + in_quotes(source.text_of(object, "id")) + ", must be " + in_quotes(id),
                kMakeAnew);
  GyroCalibration::Axis out;
  out.row = gyro_vector(source, object, field, "row", -2.0, 2.0);
  (void)gyro_figure(source, field, "row", norm(out.row), 0.5, 2.0);
  out.row_covariance = row_covariance_of(source, object, field);
  out.per_force = gyro_vector(source, object, field, "g_sensitivity_s_per_m", -1.0, 1.0);
  out.per_force_sigma = gyro_vector(source, object, field, "g_sensitivity_sigma_s_per_m", 0.0, 1.0);
  for (const AxisFigure& one : kAxisFigures)
    out.*one.field = gyro_figure(source, field, one.key, source.number_of(object, one.key), one.least, one.most);
  for (const BoundFigure& one : kBoundFigures)
    out.bound.*one.field = gyro_figure(source, field, one.key, source.number_of(object, one.key), 0.0, one.most);
  return out;
}

void read_gyro_provenance(const Source& source, const Json& object, GyroCalibration& out) {
  const Json& logs = source.member(object, "logs");
  if (!logs.is_array())
    source.fail(source.line_of("provenance", "\"logs\""), "provenance.logs", "is not a list", kMakeAnew);
  for (const Json& one : logs)
    out.log.push_back(
        {source.text_of(one, "use"), source.text_of(one, "file"), source.whole_of<std::uint64_t>(one, "bytes"),
         std::strtoull(source.text_of(one, "hash").c_str(), nullptr, 16), source.whole_of<std::uint64_t>(one, "rows")});
  out.plumb_version = source.text_of(object, "plumb_version");
  if (object.contains("serial")) out.serial = source.text_of(object, "serial");
  if (!object.contains("date")) return;
  out.date = source.text_of(object, "date");
  const FileExpected<int> day = day_number(out.date);
  if (!day) source.fail(source.line_of("provenance", "\"date\""), "provenance.date", day.error().what, kMakeAnew);
}

void read_gyro_report(const Source& source, const Json& object, GyroCalibration& out) {
  for (const FileFlag& one : kFlags) {
    const Json& value = source.member(object, one.key);
    if (!value.is_boolean())
      source.fail(source.line_of("report", "\"" + std::string(one.key) + "\""), "report." + std::string(one.key),
                  "is not true or false", kMakeAnew);
    out.*one.field = value.get<bool>();
  }
  for (const FileFigure& one : kReportFigures)
    out.*one.field = gyro_figure(source, "report", one.key, source.number_of(object, one.key), 0.0, 1e4);
}

}  // namespace

std::string gyro_calibration_json(const GyroCalibration& calibration, const ArrayFile& array) {
  Json logs = Json::array();
  for (const GyroCalibrationLog& one : calibration.log)
    logs.push_back(object({{"use", one.use},
                           {"file", last_part(one.file)},
                           {"bytes", one.bytes},
                           {"hash", hex(one.hash)},
                           {"rows", one.rows}}));
  Json provenance = object({{"logs", std::move(logs)}, {"plumb_version", calibration.plumb_version}});
  if (!calibration.date.empty()) provenance["date"] = calibration.date;
  if (!calibration.serial.empty()) provenance["serial"] = calibration.serial;
  Json report = Json::object(), sensors = Json::array();
  for (const FileFlag& one : kFlags) report[one.key] = calibration.*one.field;
  for (const FileFigure& one : kReportFigures) report[one.key] = from_double(calibration.*one.field);
  for (std::size_t k = 0; k < calibration.axis.size(); ++k)
    sensors.push_back(from_axis(calibration.axis[k], array.array.row(static_cast<int>(k)).id.data()));
  Json root = object({{"schema", kGyroCalibrationSchema},
                      {"version", kGyroCalibrationVersion},
                      {"checksum", ""},
                      {"array", from_nominal(array)},
                      {"provenance", std::move(provenance)},
                      {"report", std::move(report)},
                      {"sensors", std::move(sensors)}});
  root["checksum"] = checksum_of(root);
  return printed(root) + "\n";
}

FileExpected<void> write_gyro_calibration(const std::string& path, const GyroCalibration& calibration,
                                          const ArrayFile& array) {
  try {
    return write_file(path, gyro_calibration_json(calibration, array));
  } catch (const std::exception& error) {  // text that is not UTF-8
    return tl::unexpected<FileError>(
        FileError{path, 0, "", error.what(), "use UTF-8 in names and paths", ExitCode::other});
  }
}

FileExpected<GyroCalibration> read_gyro_calibration(const std::string& path, const ArrayFile& array) {
  FileExpected<std::string> text = read_file(path);
  if (!text) return tl::unexpected<FileError>(text.error());
  const Source source{path, *std::move(text)};
  try {
    const Json root = parsed(source);
    check_envelope(source, root,
                   {kGyroCalibrationSchema, kGyroCalibrationVersion, kGyroCalibrationVersion,
                    "give a file that plumb calibrate --motion wrote of these gyros"});
    check_array(source, root, array);
    GyroCalibration out;
    read_gyro_provenance(source, source.member(root, "provenance"), out);
    read_gyro_report(source, source.member(root, "report"), out);
    const auto n = static_cast<std::size_t>(array.datasheet.size);
    const Json& sensors = source.list(source.member(root, "sensors"), "sensors", n);
    for (std::size_t k = 0; k < n; ++k)
      out.axis.push_back(read_gyro_axis(source, sensors[k], array.datasheet.sensor[k].row.id.data(), k));
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

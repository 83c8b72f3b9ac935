// The section `motion` of a calibration file: strictly what `plumb calibrate --motion` writes, within what a monitor of
// motion takes.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <exception>
#include <initializer_list>

#include "calibration_source.hpp"
#include "plumb/io/date.hpp"
#include "plumb/io/output_file.hpp"
#include "text_tools.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {
namespace {

constexpr const char* kCommissionAnew = "run plumb calibrate --motion again, or copy the original file again";

/// A figure with the range of the bound of the same name in an array file.
struct Figure {
  const char* key;
  double least, most;
};
constexpr double kMostArm_m = 10.0;
constexpr Figure kArm{"lever_arm_m", -kMostArm_m, kMostArm_m};
constexpr Figure kStatedArm{"stated_lever_arm_m", -kMostArm_m, kMostArm_m};
constexpr Figure kArmSigma{"lever_arm_sigma_m", 0.0, 1.0};

struct SensorFigure {
  Figure figure;
  double MotionCalibration::Sensor::*field;
};
constexpr SensorFigure kSensor[] = {
    {{"lever_arm_bound_m", 0.0, 1.0}, &MotionCalibration::Sensor::lever_arm_bound_m},
    {{"lag_s", -1.0, 1.0}, &MotionCalibration::Sensor::lag_s},
    {{"lag_sigma_s", 0.0, 1.0}, &MotionCalibration::Sensor::lag_sigma_s},
    {{"lag_bound_s", 0.0, 1.0}, &MotionCalibration::Sensor::lag_bound_s},
    {{"vibration_rectification_per_mps2", -1.0, 1.0}, &MotionCalibration::Sensor::rectification_per_mps2},
    {{"vibration_rectification_sigma_per_mps2", 0.0, 1.0}, &MotionCalibration::Sensor::rectification_sigma_per_mps2},
    {{"vibration_rectification_bound_per_mps2", 0.0, 1.0}, &MotionCalibration::Sensor::rectification_bound_per_mps2},
};

struct GyroFigure {
  Figure figure;
  double GyroErrors::*field;
};
constexpr GyroFigure kGyro[] = {
    {{"scale_bound", 0.0, 0.4}, &GyroErrors::scale},
    {{"axis_bound_rad", 0.0, 0.4}, &GyroErrors::axis_rad},
    {{"bias_bound_radps", 0.0, 10.0}, &GyroErrors::bias_radps},
    {{"noise_radps", 0.0, 10.0}, &GyroErrors::noise_radps},
    {{"lag_bound_s", 0.0, 1.0}, &GyroErrors::lag_s},
};

/// Refuses what is none of its keys: a misspelt one must not be passed over.
void only(const Source& source, const Json& object, const std::string& field, const std::vector<std::string>& keys) {
  if (!object.is_object()) source.fail(source.line_of("motion", "motion"), field, "is not an object", kCommissionAnew);
  for (const auto& [key, value] : object.items()) {
    if (std::find(keys.begin(), keys.end(), key) != keys.end()) continue;
    source.fail(source.line_of("motion", "\"" + key + "\""), field + "." + key, "is not known", kCommissionAnew);
  }
}

double checked(const Source& source, const std::string& field, const Figure& figure, double value) {
  if (value >= figure.least && value <= figure.most) return value;
  source.fail(source.line_of("motion", "\"" + std::string(figure.key) + "\""), field + "." + figure.key,
              "is " + shortest(value) + ", must be from " + brief(figure.least) + " to " + brief(figure.most),
              kCommissionAnew);
}

Vec3 vector_of(const Source& source, const Json& object, const std::string& field, const Figure& figure) {
  Vec3 out{};
  source.numbers_of(object, figure.key, out.data(), 3);
  for (const double part : out) (void)checked(source, field, figure, part);
  return out;
}

MotionCalibration::Sensor read_sensor(const Source& source, const Json& object, const std::string& id, std::size_t k,
                                      bool stated) {
  const std::string field = "motion.sensors[" + std::to_string(k + 1) + "]";
  std::vector<std::string> keys = {"id", kArm.key, kArmSigma.key};
  for (const SensorFigure& one : kSensor) keys.emplace_back(one.figure.key);
  if (stated) keys.emplace_back(kStatedArm.key);
  only(source, object, field, keys);
  if (source.text_of(object, "id") != id)
    source.fail(0, field + ".id", "is " + in_quotes(source.text_of(object, "id")) + ", must be " + in_quotes(id),
                kCommissionAnew);
  MotionCalibration::Sensor out;
  if (stated) out.stated_lever_arm_m = vector_of(source, object, field, kStatedArm);
  out.lever_arm_m = vector_of(source, object, field, kArm);
  out.lever_arm_sigma_m = vector_of(source, object, field, kArmSigma);
  for (const SensorFigure& one : kSensor)
    out.*one.field = checked(source, field, one.figure, source.number_of(object, one.figure.key));
  return out;
}

void read_provenance(const Source& source, const Json& object, MotionCalibration& out) {
  only(source, object, "motion.provenance", {"log_file", "log_bytes", "log_hash", "rows", "plumb_version", "date"});
  out.log_file = source.text_of(object, "log_file");
  out.log_bytes = source.whole_of<std::uint64_t>(object, "log_bytes");
  out.log_hash = std::strtoull(source.text_of(object, "log_hash").c_str(), nullptr, 16);
  out.rows = source.whole_of<std::uint64_t>(object, "rows");
  out.plumb_version = source.text_of(object, "plumb_version");
  if (!object.contains("date")) return;
  out.date = source.text_of(object, "date");
  const FileExpected<int> day = day_number(out.date);
  if (!day)
    source.fail(source.line_of("motion", "\"date\""), "motion.provenance.date", day.error().what, kCommissionAnew);
}

Json from_sensor(const MotionCalibration::Sensor& sensor, const char* id, bool stated) {
  Json out = object({{"id", id}});
  if (stated) out[kStatedArm.key] = from_array(sensor.stated_lever_arm_m, 3);
  out[kArm.key] = from_array(sensor.lever_arm_m, 3);
  out[kArmSigma.key] = from_array(sensor.lever_arm_sigma_m, 3);
  for (const SensorFigure& one : kSensor) out[one.figure.key] = from_double(sensor.*one.field);
  return out;
}

Json from_motion(const MotionCalibration& motion, const SensorArray& array) {
  Json provenance = object({{"log_file", last_part(motion.log_file)},
                            {"log_bytes", motion.log_bytes},
                            {"log_hash", hex(motion.log_hash)},
                            {"rows", motion.rows},
                            {"plumb_version", motion.plumb_version}});
  if (!motion.date.empty()) provenance["date"] = motion.date;
  Json sensors = Json::array();
  for (std::size_t k = 0; k < motion.sensor.size(); ++k)
    sensors.push_back(
        from_sensor(motion.sensor[k], array.row(static_cast<int>(k)).id.data(), motion.lever_arms_stated));
  Json gyro = Json::object();
  for (const GyroFigure& one : kGyro) gyro[one.figure.key] = from_double(motion.gyro.*one.field);
  return object({{"version", kMotionSectionVersion},
                 {"provenance", std::move(provenance)},
                 {"lever_arms_stated", motion.lever_arms_stated},
                 {"gyros", motion.gyros},
                 {"sensors", std::move(sensors)},
                 {"gyro", std::move(gyro)}});
}

}  // namespace

std::shared_ptr<const MotionCalibration> read_motion(const Source& source, const Json& section,
                                                     const ArrayFile& array) {
  only(source, section, "motion", {"version", "provenance", "lever_arms_stated", "gyros", "sensors", "gyro"});
  if (source.member(section, "version") != kMotionSectionVersion)
    source.fail(
        source.line_of("motion", "\"version\""), "motion.version",
        "is " + section["version"].dump() + ", this plumb reads version " + std::to_string(kMotionSectionVersion),
        kCommissionAnew);
  auto out = std::make_shared<MotionCalibration>();
  read_provenance(source, source.member(section, "provenance"), *out);
  const Json& stated = source.member(section, "lever_arms_stated");
  if (!stated.is_boolean())
    source.fail(source.line_of("motion", "\"lever_arms_stated\""), "motion.lever_arms_stated", "is not true or false",
                kCommissionAnew);
  out->lever_arms_stated = stated.get<bool>();
  out->gyros = source.whole_of<int>(section, "gyros");
  if (out->gyros < 1 || out->gyros > kGyros)
    source.fail(source.line_of("motion", "\"gyros\""), "motion.gyros", "must be 1 or 2", kCommissionAnew);
  const auto n = static_cast<std::size_t>(array.datasheet.size);
  const Json& sensors = source.list(source.member(section, "sensors"), "motion.sensors", n);
  for (std::size_t k = 0; k < n; ++k)
    out->sensor.push_back(
        read_sensor(source, sensors[k], array.datasheet.sensor[k].row.id.data(), k, out->lever_arms_stated));
  const Json& gyro = source.member(section, "gyro");
  std::vector<std::string> keys;
  for (const GyroFigure& one : kGyro) keys.emplace_back(one.figure.key);
  only(source, gyro, "motion.gyro", keys);
  for (const GyroFigure& one : kGyro)
    out->gyro.*one.field = checked(source, "motion.gyro", one.figure, source.number_of(gyro, one.figure.key));
  return out;
}

FileExpected<void> add_motion(const std::string& from, const std::string& to, const MotionCalibration& motion,
                              const ArrayFile& array) {
  const FileExpected<std::string> text = read_file(from);
  if (!text) return tl::unexpected<FileError>(text.error());
  try {
    Json root = Json::parse(*text);
    root["motion"] = from_motion(motion, array.array);
    root["checksum"] = checksum_of(root);
    return write_file(to, printed(root) + "\n");
  } catch (const std::exception& error) {  // text that is not UTF-8; a file that has changed since it was read
    return tl::unexpected<FileError>(
        FileError{to, 0, "", error.what(), "use UTF-8 in names and paths", ExitCode::other});
  }
}

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb

// What calibration files of all fields begin with: whose file it is, that it is whole, and that it is of this array.
#include <exception>

#include "calibration_source.hpp"
#include "plumb/core/units.hpp"
#include "plumb/scenario/count_text.hpp"
#include "text_tools.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {
namespace {

constexpr int kDeepestCalibration = 16;

[[noreturn]] void refuse_array(const Source& source, const ArrayFile& array, const std::string& id,
                               const std::string& field, const std::string& what) {
  const int line =
      id.empty() ? source.line_of("array", "\"" + field + "\"") : source.line_of("nominal", Json(id).dump());
  source.fail(line, "array." + field, "the calibration belongs to another array: " + what,
              "use the calibration made with " + array.path + ", or calibrate this array: plumb calibrate");
}

/// Which number of `there` differs from `here`, -1 where none does.
int first_difference(const Source& source, const Json& there, const std::string& key, const double* here,
                     std::size_t count) {
  std::array<double, 4> values{};
  source.numbers_of(there, key, values.data(), count);
  for (std::size_t k = 0; k < count; ++k) {
    if (!(values[k] == here[k])) return static_cast<int>(k);
  }
  return -1;
}

void compare_sensor(const Source& source, const ArrayFile& array, const Json& there, std::size_t i) {
  const DatasheetSensor& here = array.datasheet.sensor[i];
  const std::string id = here.row.id.data();
  const std::string field = "nominal[" + std::to_string(i + 1) + "].";
  const std::string other = source.text_of(there, "id");
  if (other != id)
    refuse_array(source, array, other, field + "id",
                 "sensor " + std::to_string(i + 1) + " is " + in_quotes(other) + " in the calibration and " +
                     in_quotes(id) + " in the array file");
  Vec3 axis{};
  source.numbers_of(there, "axis", axis.data(), 3);
  if (axis != here.row.axis) {
    refuse_array(source, array, id, field + "axis",
                 "the nominal axis of " + id + " differs by " +
                     brief(deg_from_rad(angle_between_rad(axis, here.row.axis))) + " deg");
  }
  const struct {
    const char* key;
    const double* values;
    const char* words;
  } cubics[] = {{"scale", here.coefficients.scale.data(), "scale"},
                {"bias_mps2", here.coefficients.bias.data(), "bias"}};
  for (const auto& cubic : cubics) {
    const int k = first_difference(source, there, cubic.key, cubic.values, 4);
    if (k < 0) continue;
    const double found = source.number(there[cubic.key][static_cast<std::size_t>(k)], cubic.key);
    refuse_array(source, array, id, field + cubic.words,
                 std::string("the nominal ") + cubic.words +
                     (k > 0 ? " (temperature term " + std::to_string(k) + ")" : "") + " of " + id + " is " +
                     shortest(found) + " in the calibration and " + shortest(cubic.values[k]) + " in the array file");
  }
  if (source.number_of(there, "reference_degc") != here.coefficients.reference_degc) {
    refuse_array(source, array, id, field + "t_ref", "the reference temperature of " + id + " differs");
  }
}

}  // namespace

Json parsed(const Source& source) {
  if (source.text.find_first_not_of(" \t\r\n") == std::string::npos) {
    source.fail(0, "", "the file is empty", kMakeAnew);
  }
  const auto shallow = [&source](int depth, Json::parse_event_t, Json&) {
    if (depth > kDeepestCalibration) source.fail(0, "", "is nested too deeply", kMakeAnew);
    return true;
  };
  try {
    return Json::parse(source.text, shallow);
  } catch (const Json::parse_error& error) {
    const std::size_t last = source.text.find_last_not_of(" \t\r\n");
    const bool cut = error.byte > last + 1;
    source.fail(source.line_at(error.byte), "", cut ? "the file is truncated" : "is not valid JSON", kMakeAnew);
  } catch (const Json::exception&) {
    source.fail(0, "", "is not valid JSON: a number is out of range", kMakeAnew);
  }
}

void check_envelope(const Source& source, const Json& root, const Schema& schema) {
  const bool ours = root.is_object() && root.contains("schema") && root["schema"] == schema.name;
  if (!ours) {
    const std::string found = root.is_object() && root.contains("schema") ? root["schema"].dump() : "none";
    source.fail(source.line_of("schema", "schema"), "schema",
                std::string("is ") + found + ", must be \"" + schema.name + "\"", schema.remedy);
  }
  const Json& version = source.member(root, "version");
  if (!(version == schema.newest || version == schema.oldest)) {
    source.fail(source.line_of("version", "version"), "version",
                "is " + version.dump() + ", this plumb reads " +
                    (schema.oldest == schema.newest
                         ? "version " + std::to_string(schema.newest)
                         : "versions " + std::to_string(schema.oldest) + " and " + std::to_string(schema.newest)),
                "run plumb calibrate again with this plumb, or use the plumb that wrote the file");
  }
  const std::string stated = source.text_of(root, "checksum");
  const std::string actual = checksum_of(root);
  if (stated != actual) {
    source.fail(source.line_of("checksum", "checksum"), "checksum",
                "is " + stated + ", but the content gives " + actual + ": the file was edited or damaged",
                std::string("do not edit calibration files; ") + kMakeAnew);
  }
}

void check_array(const Source& source, const Json& root, const ArrayFile& array) {
  const Json& there = source.member(root, "array");
  const auto n = static_cast<std::size_t>(array.datasheet.size);
  const Json& nominal = source.member(there, "nominal");
  if (!nominal.is_array() || nominal.size() != n) {
    refuse_array(
        source, array, "", "nominal",
        "the calibration has " + count_text(nominal.size(), "sensor") + " and the array file has " + std::to_string(n));
  }
  for (std::size_t i = 0; i < n; ++i) compare_sensor(source, array, nominal[i], i);
  const std::string reads = source.text_of(there, "reads");
  if (reads != reads_word(array.datasheet.reads)) {
    refuse_array(
        source, array, "", "reads",
        "its sensors have reads = " + reads + ", those of the array file reads = " + reads_word(array.datasheet.reads));
  }
  if (source.text_of(there, "fingerprint") != hex(array.fingerprint)) {
    refuse_array(source, array, "", "fingerprint", "the fingerprints of the two arrays differ");
  }
}

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb

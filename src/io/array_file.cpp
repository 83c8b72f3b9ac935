#include "plumb/io/array_file.hpp"

#include <cmath>
#include <cstring>
#include <exception>
#include <utility>

#include "array_parts.hpp"
#include "plumb/io/hash.hpp"
#include "plumb/io/output_file.hpp"
#include "refusal.hpp"
#include "text_tools.hpp"
#include "toml_table.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {
namespace {

const std::vector<std::string>& known_sections() {
  static const std::vector<std::string> names = {"name",   "gravity", "monitor", "input",  "output",
                                                 "motion", "gyro",    "clock",   "sensor", "group"};
  return names;
}

const std::vector<std::string>& known_input_keys() {
  static const std::vector<std::string> names = {
      "rows",  "time",        "time_unit",      "rate",      "station", "roll_group",     "count",
      "where", "temperature", "reads",          "corrected", "unit",    "rotation_radps", "second_rotation_radps",
      "depth", "depth_unit",  "known_attitudes"};
  return names;
}

constexpr double kFrameTolerance = 1e-6;

void read_corrected(const TomlTable& table, InputSpec& input) {
  const TomlNode* corrected = table.find("corrected");
  if (corrected == nullptr) return;
  if (corrected->kind != TomlNode::Kind::boolean)
    table.fail(corrected->line, "corrected", std::string("is ") + corrected->kind_name() + ", must be true or false",
               "write corrected = true where the autopilot's own calibration is in the readings already");
  input.corrected = corrected->boolean;
}

void read_time(const TomlTable& table, InputSpec& input) {
  input.time_column = table.text("time", "");
  const bool has_rate = table.has("rate");
  if (table.has("time_unit")) {
    const TomlNode& value = table.need("time_unit", "");
    const std::string text = table.text_with_unit(value, "time_unit", accepted_units(Quantity::time));
    input.time_unit_s = table.checked(parse_quantity(Quantity::time, "1 " + text), "time_unit", value);
    if (input.time_column.empty())
      table.fail(value.line, "time_unit", "needs a time column", "add time = \"<column>\", or remove this key");
  }
  if (has_rate && !input.time_column.empty()) {
    table.fail(table.line_of("rate"), "rate", "and time are both given", "keep one of them");
  }
  if (has_rate && input.rows == RowKind::stations) {
    table.fail(table.line_of("rate"), "rate", "cannot be used with rows = \"stations\"",
               "remove this key; the row number is then the time");
  }
  if (has_rate) {
    input.rate_hz = table.need_quantity(Quantity::rate, "rate", "");
    if (!(input.rate_hz > 0.0))
      table.fail(table.line_of("rate"), "rate", "must be above zero", "give rate = \"100 Hz\"");
  }
  if (input.rows == RowKind::samples && !has_rate && input.time_column.empty()) {
    table.fail(table.line(), "time", "is missing", "name the time column, time = \"t_s\", or give rate = \"100 Hz\"");
  }
}

std::vector<std::string> read_rates(const TomlTable& table, const char* key) {
  std::vector<std::string> out;
  const TomlNode* list = table.find(key);
  if (list == nullptr) return out;
  const std::string form =
      std::string("name the columns of the three components: ") + key + " = [\"wx\", \"wy\", \"wz\"]";
  if (list->kind != TomlNode::Kind::array || list->items.size() != 3)
    table.fail(list->line, key, "must be a list of three columns", form);
  for (const TomlNode& item : list->items) {
    if (item.kind != TomlNode::Kind::text || item.text.empty())
      table.fail(list->line, key, "holds an entry that is not a column name", form);
    out.push_back(item.text);
  }
  return out;
}

void read_rotation(const TomlTable& table, InputSpec& input) {
  input.rotation_columns = read_rates(table, "rotation_radps");
  input.second_rotation_columns = read_rates(table, "second_rotation_radps");
  if (!input.second_rotation_columns.empty() && input.rotation_columns.empty())
    table.fail(table.line_of("second_rotation_radps"), "second_rotation_radps", "is given without a first gyro",
               "name its columns rotation_radps, or add those of the first gyro");
}

void read_depth(const TomlTable& table, InputSpec& input) {
  input.depth_column = table.text("depth", "");
  if (!table.has("depth_unit")) return;
  const TomlNode& value = table.need("depth_unit", "");
  const std::string text = table.text_with_unit(value, "depth_unit", accepted_units(Quantity::length));
  input.depth_unit_m = table.checked(parse_quantity(Quantity::length, "1 " + text), "depth_unit", value);
  if (input.depth_column.empty())
    table.fail(value.line, "depth_unit", "needs a depth column", "add depth = \"<column>\", or remove this key");
}

void read_known_attitudes(const TomlTable& table, InputSpec& input) {
  const TomlNode* list = table.find("known_attitudes");
  if (list == nullptr) return;
  const std::string form =
      "list stations of the calibration log with inclination and toolface in deg: known_attitudes = [\"7:60,40\"]";
  if (list->kind != TomlNode::Kind::array) table.fail(list->line, "known_attitudes", "must be a list of texts", form);
  for (const TomlNode& item : list->items) {
    if (item.kind != TomlNode::Kind::text)
      table.fail(list->line, "known_attitudes", "holds an entry that is not a text", form);
    const tl::expected<KnownAttitude, std::string> one = parse_known_attitude(item.text);
    if (!one) table.fail(list->line, "known_attitudes", one.error(), form);
    input.known_attitudes.push_back(*one);
  }
}

void read_where(const TomlTable& table, InputSpec& input) {
  const TomlNode* where = table.find("where");
  if (where == nullptr) return;
  const std::string form = "write where = {exp = 1}: a column and the value that selects a row";
  if (where->kind != TomlNode::Kind::table)
    table.fail(where->line, "where", std::string("is ") + where->kind_name() + ", must be a table", form);
  for (const auto& [column, value] : where->members) {
    ColumnFilter filter;
    filter.column = column;
    filter.numeric = value.kind == TomlNode::Kind::integer || value.kind == TomlNode::Kind::number;
    filter.number = value.number;
    if (value.kind == TomlNode::Kind::integer) filter.text = std::to_string(value.integer);
    if (value.kind == TomlNode::Kind::number) filter.text = shortest(value.number);
    if (value.kind == TomlNode::Kind::text) filter.text = value.text;
    if (!filter.numeric && value.kind != TomlNode::Kind::text) {
      table.fail(where->line, "where." + column,
                 std::string("is ") + value.kind_name() + ", must be a number or a string", form);
    }
    if (filter.numeric && !std::isfinite(filter.number)) {
      table.fail(where->line, "where." + column, "is not finite", form);
    }
    input.where.push_back(filter);
  }
}

/// Rows of unit length at right angles: a rotation, perhaps with a mirror (left-handed conventions).
Mat3 read_frame(const TomlNode& root, const std::string& file) {
  const TomlNode* node = root.find("output");
  if (node == nullptr) return kIdentity3;
  const TomlTable table(*node, file, "output", {"frame"});
  const TomlNode* frame = table.find("frame");
  if (frame == nullptr) return kIdentity3;
  const std::string form =
      "write frame = [[1, 0, 0], [0, 1, 0], [0, 0, 1]], rows of unit length at right angles; signs are free";
  if (frame->kind != TomlNode::Kind::array || frame->items.size() != 3)
    table.fail(frame->line, "frame", "must be three rows of three numbers", form);
  Mat3 out{};
  for (std::size_t r = 0; r < 3; ++r) {
    const TomlNode& row = frame->items[r];
    if (row.kind != TomlNode::Kind::array || row.items.size() != 3)
      table.fail(frame->line, "frame", "must be three rows of three numbers", form);
    for (std::size_t c = 0; c < 3; ++c) {
      const TomlNode& item = row.items[c];
      const bool number = item.kind == TomlNode::Kind::integer || item.kind == TomlNode::Kind::number;
      if (!number || !std::isfinite(item.number))
        table.fail(frame->line, "frame", "holds an entry that is not a finite number", form);
      out[3 * r + c] = item.number;
    }
  }
  for (std::size_t a = 0; a < 3; ++a) {
    for (std::size_t b = 0; b < 3; ++b) {
      const double product =
          out[3 * a] * out[3 * b] + out[3 * a + 1] * out[3 * b + 1] + out[3 * a + 2] * out[3 * b + 2];
      if (std::abs(product - (a == b ? 1.0 : 0.0)) <= kFrameTolerance) continue;
      const std::string rows = "rows " + std::to_string(a + 1) + " and " + std::to_string(b + 1);
      table.fail(frame->line, "frame",
                 a == b ? "row " + std::to_string(a + 1) + " is not of unit length" : rows + " are not at right angles",
                 form);
    }
  }
  return out;
}

ArrayFile chosen(std::vector<ArrayFile>& groups, const std::string& name, const std::string& path) {
  std::string known;
  for (ArrayFile& one : groups) {
    if (one.group == name) return std::move(one);
    known += (known.empty() ? "" : ", ") + path + "#" + one.group;
  }
  if (groups.empty())
    throw Refusal(FileError{path, 0, "group", "has no group " + in_quotes(name) + ", nor any other",
                            "leave out #" + name + " for its accelerometers, or add a [[group]]"});
  throw Refusal(FileError{path, 0, "group",
                          name.empty() ? "the file describes no accelerometer" : "has no group " + in_quotes(name),
                          "name one of its groups: " + known});
}

}  // namespace

ArrayFile array_of(const TomlNode& root, const std::string& text, const std::string& path, const FieldLookup& lookup,
                   const std::string& group) {
  const TomlTable top(root, path, "", known_sections());
  ArrayFile out;
  out.path = path;
  out.text = text;
  const std::string file_name = last_part(path);
  out.name = top.text("name", file_name.substr(0, file_name.rfind('.')));
  const GroupNode own{root, path, FieldKind::gravity, ""};
  const bool accelerometers = group.empty() && (root.find("sensor") != nullptr || root.find("group") == nullptr);
  if (accelerometers) {
    out.gravity = read_gravity(root, path, out.basis.normal_gravity);
    out.monitor = read_monitor(own);
  }
  out.input = read_input(root, path, out.datasheet.reads);
  out.output_frame = read_frame(root, path);
  std::vector<ArrayFile> groups = read_groups(root, out, lookup);
  if (!accelerometers) return chosen(groups, group, path);
  out.motion = read_motion(root, path, out.input);
  read_sensors(own, out);
  read_clocks(root, path, out);
  refuse_columns_of(out, groups);
  refuse_gyros_of(root, out, groups);
  out.fingerprint = fingerprint_of(out.datasheet);
  out.groups = std::move(groups);
  return out;
}

namespace {

std::uint64_t hashed(double value, std::uint64_t hash) noexcept {
  const double plain = value == 0.0 ? 0.0 : value;  // -0 and 0 are the same nominal value
  std::uint64_t bits = 0;
  std::memcpy(&bits, &plain, sizeof bits);
  std::array<unsigned char, 8> bytes{};
  for (std::size_t k = 0; k < bytes.size(); ++k) bytes[k] = static_cast<unsigned char>(bits >> (8U * k));
  return fnv1a(bytes.data(), bytes.size(), hash);
}

}  // namespace

const char* to_string(RowKind rows) noexcept { return rows == RowKind::stations ? "stations" : "samples"; }

InputSpec read_input(const TomlNode& root, const std::string& file, Reads& reads) {
  const TomlNode* node = root.find("input");
  if (node == nullptr) {
    throw Refusal(FileError{file, 0, "input", "is missing",
                            "add [input] with reads, unit and time (or rate): plumb needs them to read the log"});
  }
  const TomlTable table(*node, file, "input", known_input_keys());
  InputSpec input;
  input.rows = table.choice("rows", {"samples", "stations"}, 0) == 1 ? RowKind::stations : RowKind::samples;
  const std::string about_reads =
      "state the sign convention of the sensors: reads = \"specific-force\" where a sensor pointing up reads +1 g0 "
      "at rest (most MEMS parts), reads = \"gravity\" where one pointing down does";
  reads = table.need_choice("reads", {"specific-force", "gravity"}, about_reads) == 1 ? Reads::gravity
                                                                                      : Reads::specific_force;
  const std::string about_unit = "state the unit of the log, one of: " + accepted_raw_units();
  const std::string unit = table.need_text("unit", about_unit);
  input.unit = table.checked(parse_raw_unit(unit), "unit", table.need("unit", about_unit));
  read_corrected(table, input);
  read_time(table, input);
  input.station_column = table.text("station", "");
  input.roll_group_column = table.text("roll_group", "");
  input.count_column = table.text("count", "");
  input.temperature_column = table.text("temperature", "");
  read_rotation(table, input);
  read_depth(table, input);
  read_known_attitudes(table, input);
  read_where(table, input);
  return input;
}

FileExpected<ArrayFile> parse_array_text(const std::string& text, const std::string& path, const FieldLookup& lookup,
                                         const std::string& group) {
  try {
    const FileExpected<TomlNode> root = parse_toml(text, path);
    if (!root) return tl::unexpected<FileError>(root.error());
    return array_of(*root, text, path, lookup, group);
  } catch (const Refusal& refusal) {
    return tl::unexpected<FileError>(refusal.error());
  } catch (const std::exception& error) {
    return tl::unexpected<FileError>(
        FileError{path, 0, "", error.what(), "report this as a bug of plumb", ExitCode::other});
  }
}

FileExpected<ArrayFile> read_array_file(const std::string& path, const FieldLookup& lookup) {
  const std::size_t mark = path.rfind('#');
  FileExpected<std::string> text = read_file(path);
  if (text || mark == std::string::npos) {  // a file may have the sign in its name
    if (!text) return tl::unexpected<FileError>(text.error());
    return parse_array_text(*text, path, lookup);
  }
  const std::string file = path.substr(0, mark);
  text = read_file(file);
  if (!text) return tl::unexpected<FileError>(text.error());
  return parse_array_text(*text, file, lookup, path.substr(mark + 1));
}

SensorSet without_stability(const ArrayFile& array) noexcept {
  SensorSet out;
  for (int i = 0; i < array.datasheet.size; ++i) {
    if (!array.stability[static_cast<std::size_t>(i)].stated()) out = out.with(i);
  }
  return out;
}

Readings tolerance_mps2(const ArrayFile& array, double days_since_calibration) noexcept {
  Readings out{};
  for (std::size_t i = 0; i < static_cast<std::size_t>(array.datasheet.size); ++i) {
    const auto now = StabilityNow::of(array.stability[i], days_since_calibration);
    out[i] = static_cast<double>(now.tolerance_mps2(0.0, 0.0));
  }
  return out;
}

std::uint64_t fingerprint_of(const Datasheet& datasheet, FieldKind field) noexcept {
  const char of_gravity = datasheet.reads == Reads::gravity ? 'g' : 's';
  const char reads = field == FieldKind::gravity ? of_gravity : field == FieldKind::magnetic ? 'm' : 'r';
  std::uint64_t hash = fnv1a(&reads, 1);
  for (int i = 0; i < datasheet.size && i < kCapacity; ++i) {
    const DatasheetSensor& sensor = datasheet.sensor[static_cast<std::size_t>(i)];
    hash = fnv1a(sensor.row.id.data(), sensor.row.id.size(), hash);
    for (const double value : sensor.row.axis) hash = hashed(value, hash);
    for (const double value : sensor.coefficients.scale) hash = hashed(value, hash);
    for (const double value : sensor.coefficients.bias) hash = hashed(value, hash);
    hash = hashed(sensor.coefficients.reference_degc, hash);
  }
  return hash;
}

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb

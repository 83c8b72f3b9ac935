// The table of coefficients as JSON: the keys of the array file, with `sigma` for the uncertainties.
#include <exception>

#include "../io/calibration_json.hpp"
#include "../io/text_tools.hpp"
#include "plumb/io/json_fields.hpp"
#include "plumb/io/units.hpp"
#include "sensor_table.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace coefficients {
namespace {

using io::Json;

constexpr int kDeepest = 6;
constexpr const char* kForm =
    "write {\"schema\": \"plumb-coefficients\", \"version\": 1, \"sensors\": [{\"id\": \"a1\", \"scale\": \"3 V/g0\", "
    "\"bias\": \"12 mg\", \"sigma\": {\"bias\": \"2 mg\", \"scale\": \"500 ppm\", \"axis\": \"0.1 deg\"}}]}";

struct Reader {
  const std::string& path;
  const std::string& text;

  int line_at(std::size_t position) const {
    int line = 1;
    for (std::size_t k = 0; k < position && k < text.size(); ++k) line += text[k] == '\n' ? 1 : 0;
    return line;
  }
  [[noreturn]] void refuse(int line, const std::string& field, const std::string& what,
                           const std::string& remedy = kForm) const {
    throw io::Refusal(io::FileError{path, line, field, what, remedy});
  }
};

Json root_of(const Reader& in) {
  const auto shallow = [&in](int depth, Json::parse_event_t, Json&) {
    if (depth > kDeepest) in.refuse(0, "", "is nested too deeply");
    return true;
  };
  try {
    return Json::parse(in.text, shallow);
  } catch (const Json::parse_error& error) {
    in.refuse(in.line_at(error.byte), "", "is not valid JSON");
  } catch (const Json::exception&) {
    in.refuse(0, "", "is not valid JSON: a number is out of range");
  }
}

std::string cell_of(const Reader& in, const Json& value, const std::string& field) {
  if (value.is_string()) return value.get<std::string>();
  if (value.is_number()) return io::shortest(value.get<double>());
  in.refuse(0, field, "must be a text with a unit, or a number");
}

void put(const Reader& in, TableRow& row, const std::string& column, const Json& value) {
  const std::string field = row.place + "." + column;
  const auto& known = table_columns();
  bool is_known = false;
  for (const std::string& one : known) is_known = is_known || one == column;
  if (!is_known)
    in.refuse(0, row.place + "." + io::in_quotes(column), "is no key of a sensor",
              io::did_you_mean(column, known) +
                  "known: id, scale, bias, axis, bias_t, scale_t, t_ref, t_min, t_max, "
                  "sigma");
  const std::string text = cell_of(in, value, field);
  if (!text.empty()) row.cell[column] = text;
}

/// A list under one key: axis, bias_t, scale_t.
void put_list(const Reader& in, TableRow& row, const std::string& key, const Json& list) {
  const bool axis = key == "axis";
  if (!axis && key != "bias_t" && key != "scale_t") in.refuse(0, row.place + "." + io::in_quotes(key), "is a list");
  if (list.size() > 3 || (axis && list.size() != 3))
    in.refuse(0, row.place + "." + key, "has " + std::to_string(list.size()) + " numbers, must have three");
  for (std::size_t k = 0; k < list.size(); ++k)
    put(in, row, axis ? std::string("axis_") + "xyz"[k] : key + std::to_string(k + 1), list[k]);
}

void put_sigma(const Reader& in, TableRow& row, const Json& sigma) {
  for (const auto& [key, value] : sigma.items()) {
    const std::string column = "sigma_" + key;
    if (row.cell.find(column) == row.cell.end()) put(in, row, column, value);
  }
}

TableRow row_at(const Reader& in, const Json& sensor, std::size_t number, const Json* usual) {
  TableRow row;
  row.place = "sensors[" + std::to_string(number) + "]";
  if (!sensor.is_object()) in.refuse(0, row.place, "is not an object");
  for (const auto& [key, value] : sensor.items()) {
    if (key == "sigma" && value.is_object()) {
      put_sigma(in, row, value);
    } else if (value.is_array()) {
      put_list(in, row, key, value);
    } else {
      put(in, row, key, value);
    }
  }
  if (usual != nullptr) put_sigma(in, row, *usual);
  return row;
}

}  // namespace

std::vector<TableRow> json_rows(const std::string& text, const std::string& path) {
  const Reader in{path, text};
  const Json root = root_of(in);
  const bool ours = root.is_object() && root.contains("schema") && root["schema"] == kSchema;
  if (!ours) {
    const bool calibration = root.is_object() && root.contains("schema") && root["schema"] == io::kCalibrationSchema;
    in.refuse(
        0, "schema",
        std::string("must be \"") + kSchema + "\"" + (calibration ? ", and this is a calibration file of plumb" : ""),
        calibration ? "use it as it is: plumb monitor --calibration" : kForm);
  }
  if (!root.contains("version") || root["version"] != kVersion) in.refuse(0, "version", "must be 1");
  const Json* usual = nullptr;
  for (const auto& [key, value] : root.items()) {
    if (key == "schema" || key == "version" || key == "sensors" || key == "comment") continue;
    if (key != "sigma" || !value.is_object()) in.refuse(0, io::in_quotes(key), "is not a known key here");
    usual = &value;
  }
  if (!root.contains("sensors") || !root["sensors"].is_array() || root["sensors"].empty())
    in.refuse(0, "sensors", "must be a list with the coefficients of each sensor");
  const Json& sensors = root["sensors"];
  if (sensors.size() > static_cast<std::size_t>(kCapacity))
    in.refuse(0, "sensors", "has more entries than an array has sensors", "give every sensor one entry");
  std::vector<TableRow> out;
  for (std::size_t k = 0; k < sensors.size(); ++k) out.push_back(row_at(in, sensors[k], k + 1, usual));
  return out;
}

std::string json_text(const std::vector<TableRow>& rows) {
  Json sensors = Json::array();
  for (const TableRow& row : rows) {
    Json one = Json::object();
    Json sigma = Json::object();
    for (const std::string& column : table_columns()) {
      const auto found = row.cell.find(column);
      if (found == row.cell.end()) continue;
      const std::string& text = found->second;
      const std::string stem = column.substr(0, column.size() - 1);
      if (column.rfind("sigma_", 0) == 0) {
        sigma[column.substr(6)] = text;
      } else if (stem == "axis_") {
        one["axis"].push_back(io::parsed(text));  // a number, as the array file has it
      } else if (stem == "bias_t" || stem == "scale_t") {
        one[stem].push_back(text);
      } else {
        one[column] = text;
      }
    }
    if (!sigma.empty()) one["sigma"] = std::move(sigma);
    sensors.push_back(std::move(one));
  }
  return io::printed(io::object({{"schema", kSchema}, {"version", kVersion}, {"sensors", std::move(sensors)}})) + "\n";
}

}  // namespace coefficients
}  // namespace PLUMB_ABI
}  // namespace plumb

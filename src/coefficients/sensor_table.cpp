// Cells of a table of coefficients as statements, and back.
#include "sensor_table.hpp"

#include <cmath>

#include "../io/csv.hpp"
#include "../io/text_tools.hpp"
#include "plumb/core/units.hpp"
#include "plumb/io/units.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace coefficients {
namespace {

constexpr double kColdest_degc = -273.15, kHottest_degc = 1000.0;

std::string order_name(const char* stem, std::size_t order) { return stem + std::to_string(order); }

/// Reads the cells of one row.
class Cells {
 public:
  Cells(const TableRow& row, const std::string& path, const io::ArrayFile& array)
      : row_(row), path_(path), array_(array) {}

  bool has(const std::string& column) const { return row_.cell.find(column) != row_.cell.end(); }
  const std::string& need(const std::string& column, const std::string& remedy) const {
    const auto found = row_.cell.find(column);
    if (found == row_.cell.end()) refuse(column, "is missing", remedy);
    return found->second;
  }
  double checked(const std::string& column, const io::FileExpected<double>& read) const {
    if (!read) refuse(column, read.error().what, read.error().remedy);
    return *read;
  }
  double quantity(const std::string& column, io::Quantity quantity) const {
    return checked(column, io::parse_quantity(quantity, need(column, "give it")));
  }
  double number(const std::string& column) const {
    double out = 0.0;
    const std::string& text = need(column, "give all three: axis_x, axis_y, axis_z");
    if (io::parse_cell(text, out) != io::CellKind::number || !std::isfinite(out))
      refuse(column, io::in_quotes(text) + " is not a number", "give the direction in the tool frame as three numbers");
    return out;
  }
  [[noreturn]] void refuse(const std::string& column, const std::string& what, const std::string& remedy) const {
    throw io::Refusal(
        io::FileError{path_, row_.line, row_.place.empty() ? column : row_.place + "." + column, what, remedy});
  }
  const io::ArrayFile& array() const { return array_; }

 private:
  const TableRow& row_;
  const std::string& path_;
  const io::ArrayFile& array_;
};

int sensor_of(const Cells& cells) {
  const std::string& id = cells.need("id", "name the sensor as the array file does");
  std::vector<std::string> known;
  for (int i = 0; i < cells.array().array.size(); ++i) {
    known.emplace_back(cells.array().array.row(i).id.data());
    if (known.back() == id) return i;
  }
  cells.refuse("id", io::in_quotes(id) + " is no sensor of " + cells.array().path,
               io::did_you_mean(id, known) + "known: " + io::joined(known));
}

SensorCoefficients model_of(const Cells& cells, int sensor) {
  const io::RawUnit& unit = cells.array().input.unit;
  SensorCoefficients out = cells.array().datasheet.sensor[static_cast<std::size_t>(sensor)].coefficients;
  const SensorCoefficients nominal = out;
  const std::string& scale = cells.need("scale", "give the output per m/s^2 or per g0, as in the array file");
  out.scale[0] = cells.checked("scale", io::parse_scale(scale, unit));
  const std::string& bias = cells.need("bias", "give it, \"0 m/s^2\" where there is none");
  out.bias[0] = cells.checked("bias", io::parse_as_acceleration(bias, unit, out.scale[0]));
  for (std::size_t k = 1; k < 4; ++k) {
    const int order = static_cast<int>(k);
    out.scale[k] = out.scale[0] * (nominal.scale[k] / nominal.scale[0]);
    if (const std::string name = order_name("scale_t", k); cells.has(name))
      out.scale[k] = out.scale[0] *
                     cells.checked(name, io::parse_temperature_slope(io::Quantity::ratio, cells.need(name, ""), order));
    if (const std::string name = order_name("bias_t", k); cells.has(name))
      out.bias[k] =
          cells.checked(name, io::parse_temperature_slope(io::Quantity::acceleration, cells.need(name, ""), order));
  }
  if (cells.has("t_ref")) out.reference_degc = cells.quantity("t_ref", io::Quantity::temperature);
  if (!(out.reference_degc >= kColdest_degc && out.reference_degc <= kHottest_degc))
    cells.refuse("t_ref", "is " + io::brief(out.reference_degc) + " degC, out of range",
                 "give the temperature in degC");
  return out;
}

Vec3 axis_of(const Cells& cells, int sensor) {
  if (!cells.has("axis_x") && !cells.has("axis_y") && !cells.has("axis_z")) return cells.array().array.axis(sensor);
  const Vec3 axis = {cells.number("axis_x"), cells.number("axis_y"), cells.number("axis_z")};
  const double length = norm(axis);
  if (std::fabs(length - 1.0) <= kAxisLengthTolerance) return axis;
  cells.refuse("axis_x", "the axis is " + io::brief(length, 9) + " long, must be of unit length",
               "divide its three numbers by its length");
}

double positive(const Cells& cells, const std::string& column, double value, double most, const char* unit) {
  if (value > 0.0 && value <= most) return value;
  cells.refuse(column,
               "is " + io::brief(value) + unit + ", must be above 0 and at most " + io::brief(most) + unit +
                   ": every limit of a monitor rests on it",
               "state 1 sigma of what the coefficients may be off by");
}

Uncertainty sigma_of(const Cells& cells) {
  Uncertainty out;
  if (cells.has("sigma_bias")) {
    const std::string& text = cells.need("sigma_bias", "");
    const double value = cells.checked("sigma_bias", io::parse_quantity(io::Quantity::acceleration, text));
    out.bias_mps2 = positive(cells, "sigma_bias", value, kMostSigmaBias_mps2, " m/s^2");
  }
  if (cells.has("sigma_scale"))
    out.scale = positive(cells, "sigma_scale", cells.quantity("sigma_scale", io::Quantity::ratio), kMostSigmaScale, "");
  if (cells.has("sigma_axis"))
    out.axis_rad =
        positive(cells, "sigma_axis", cells.quantity("sigma_axis", io::Quantity::angle), kMostSigmaAxis_rad, " rad");
  return out;
}

std::optional<TemperatureSpan> span_of(const Cells& cells) {
  if (!cells.has("t_min") && !cells.has("t_max")) return std::nullopt;
  const TemperatureSpan out = {cells.quantity("t_min", io::Quantity::temperature),
                               cells.quantity("t_max", io::Quantity::temperature)};
  const bool sound = out.min_degc >= kColdest_degc && out.max_degc <= kHottest_degc && out.min_degc <= out.max_degc;
  if (!sound) cells.refuse("t_max", "must be no less than t_min, both in degC", "correct the two temperatures");
  return out;
}

}  // namespace

const std::vector<std::string>& table_columns() {
  static const std::vector<std::string> columns = {
      "id",       "scale",    "bias",     "axis_x", "axis_y", "axis_z", "bias_t1",    "bias_t2",     "bias_t3",
      "scale_t1", "scale_t2", "scale_t3", "t_ref",  "t_min",  "t_max",  "sigma_bias", "sigma_scale", "sigma_axis"};
  return columns;
}

std::vector<SensorStatement> statements_of(const std::vector<TableRow>& rows, const std::string& path,
                                           const io::ArrayFile& array) {
  std::vector<SensorStatement> out;
  for (const TableRow& row : rows) {
    const Cells cells(row, path, array);
    SensorStatement one;
    one.sensor = sensor_of(cells);
    one.source = path + (row.line > 0 ? ":" + std::to_string(row.line) : ": " + row.place);
    one.model = model_of(cells, one.sensor);
    one.axis = axis_of(cells, one.sensor);
    one.sigma = sigma_of(cells);
    one.span = span_of(cells);
    for (const SensorStatement& other : out) {
      if (other.sensor == one.sensor)
        cells.refuse("id", io::in_quotes(cells.need("id", "")) + " stands in " + other.source + " already",
                     "give every sensor one row");
    }
    out.push_back(one);
  }
  return out;
}

TableRow row_of(const io::ArrayFile& array, const SensorStatement& sensor) {
  TableRow row;
  auto& cell = row.cell;
  const SensorCoefficients& c = sensor.model;
  const io::RawUnit& unit = array.input.unit;
  const std::string plain = io::shortest(c.scale[0]);
  cell["id"] = array.array.row(sensor.sensor).id.data();
  cell["scale"] = plain + " " + unit.name + "/(m/s^2)";
  cell["bias"] = io::shortest(c.bias[0]) + " m/s^2";
  for (std::size_t k = 0; k < 3; ++k) cell[std::string("axis_") + "xyz"[k]] = io::shortest(sensor.axis[k]);
  for (std::size_t k = 1; k < 4; ++k) {
    const std::string per = k == 1 ? "/degC" : "/degC^" + std::to_string(k);
    cell[order_name("bias_t", k)] = io::shortest(c.bias[k]) + " m/s^2" + per;
    cell[order_name("scale_t", k)] = io::shortest(c.scale[k] / c.scale[0]) + " " + per;
  }
  cell["t_ref"] = io::shortest(c.reference_degc) + " degC";
  if (sensor.span) {
    cell["t_min"] = io::shortest(sensor.span->min_degc) + " degC";
    cell["t_max"] = io::shortest(sensor.span->max_degc) + " degC";
  }
  if (sensor.sigma.bias_mps2) cell["sigma_bias"] = io::shortest(*sensor.sigma.bias_mps2) + " m/s^2";
  if (sensor.sigma.scale) cell["sigma_scale"] = io::shortest(*sensor.sigma.scale);
  if (sensor.sigma.axis_rad) cell["sigma_axis"] = io::shortest(*sensor.sigma.axis_rad) + " rad";
  return row;
}

}  // namespace coefficients
}  // namespace PLUMB_ABI
}  // namespace plumb

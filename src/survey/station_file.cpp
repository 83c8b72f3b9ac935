#include "plumb/survey/station_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "plumb/core/units.hpp"
#include "plumb/io/printable.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace survey {
namespace {

constexpr std::size_t kMostStations = 100'000;
struct Unit {
  const char* name;
  double si;
};
constexpr Unit kLengths[] = {{"m", 1.0}, {"ft", 0.3048}};
constexpr Unit kAccelerations[] = {{"mps2", 1.0}, {"g", kG0_mps2}, {"mg", 1e-3 * kG0_mps2}};
constexpr Unit kFields[] = {{"nT", 1e-9}, {"uT", 1e-6}, {"mG", 1e-7}, {"G", 1e-4}, {"T", 1.0}};
constexpr double kLeastGravity_mps2 = 5.0;
constexpr double kMostGravity_mps2 = 15.0;
constexpr double kLeastField_tesla = 5e-6;
constexpr double kMostField_tesla = 200e-6;

tl::unexpected<io::FileError> refuse(const std::string& path, std::string field, std::string what, std::string remedy) {
  return tl::unexpected<io::FileError>(
      io::FileError{path, 0, std::move(field), std::move(what), std::move(remedy), io::ExitCode::invalid_input});
}

std::optional<std::size_t> column(const io::CsvColumns& columns, const std::string& name) {
  const auto at = std::find(columns.names.begin(), columns.names.end(), name);
  if (at == columns.names.end()) return std::nullopt;
  return static_cast<std::size_t>(at - columns.names.begin());
}

struct Triad {
  std::array<std::size_t, 3> at{};
  std::string prefix;
  Unit unit{"", 1.0};
};

/// Every triad with one of these prefixes, in one of these units.
template <std::size_t Units>
std::vector<Triad> triads(const io::CsvColumns& columns, std::initializer_list<const char*> prefixes,
                          const Unit (&units)[Units]) {
  std::vector<Triad> out;
  for (const char* prefix : prefixes) {
    for (const Unit& unit : units) {
      Triad triad{{}, prefix, unit};
      bool whole = true;
      for (std::size_t k = 0; k < 3; ++k) {
        const auto at = column(columns, fmt::format("{}{}_{}", prefix, "xyz"[k], unit.name));
        whole = whole && at;
        triad.at[k] = at.value_or(0);
      }
      if (whole) out.push_back(triad);
    }
  }
  return out;
}

io::FileExpected<Triad> only(std::vector<Triad> found, const std::string& path, const char* what, const char* example) {
  if (found.size() == 1) return std::move(found.front());
  if (found.empty())
    return refuse(path, "header", fmt::format("has no three {} in one unit", what),
                  fmt::format("name the columns {}", example));
  return refuse(path, "header",
                fmt::format("has {} twice: {}x_{} and {}x_{}", what, found[0].prefix, found[0].unit.name,
                            found[1].prefix, found[1].unit.name),
                "keep the columns of one of them");
}

Vec3 row_of(const io::CsvColumns& columns, const Triad& triad, std::size_t row) {
  Vec3 out{};
  for (std::size_t k = 0; k < 3; ++k) out[k] = columns.values[triad.at[k]][row] * triad.unit.si;
  return out;
}

/// The median length, and in which unit it would be right.
template <std::size_t Units>
io::FileExpected<void> check_unit(std::vector<double> lengths, const Triad& triad, const Unit (&units)[Units],
                                  double least, double most, double told_per_si, const char* told, const char* what,
                                  const std::string& path) {
  const auto middle = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2);
  std::nth_element(lengths.begin(), middle, lengths.end());
  const double median = *middle;
  if (median >= least && median <= most) return {};
  std::string remedy = "check the unit at the end of the columns' names";
  const double usual = std::sqrt(least * most);
  double nearest = std::sqrt(most / least);
  for (const Unit& unit : units) {  // of several that would do, the one that gives the most usual length
    const double length = median / triad.unit.si * unit.si;
    if (!(length > 0.0)) continue;
    const double off = length > usual ? length / usual : usual / length;
    if (!(off <= nearest)) continue;
    nearest = off;
    remedy = fmt::format("the numbers are right in {}: end the columns' names in _{}", unit.name, unit.name);
  }
  return refuse(path, fmt::format("{}x_{}", triad.prefix, triad.unit.name),
                fmt::format("gives {} of {:.4g} {} at half of the stations, must be {:.4g} to {:.4g} {}", what,
                            median * told_per_si, told, least * told_per_si, most * told_per_si, told),
                remedy);
}

}  // namespace

io::FileExpected<StationFile> stations_of(const io::CsvColumns& columns, const std::string& path) {
  const auto gravity =
      only(triads(columns, {"g", "a"}, kAccelerations), path, "accelerometers", "gx_mps2, gy_mps2, gz_mps2");
  if (!gravity) return tl::unexpected<io::FileError>(gravity.error());
  const auto field = only(triads(columns, {"b", "m", "mag"}, kFields), path, "magnetometers", "bx_nT, by_nT, bz_nT");
  if (!field) return tl::unexpected<io::FileError>(field.error());
  std::optional<std::size_t> depth;
  double depth_m = 1.0;
  for (const Unit& unit : kLengths) {
    const auto at = column(columns, fmt::format("md_{}", unit.name));
    if (at && depth) return refuse(path, "header", "has the measured depth twice: md_m and md_ft", "keep one of them");
    if (at) depth_m = unit.si;
    depth = at ? at : depth;
  }
  if (!depth) return refuse(path, "header", "has no measured depth", "name its column md_m, or md_ft");

  StationFile out;
  out.gravity_unit = gravity->unit.name;
  out.field_unit = field->unit.name;
  out.specific_force = gravity->prefix == "a";
  out.rows_left_out = columns.rows_bad;
  std::vector<double> gravities, fields;
  for (std::size_t row = 0; row < columns.values[*depth].size(); ++row) {
    Measurement m;
    m.md_m = columns.values[*depth][row] * depth_m;
    m.gravity_mps2 = row_of(columns, *gravity, row);
    if (out.specific_force) m.gravity_mps2 = gravity_of_specific_force(m.gravity_mps2);
    m.field_tesla = row_of(columns, *field, row);
    if (!std::isfinite(m.md_m + norm(m.gravity_mps2) + norm(m.field_tesla))) {
      ++out.rows_left_out;
      continue;
    }
    if (out.stations.size() == kMostStations)
      return refuse(path, "", fmt::format("has more than {} stations", kMostStations), "give one row a station");
    gravities.push_back(norm(m.gravity_mps2));
    fields.push_back(norm(m.field_tesla));
    out.stations.push_back(m);
  }
  if (out.stations.empty()) return refuse(path, "", "has no row with all seven numbers", "give one row a station");
  if (const auto fits = check_unit(gravities, *gravity, kAccelerations, kLeastGravity_mps2, kMostGravity_mps2, 1.0,
                                   "m/s^2", "a gravity", path);
      !fits)
    return tl::unexpected<io::FileError>(fits.error());
  if (const auto fits =
          check_unit(fields, *field, kFields, kLeastField_tesla, kMostField_tesla, 1e6, "uT", "a field", path);
      !fits)
    return tl::unexpected<io::FileError>(fits.error());
  return out;
}

io::FileExpected<StationFile> read_stations(const std::string& path, io::BadRowPolicy policy) {
  const io::FileExpected<io::CsvColumns> columns = io::read_csv_columns(path, policy, nullptr, 100 * kMostStations);
  if (!columns) return tl::unexpected<io::FileError>(columns.error());
  return stations_of(*columns, path);
}

}  // namespace survey
}  // namespace PLUMB_ABI
}  // namespace plumb

/// Stations of a survey from a CSV.
#pragma once

#include <string>
#include <vector>

#include "plumb/io/csv_columns.hpp"
#include "plumb/survey/measurement.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace survey {

/// Columns by name, the unit at its end; capitals count in the units alone:
///   md_m, md_ft                        measured depth
///   gx_mps2, gx_g, gx_mg               accelerometers, positive where the axis points down (ISCWSA)
///   ax_mps2, ax_g, ax_mg               the same as specific force, which at rest points up: the sign is turned
///   bx_nT, bx_uT, bx_mG, bx_G, bx_T    magnetometers; mx_ and magx_ are read as well
/// A g is 9.80665 m/s^2.
/// y and z alike, all three of a triad in one unit. Other columns are left alone.
struct StationFile {
  std::vector<Measurement> stations;  ///< random errors and bias bounds are 0: the caller states them
  std::string gravity_unit, field_unit;
  bool specific_force = false;
  std::uint64_t rows_left_out = 0;  ///< without one of the seven numbers, or bad under BadRowPolicy::skip
};

/// Refuses a file without the columns, a triad in two units or twice, no row of numbers, more than 100 000 stations,
/// and numbers that are in another unit than the header says: half of the stations with gravity outside of 5 to 15
/// m/s^2 or a field outside of 5 to 200 uT. The remedy names the unit in which they would be right.
io::FileExpected<StationFile> stations_of(const io::CsvColumns& columns, const std::string& path);
io::FileExpected<StationFile> read_stations(const std::string& path, io::BadRowPolicy policy);

}  // namespace survey
}  // namespace PLUMB_ABI
}  // namespace plumb

/// plumb's own table of coefficients, one row a sensor, as CSV and as JSON (private to src/coefficients).
#pragma once

#include <map>
#include <string>
#include <vector>

#include "../io/refusal.hpp"
#include "plumb/coefficients/coefficient_file.hpp"
#include "plumb/io/calibration_file.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace coefficients {

inline constexpr const char* kSchema = "plumb-coefficients";
inline constexpr int kVersion = 1;

/// The columns of the table in the order of an export; `id`, `scale` and `bias` are required.
const std::vector<std::string>& table_columns();

/// One row as it stands: what the column holds. An empty cell is as none.
struct TableRow {
  int line = 0;
  std::string place;  ///< in messages: "sensors[2]", or empty
  std::map<std::string, std::string> cell;
};

/// Both throw a Refusal. What a JSON file states as `sigma` of all sensors stands in every row that states none.
std::vector<TableRow> csv_rows(const std::string& text, const std::string& path);
std::vector<TableRow> json_rows(const std::string& text, const std::string& path);

/// The rows as statements of sensors of this array. Throws a Refusal.
std::vector<SensorStatement> statements_of(const std::vector<TableRow>& rows, const std::string& path,
                                           const io::ArrayFile& array);

/// One row of cells for a sensor: values that read back as the same doubles, but for drifts of the scale, which may be
/// off by rounding.
TableRow row_of(const io::ArrayFile& array, const SensorStatement& sensor);

/// The text of the table. Throws a Refusal where an id cannot stand in a cell.
std::string csv_text(const std::vector<TableRow>& rows, const std::string& comment, const std::string& path);
std::string json_text(const std::vector<TableRow>& rows);

}  // namespace coefficients
}  // namespace PLUMB_ABI
}  // namespace plumb

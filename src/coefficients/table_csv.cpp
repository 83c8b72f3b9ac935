// The table of coefficients as CSV.
#include <algorithm>

#include "../io/csv.hpp"
#include "../io/text_tools.hpp"
#include "sensor_table.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace coefficients {
namespace {

[[noreturn]] void refuse_row(const std::string& path, int line, const std::string& what, const std::string& remedy) {
  throw io::Refusal(io::FileError{path, line, "", what, remedy});
}

std::vector<std::string> header_of(std::string_view line, const std::string& path, int number) {
  std::vector<std::string_view> cells(table_columns().size() + 1);
  const std::size_t count = io::split_cells(line, cells);
  std::vector<std::string> out;
  for (std::size_t k = 0; k < std::min(count, cells.size()); ++k) {
    out.emplace_back(io::bare_cell(cells[k]));
    const auto& known = table_columns();
    if (std::find(known.begin(), known.end(), out.back()) == known.end())
      refuse_row(path, number, io::in_quotes(out.back()) + " is no column of a table of coefficients",
                 io::did_you_mean(out.back(), known) + "known, with commas between them: " + io::joined(known));
    if (std::find(out.begin(), out.end() - 1, out.back()) != out.end() - 1)
      refuse_row(path, number, "the column " + io::in_quotes(out.back()) + " stands there twice", "remove one of them");
  }
  return out;
}

TableRow row_at(std::string_view line, const std::vector<std::string>& header, const std::string& path, int number) {
  std::vector<std::string_view> cells(header.size());
  const std::size_t count = io::split_cells(line, cells);
  if (count != header.size())
    refuse_row(path, number,
               "the row has " + std::to_string(count) + " cells, but the header has " + std::to_string(header.size()),
               "correct the row");
  TableRow row;
  row.line = number;
  for (std::size_t k = 0; k < count; ++k) {
    const std::string_view bare = io::bare_cell(cells[k]);
    if (!bare.empty()) row.cell[header[k]] = std::string(bare);
  }
  return row;
}

/// In double quotes where a comma or blanks would be lost.
std::string cell_text(const std::string& text, const std::string& path) {
  const bool plain = text.find('"') == std::string::npos &&
                     std::none_of(text.begin(), text.end(), [](unsigned char c) { return c < ' ' || c == 0x7f; });
  if (!plain || text.empty() || io::trimmed(text) != text)
    refuse_row(path, 0, io::in_quotes(text) + " cannot stand in a cell of a CSV file",
               "export json, or rename the sensor");
  return text.find(',') == std::string::npos && text.front() != '#' ? text : '"' + text + '"';
}

}  // namespace

std::vector<TableRow> csv_rows(const std::string& text, const std::string& path) {
  std::vector<TableRow> out;
  std::vector<std::string> header;
  int number = 0;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    std::string_view line = io::trimmed(std::string_view(text).substr(begin, end - begin));
    begin = end + 1;
    ++number;
    while (!line.empty() && line.back() == '\r') line = io::trimmed(line.substr(0, line.size() - 1));
    if (line.empty() || line.front() == '#') continue;
    if (header.empty()) {
      header = header_of(line, path, number);
      continue;
    }
    if (out.size() > static_cast<std::size_t>(kCapacity))
      refuse_row(path, number, "has more rows than an array has sensors", "give every sensor one row");
    out.push_back(row_at(line, header, path, number));
  }
  if (out.empty())
    refuse_row(
        path, 0, "holds no row of coefficients",
        "give a header row (id, scale, bias, ...) and one row a sensor: docs/calibration.md, Known coefficients");
  return out;
}

std::string csv_text(const std::vector<TableRow>& rows, const std::string& comment, const std::string& path) {
  std::string out = comment;
  const auto& columns = table_columns();
  for (std::size_t k = 0; k < columns.size(); ++k) out += (k > 0 ? "," : "") + columns[k];
  out += '\n';
  for (const TableRow& row : rows) {
    for (std::size_t k = 0; k < columns.size(); ++k) {
      const auto found = row.cell.find(columns[k]);
      out += k > 0 ? "," : "";
      if (found != row.cell.end()) out += cell_text(found->second, path);
    }
    out += '\n';
  }
  return out;
}

}  // namespace coefficients
}  // namespace PLUMB_ABI
}  // namespace plumb

#include "csv_layout.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "plumb/io/printable.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace logs {
namespace {

using Cells = std::vector<std::string_view>;

/// In the order in which they are believed where several fit as well.
constexpr std::array<CsvDialect, 9> kDialects = {
    {{',', '.'}, {';', '.'}, {';', ','}, {'\t', '.'}, {'\t', ','}, {' ', '.'}, {' ', ','}, {'|', '.'}, {'|', ','}}};
/// Three axes; a time may be missing.
constexpr std::size_t kFewestNumbers = 3;

tl::unexpected<CsvTrouble> trouble(std::uint64_t line, std::string what, std::string remedy) {
  return tl::unexpected<CsvTrouble>(CsvTrouble{line, std::move(what), std::move(remedy)});
}

bool is_comment(std::string_view line) noexcept {
  line = bare(line);
  return line.empty() || line[0] == '#' || line[0] == '%' || line.substr(0, 2) == "//";
}

std::string_view without_mark(std::string_view line) noexcept {
  while (!line.empty() && std::string_view("#%/ \t").find(line.front()) != std::string_view::npos)
    line.remove_prefix(1);
  return line;
}

/// How many cells are numbers or dates; 0 where the line is none of readings.
std::size_t readings_in(const Cells& cells, char decimal) {
  std::size_t numbers = 0, others = 0;
  for (const std::string_view cell : cells) {
    double value = 0.0;
    std::int64_t time_ns = 0;
    const CellKind kind = parse_number(cell, decimal, value);
    if (kind == CellKind::number || (kind == CellKind::text && parse_time(cell, decimal, TimeForm::date, time_ns)))
      ++numbers;
    else if (kind == CellKind::text)
      ++others;
  }
  return numbers >= kFewestNumbers && numbers >= others ? numbers : 0;
}

struct Fit {
  CsvDialect dialect;
  std::size_t columns = 0;
  std::size_t numbers = 0;  ///< in all lines with so many cells
};

Fit fit_of(const CsvSample& sample, const CsvDialect& dialect) {
  std::map<std::size_t, std::size_t> numbers;
  Cells cells;
  for (const std::string& line : sample.lines) {
    if (is_comment(line)) continue;
    split(line, dialect.separator, cells);
    const std::size_t count = readings_in(cells, dialect.decimal);
    if (count > 0) numbers[cells.size()] += count;
  }
  const auto most = std::max_element(numbers.begin(), numbers.end(),
                                     [](const auto& a, const auto& b) { return a.second < b.second; });
  return most == numbers.end() ? Fit{dialect, 0, 0} : Fit{dialect, most->first, most->second};
}

/// Whether cells may name columns: fewer numbers than words.
bool are_names(const Cells& cells) {
  std::size_t numbers = 0, words = 0;
  for (const std::string_view cell : cells) {
    double value = 0.0;
    const CellKind kind = parse_number(cell, '.', value);
    numbers += kind == CellKind::number ? 1U : 0U;
    words += kind == CellKind::text ? 1U : 0U;
  }
  return words >= kFewestNumbers && words > numbers;
}

/// A second row of the header: "s;m/s^2;m/s^2".
bool are_units(const Cells& cells) {
  std::size_t known = 0;
  for (const std::string_view cell : cells) {
    const ColumnUnit unit = unit_of(cell);
    if (unit == ColumnUnit::unknown && bare(cell).size() > 12) return false;
    known += factor_of(unit) > 0.0 ? 1U : 0U;
  }
  return known >= kFewestNumbers;
}

/// A header may be separated in another way than what follows: "# time ax ay az" above cells with commas.
bool split_header(std::string_view line, std::size_t columns, char separator, Cells& out) {
  line = without_mark(line);
  for (const char c : {separator, ',', ';', '\t', ' '}) {
    split(line, c, out);
    while (out.size() > columns && bare(out.back()).empty()) out.pop_back();
    if (out.size() + 1 == columns) out.emplace_back();  // rows may end with a separator
    if (out.size() == columns) return true;
  }
  return false;
}

/// The names above the line `data`, and the units below them.
bool find_header(const CsvSample& sample, std::size_t data, std::size_t columns, CsvLayout& out) {
  Cells cells;
  std::vector<std::string> units;
  for (std::size_t k = data; k > 0; --k) {
    const std::string& line = sample.lines[k - 1];
    if (bare(without_mark(line)).empty()) continue;
    if (!split_header(line, columns, out.dialect.separator, cells)) return false;
    if (units.empty() && are_units(cells)) {
      units.assign(cells.begin(), cells.end());
      continue;
    }
    if (!are_names(cells)) return false;
    out.header.assign(cells.begin(), cells.end());
    out.header_line = k;
    for (std::size_t c = 0; c < units.size(); ++c) {
      if (!bare(units[c]).empty()) out.header[c] += " [" + std::string(bare(units[c])) + "]";
    }
    return true;
  }
  return false;
}

tl::expected<Fit, CsvTrouble> find_dialect(const CsvSample& sample, const CsvHints& hints) {
  Fit best;
  for (const CsvDialect& dialect : kDialects) {
    CsvDialect tried = dialect;
    if (hints.decimal != 0 && dialect.decimal != hints.decimal) continue;
    if (hints.separator != 0 && dialect.separator != hints.separator) continue;
    const Fit fit = fit_of(sample, tried);
    if (fit.numbers > best.numbers) best = fit;
  }
  if (best.numbers > 0) return best;
  return trouble(0, "has no rows of at least 3 numbers in its first " + std::to_string(sample.lines.size()) + " lines",
                 "give a table of readings: a row a time, cells separated by commas, semicolons, tabs or blanks");
}

}  // namespace

tl::expected<void, CsvTrouble> check(const CsvHints& hints) {
  const auto is_unit = [&hints](double unit_s) { return std::abs(hints.time_unit_s / unit_s - 1.0) < 1e-6; };
  if (!std::isnan(hints.time_unit_s) && !is_unit(1.0) && !is_unit(1e-3) && !is_unit(1e-6) && !is_unit(1e-9))
    return trouble(0, "cannot be read with this unit of time", "give 1, 1e-3, 1e-6 or 1e-9 seconds");
  if (!std::isnan(hints.force_unit_mps2) && !(hints.force_unit_mps2 > 0.0 && std::isfinite(hints.force_unit_mps2)))
    return trouble(0, "cannot be read with this unit of readings", "give m/s^2 in one count, above 0");
  if (!std::isnan(hints.rate_hz) && !(hints.rate_hz > 0.0 && std::isfinite(hints.rate_hz)))
    return trouble(0, "cannot be read with this rate", "give rows in a second, above 0");
  if (hints.separator != 0 && std::string_view(",;\t |").find(hints.separator) == std::string_view::npos)
    return trouble(0, "cannot be read with this separator", "give a comma, a semicolon, a tab, a blank or |");
  if (hints.decimal != 0 && hints.decimal != '.' && hints.decimal != ',')
    return trouble(0, "cannot be read with this decimal mark", "give a point or a comma");
  return {};
}

tl::expected<CsvLayout, CsvTrouble> csv_layout(const CsvSample& sample, const CsvHints& hints) {
  const auto fit = find_dialect(sample, hints);
  if (!fit) return tl::make_unexpected(fit.error());
  CsvLayout out;
  out.dialect = fit->dialect;
  std::vector<std::vector<std::string>> rows;
  Cells cells;
  std::size_t first = 0;
  for (std::size_t k = 0; k < sample.lines.size(); ++k) {
    if (is_comment(sample.lines[k])) continue;
    split(sample.lines[k], out.dialect.separator, cells);
    if (cells.size() != fit->columns || readings_in(cells, out.dialect.decimal) == 0) continue;
    if (rows.empty()) first = k;
    rows.emplace_back(cells.begin(), cells.end());
  }
  out.data_line = first + 1;
  if (!hints.header.empty()) {
    if (hints.header.size() != fit->columns)
      return trouble(out.data_line,
                     "has " + std::to_string(fit->columns) + " columns, " + std::to_string(hints.header.size()) +
                         " names were given",
                     "name each column; \"-\" where it is of no use");
    out.header = hints.header;
  } else if (!find_header(sample, first, fit->columns, out)) {
    return trouble(
        out.data_line,
        "has no header above its first row of numbers that names its " + std::to_string(fit->columns) + " columns",
        "put a row of names above the numbers, for example: time_s,ax_mps2,ay_mps2,az_mps2");
  }
  const auto assigned = assign_columns(rows, sample, hints, out);
  if (!assigned) return tl::make_unexpected(assigned.error());
  return out;
}

std::string text_of(const CsvLayout& layout) {
  const auto column = [&layout](std::size_t k) { return "\"" + io::printable_line(bare(layout.header[k])) + "\""; };
  const char separator = layout.dialect.separator;
  std::string out = separator == ' '    ? std::string("separated by blanks")
                    : separator == '\t' ? std::string("separated by tabs")
                                        : std::string("separated by '") + separator + "'";
  if (layout.dialect.decimal == ',') out += ", decimal comma";
  if (layout.header_line > 0) out += ", header in line " + std::to_string(layout.header_line);
  if (layout.time != kNoColumn) out += ", time " + column(layout.time) + " in " + to_string(layout.time_form);
  for (const CsvSource& source : layout.sources) {
    out += ", " + source.name + ": " + column(source.force[0]) + ", " + column(source.force[1]) + ", " +
           column(source.force[2]);
    if (source.force_unit != ColumnUnit::none) out += std::string(" in ") + to_string(source.force_unit);
    if (source.rate_factor > 0.0) out += ", rates from " + column(source.rate[0]);
  }
  return out;
}

}  // namespace logs
}  // namespace PLUMB_ABI
}  // namespace plumb

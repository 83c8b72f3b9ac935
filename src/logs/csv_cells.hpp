/// Cells of a line, and what stands in them (private to src/logs).
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "plumb/core/config.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace logs {

/// How cells are separated and numbers written.
struct CsvDialect {
  char separator = ',';  ///< a blank stands for any number of blanks and tabs
  char decimal = '.';
};

constexpr std::size_t kMostColumns = 4096;

/// Without blanks and quotation marks around it.
std::string_view bare(std::string_view cell) noexcept;
/// Cells as they stand, no more than `kMostColumns`. A separator within quotation marks separates nothing.
void split(std::string_view line, char separator, std::vector<std::string_view>& out);

enum class CellKind : std::uint8_t { number, empty, text };
/// A number that is not finite counts as one.
CellKind parse_number(std::string_view cell, char decimal, double& out) noexcept;

/// What a cell of time counts in: a power of ten of nanoseconds, or it is a date or the time of a day.
enum class TimeForm : std::uint8_t { seconds, milliseconds, microseconds, nanoseconds, date };
const char* to_string(TimeForm form) noexcept;
/// Nanoseconds, of a date since 1970. Exact for what is written out, whatever it counts from. False where it is no
/// time.
bool parse_time(std::string_view cell, char decimal, TimeForm form, std::int64_t& out_ns) noexcept;

}  // namespace logs
}  // namespace PLUMB_ABI
}  // namespace plumb

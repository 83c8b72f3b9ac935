#include "csv_cells.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <system_error>

namespace plumb {
inline namespace PLUMB_ABI {
namespace logs {
namespace {

constexpr std::int64_t kSecond_ns = 1000000000;

bool is_blank(char c) noexcept { return c == ' ' || c == '\t'; }
bool is_digit(char c) noexcept { return c >= '0' && c <= '9'; }

int decimals_of(TimeForm form) noexcept {
  switch (form) {
    case TimeForm::seconds: return 9;
    case TimeForm::milliseconds: return 6;
    case TimeForm::microseconds: return 3;
    case TimeForm::nanoseconds:
    case TimeForm::date: break;
  }
  return 0;
}

/// Takes a whole number of 1 to `most` digits off the front.
bool take_whole(std::string_view& text, std::size_t most, std::int64_t& out) noexcept {
  std::size_t count = 0;
  out = 0;
  while (count < text.size() && count < most && is_digit(text[count])) out = 10 * out + (text[count++] - '0');
  text.remove_prefix(count);
  return count > 0;
}
bool take_one_of(std::string_view& text, std::string_view wanted) noexcept {
  if (text.empty() || wanted.find(text.front()) == std::string_view::npos) return false;
  text.remove_prefix(1);
  return true;
}

/// Digits behind the point as billionths; more than nine are passed over.
std::int64_t take_fraction_ns(std::string_view& text) noexcept {
  std::int64_t out = 0;
  std::size_t count = 0;
  for (; count < text.size() && is_digit(text[count]); ++count) {
    if (count < 9) out = 10 * out + (text[count] - '0');
  }
  text.remove_prefix(count);
  for (; count < 9; ++count) out *= 10;
  return out;
}

/// Days since 1970-01-01 of the Gregorian calendar; years begin in March here.
std::int64_t days_since_1970(std::int64_t year, std::int64_t month, std::int64_t day) noexcept {
  const std::int64_t y = month > 2 ? year : year - 1;
  const std::int64_t era = (y >= 0 ? y : y - 399) / 400;
  const std::int64_t of_era = y - era * 400;
  const std::int64_t of_year = (153 * (month > 2 ? month - 3 : month + 9) + 2) / 5 + day - 1;
  return era * 146097 + of_era * 365 + of_era / 4 - of_era / 100 + of_year - 719468;
}

/// "2024-02-29", "2024/2/29", "29.02.2024", "2/29/2024".
bool take_date(std::string_view& text, std::int64_t& days) noexcept {
  std::string_view rest = text;
  std::int64_t first = 0, second = 0, third = 0;
  if (!take_whole(rest, 4, first)) return false;
  const char mark = rest.empty() ? '\0' : rest.front();
  const std::string_view marks(&mark, 1);
  if (!take_one_of(rest, "-/.") || !take_whole(rest, 2, second) || !take_one_of(rest, marks) ||
      !take_whole(rest, 4, third))
    return false;
  std::int64_t year = first, month = second, day = third;
  if (first <= 31 && third > 31) {
    const bool is_american = mark == '/' && first <= 12;
    year = third;
    month = is_american ? first : second;
    day = is_american ? second : first;
  }
  if (year < 1900 || year > 2200 || month < 1 || month > 12 || day < 1 || day > 31) return false;
  days = days_since_1970(year, month, day);
  text = rest;
  return true;
}

/// "+02:00", "-0730", "Z".
bool take_zone(std::string_view& text, std::int64_t& seconds) noexcept {
  seconds = 0;
  if (take_one_of(text, "Zz")) return true;
  const bool is_west = !text.empty() && text.front() == '-';
  if (!take_one_of(text, "+-")) return true;
  std::int64_t hours = 0, minutes = 0;
  if (!take_whole(text, 2, hours)) return false;
  (void)take_one_of(text, ":");
  (void)take_whole(text, 2, minutes);
  seconds = (is_west ? -60 : 60) * (60 * hours + minutes);
  return true;
}

bool parse_date(std::string_view text, std::int64_t& out_ns) noexcept {
  std::int64_t days = 0, hours = 0, minutes = 0, seconds = 0, fraction_ns = 0, zone_s = 0;
  const bool has_date = take_date(text, days);
  if (has_date) {
    (void)take_one_of(text, "Tt,_");
    while (take_one_of(text, " ")) continue;
  }
  if (!take_whole(text, 2, hours)) return false;
  if (!take_one_of(text, ":") || !take_whole(text, 2, minutes)) return false;
  if (take_one_of(text, ":") && !take_whole(text, 2, seconds)) return false;
  if (take_one_of(text, ".,:")) fraction_ns = take_fraction_ns(text);
  while (take_one_of(text, " ")) continue;
  if (!take_zone(text, zone_s) || !text.empty() || hours > 24 || minutes > 59 || seconds > 60) return false;
  out_ns = (days * 86400 + hours * 3600 + minutes * 60 + seconds - zone_s) * kSecond_ns + fraction_ns;
  return true;
}

/// Digits as they stand, so that nanoseconds since 1970 lose nothing. False where it takes another way.
bool parse_digits(std::string_view text, char decimal, int decimals, std::int64_t& out_ns) noexcept {
  const bool is_negative = !text.empty() && text.front() == '-';
  if (is_negative || (!text.empty() && text.front() == '+')) text.remove_prefix(1);
  constexpr std::int64_t kMost = 900000000000000000;
  std::int64_t out = 0;
  bool is_behind = false;
  int left = decimals;
  if (text.empty() || !(is_digit(text.front()) || text.front() == decimal)) return false;
  for (const char c : text) {
    if (c == decimal && !is_behind) {
      is_behind = true;
      continue;
    }
    if (!is_digit(c)) return false;
    if (is_behind && left == 0) continue;
    if (out > kMost) return false;
    out = 10 * out + (c - '0');
    if (is_behind) --left;
  }
  for (; left > 0; --left) {
    if (out > kMost) return false;
    out *= 10;
  }
  out_ns = is_negative ? -out : out;
  return true;
}

}  // namespace

std::string_view bare(std::string_view cell) noexcept {
  const auto trim = [](std::string_view text) {
    while (!text.empty() && (is_blank(text.front()) || text.front() == '\r')) text.remove_prefix(1);
    while (!text.empty() && (is_blank(text.back()) || text.back() == '\r')) text.remove_suffix(1);
    return text;
  };
  cell = trim(cell);
  if (cell.size() >= 2 && (cell.front() == '"' || cell.front() == '\'') && cell.back() == cell.front())
    cell = trim(cell.substr(1, cell.size() - 2));
  return cell;
}

void split(std::string_view line, char separator, std::vector<std::string_view>& out) {
  out.clear();
  std::size_t at = 0;
  const auto separates = [separator](char c) { return separator == ' ' ? is_blank(c) : c == separator; };
  if (separator == ' ') {
    while (at < line.size() && is_blank(line[at])) ++at;
    while (!line.empty() && is_blank(line.back())) line.remove_suffix(1);
  }
  while (at <= line.size() && out.size() < kMostColumns) {
    std::size_t end = at;
    if (end < line.size() && line[end] == '"') {
      const std::size_t closing = line.find('"', end + 1);
      if (closing != std::string_view::npos) end = closing;
    }
    while (end < line.size() && !separates(line[end])) ++end;
    out.push_back(line.substr(at, end - at));
    at = end + 1;
    while (separator == ' ' && at < line.size() && is_blank(line[at])) ++at;
  }
}

CellKind parse_number(std::string_view cell, char decimal, double& out) noexcept {
  cell = bare(cell);
  if (cell.empty()) return CellKind::empty;
  if (cell.front() == '+') cell.remove_prefix(1);
  std::array<char, 64> copy{};
  if (decimal != '.') {
    if (cell.size() > copy.size() || cell.find('.') != std::string_view::npos) return CellKind::text;
    std::replace_copy(cell.begin(), cell.end(), copy.begin(), decimal, '.');
    cell = std::string_view(copy.data(), cell.size());
  }
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), out);
  if (error == std::errc::result_out_of_range) out = HUGE_VAL;
  const bool is_number = error != std::errc::invalid_argument && end == cell.data() + cell.size();
  return is_number ? CellKind::number : CellKind::text;
}

const char* to_string(TimeForm form) noexcept {
  switch (form) {
    case TimeForm::seconds: return "seconds";
    case TimeForm::milliseconds: return "milliseconds";
    case TimeForm::microseconds: return "microseconds";
    case TimeForm::nanoseconds: return "nanoseconds";
    case TimeForm::date: return "dates";
  }
  return "";
}

bool parse_time(std::string_view cell, char decimal, TimeForm form, std::int64_t& out_ns) noexcept {
  cell = bare(cell);
  if (form == TimeForm::date) return parse_date(cell, out_ns);
  if (parse_digits(cell, decimal, decimals_of(form), out_ns)) return true;
  double value = 0.0;
  if (parse_number(cell, decimal, value) != CellKind::number) return false;
  value *= std::pow(10.0, decimals_of(form));
  if (!(std::abs(value) < 9e18)) return false;
  out_ns = static_cast<std::int64_t>(value);
  return true;
}

}  // namespace logs
}  // namespace PLUMB_ABI
}  // namespace plumb

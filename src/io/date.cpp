#include "plumb/io/date.hpp"

#include <array>
#include <string>

#include "text_tools.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {
namespace {

constexpr int kFirstYear = 1970, kLastYear = 2199;

bool leaps(int year) noexcept { return year % 4 == 0 && (year % 100 != 0 || year % 400 == 0); }

int days_of_month(int year, int month) noexcept {
  constexpr std::array<int, 12> kDays = {31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31};
  return kDays[static_cast<std::size_t>(month - 1)] + (month == 2 && leaps(year) ? 1 : 0);
}

/// The number that these digits are; -1 where one is none.
int number(std::string_view digits) noexcept {
  int out = 0;
  for (const char c : digits) {
    if (c < '0' || c > '9') return -1;
    out = 10 * out + (c - '0');
  }
  return out;
}

}  // namespace

FileExpected<int> day_number(std::string_view date) {
  const bool form = date.size() == 10 && date[4] == '-' && date[7] == '-';
  const int year = form ? number(date.substr(0, 4)) : -1;
  const int month = form ? number(date.substr(5, 2)) : -1;
  const int day = form ? number(date.substr(8, 2)) : -1;
  const bool real = year >= kFirstYear && year <= kLastYear && month >= 1 && month <= 12 && day >= 1 &&
                    day <= days_of_month(year, month);
  if (!real) {
    FileError error;
    error.what = in_quotes(date) + " is no date";
    error.remedy = "write year, month and day as in 2026-03-31, from 1970 to 2199";
    return tl::unexpected<FileError>(std::move(error));
  }
  int out = day - 1;
  for (int y = kFirstYear; y < year; ++y) out += leaps(y) ? 366 : 365;
  for (int m = 1; m < month; ++m) out += days_of_month(year, m);
  return out;
}

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb

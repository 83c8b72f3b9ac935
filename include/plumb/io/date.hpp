/// Dates as users write them, "2026-03-31".
#pragma once

#include <string_view>

#include "plumb/io/file_error.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {

/// Days from 1970-01-01, of a date of the years 1970 to 2199. Refuses, with remedy, what is no date: another form, a
/// month 13, a 30th of February.
FileExpected<int> day_number(std::string_view date);

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb

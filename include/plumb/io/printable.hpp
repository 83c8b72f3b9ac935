/// Text from a file as a terminal may show it.
#pragma once

#include <string>
#include <string_view>

#include "plumb/core/config.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {

/// With every control character but the end of a line and the tab written out, "\\x1b": the name of a column or of an
/// array must not move the cursor, recolour or retitle a terminal. C1 controls in UTF-8 are written out too.
std::string printable(std::string_view text);
/// The same on one line: "\\x0a" for its end.
std::string printable_line(std::string_view text);

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb

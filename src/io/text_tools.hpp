/// Small text helpers of the readers (private to src/io).
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "plumb/core/config.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {

/// Without blanks and tabs at both ends.
std::string_view trimmed(std::string_view text) noexcept;

/// "a, b, c".
std::string joined(const std::vector<std::string>& names);

/// The known name that is fewest edits (insert, delete, replace, swap neighbours; case counts for
/// nothing) away, or "" where none is near enough to be meant: at most a third of its length.
std::string nearest_name(std::string_view given, const std::vector<std::string>& known);

/// `did you mean "x"? ` or nothing, to be put in front of a remedy.
std::string did_you_mean(std::string_view given, const std::vector<std::string>& known);

/// With a few significant digits, for messages only.
std::string brief(double value, int digits = 6);

/// What the system says of an errno, in a way that threads may share.
std::string system_message(int error_number);

/// The part after the last '/'.
std::string last_part(const std::string& path);

/// Text in double quotes for a message: control characters shown as '?', cut after 60 characters.
std::string in_quotes(std::string_view text);

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb

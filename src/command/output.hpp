/// What a program says on standard output and standard error.
#pragma once

#include <string_view>

#include "plumb/core/config.hpp"
#include "plumb/io/file_error.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace command {

/// Standard output and standard error. A failure to write is remembered and ends the tool with code 1.
void print(std::string_view text);
void print_now(std::string_view text);  ///< and flushes: for what someone is waiting for
void print_error(std::string_view text);
/// A line that is written over and over on a terminal, with its control characters; names in it must be `printable`.
/// All others write control characters out.
void print_status(std::string_view text);
/// "plumb: <text>" on standard error; returns the code of the error.
io::ExitCode report(const io::FileError& error);
bool output_is_sound();

}  // namespace command
}  // namespace PLUMB_ABI
}  // namespace plumb

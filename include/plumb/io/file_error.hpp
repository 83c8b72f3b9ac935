/// What went wrong with a file, said so that a stranger can mend it: file, line, field, what, remedy.
#pragma once

#include <string>
#include <tl/expected.hpp>

#include "plumb/core/config.hpp"
#include "plumb/core/error.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {

/// Exit codes of the tool (docs/array-file.md, "Exit codes and errors").
enum class ExitCode {
  done = 0,
  other = 1,  ///< anything else, unwritable output among it
  usage = 2,
  invalid_input = 3,   ///< unreadable or invalid input
  not_accepted = 4,    ///< not observable, or the fit was not accepted
  monitor_failed = 5,  ///< the monitor ended in `failed`
  verification_failed = 6,
  nothing_judged = 7,  ///< no block was at rest: the run says nothing about any sensor
  review_orange = 8,   ///< the worst finding of a review
  review_red = 9,
};
constexpr int to_int(ExitCode code) noexcept { return static_cast<int>(code); }

struct FileError {
  std::string file;    ///< as the user wrote it; "-" is standard input
  int line = 0;        ///< counted from 1; 0 = no line applies
  std::string field;   ///< "sensor[2].axis" (sensors counted from 1), a column name, or empty
  std::string what;    ///< what was found and what is needed
  std::string remedy;  ///< an instruction
  ExitCode code = ExitCode::invalid_input;

  /// "array.toml:12: sensor[2].axis: is 1.02 long, must be of unit length. Remedy: divide it ..."
  std::string text() const;
};

template <class T>
using FileExpected = tl::expected<T, FileError>;

/// A path or text as a shell takes it for one word, on one line: quoted where it must be. Control characters are
/// written out as bash, zsh and POSIX of 2024 read them, $'a\012b'.
std::string shell_word(const std::string& text);

/// An error of layers 1 to 4 in the words of `describe` and `remedy`, with its figures. `code` says
/// what the tool shall exit with.
FileError from_error(const Error& error, ExitCode code = ExitCode::invalid_input);

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb

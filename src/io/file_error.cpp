#include "plumb/io/file_error.hpp"

#include "plumb/io/printable.hpp"
#include "text_tools.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {

std::string FileError::text() const {
  std::string out = printable_line(file);
  if (line > 0) out += (out.empty() ? "line " : ":") + std::to_string(line);
  if (!out.empty()) out += ": ";
  if (!field.empty()) out += printable_line(field) + ": ";
  out += printable(what);
  if (!out.empty() && out.back() != '.' && out.back() != '?') out += '.';
  if (!remedy.empty()) out += " Remedy: " + printable(remedy) + (remedy.back() == '.' ? "" : ".");
  return out;
}

std::string shell_word(const std::string& text) {
  const bool plain =
      text.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_./:=@%+,-") ==
      std::string::npos;
  if (plain && !text.empty()) return text;
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

FileError from_error(const Error& error, ExitCode code) {
  FileError out;
  out.what = describe(error.code);
  if (error.value != 0.0 || error.limit != 0.0) {
    out.what += " (found " + brief(error.value) + ", limit " + brief(error.limit) + ")";
  }
  out.remedy = remedy(error.code);
  out.code = code;
  return out;
}

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb

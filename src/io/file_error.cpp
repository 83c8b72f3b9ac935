#include "plumb/io/file_error.hpp"

#include "plumb/io/printable.hpp"
#include "text_tools.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {
namespace {

/// $'...' of bash, zsh, ksh and POSIX of 2024: the only quotes that show a control character without one. Octal, since
/// a hexadecimal number may go on with the digits behind it.
std::string ansi_c_word(const std::string& text) {
  std::string out = "$'";
  for (const char c : text) {
    const auto byte = static_cast<unsigned>(static_cast<unsigned char>(c));
    if (byte < 0x20U || byte >= 0x7FU) {
      out += '\\';
      for (const unsigned shift : {6U, 3U, 0U}) out += static_cast<char>('0' + static_cast<int>(byte >> shift & 7U));
    } else {
      if (c == '\'' || c == '\\') out += '\\';
      out += c;
    }
  }
  return out + "'";
}

}  // namespace

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
  if (printable_line(text) != text || text.find('\t') != std::string::npos) return ansi_c_word(text);
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

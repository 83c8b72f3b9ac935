#include "output.hpp"

#include <cstdio>
#include <string>

#include "plumb/io/printable.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace command {
namespace {

bool g_output_failed = false;

}  // namespace

void print(std::string_view text) {
  const std::string shown = io::printable(text);
  if (std::fwrite(shown.data(), 1, shown.size(), stdout) != shown.size()) g_output_failed = true;
}

void print_now(std::string_view text) {
  print(text);
  if (std::fflush(stdout) != 0) g_output_failed = true;
}

void print_error(std::string_view text) { print_status(io::printable(text)); }

void print_status(std::string_view text) {
  // What was said before on standard output comes first, also where both go to one file.
  std::fflush(stdout);
  std::fwrite(text.data(), 1, text.size(), stderr);
}

io::ExitCode report(const io::FileError& error) {
  print_error("plumb: " + error.text() + "\n");
  return error.code;
}

bool output_is_sound() {
  if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) g_output_failed = true;
  return !g_output_failed;
}

}  // namespace command
}  // namespace PLUMB_ABI
}  // namespace plumb

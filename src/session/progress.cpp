#include "plumb/session/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>

#include <utility>
#include "plumb/io/printable.hpp"

#include "plumb/scenario/count_text.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace session {
namespace {

/// Rows between two updates of the progress line: rare enough to cost nothing.
constexpr std::uint64_t kProgressRows = 16384;

void show(const std::string& text) {
  std::fflush(stdout);  // what was said before on standard output comes first
  std::fwrite(text.data(), 1, text.size(), stderr);
}

}  // namespace

Progress::Progress(const std::string& what)
    : what_(io::printable_line(what)), on_terminal_(::isatty(STDERR_FILENO) != 0) {}

Progress::~Progress() {
  if (shown_) show("\r\033[K");
}

void Progress::at(std::uint64_t rows, double time_s) {
  if (!on_terminal_ || rows % kProgressRows != 0) return;
  shown_ = true;
  show(fmt::format("\r{}: {}, t = {:.1f} s\033[K", what_, count_text(rows, "row"), time_s));
}

}  // namespace session
}  // namespace PLUMB_ABI
}  // namespace plumb

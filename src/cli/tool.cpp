#include "tool.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cstdio>

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {
namespace {

volatile std::sig_atomic_t g_interrupt = 0;
bool g_output_failed = false;

void on_interrupt(int) { g_interrupt = 1; }

/// Rows between two updates of the progress line: rare enough to cost nothing.
constexpr std::uint64_t kProgressRows = 16384;

}  // namespace

std::string exit_codes_help() {
  return "Exit codes:\n"
         "  0  done\n"
         "  1  anything else: interrupted, output that cannot be written\n"
         "  2  the command line is not understood\n"
         "  3  a file is unreadable or invalid (the message names file, line, field and remedy)\n"
         "  4  the calibration was not accepted (the report says why and what to record next)\n"
         "  5  the monitor ended in the state `failed`\n"
         "  6  a verification did not pass\n";
}

void add_bad_row_option(CLI::App& app, io::BadRowPolicy& policy) {
  const std::map<std::string, io::BadRowPolicy> names{{"skip", io::BadRowPolicy::skip},
                                                      {"stop", io::BadRowPolicy::stop}};
  app.add_option("--on-bad-row", policy,
                 "what to do at a row that cannot be read: `stop` (default) or `skip` and count it")
      ->transform(CLI::CheckedTransformer(names).description(""))
      ->type_name("skip|stop");
}

void print(std::string_view text) {
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size()) g_output_failed = true;
}

void print_now(std::string_view text) {
  print(text);
  if (std::fflush(stdout) != 0) g_output_failed = true;
}

void print_error(std::string_view text) {
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

Progress::Progress(std::string what) : what_(std::move(what)), on_terminal_(::isatty(STDERR_FILENO) != 0) {}

Progress::~Progress() {
  if (shown_) print_error("\r\033[K");
}

void Progress::at(std::uint64_t rows, double time_s) {
  if (!on_terminal_ || rows % kProgressRows != 0) return;
  shown_ = true;
  print_error(fmt::format("\r{}: {} rows, t = {:.1f} s\033[K", what_, rows, time_s));
}

void watch_interrupts() {
  struct sigaction action {};
  action.sa_handler = on_interrupt;
  // No SA_RESTART, so that a read that waits on a pipe wakes up; once only, so that a second Ctrl-C ends a
  // tool that does not come to its orderly end.
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

const volatile std::sig_atomic_t* interrupt_flag() noexcept { return &g_interrupt; }
bool interrupted() noexcept { return g_interrupt != 0; }

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb

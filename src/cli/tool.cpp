#include "tool.hpp"

#include <fmt/format.h>
#include <sys/utsname.h>
#include <unistd.h>

#include <charconv>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <fstream>

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

std::string seed_refusal(const std::string& text) {
  std::uint64_t seed = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), seed);
  const bool whole = error == std::errc() && end == text.data() + text.size();
  return whole ? "" : "must be a whole number from 0 to 2^64 - 1";
}

void add_bad_row_option(const Options& command, io::BadRowPolicy& policy) {
  const std::map<std::string, io::BadRowPolicy> names{{"skip", io::BadRowPolicy::skip},
                                                      {"stop", io::BadRowPolicy::stop}};
  command
      .add_option("--on-bad-row", policy, names,
                  "what to do at a row that cannot be read: `stop` (default) or `skip` and count it")
      .type_name("skip|stop");
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

std::optional<io::FileError> overwritten(const std::vector<NamedFile>& outputs, const std::vector<NamedFile>& inputs) {
  const auto same = [](const NamedFile& a, const NamedFile& b) {
    if (a.path.empty() || a.path == "-" || b.path.empty() || b.path == "-") return false;
    std::error_code absent;  // a file that is not there yet can only be the same by its name
    if (std::filesystem::equivalent(a.path, b.path, absent) && !absent) return true;
    return std::filesystem::path(a.path).lexically_normal() == std::filesystem::path(b.path).lexically_normal();
  };
  const auto refusal = [](const NamedFile& output, const NamedFile& other) {
    return io::FileError{
        output.path,         0,
        output.option,       std::string("is the file that ") + other.option + " names too, and would be overwritten",
        "give another name", io::ExitCode::usage};
  };
  for (std::size_t k = 0; k < outputs.size(); ++k) {
    for (const NamedFile& input : inputs) {
      if (same(outputs[k], input)) return refusal(outputs[k], input);
    }
    for (std::size_t j = 0; j < k; ++j) {
      if (same(outputs[k], outputs[j])) return refusal(outputs[k], outputs[j]);
    }
  }
  return std::nullopt;
}

std::string now_utc() {
  const std::time_t now = std::time(nullptr);
  std::tm parts{};
  gmtime_r(&now, &parts);
  char text[32] = {};
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &parts);
  return text;
}

std::string host_name() {
  char text[256] = {};
  return ::gethostname(text, sizeof text - 1) == 0 ? text : "unknown";
}

std::string machine_name() {
  utsname system{};
  std::string out = ::uname(&system) == 0 ? std::string(system.machine) + ", " + system.sysname + " " + system.release
                                          : std::string("unknown");
  std::ifstream processors("/proc/cpuinfo");
  std::string line;
  while (std::getline(processors, line)) {
    const std::size_t colon = line.find(": ");
    if (line.rfind("model name", 0) == 0 && colon != std::string::npos) return line.substr(colon + 2) + ", " + out;
  }
  return out;
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

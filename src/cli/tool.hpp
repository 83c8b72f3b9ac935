/// What every command of the tool needs: how it is added, how it talks, how it is interrupted.
#pragma once

#include <csignal>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "options.hpp"
#include "plumb/core/config.hpp"
#include "plumb/io/file_error.hpp"
#include "plumb/io/log_reader.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {

/// Set by the build, from the project's version.
inline constexpr const char* kVersion = PLUMB_VERSION;

/// A command: its part of the command line, and what it does once that has been read.
struct Command {
  Options options;
  const char* about = "";  ///< what it does, at length; `plumb --help` shows one line only
  std::function<io::ExitCode()> run;
};

Command add_geometry(const Options& tool);
Command add_calibrate(const Options& tool);
Command add_monitor(const Options& tool);
Command add_simulate(const Options& tool);
Command add_inject(const Options& tool);
Command add_convert(const Options& tool);
Command add_model(const Options& tool);
Command add_verify(const Options& tool);
Command add_demo(const Options& tool);

/// The exit codes for the end of every --help.
std::string exit_codes_help();
/// For `check` of a --seed: empty where the text is a whole number that fits. The library alone takes -1, and 2^64, for
/// 2^64 - 1.
std::string seed_refusal(const std::string& text);
/// --on-bad-row skip|stop
void add_bad_row_option(const Options& command, io::BadRowPolicy& policy);

/// Standard output and standard error. A failure to write is remembered and ends the tool with code 1.
void print(std::string_view text);
void print_now(std::string_view text);  ///< and flushes: for what someone is waiting for
void print_error(std::string_view text);
/// "plumb: <text>" on standard error; returns the code of the error.
io::ExitCode report(const io::FileError& error);
bool output_is_sound();

/// What tells of a run rather than of its result.
std::string now_utc();
std::string host_name();
/// Processor and system, as the system names them.
std::string machine_name();

/// A file named on the command line, with the option that named it. "" and "-" stand for no file.
struct NamedFile {
  const char* option;
  std::string path;
};
/// The first output that is one of the inputs, or another output: writing it would destroy what the user has.
std::optional<io::FileError> overwritten(const std::vector<NamedFile>& outputs, const std::vector<NamedFile>& inputs);

/// A line of progress on standard error, only where that is a terminal; `done` wipes it.
class Progress {
 public:
  explicit Progress(std::string what);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  void at(std::uint64_t rows, double time_s);

 private:
  std::string what_;
  bool shown_ = false;
  bool on_terminal_;
};

/// From now on the first Ctrl-C (or SIGTERM) asks for an orderly end; the second one ends at once.
void watch_interrupts();
const volatile std::sig_atomic_t* interrupt_flag() noexcept;
bool interrupted() noexcept;

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb

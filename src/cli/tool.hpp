/// What every command of the tool needs: how it is added, how it talks, how it is interrupted.
#pragma once

#include <functional>
#include <string>

#include "../command/options.hpp"
#include "../command/output.hpp"
#include "../command/usual_options.hpp"
#include "plumb/core/config.hpp"
#include "plumb/session/interrupt.hpp"
#include "plumb/session/progress.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {

using command::add_bad_row_option;
using command::CommandLine;
using command::exit_codes_help;
using command::NamedFile;
using command::Option;
using command::Options;
using command::output_is_sound;
using command::overwritten;
using command::print;
using command::print_error;
using command::print_now;
using command::print_status;
using command::Reading;
using command::report;
using command::seed_refusal;
using command::TextReader;

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
Command add_review(const Options& tool);
Command add_import(const Options& tool);
Command add_simulate(const Options& tool);
Command add_inject(const Options& tool);
Command add_convert(const Options& tool);
Command add_noise(const Options& tool);
Command add_survey(const Options& tool);
Command add_upgrade(const Options& tool);
Command add_model(const Options& tool);
Command add_verify(const Options& tool);
Command add_campaign(const Options& tool);
Command add_demo(const Options& tool);

/// What tells of a run rather than of its result.
std::string now_utc();
std::string host_name();
/// Processor and system, as the system names them.
std::string machine_name();

using session::interrupt_flag;
using session::interrupted;
using session::Progress;
using session::watch_interrupts;

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb

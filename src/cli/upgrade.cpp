// plumb upgrade: a file of an earlier plumb in the words of this one.
#include <fmt/format.h>

#include <memory>

#include "plumb/io/output_file.hpp"
#include "plumb/io/upgrade.hpp"
#include "tool.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {
namespace {

struct UpgradeOptions {
  std::string file;
  std::string out;
  bool in_place = false;
};

constexpr const char* kUpgradeAbout =
    "Rename old keys in an array, scenario, campaign or calibration file. Only names change: comments, order and\n"
    "layout stay as they are. Without --in-place or --output it says what it would change and writes nothing.";
constexpr const char* kUpgradeNotes =
    "Every change is printed with its line. Where a key has no successor of the same meaning (drift_bias, "
    "drift_scale,\n"
    "common_drift) nothing is written: the message says what to write by hand, and the exit code is 3.\n\n"
    "Examples:\n"
    "  plumb upgrade tool.toml                        # which keys are old?\n"
    "  plumb upgrade tool.toml --in-place\n"
    "  plumb upgrade cal.json --output cal-new.json\n\n";

io::ExitCode run_upgrade(const UpgradeOptions& options) {
  if (options.in_place && !options.out.empty())
    return report(
        {options.out, 0, "--output", "and --in-place are both given", "keep one of the two", io::ExitCode::usage});
  const std::vector<NamedFile> to_write = {{"--output", options.out}};
  if (const std::optional<io::FileError> clash = overwritten(to_write, {{"FILE", options.file}})) return report(*clash);
  const io::FileExpected<std::string> text = io::read_file(options.file);
  if (!text) return report(text.error());
  const io::FileExpected<io::Upgraded> done = io::upgrade_text(*text, options.file);
  if (!done) return report(done.error());
  const bool to_standard_output = options.out == "-";
  if (!to_standard_output) {
    for (const io::Renaming& one : done->renamed)
      print(fmt::format("{}:{}: {}: {} -> {}\n", options.file, one.line, one.section, one.old_name, one.new_name));
    if (done->renamed.empty()) print(fmt::format("{}: no old key found\n", options.file));
  }
  const std::string target = options.in_place && !done->renamed.empty() ? options.file : options.out;
  if (target.empty()) return io::ExitCode::done;
  const io::FileExpected<void> written = io::write_file(target, done->text);
  if (!written) return report(written.error());
  if (!to_standard_output) print(fmt::format("written: {}\n", target));
  return io::ExitCode::done;
}

}  // namespace

Command add_upgrade(const Options& tool) {
  auto options = std::make_shared<UpgradeOptions>();
  const Options command = tool.add_command("upgrade", "rename the old keys of a file; comments and layout are kept");
  command.add_option("file", options->file, "an array, scenario, campaign or calibration file")
      .required()
      .type_name("FILE");
  command.add_option("--output", options->out, "where to write the new file; `-` = standard output").type_name("OUT|-");
  command.add_flag("--in-place", options->in_place, "write the new text into FILE itself");
  command.footer(kUpgradeNotes + exit_codes_help());
  return {command, kUpgradeAbout, [options] { return run_upgrade(*options); }};
}

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb

// plumb: the command-line tool. Finds the command, and turns every misunderstanding into a hint.
#include <exception>
#include <vector>

#include "../io/text_tools.hpp"
#include "manual.hpp"
#include "tool.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {
namespace {

constexpr const char* kAbout =
    "plumb monitors redundant accelerometers: it calibrates an array of single-axis accelerometers from\n"
    "gravity, tests it sample by sample, excludes faulty sensors, and gives the direction of gravity with a bound.";
constexpr const char* kNotes =
    "Start here:\n"
    "  plumb demo                     a tour on simulated tools whose sensors fail; needs no file\n"
    "  plumb COMMAND --help           what a command does, with an example\n\n";

std::string without_dashes(const std::string& option) {
  const std::size_t begin = option.find_first_not_of('-');
  return begin == std::string::npos ? option : option.substr(begin, option.find('=') - begin);
}

int usage(const std::string& what, const std::string& help_of) {
  print_error("plumb: " + what + "\nTry: " + help_of + " --help\n");
  return io::to_int(io::ExitCode::usage);
}

/// The first argument names the command: an unknown one is answered with the nearest known.
bool unknown_command(const std::string& word, const std::vector<Command>& commands, std::string& answer) {
  std::vector<std::string> names;
  for (const Command& command : commands) names.push_back(command.options.name());
  for (const std::string& name : names) {
    if (name == word) return false;
  }
  const std::string nearest = io::nearest_name(word, names);
  answer = "there is no command " + io::in_quotes(word) + ". " +
           (nearest.empty() ? "Commands: " + io::joined(names) : "Did you mean \"" + nearest + "\"?");
  return true;
}

/// What an option was called before: `--stations` is the field's word.
struct RenamedOption {
  const char* old_name;
  const char* new_name;
};
constexpr RenamedOption kRenamedOptions[] = {{"--positions", "--stations"},
                                             {"--roll-wobble-deg", "--roll-axis-deviation-deg"}};

/// What the command line holds beyond what the command knows.
std::string leftover(const Options& options) {
  const std::vector<std::string> rest = options.left_over();
  if (rest.empty()) return "";
  if (rest.front().empty() || rest.front()[0] != '-')
    return options.name() + ": " + io::in_quotes(rest.front()) + " is not expected here.";
  for (const RenamedOption& one : kRenamedOptions) {
    if (rest.front() == one.old_name)
      return options.name() + ": " + io::in_quotes(one.old_name) + " was renamed to " + io::in_quotes(one.new_name) +
             ".";
  }
  std::vector<std::string> known;
  for (const Option& option : options.list()) {
    for (const std::string& name : option.long_names()) known.push_back(name);
  }
  const std::string nearest = io::nearest_name(without_dashes(rest.front()), known);
  return options.name() + ": there is no option " + io::in_quotes(rest.front()) + "." +
         (nearest.empty() ? "" : " Did you mean \"--" + nearest + "\"?");
}

int misunderstood(const Options& tool, const std::string& what) {
  for (const Options& command : tool.given_commands()) {
    const std::string unknown = leftover(command);
    if (!unknown.empty()) return usage(unknown, "plumb " + command.name());
    return usage(command.name() + ": " + what + ".", "plumb " + command.name());
  }
  const std::string unknown = leftover(tool);
  return usage(unknown.empty() ? what + "." : unknown, "plumb");
}

int run(int argc, char** argv) {
  const CommandLine line(kAbout, "plumb", std::string("plumb ") + kVersion);
  line.column_width(34);
  const Options tool = line.options();
  // In the order in which a newcomer meets them.
  std::vector<Command> commands;
  for (const auto add :
       {add_demo, add_review, add_import, add_geometry, add_calibrate, add_monitor, add_simulate, add_inject, add_noise,
        add_survey, add_convert, add_campaign, add_verify, add_model, add_upgrade})
    commands.push_back(add(tool));
  tool.footer(kNotes + exit_codes_help());
  if (argc < 2) {
    print_error(tool.help());
    return io::to_int(io::ExitCode::usage);
  }
  // For the build, which installs them: no part of what a user sees.
  for (const auto& [name, print_it] : {std::pair<const char*, std::string (*)(const Manual&)>{"--man", man_page},
                                       {"--completion", bash_completion},
                                       {"--completion-zsh", zsh_completion},
                                       {"--completion-fish", fish_completion}}) {
    if (argc != 2 || std::string(argv[1]) != name) continue;
    print(print_it(Manual{kAbout, commands}));
    return output_is_sound() ? 0 : io::to_int(io::ExitCode::other);
  }
  std::string answer;
  if (argv[1][0] != '-' && unknown_command(argv[1], commands, answer)) return usage(answer, "plumb");
  for (const Command& command : commands) {
    if (command.options.name() == argv[1]) command.options.describe(command.about);
  }
  const Reading reading = line.read(argc, argv);
  if (reading.end == Reading::End::refused) return misunderstood(tool, reading.text);
  if (reading.end == Reading::End::answered) {
    print(reading.text);
    return output_is_sound() ? 0 : io::to_int(io::ExitCode::other);
  }
  for (const Command& command : commands) {
    if (!command.options.given()) continue;
    const io::ExitCode code = command.run();
    if (output_is_sound()) return io::to_int(code);
    print_error("plumb: standard output cannot be written. Remedy: free space, or write to another place.\n");
    return io::to_int(io::ExitCode::other);
  }
  return usage("a command is missing.", "plumb");
}

}  // namespace
}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb

int main(int argc, char** argv) {
  try {
    return plumb::cli::run(argc, argv);
  } catch (const std::exception& error) {
    // Only memory and the libraries of the host tool throw; plumb itself returns its errors.
    plumb::cli::print_error(std::string("plumb: unexpected: ") + error.what() + ". Please report this.\n");
    return plumb::io::to_int(plumb::io::ExitCode::other);
  }
}

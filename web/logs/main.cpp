// The commands of the tool that the page drops logs on. What they say, and how they refuse, is the tool's.
#include <exception>

#include "tool.hpp"

namespace {

using namespace plumb::cli;

int run(int argc, char** argv) {
  const CommandLine line("plumb in a page", "plumb", std::string("plumb ") + kVersion);
  const Options tool = line.options();
  std::vector<Command> commands;
  for (const auto add : {add_review, add_monitor}) commands.push_back(add(tool));
  const Reading reading = line.read(argc, argv);
  if (reading.end != Reading::End::understood) {
    print_error("plumb: " + reading.text + "\n");
    return plumb::io::to_int(plumb::io::ExitCode::usage);
  }
  for (const Command& command : commands) {
    if (command.options.given()) return plumb::io::to_int(command.run());
  }
  return plumb::io::to_int(plumb::io::ExitCode::usage);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const int code = run(argc, argv);
    return output_is_sound() ? code : plumb::io::to_int(plumb::io::ExitCode::other);
  } catch (const std::exception& error) {
    print_error(std::string("plumb: unexpected: ") + error.what() + ". Please report this.\n");
    return plumb::io::to_int(plumb::io::ExitCode::other);
  }
}

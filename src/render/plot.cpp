#include "plumb/render/plot.hpp"

#include <spawn.h>
#include <sys/wait.h>

#include <cerrno>
#include <cstring>

extern char** environ;

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {

const char* colour_of(HealthState state) noexcept {
  switch (state) {
    case HealthState::nominal: return "#2c8f57";
    case HealthState::suspect: return "#b97a00";
    case HealthState::isolated: return "#2f78b7";
    case HealthState::degraded_3_sensor: return "#8f55c4";
    case HealthState::recalibrating: return "#1f8a99";
    case HealthState::failed: return "#c53a3a";
  }
  return "#777777";
}

io::FileExpected<void> run_program(const std::string& directory, const std::string& program,
                                   const std::vector<std::string>& arguments, const std::string& package,
                                   const std::string& what) {
  const auto failed = [&program](std::string said, std::string remedy) {
    return tl::unexpected<io::FileError>(
        io::FileError{program, 0, "", std::move(said), std::move(remedy), io::ExitCode::other});
  };
  std::vector<std::string> words = {program};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  std::string line;
  for (std::string& word : words) {
    argv.push_back(word.data());
    line += (line.empty() ? "" : " ") + word;
  }
  argv.push_back(nullptr);
  // The scripts are UTF-8 and their numbers have points, whatever the user's locale is: without one, gnuplot complains
  // of the degree sign.
  std::string locale = "LC_ALL=C.UTF-8";
  std::vector<char*> environment;
  for (char** entry = environ; *entry != nullptr; ++entry)
    if (std::strncmp(*entry, "LC_ALL=", 7) != 0) environment.push_back(*entry);
  environment.push_back(locale.data());
  environment.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addchdir_np(&actions, directory.c_str());
  pid_t child = 0;
  const int error = posix_spawnp(&child, program.c_str(), &actions, nullptr, argv.data(), environment.data());
  posix_spawn_file_actions_destroy(&actions);
  if (error == ENOENT)
    return failed("is not installed, so there is no " + what,
                  "install it (Debian: apt-get install " + package + ") and run again");
  if (error != 0)
    return failed(std::string("cannot be started: ") + std::strerror(error), "check the installation of " + program);
  int status = 0;
  while (waitpid(child, &status, 0) < 0) {
    if (errno != EINTR) return failed("was interrupted while plumb waited for it", "run again");
  }
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
    return failed("did not draw the " + what, "run `" + line + "` in " + directory + " to see why");
  return {};
}

io::FileExpected<void> run_gnuplot(const std::string& directory, const std::string& script, DrawnFor drawn_for) {
  std::vector<std::string> arguments = {script};
  if (drawn_for != DrawnFor::itself)
    arguments.insert(arguments.begin(), {"-e", drawn_for == DrawnFor::page ? "page=1" : "page=1; narrow=1"});
  return run_program(directory, "gnuplot", arguments, "gnuplot-nox", "plot");
}

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb

// The drills of examples/ run as their first lines say.
#include "tool_runner.hpp"

namespace examples_test {
namespace {

using namespace plumb_test;

/// The commands in the comment at the head of an example, joined where a line goes on.
std::string commands_of(const std::string& example) {
  std::istringstream in(example);
  std::string line, out;
  while (std::getline(in, line) && line[0] == '#') {
    if (line.substr(0, 4) == "#   ") out += line.substr(4) + "\n";
  }
  return out;
}

/// Runs them in a directory in which examples/ lies; returns what the last one printed.
std::string play(const Directory& where, const char* stand, const char* drill) {
  const std::string examples = PLUMB_SOURCE_DIR "/examples/";
  std::filesystem::create_directory_symlink(examples, where / "examples");
  write_text(where / "script", "set -e\nplumb() { '" PLUMB_TOOL_PATH "' \"$@\"; }\n" +
                                   commands_of(read_text(examples + stand)) + commands_of(read_text(examples + drill)));
  const std::string shell = "cd '" + where.path().string() + "' && sh script > out 2> err";
  EXPECT_EQ(std::system(shell.c_str()), 0) << read_text(where / "script") << read_text(where / "err");
  return read_text(where / "out");
}

TEST(Examples, DrillAEndsWithWhatHasRecovered) {
  const Directory where;
  const std::string out = play(where, "stand.toml", "drill_a.toml");
  EXPECT_TRUE(says(out, {"nominal", "suspect", "parity", "degraded", "a2", "suspect", "norm", "failed",
                         "isolation_timeout", "suspect", "host_request", "a2", "suspect", "isolated_fault", "a3",
                         "degraded", "passed_block", "in service  a1, a2, a4", "excluded    a3"}));
  EXPECT_TRUE(says(read_text(where / "err"), {"--host \"63.5s reset a2 key 0x1\" was refused", "Remedy: "}));
}

TEST(Examples, DrillBTakesBackWhatHasRecovered) {
  const Directory where;
  const std::string out = play(where, "hexad_stand.toml", "drill_b.toml");
  EXPECT_TRUE(says(out, {"nominal", "suspect", "a2", "isolated", "recalibrating", "host_request", "suspect",
                         "calibration", "isolated", "passed_block", "suspect", "a5", "isolated", "probation", "a2",
                         "in service  a1, a2, a3, a4, a6", "excluded    a5"}));
  EXPECT_EQ(read_text(where / "err"), "");
}

}  // namespace
}  // namespace examples_test

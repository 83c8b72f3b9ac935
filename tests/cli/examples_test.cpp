// The drills of examples/ run as their first lines say.
#include "tool_runner.hpp"

namespace examples_test {
namespace {

using namespace plumb_test;

TEST(Examples, DrillAEndsWithWhatHasRecovered) {
  const Directory where;
  const std::string out = play_examples(where, {"stand.toml", "drill_a.toml"});
  EXPECT_TRUE(says(out, {"nominal", "suspect", "parity", "degraded", "a2", "suspect", "norm", "failed",
                         "isolation_timeout", "suspect", "host_request", "a2", "suspect", "isolated_fault", "a3",
                         "degraded", "passed_block", "in service  a1, a2, a4", "excluded    a3"}));
  EXPECT_TRUE(says(read_text(where / "err"), {"--host \"63.5s reset a2 key 0x1\" was refused", "Remedy: "}));
}

TEST(Examples, DrillBTakesBackWhatHasRecovered) {
  const Directory where;
  const std::string out = play_examples(where, {"hexad_stand.toml", "drill_b.toml"});
  EXPECT_TRUE(says(out, {"nominal", "suspect", "a2", "isolated", "recalibrating", "host_request", "suspect",
                         "calibration", "isolated", "passed_block", "suspect", "a5", "isolated", "probation", "a2",
                         "in service  a1, a2, a3, a4, a6", "excluded    a5"}));
  EXPECT_EQ(read_text(where / "err"), "");
}

}  // namespace
}  // namespace examples_test

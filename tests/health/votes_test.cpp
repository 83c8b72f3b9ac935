// Where a vote says the tool points, block by block: a fault must not pass for a movement of the tool.
// Serves: REQ-070, REQ-104
#include <gtest/gtest.h>

#include "support/simulated_tool.hpp"

namespace votes_test {
namespace {

using namespace plumb;
using plumb_test::direction_at;
using plumb_test::Rig;

/// The estimate with a faulty sensor in it is another direction, of the survivors it is not: between two votes of a
/// station (blocks 1, 2, 4, 8, 16) nothing seems to have turned.
TEST(Votes, BetweenThemTheToolPointsWhereTheSurvivorsSay) {
  Rig rig(plumb_test::tetrahedron());
  rig.prove();
  rig.distort = [](int i, double r, int) { return i == 2 ? r + 5.0 : r; };
  for (int station = 1; station <= 3; ++station) {
    for (int block = 1; block <= 20; ++block) {
      const Verdict& v = rig.stay(direction_at(33 + 12 * station, 140 + 60 * station));
      ASSERT_EQ(v.stations_on_record, station) << "block " << block;
      ASSERT_EQ(v.state, HealthState::suspect) << "block " << block;
    }
  }
}

}  // namespace
}  // namespace votes_test

// Lives of the paper's monitor that are seldom led: what is published stays finite, and a setup that fits nothing is
// refused.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <vector>

#include "paper/paper_rig.hpp"

namespace paper_unusual_runs_test {
namespace {

using namespace plumb;
using namespace paper_test;

/// Temperatures at which a polynomial has no number: no vector, and no harm.
// Negative: REQ-190
TEST(PaperMonitorUnusualRun, ReadingsThatAreNotNumbersDoNoHarm) {
  for (const double degc : {1e150, 1e200, 1e308, -1e160}) {
    PaperRig rig(4);
    rig.prove();
    for (int k = 0; k < 200; ++k) {
      Sample s = rig.sample(direction_at(30.0, 50.0));
      s.temperature_degc = degc;
      if (k % 50 == 7) s.raw[1] = 1e300;
      for (const double g : rig.step(s).gravity_mps2) ASSERT_TRUE(std::isfinite(g)) << degc;
      for (const double g : rig.monitor->verdict().latest_mps2) ASSERT_TRUE(std::isfinite(g)) << degc;
    }
    rig.tour(6);
    EXPECT_TRUE(rig.ever_excluded.empty()) << degc;
  }
}

// Negative: REQ-190
TEST(PaperMonitorUnusualRun, RefusesFitsOfOtherSensors) {
  const std::vector<std::function<void(PaperSetup&)>> wrong = {
      [](PaperSetup& s) { s.paper.all.used = SensorSet::first(3); },
      [](PaperSetup& s) { s.paper.triples = 1; },
      [](PaperSetup& s) { s.datasheet.size = 3; },
      [](PaperSetup& s) { s.paper.all.rank = 3; },
      [](PaperSetup& s) { s.paper.triple[1].used = SensorSet::first(3); },
      [](PaperSetup& s) {
        s.datasheet.sensor[0].row.axis = {2.0, 0.0, 0.0};
      }};
  for (std::size_t k = 0; k < wrong.size(); ++k) {
    PaperRig rig(4);
    wrong[k](*rig.setup);
    PaperMonitor monitor;
    EXPECT_FALSE(monitor.configure(*rig.setup).has_value()) << k;
  }
}

}  // namespace
}  // namespace paper_unusual_runs_test

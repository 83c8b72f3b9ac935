// Numbers of every size in every place of a datasheet and of the stations: the paper's fit ends with figures that are
// finite, or with a reason.
#include <gtest/gtest.h>

#include <cmath>

#include "calibration/extremes_support.hpp"
#include "plumb/paper/paper_calibration.hpp"

namespace paper_extremes_test {
namespace {

using namespace extremes_test;

TEST(PaperExtremes, TheFitStopsWithAReasonAtNumbersOfEverySize) {
  for (const int n : {3, 4}) {
    int sound = 0;
    const Count count = for_each_extreme([&](Problem& p) {
      plumb::PaperFit fit;
      const auto done =
          plumb::paper_calibrate(p.sheet, p.gravity, p.stations.data(), p.count(), plumb::SensorSet::first(n), {}, fit);
      if (!done) return false;
      EXPECT_NE(fit.stop, plumb::StopReason::none);
      if (fit.sound()) {
        EXPECT_TRUE(std::isfinite(fit.cost));
        ++sound;
      }
      return true;
    });
    expect_both(count, 250, 40);
    EXPECT_GE(sound, 100) << n << " sensors";
    EXPECT_GE(count.answered - sound, 50) << n << " sensors";
  }
}

}  // namespace
}  // namespace paper_extremes_test

#include "plumb/findings/dead_channel.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace dead_channel_test {
namespace {

using namespace plumb;

/// Three channels: the first changes, the second repeats itself, the third is nan.
std::vector<Sample> samples() {
  std::vector<Sample> out(4);
  for (std::size_t k = 0; k < out.size(); ++k) {
    out[k].delivered = SensorSet::first(3);
    out[k].raw[0] = static_cast<double>(k);
    out[k].raw[1] = 1.5;
    out[k].raw[2] = std::numeric_limits<double>::quiet_NaN();
  }
  return out;
}

TEST(DeadChannel, IsOneThatIsEmptyOrAlwaysTheSame) {
  const io::LogStatistics log = findings::statistics_of(samples(), 3);
  EXPECT_EQ(log.rows, 4U);
  EXPECT_EQ(log.not_finite[2], 4U);
  EXPECT_FALSE(findings::dead_channel(log, 0));
  EXPECT_TRUE(findings::dead_channel(log, 1));
  EXPECT_TRUE(findings::dead_channel(log, 2));
}

TEST(DeadChannel, IsNotReportedFromASingleRow) {
  const io::LogStatistics log = findings::statistics_of({samples().front()}, 3);
  EXPECT_FALSE(findings::dead_channel(log, 1));
}

TEST(TwinChannel, IsTheOneWithTheSameNumbersAtEveryStation) {
  std::vector<Station> stations(3);
  for (std::size_t k = 0; k < stations.size(); ++k) {
    const auto x = static_cast<double>(k);
    stations[k].mean = {x, 2.0 * x + 1.0, x};
  }
  EXPECT_EQ(findings::twin_channel(stations, 3, 2), 0);
  EXPECT_EQ(findings::twin_channel(stations, 3, 1), -1);
  EXPECT_EQ(findings::twin_channel(stations, 3, -1), -1);
  EXPECT_EQ(findings::twin_channel({}, 3, 2), -1);
}

}  // namespace
}  // namespace dead_channel_test

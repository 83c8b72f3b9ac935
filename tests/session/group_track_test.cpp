// The blocks at rest of one group, as its neighbours hear of them.
#include "plumb/session/group_track.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace group_track_test {
namespace {

using namespace plumb;
using namespace plumb::session;

struct Heard final : TrackListener {
  io::FileExpected<void> rested(const TrackPoint& block) override {
    blocks.push_back(block);
    return {};
  }
  io::FileExpected<void> moved(double until_s) override {
    moves_s.push_back(until_s);
    return {};
  }
  std::vector<TrackPoint> blocks;
  std::vector<double> moves_s;
};

class Track {
 public:
  Track() { track_.tell(heard); }
  /// A row: how many of the block there are now, and whether it ended one at rest.
  void row(double time_s, int fill, bool tick = false) {
    Sample sample;
    sample.time_s = time_s;
    Verdict verdict;
    verdict.block_fill = fill;
    verdict.tick = tick;
    verdict.validity = Validity::valid;
    verdict.protection_available = true;
    verdict.alert = false;
    verdict.gravity_mps2 = {0.0, 0.0, 9.8};
    verdict.covariance = {1e-6, 0.0, 0.0, 0.0, 4e-6, 0.0, 0.0, 0.0, 2e-6};
    verdict.protection_level_housing_rad = 0.01;
    ASSERT_TRUE(track_.take(sample, verdict));
  }
  Heard heard;

 private:
  GroupTrack track_;
};

TEST(GroupTrack, ABlockReachesFromItsFirstRowToItsLast) {
  Track track;
  for (const int fill : {1, 2, 3}) track.row(0.1 * fill, fill);
  track.row(0.4, 0, true);
  track.row(0.5, 1);
  track.row(0.6, 2);
  track.row(0.7, 3);
  track.row(0.8, 0, true);
  ASSERT_EQ(track.heard.blocks.size(), 2U);
  EXPECT_DOUBLE_EQ(track.heard.blocks[0].begin_s, 0.1);
  EXPECT_DOUBLE_EQ(track.heard.blocks[0].end_s, 0.4);
  EXPECT_DOUBLE_EQ(track.heard.blocks[1].begin_s, 0.5);
  EXPECT_TRUE(track.heard.blocks[1].usable);
  EXPECT_DOUBLE_EQ(track.heard.blocks[1].sigma, 0.002);
  EXPECT_TRUE(track.heard.moves_s.empty());
}

TEST(GroupTrack, ABlockThatMovedIsNoneAndAGapBeginsAnew) {
  Track track;
  track.row(0.1, 1);
  track.row(0.2, 2);
  track.row(0.3, 0);  // ended, and moved
  track.row(0.4, 1);
  track.row(0.5, 2);
  track.row(9.0, 1);  // a gap
  track.row(9.1, 2);
  track.row(9.2, 0, true);
  EXPECT_EQ(track.heard.moves_s, std::vector<double>{0.3});
  ASSERT_EQ(track.heard.blocks.size(), 1U);
  EXPECT_DOUBLE_EQ(track.heard.blocks[0].begin_s, 9.0);
}

TEST(GroupTrack, EveryRowMayBeABlock) {
  Track track;
  track.row(1.0, 0, true);
  track.row(2.0, 0, true);
  ASSERT_EQ(track.heard.blocks.size(), 2U);
  EXPECT_DOUBLE_EQ(track.heard.blocks[1].begin_s, 2.0);
  EXPECT_FALSE(track.heard.blocks[0].meets(track.heard.blocks[1]));
  EXPECT_TRUE(track.heard.blocks[0].meets(track.heard.blocks[0]));
}

}  // namespace
}  // namespace group_track_test

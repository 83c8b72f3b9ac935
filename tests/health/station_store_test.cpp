#include "plumb/health/detail/station_store.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <limits>

#include "support/simulated_tool.hpp"

// Serves: REQ-131

namespace station_store_test {
namespace {

using namespace plumb;
using plumb_test::direction_at;

StationMean block_at(const Vec3& direction, double value = 0.0) {
  StationMean mean;
  mean.raw[0] = value;
  mean.direction = direction;
  mean.samples = 32.0;
  return mean;
}

void visit(StationStore& store, const Vec3& direction, double value = 0.0) {
  store.end_station();
  store.add_block(block_at(direction, value));
}

TEST(StationStore, AStationEntersOnlyAfterTheNextOneHasEnded) {
  StationStore store;
  visit(store, direction_at(10, 0), 1.0);
  visit(store, direction_at(40, 0), 2.0);
  EXPECT_EQ(store.size(), 0) << "the first has ended, the second is at hand";
  visit(store, direction_at(70, 0), 3.0);
  ASSERT_EQ(store.size(), 1);
  EXPECT_EQ(store.station(0).raw[0], 1.0);
}

TEST(StationStore, AnAlarmTakesBackTheLastStationAndTheOneAtHand) {
  StationStore store;
  for (int k = 0; k < 4; ++k) visit(store, direction_at(20.0 * k, 0), k);
  ASSERT_EQ(store.size(), 2);
  store.drop_last();
  visit(store, direction_at(100, 0), 9.0);
  visit(store, direction_at(120, 0), 10.0);
  visit(store, direction_at(140, 0), 11.0);
  ASSERT_EQ(store.size(), 3);
  EXPECT_EQ(store.station(1).raw[0], 1.0);
  EXPECT_EQ(store.station(2).raw[0], 9.0) << "stations 2 and 3 are gone";
}

// Verifies: REQ-131
TEST(StationStore, EveryFourthIsHeldOut) {
  StationStore store;
  for (int k = 0; k < 14; ++k) visit(store, direction_at(10.0 * k, 0), k);
  ASSERT_EQ(store.size(), 12);
  EXPECT_EQ(store.held_out_count(), 3);
  EXPECT_EQ(store.fit_count(), 9);
  int held = 0;
  for (int k = 0; k < store.size(); ++k) held += StationStore::held_out(k) ? 1 : 0;
  EXPECT_EQ(held, 3);
  EXPECT_TRUE(StationStore::held_out(3));
  EXPECT_FALSE(StationStore::held_out(0));
}

TEST(StationStore, WhenFullTheNearestInDirectionIsReplaced) {
  StationStore store;
  for (int k = 0; k < StationStore::kMax + 2; ++k) visit(store, direction_at(5.0 * k, 0), k);
  ASSERT_EQ(store.size(), StationStore::kMax);
  const std::uint32_t before = store.entries();
  visit(store, direction_at(37, 0), 100.0);  // 2 deg from station 7: nearer than any two others
  visit(store, direction_at(37, 180), 101.0);
  visit(store, direction_at(37, 90), 102.0);
  EXPECT_EQ(store.size(), StationStore::kMax);
  EXPECT_EQ(store.station(7).raw[0], 100.0);
  EXPECT_EQ(store.station(8).raw[0], 8.0);
  EXPECT_GT(store.entries(), before);
}

TEST(StationStore, AFarAttitudeTakesAPlaceInTheCrowdNotThatOfItsNeighbour) {
  StationStore store;
  for (int k = 0; k < 12; ++k) visit(store, direction_at(15.0 * k, 0), k);                         // far apart
  for (int k = 12; k < StationStore::kMax + 2; ++k) visit(store, direction_at(8.0, 25.0 * k), k);  // a bundle
  ASSERT_EQ(store.size(), StationStore::kMax);
  visit(store, direction_at(90, 90), 100.0);
  visit(store, direction_at(90, 180), 101.0);
  visit(store, direction_at(90, 270), 102.0);
  for (int k = 1; k < 12; ++k) EXPECT_EQ(store.station(k).raw[0], k) << "those far apart stay";
}

TEST(StationStore, TheSameAttitudeIsRefinedNotCountedAgain) {
  StationStore store;
  for (int k = 0; k < 10; ++k) visit(store, direction_at(30.0 + 0.1 * k, 20), k);
  EXPECT_EQ(store.size(), 1);
  EXPECT_EQ(store.station(0).raw[0], 7.0) << "the latest that has been entered";
}

TEST(StationStore, BlocksOfOneStationArePooledWhileTheToolIsStill) {
  StationStore store;
  visit(store, direction_at(30, 0), 1.0);
  store.add_block(block_at(direction_at(30.02, 0), 3.0));
  visit(store, direction_at(60, 0), 5.0);
  store.add_block(block_at(direction_at(60.5, 0), 7.0));  // turned by more than the pool bears
  visit(store, direction_at(90, 0));
  visit(store, direction_at(120, 0));
  ASSERT_EQ(store.size(), 2);
  EXPECT_DOUBLE_EQ(store.station(0).raw[0], 2.0);
  EXPECT_DOUBLE_EQ(store.station(0).samples, 64.0);
  EXPECT_EQ(store.station(1).raw[0], 7.0);
  EXPECT_EQ(store.station(1).samples, 32.0);
}

TEST(RawBlock, AChannelThatMissesASampleHasNoMean) {
  RawBlock block;
  block.add({1.0, 2.0, std::numeric_limits<double>::quiet_NaN()}, SensorSet::first(2), 20.0);
  block.add({3.0, 4.0, 5.0}, SensorSet::first(3), 30.0);
  block.add({5.0, 6.0, 5.0}, SensorSet::first(3).without(1), 40.0);
  EXPECT_EQ(block.complete(), SensorSet::of(0));
  const StationMean mean = block.mean(SensorSet::first(3), {0.0, 0.0, 2.0}, 3.0);
  EXPECT_EQ(mean.raw[0], 3.0);
  EXPECT_EQ(mean.raw[1], 0.0);
  EXPECT_EQ(mean.raw[2], 0.0);
  EXPECT_EQ(mean.temperature_degc, 30.0);
  EXPECT_EQ(mean.direction[2], 1.0);
}

/// Whatever is offered: bounded, every entry finite in time, no two attitudes nearer than asked while there is room.
RC_GTEST_PROP(StationStoreLaw, HoldsDifferentAttitudesOnly, ()) {
  plumb_test::Noise noise(*rc::gen::arbitrary<std::uint64_t>());
  const double same_rad = rad_from_deg(*rc::gen::inRange(1, 40));
  StationStore store(same_rad);
  for (int k = 0; k < 60; ++k) {
    visit(store, plumb_test::random_direction(noise), k);
    if (noise.uniform() < 0.1) store.drop_last();
    RC_ASSERT(store.size() <= StationStore::kMax);
    RC_ASSERT(store.fit_count() + store.held_out_count() == store.size());
    if (store.size() == StationStore::kMax) break;
    for (int a = 0; a < store.size(); ++a) {
      for (int b = 0; b < a; ++b) {
        // A station that took its nearest neighbour's place may be nearer to a third one, by less than both.
        RC_ASSERT(angle_between_rad(store.station(a).direction, store.station(b).direction) > 0.0);
      }
    }
  }
}

TEST(RawBlock, OfNoSamplesThereIsNoMeanAndNothingIsReadBeyondTheSensors) {
  const RawBlock none;
  const StationMean mean = none.mean(SensorSet::first(4), {0.0, 0.0, 1.0}, 32.0);
  EXPECT_EQ(mean.raw[0], 0.0);
  EXPECT_TRUE(none.holds());
  RawBlock block;
  std::array<double, kCapacity> raw{};
  raw.fill(2.0);
  block.add(raw, SensorSet(~std::uint32_t{0}), 20.0);
  EXPECT_TRUE(block.holds());
  EXPECT_EQ(block.mean(SensorSet::first(4), {0.0, 0.0, 1.0}, 32.0).raw[3], 2.0);
}

}  // namespace
}  // namespace station_store_test

#include "plumb/calibration/detail/station_list.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace station_list_test {
namespace {

using namespace plumb;

TEST(StationList, OnlyTheFirstCanBeOmitted) {
  std::vector<StationMean> means(60);
  StationList list(means.data(), 60, SensorSet::first(4), 4);
  EXPECT_EQ(list.size(), 45);
  list.leave_out(StationList::kMarked - 1);
  list.leave_out(StationList::kMarked);
  EXPECT_EQ(list[StationList::kMarked - 1].count, 0U);
  EXPECT_EQ(list[StationList::kMarked].count, 1U);
  EXPECT_EQ(list[0].count, 1U);
}

}  // namespace
}  // namespace station_list_test

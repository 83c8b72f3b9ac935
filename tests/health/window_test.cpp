// What is collected until a block is full: which rows join it.
#include "plumb/health/detail/window.hpp"

#include <gtest/gtest.h>

#include "support/simulated_tool.hpp"

namespace window_test {
namespace {

using namespace plumb;

class WindowRows : public testing::Test {
 protected:
  WindowRows() {
    in_force_.array = plumb_test::tetrahedron();
    in_force_.model = plumb_test::identity_model(4);
    in_force_.gravity = {kG0_mps2, 1e-4 * kG0_mps2, GravityModel::value};
    map_ = least_squares(in_force_.array, in_force_.array.all());
    window_.power_on(in_force_.array.triple_count(), 32);
  }
  void add(SensorSet usable) {
    Readings y{};
    for (int i = 0; i < 4; ++i)
      y[static_cast<std::size_t>(i)] = dot(in_force_.array.axis(i), plumb_test::direction_at(20, 10)) * kG0_mps2;
    window_.add(in_force_, map_, {1, 0, 0, 0, 1, 0, 0, 0, 1}, in_force_.array.all(), y, usable, 1.0);
  }
  SensorSet all() const { return in_force_.array.all(); }

  InForce in_force_;
  LeastSquares map_;
  Window window_;
};

// Verifies: REQ-078
TEST_F(WindowRows, TheFirstRowJoinsWhoeverDelivers) {
  EXPECT_EQ(window_.place_of(all(), all()), RowPlace::joins);
  EXPECT_EQ(window_.place_of(SensorSet::of(2), all()), RowPlace::joins);
  EXPECT_EQ(window_.place_of(SensorSet{}, all()), RowPlace::joins);
}

// Verifies: REQ-078
TEST_F(WindowRows, ARowThatLacksASensorIsNotUsed) {
  add(all());
  EXPECT_EQ(window_.place_of(all(), all()), RowPlace::joins);
  EXPECT_EQ(window_.place_of(all().without(1), all()), RowPlace::left_out);
  EXPECT_EQ(window_.place_of(all().without(1), all().without(1)), RowPlace::joins) << "it does not serve";
}

// Negative: REQ-078
TEST_F(WindowRows, ARowThatBringsASensorBeginsTheBlockAnew) {
  add(all().without(3));
  EXPECT_EQ(window_.place_of(all(), all()), RowPlace::begins_block);
  EXPECT_EQ(window_.delivered(), all().without(3));
  window_.begin_block();
  EXPECT_EQ(window_.block.size(), 0);
  EXPECT_TRUE(window_.delivered().empty());
}

// Verifies: REQ-078
TEST_F(WindowRows, TheLatestVectorIsThatOfACompleteRow) {
  add(all());
  const Vec3 complete = window_.latest_mps2;
  EXPECT_NEAR(norm(complete), kG0_mps2, 1e-9);
  add(all().without(0));
  EXPECT_EQ(window_.latest_mps2, complete);
  EXPECT_TRUE(window_.holds());
}

}  // namespace
}  // namespace window_test

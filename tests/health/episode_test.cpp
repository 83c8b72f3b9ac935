/// Records of directions: what counts as another attitude.
#include "plumb/health/detail/episode.hpp"

#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "support/simulated_tool.hpp"

// Serves: REQ-071

namespace episode_test {
namespace {

using namespace plumb;
using plumb_test::Noise;

/// The rule as it reads, every angle worked out, on directions in the precision in which they are kept.
class PlainRecord {
 public:
  bool add(const Vec3& direction, double angle_rad) {
    for (const Vec3& kept : kept_) {
      if (!(angle_between_rad(kept, direction) >= angle_rad)) return false;
    }
    if (kept_.size() == static_cast<std::size_t>(DirectionRecord::kMax)) return false;
    Vec3 kept = scaled(direction, 32766.0 / norm(direction));
    for (double& one : kept) one = std::floor(one + 0.5);
    EXPECT_LT(angle_between_rad(kept, direction), 3e-5);
    kept_.push_back(kept);
    return true;
  }
  int size() const { return static_cast<int>(kept_.size()); }
  Vec3 last() const { return scaled(kept_.back(), 9.8 / norm(kept_.back())); }

 private:
  std::vector<Vec3> kept_;
};

/// `direction` turned by `angle_rad` about some axis across it.
Vec3 turned_from(const Vec3& direction, double angle_rad, Noise& noise) {
  const Vec3 about = cross(direction, plumb_test::random_direction(noise));
  const Vec3 across = scaled(cross(about, direction), 1.0 / norm(about) / norm(direction));
  return plus(scaled(direction, std::cos(angle_rad)), scaled(across, norm(direction) * std::sin(angle_rad)));
}

TEST(DirectionRecord, TakesWhatThePlainRuleTakesFarFromTheAngleAndAtIt) {
  Noise noise(3);
  int taken = 0, refused = 0;
  for (const double angle_rad : {1e-6, 0.01, 0.0872664625997165, 0.5, 1.5, 3.0, 3.2, 7.0}) {
    for (int round = 0; round < 200; ++round) {
      DirectionRecord record;
      PlainRecord plain;
      for (int k = 0; k < 40; ++k) {
        Vec3 direction = scaled(plumb_test::random_direction(noise), 9.8);
        // Every other one at the angle itself, but for a few units of the last place or a few parts in 1e8.
        const double off = (noise.uniform() - 0.5) * (k % 4 == 1 ? 1e-15 : 1e-7);
        if (k % 2 == 1 && plain.size() > 0) direction = turned_from(plain.last(), angle_rad * (1.0 + off), noise);
        const bool expected = plain.add(direction, angle_rad);
        ASSERT_EQ(record.add(direction, angle_rad), expected) << angle_rad << ", direction " << k;
        ASSERT_EQ(record.size(), plain.size());
        (expected ? taken : refused) += 1;
      }
    }
  }
  EXPECT_GT(taken, 1000);
  EXPECT_GT(refused, 1000);
}

TEST(DirectionRecord, AZeroVectorIsNoNewDirection) {
  DirectionRecord record;
  EXPECT_FALSE(record.add({0.0, 0.0, 0.0}, 0.1)) << "sensors that all read zero";
  EXPECT_FALSE(record.add({std::nan(""), 0.0, 9.8}, 0.1));
  EXPECT_TRUE(record.add({0.0, 0.0, 9.8}, 0.1));
  EXPECT_FALSE(record.add({0.0, 0.0, 0.0}, 0.1));
  EXPECT_FALSE(record.add({std::nan(""), 0.0, 9.8}, 0.1));
  EXPECT_TRUE(record.add({9.8, 0.0, 0.0}, 0.1)) << "what was refused keeps nothing else out";
  EXPECT_EQ(record.size(), 2);
}

}  // namespace
}  // namespace episode_test

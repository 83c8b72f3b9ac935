// Exact attitudes as test vectors: the points of proofs/mirror_attitudes.smt2 (z3 decides which triples pass there) and
// the moving fault of proofs/coq/MovingFault.v, put to the compiled code.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "plumb/detection/combination_mae.hpp"
#include "plumb/detection/isolation.hpp"
#include "support/simulated_tool.hpp"

// Serves: REQ-074

namespace mirror_attitudes_test {
namespace {

using namespace plumb;

constexpr double kSigma = 5e-4 * kG0_mps2;
const GravityReference kGravity{kG0_mps2, 1e-4, GravityModel::value};

struct Point {
  const char* name;
  Vec3 g;           ///< unit gravity in the tool frame
  double fault;     ///< on sensor a1, in g
  bool mirror_124;  ///< which triples with a1 pass
  bool mirror_134;
  bool mirror_123;
};

const std::array<Point, 5> kPoints = {{
    {"one mirror", {-3 * std::sqrt(2.0) / 16, -std::sqrt(6.0) / 16, std::sqrt(58.0) / 8}, 0.5, true, false, false},
    {"two mirrors", {-std::sqrt(2.0) / 4, 0.0, std::sqrt(14.0) / 4}, 0.5, true, true, false},
    {"all pass", {2 * std::sqrt(2.0) / 3, 0.0, 1.0 / 3}, -4.0 / 3, true, true, true},
    {"vertical tool", {0.0, 0.0, 1.0}, -4.0 / 3, false, false, true},
    {"clear", {0.0, 0.0, 1.0}, 0.5, false, false, false},
}};

BlockEvidence evidence(const SensorArray& array, const Vec3& unit_g) {
  BlockEvidence block;
  block.usable = array.all();
  block.samples = 32;
  for (int i = 0; i < array.size(); ++i) {
    block.mean_mps2[static_cast<std::size_t>(i)] = kG0_mps2 * dot(array.axis(i), unit_g);
  }
  return block;
}

/// |length of the triple's estimate - G|, by the kernel of the monitor.
double norm_error(const SensorArray& array, const Readings& y, int k) {
  const Triple& t = array.triple(k);
  const double square = squared_length(array.form(k), y[t.sensors[0]], y[t.sensors[1]], y[t.sensors[2]]);
  return std::fabs(std::sqrt(std::fmax(square, 0.0)) - kG0_mps2);
}

TEST(MirrorAttitudes, TriplesPassWhereTheProofSaysAndNowhereElse) {
  const SensorArray array = plumb_test::tetrahedron(kSigma);
  for (const Point& point : kPoints) {
    SCOPED_TRACE(point.name);
    BlockEvidence block = evidence(array, point.g);
    block.mean_mps2[0] += point.fault * kG0_mps2;
    const auto passes = [&](int i, int j, int l) {
      const double error = norm_error(array, block.mean_mps2, array.triple_index(i, j, l));
      // Exact in the proof; here to rounding, and otherwise far off: no value lies between.
      EXPECT_TRUE(error < 1e-12 || error > 0.1) << error;
      return error < 1e-12;
    };
    EXPECT_EQ(passes(0, 1, 3), point.mirror_124);
    EXPECT_EQ(passes(0, 2, 3), point.mirror_134);
    EXPECT_EQ(passes(0, 1, 2), point.mirror_123);
    EXPECT_TRUE(passes(1, 2, 3)) << "the healthy triple";
  }
}

TEST(MirrorAttitudes, ParityDetectsEveryOneAndIsolatesNoSensorThere) {
  const SensorArray array = plumb_test::tetrahedron(kSigma);
  const TestLimits limits = TestLimits::from_rates(4, 1e-5, 1e-6);
  for (const Point& point : kPoints) {
    SCOPED_TRACE(point.name);
    BlockEvidence block = evidence(array, point.g);
    block.mean_mps2[0] += point.fault * kG0_mps2;
    const SetTest all = test_set(array, kGravity, limits, block, array.all());
    EXPECT_GT(all.parity, all.parity_alarm_limit(limits));
    Isolation isolation;
    isolation.pose(array, array.all());
    const IsolationAnswer answer = isolation.vote({array, kGravity, limits, block});
    const int mirrors = int{point.mirror_124} + int{point.mirror_134} + int{point.mirror_123};
    EXPECT_EQ(answer.live, 1 + mirrors);
    EXPECT_EQ(answer.strict, mirrors == 0 ? SensorSet::of(0) : SensorSet{});
  }
}

/// The rule is sound for sensors healthy throughout the episode while enough of them are. Here, exactly as proved,
/// it is not: the fault moves from a1 to a2 between two stations, only a3 and a4 are healthy at both, and the rule
/// names a3. That is why the monitor asks for more stations before it excludes, and says "throughout".
TEST(MirrorAttitudes, AFaultThatMovesDefeatsTheConfirmedGradeAsProved) {
  AxisList axes{};
  const std::array<Vec3, 4> raw = {{{2, 1, 3}, {-2, 2, -1}, {0, 2, 0}, {1, -3, -3}}};
  for (std::size_t i = 0; i < 4; ++i) axes[i] = scaled(raw[i], 1.0 / norm(raw[i]));
  const SensorArray array = plumb_test::make_array(axes, 4, kSigma);
  const TestLimits limits = TestLimits::from_rates(4, 1e-5, 1e-6);
  Isolation isolation;
  isolation.pose(array, array.all());
  ASSERT_EQ(isolation.confirmed_grade(), 1);

  const std::array<Vec3, 2> gravity = {{{-4, -2, 1}, {3, -5, 5}}};
  const std::array<double, 2> fault = {702.0 / 73, 806.0 / 83};  // on a1, then on a2, in the units of `raw`
  IsolationAnswer answer;
  for (std::size_t k = 0; k < 2; ++k) {
    const double length = norm(gravity[k]);
    BlockEvidence block = evidence(array, scaled(gravity[k], 1.0 / length));
    block.mean_mps2[k] += fault[k] / norm(raw[k]) / length * kG0_mps2;
    answer = isolation.vote({array, kGravity, limits, block});
  }
  EXPECT_EQ(answer.live, 1);
  EXPECT_EQ(answer.strict, SensorSet::of(2));
}

}  // namespace
}  // namespace mirror_attitudes_test

#include "plumb/scenario/random.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include <cstring>
#include <vector>

namespace plumb {
namespace scenario {
namespace random_test {
namespace {

// Random123's published known answers for philox4x32-10 (its file kat_vectors).
TEST(Philox, KnownAnswers) {
  using Four = std::array<std::uint32_t, 4>;
  EXPECT_EQ(philox_block({0, 0, 0, 0}, {0, 0}), (Four{0x6627e8d5U, 0xe169c58dU, 0xbc57ac4cU, 0x9b00dbd8U}));
  EXPECT_EQ(philox_block({~0U, ~0U, ~0U, ~0U}, {~0U, ~0U}), (Four{0x408f276dU, 0x41c83b0eU, 0xa20bc7c6U, 0x6d5451fdU}));
  EXPECT_EQ(philox_block({0x243f6a88U, 0x85a308d3U, 0x13198a2eU, 0x03707344U}, {0xa4093822U, 0x299f31d0U}),
            (Four{0xd16cfe09U, 0x94fdcceb, 0x5001e420U, 0x24126ea1U}));
}

// Recorded results depend on these bits: a change here is a change of every seeded figure of the project.
TEST(Stream, FirstValuesArePinned) {
  const Stream stream(2024, Purpose::test, 7);
  EXPECT_EQ(stream.bits(0), 13372784255917620502ULL);
  EXPECT_EQ(stream.bits(1), 12731379112258477977ULL);
  EXPECT_EQ(stream.uniform(0), 0x1.51f5eb549b008p-1);
  EXPECT_EQ(stream.uniform(1), 0x1.3d87e90eb538p-8);
  EXPECT_EQ(stream.normal(0), 0x1.0e5d3e6447145p-2);
  EXPECT_EQ(stream.normal(1), -0x1.095b72305cf4ap-6);
  EXPECT_EQ(stream.normal(2), 0x1.14705492f5826p-3);
  EXPECT_EQ(stream.normal(1ULL << 40U), -0x1.2e54023117044p-1);
  EXPECT_EQ(derive_seed(2024, 3), 12786715237325364395ULL);
}

TEST(Stream, HashOfAMillionNormalsIsPinned) {
  const Stream stream(1, Purpose::test);
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  for (std::uint64_t k = 0; k < 1000000; ++k) {
    const double value = stream.normal(k);
    std::uint64_t bits = 0;
    static_assert(sizeof bits == sizeof value, "the bits of a double");
    std::memcpy(&bits, &value, sizeof bits);
    hash = (hash ^ bits) * 0x100000001b3ULL;
  }
  EXPECT_EQ(hash, 17323264066432585461ULL);
}

TEST(Stream, ValuesDoNotDependOnTheOrderOfDrawing) {
  const Stream stream(99, Purpose::test, 1);
  std::vector<double> forward;
  for (std::uint64_t k = 0; k < 1000; ++k) forward.push_back(stream.normal(k) + stream.uniform(k));
  const Stream again(99, Purpose::test, 1);
  for (std::uint64_t k = 1000; k-- > 0;) {
    EXPECT_EQ(again.uniform(k) + again.normal(k), forward[static_cast<std::size_t>(k)]) << k;
  }
}

TEST(Stream, SeedPurposeAndSubStreamGiveDifferentStreams) {
  const Stream base(5, Purpose::noise, 0);
  EXPECT_NE(base.bits(0), Stream(6, Purpose::noise, 0).bits(0));
  EXPECT_NE(base.bits(0), Stream(5ULL << 32U, Purpose::noise, 0).bits(0));
  EXPECT_NE(base.bits(0), Stream(5, Purpose::vibration, 0).bits(0));
  EXPECT_NE(base.bits(0), Stream(5, Purpose::noise, 1).bits(0));
  EXPECT_NE(base.bits(0), base.bits(1ULL << 32U));
}

/// Correlation of two sequences of length n; |.| < 4/sqrt(n) unless something is wrong.
template <class A, class B>
double correlation(A a, B b, int n) {
  double sa = 0, sb = 0, saa = 0, sbb = 0, sab = 0;
  for (int k = 0; k < n; ++k) {
    const double x = a(static_cast<std::uint64_t>(k));
    const double y = b(static_cast<std::uint64_t>(k));
    sa += x;
    sb += y;
    saa += x * x;
    sbb += y * y;
    sab += x * y;
  }
  return (sab - sa * sb / n) / std::sqrt((saa - sa * sa / n) * (sbb - sb * sb / n));
}

TEST(Stream, NeighboursAreUncorrelated) {
  constexpr int kDraws = 200000;
  const double limit = 4.0 / std::sqrt(double{kDraws});
  const Stream one(3, Purpose::noise, 0);
  const Stream two(3, Purpose::noise, 1);
  const auto normal_of = [](const Stream& s) { return [&s](std::uint64_t k) { return s.normal(k); }; };
  EXPECT_LT(std::abs(correlation(normal_of(one), normal_of(two), kDraws)), limit);
  EXPECT_LT(std::abs(correlation(
                normal_of(one), [&](std::uint64_t k) { return one.normal(k + 1); }, kDraws)),
            limit);
  EXPECT_LT(std::abs(correlation(
                normal_of(one), [&](std::uint64_t k) { return one.uniform(k); }, kDraws)),
            limit);
}

/// Pearson's chi^2 over `cells` equal cells of the unit interval; upper tail probability.
template <class F>
double equal_cells_p(F unit_value, int draws, int cells) {
  std::vector<double> hits(static_cast<std::size_t>(cells), 0.0);
  for (int k = 0; k < draws; ++k) {
    const double u = unit_value(static_cast<std::uint64_t>(k));
    hits[std::min(static_cast<std::size_t>(cells - 1), static_cast<std::size_t>(u * cells))] += 1.0;
  }
  const double expected = double{1} * draws / cells;
  double chi2 = 0.0;
  for (const double h : hits) chi2 += (h - expected) * (h - expected) / expected;
  return boost::math::cdf(boost::math::complement(boost::math::chi_squared(cells - 1), chi2));
}

double normal_cdf(double z) { return 0.5 * std::erfc(-z / std::sqrt(2.0)); }

/// Kolmogorov's sqrt(n) D; 1.63 is its 1 % point.
double kolmogorov(std::vector<double> unit_values) {
  std::sort(unit_values.begin(), unit_values.end());
  const double n = static_cast<double>(unit_values.size());
  double distance = 0.0;
  for (std::size_t k = 0; k < unit_values.size(); ++k) {
    const double step = static_cast<double>(k);
    distance = std::max({distance, unit_values[k] - step / n, (step + 1.0) / n - unit_values[k]});
  }
  return std::sqrt(n) * distance;
}

TEST(Stream, UniformIsUniform) {
  const Stream stream(11, Purpose::test);
  const double p = equal_cells_p([&](std::uint64_t k) { return stream.uniform(k); }, 1000000, 1000);
  EXPECT_GT(p, 1e-3);
  EXPECT_LT(p, 1.0 - 1e-3);
  std::vector<double> values;
  for (std::uint64_t k = 0; k < 100000; ++k) {
    values.push_back(stream.uniform(k));
    EXPECT_GE(values.back(), 0.0);
    EXPECT_LT(values.back(), 1.0);
    EXPECT_EQ(std::ldexp(values.back(), 53), std::floor(std::ldexp(values.back(), 53)));
    EXPECT_GE(stream.uniform(k, -3.0, 3.0), -3.0);
    EXPECT_LE(stream.uniform(k, -3.0, 3.0), 3.0);
  }
  EXPECT_LT(kolmogorov(values), 1.63);
}

TEST(Stream, NormalHasTheRightDistribution) {
  const Stream stream(12, Purpose::test);
  const double p = equal_cells_p([&](std::uint64_t k) { return normal_cdf(stream.normal(k)); }, 2000000, 1000);
  EXPECT_GT(p, 1e-3);
  EXPECT_LT(p, 1.0 - 1e-3);
  std::vector<double> values;
  for (std::uint64_t k = 0; k < 200000; ++k) values.push_back(normal_cdf(stream.normal(k)));
  EXPECT_LT(kolmogorov(values), 1.63);
}

TEST(Stream, NormalHasTheRightMomentsAndTails) {
  const Stream stream(13, Purpose::test);
  constexpr int kDraws = 4000000;
  double sum[5] = {};
  int beyond[5] = {};  // beyond 3, the ziggurat's r, 4, 4.5 and below -r
  for (int k = 0; k < kDraws; ++k) {
    const double z = stream.normal(static_cast<std::uint64_t>(k));
    double power = 1.0;
    for (double& s : sum) {
      s += power;
      power *= z;
    }
    const double limits[4] = {3.0, 3.6541528853610088, 4.0, 4.5};
    for (int i = 0; i < 4; ++i) beyond[i] += std::abs(z) > limits[i] ? 1 : 0;
    beyond[4] += z < -3.6541528853610088 ? 1 : 0;
  }
  const double n = kDraws;
  EXPECT_NEAR(sum[1] / n, 0.0, 4.0 / std::sqrt(n));
  EXPECT_NEAR(sum[2] / n, 1.0, 4.0 * std::sqrt(2.0 / n));
  EXPECT_NEAR(sum[3] / n, 0.0, 4.0 * std::sqrt(15.0 / n));
  EXPECT_NEAR(sum[4] / n, 3.0, 4.0 * std::sqrt(96.0 / n));
  const double limits[5] = {3.0, 3.6541528853610088, 4.0, 4.5, 3.6541528853610088};
  for (int i = 0; i < 5; ++i) {
    const double expected = n * (i == 4 ? 1.0 : 2.0) * normal_cdf(-limits[i]);
    EXPECT_NEAR(beyond[i], expected, 4.0 * std::sqrt(expected)) << "beyond " << limits[i];
  }
}

TEST(Stream, DirectionsCoverTheSphereEvenly) {
  const Stream stream(14, Purpose::attitude);
  // Archimedes: every coordinate of a uniform direction is uniform on [-1, 1].
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double p =
        equal_cells_p([&](std::uint64_t k) { return 0.5 * (stream.direction(k)[axis] + 1.0); }, 200000, 100);
    EXPECT_GT(p, 1e-3) << axis;
  }
  for (std::uint64_t k = 0; k < 1000; ++k) EXPECT_NEAR(norm(stream.direction(k)), 1.0, 4e-16);
}

}  // namespace
}  // namespace random_test
}  // namespace scenario
}  // namespace plumb

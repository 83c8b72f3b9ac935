/// How often the paper's calibration ends, and how well, over simulated tools (docs/theory.md, section 9.4).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "paper/paper_fits.hpp"

namespace paper_convergence_test {
namespace {

using namespace calibration_test;
using plumb::PaperStep;

/// Norm error over the sphere below which a run has found the right answer; a good one has 1e-4, a wrong one percents.
constexpr double kRight_g0 = 5e-4;
/// What the fitted tool says over the sphere in the absence of noise, rms in g0.
struct Over {
  double norm = 0.0;
  double parity = 0.0;  ///< of y - H x, all sensors together
};

Over over_sphere(const FittedScene& s, const PaperFit& fit) {
  constexpr int kPoints = 100;
  const auto nominal = s.sheet.array();
  EXPECT_TRUE(nominal.has_value());
  Noise none(0);
  Over sum;
  for (int k = 0; k < kPoints; ++k) {
    const double z = 1.0 - (2.0 * k + 1.0) / kPoints, a = k * plumb::kPi * (3.0 - std::sqrt(5.0)),
                 r = std::sqrt(1.0 - z * z);
    const Vec3 g = plumb::scaled({r * std::cos(a), r * std::sin(a), z}, plumb::kG0_mps2);
    const plumb::Station station = station_at(s.sheet, s.truth, g, none, 0.0);
    const Vec3 x = plumb::paper_vector(*nominal, fit, station.mean, station.temperature_degc);
    const double error = plumb::g0_from_mps2(plumb::norm(x) - plumb::kG0_mps2);
    sum.norm += error * error / kPoints;
    const plumb::Readings y = fit.model.apply(station.mean, station.temperature_degc, fit.used);
    for (int i = 0; i < s.sheet.size; ++i) {
      if (!fit.used.has(i)) continue;
      const double e = plumb::g0_from_mps2(y[at(i)] - plumb::dot(nominal->axis(i), x));
      sum.parity += e * e / kPoints;
    }
  }
  return {std::sqrt(sum.norm), std::sqrt(sum.parity)};
}

struct Tally {
  int stopped = 0;
  int right = 0;  ///< whether or not the stop rule was met
  int rank_nine = 0;
  int not_finite = 0;
  double iterations = 0.0;  ///< mean of those that stopped
  int most_iterations = 0;
  double norm = 0.0;  ///< rms over the runs
};

Tally tally(int runs, std::uint64_t seed, SensorSet used, const PaperOptions& options) {
  Tally t;
  for (int run = 0; run < runs; ++run) {
    const FittedScene s = scene_of(seed + static_cast<std::uint64_t>(run));
    const PaperFit fit = fitted_by_paper(s, used, options);
    const double norm = over_sphere(s, fit).norm;
    t.norm += norm * norm / runs;
    if (norm <= kRight_g0) ++t.right;
    if (fit.rank == plumb::kPaperRank) ++t.rank_nine;
    if (fit.stop == plumb::StopReason::not_finite) ++t.not_finite;
    if (!fit.converged) continue;
    ++t.stopped;
    t.iterations += fit.iterations;
    t.most_iterations = std::max(t.most_iterations, fit.iterations);
  }
  t.norm = std::sqrt(t.norm);
  if (t.stopped > 0) t.iterations /= t.stopped;
  return t;
}

void tell_all(const std::string& name, const Tally& t, int runs) {
  const double share = 100.0 / runs;
  tell(name + ".stop_rule_met_percent", share * t.stopped);
  tell(name + ".right_answer_percent", share * t.right);
  tell(name + ".not_finite_percent", share * t.not_finite);
  tell(name + ".iterations", t.iterations);
  if (t.right == runs) tell(name + ".norm_g0", t.norm);
}

TEST(PaperConvergence, MinimumNormConvergesOnFourSensors) {
  constexpr int kRuns = 200;
  const Tally t = tally(kRuns, 5000, kAll, {});
  tell_all("n4.minimum_norm", t, kRuns);
  EXPECT_EQ(t.stopped, kRuns);
  EXPECT_EQ(t.right, kRuns);
  EXPECT_EQ(t.rank_nine, kRuns) << "9 of 20";
  EXPECT_LE(t.most_iterations, 6);
  EXPECT_LE(t.iterations, 5.0);
  EXPECT_LE(t.norm, 1e-4);
}

TEST(PaperConvergence, MinimumNormConvergesOnEveryTriple) {
  constexpr int kRuns = 200;
  for (int left_out = 0; left_out < 4; ++left_out) {
    const Tally t = tally(kRuns, 5000, kAll.without(left_out), {});
    tell_all("n3_without_a" + std::to_string(left_out + 1) + ".minimum_norm", t, kRuns);
    EXPECT_EQ(t.stopped, kRuns);
    EXPECT_EQ(t.right, kRuns);
    EXPECT_EQ(t.rank_nine, kRuns) << "9 of 12";
    EXPECT_LE(t.most_iterations, 6);
    EXPECT_LE(t.norm, 1.4e-4);
  }
}

TEST(PaperConvergence, PlainInverseHardlyEverEndsOnFourSensors) {
  constexpr int kRuns = 300;
  PaperOptions options;
  options.step = PaperStep::plain_inverse;
  const Tally t = tally(kRuns, 7000, kAll, options);
  tell_all("n4.plain_inverse", t, kRuns);
  EXPECT_LT(t.stopped, kRuns / 20);
  options.damping = 0.5;
  tell_all("n4.plain_inverse_damped", tally(kRuns, 7000, kAll, options), kRuns);
}

TEST(PaperConvergence, PlainInverseMostlyEndsOnThreeByLuckOfRounding) {
  constexpr int kRuns = 300;
  PaperOptions options;
  options.step = PaperStep::plain_inverse;
  const Tally t = tally(kRuns, 7000, kAll.without(3), options);
  tell_all("n3.plain_inverse", t, kRuns);
  EXPECT_GT(t.stopped, kRuns * 8 / 10);
  EXPECT_GT(t.right, kRuns * 8 / 10);
}

TEST(PaperConvergence, LargerArraysHaveTheSameNineDirections) {
  constexpr int kRuns = 20;
  for (const int n : {5, 6, 8}) {
    double square = 0.0;
    for (int run = 0; run < kRuns; ++run) {
      const FittedScene s =
          scene_of_many(n, 1000U * static_cast<std::uint64_t>(n) + static_cast<std::uint64_t>(run), kSigma);
      const PaperFit fit = fitted_by_paper(s, SensorSet::first(n));
      EXPECT_TRUE(fit.converged);
      EXPECT_EQ(fit.rank, plumb::kPaperRank);
      EXPECT_LE(fit.iterations, 6);
      const double norm = over_sphere(s, fit).norm;
      square += norm * norm / kRuns;
    }
    tell("n" + std::to_string(n) + ".norm_g0", std::sqrt(square));
    EXPECT_LE(std::sqrt(square), 1e-4);
  }
}

TEST(PaperConvergence, ItsNormIsPerfectAndItsParityIsNot) {
  constexpr int kRuns = 50;
  double paper_parity = 0.0, paper_norm = 0.0, forward_parity = 0.0;
  for (int run = 0; run < kRuns; ++run) {
    const FittedScene s = scene_of(9000U + static_cast<std::uint64_t>(run));
    const PaperFit fit = fitted_by_paper(s, kAll);
    const Over over = over_sphere(s, fit);
    paper_parity += over.parity * over.parity / kRuns;
    paper_norm += over.norm * over.norm / kRuns;
    plumb::FitOptions options;
    options.estimate_misfit = false;
    const auto own = plumb::calibrate(s.sheet, standard_gravity(), s.stations.data(), 48, options);
    ASSERT_TRUE(own.has_value());
    const double parity = sphere_error(s.sheet, s.truth, *own).parity_g0;
    forward_parity += parity * parity / kRuns;
  }
  tell("paper.norm_g0", std::sqrt(paper_norm));
  tell("paper.parity_g0", std::sqrt(paper_parity));
  tell("forward.parity_g0", std::sqrt(forward_parity));
  EXPECT_LE(std::sqrt(paper_norm), 1e-4);
  EXPECT_GT(std::sqrt(paper_parity), 5e-3);
  EXPECT_LT(std::sqrt(forward_parity), 1e-4);
}

}  // namespace
}  // namespace paper_convergence_test

/// The steps of three sensors against the general ones, and against the whole matrix.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <vector>

#include "../../src/paper/paper_three.hpp"
#include "paper/paper_fits.hpp"
#include "paper/paper_scene.hpp"

namespace paper_three_test {
namespace {

using namespace calibration_test;

/// The parameters of two fits, in prior units.
double furthest_apart(const plumb::PaperError& error, const plumb::PaperIteration& a, const plumb::PaperIteration& b) {
  double most = 0.0;
  for (int k = 0; k < error.parameters(); ++k) {
    most = std::fmax(most, std::fabs(a.parameter[at(k)] - b.parameter[at(k)]) / error.prior()[at(k)]);
  }
  return most;
}

/// A triple at one temperature takes steps of a form of its own. A bias that drifts by a part in 1e12 between stations
/// changes nothing but that: the general form takes over, and every iteration has to come out the same.
TEST(PaperThree, StepOfATripleIsThatOfTheGeneralForm) {
  const auto own = std::make_unique<PaperTrace>(), general = std::make_unique<PaperTrace>();
  double apart = 0.0;
  for (int run = 0; run < 20; ++run) {
    FittedScene s = scene_of(800U + static_cast<std::uint64_t>(run));
    s.stations.resize(run < 10 ? 48 : 12);
    for (int i = 0; i < 4; ++i) s.sheet.sensor[at(i)].coefficients.bias = {0.02, 0.0, 0.0, 0.0};
    const SensorSet used = kAll.without(run % 4);
    const auto error = plumb::PaperError::make(s.sheet, standard_gravity(), used);
    ASSERT_TRUE(error.has_value());
    for (std::size_t k = 0; k < s.stations.size(); ++k) s.stations[k].temperature_degc = k % 2 == 0 ? 25.0 : 26.0;
    const PaperFit fast = fitted_by_paper(s, used, {}, own.get());
    for (int i = 0; i < 4; ++i) s.sheet.sensor[at(i)].coefficients.bias[1] = 2e-14;
    const PaperFit slow = fitted_by_paper(s, used, {}, general.get());
    EXPECT_EQ(fast.rank, slow.rank);
    EXPECT_TRUE(fast.converged && slow.converged);
    ASSERT_EQ(own->size, general->size);
    for (int k = 0; k < own->size; ++k) {
      const plumb::PaperIteration& a = own->iteration[at(k)];
      const plumb::PaperIteration& b = general->iteration[at(k)];
      apart = std::fmax(apart, furthest_apart(*error, a, b));
      EXPECT_NEAR(a.cost / b.cost, 1.0, 1e-9) << run << ' ' << k;
      EXPECT_NEAR(a.cost / error->cost(a.parameter, s.stations.data(), static_cast<int>(s.stations.size())), 1.0,
                  1e-12);
    }
  }
  tell("triple.apart_prior_sigmas", apart);
  EXPECT_LT(apart, 1e-9);
}

TEST(PaperThree, ATripleOverTemperatureIsThatOfTheGeneralForm) {
  for (const bool bias_drifts : {false, true}) {
    const FittedScene s = scene_over_temperature(bias_drifts);
    const auto error = plumb::PaperError::make(s.sheet, standard_gravity(), SensorSet::first(3));
    ASSERT_TRUE(error.has_value());
    const auto trace = std::make_unique<PaperTrace>();
    const PaperFit fit = fitted_by_paper(s, SensorSet::first(3), {}, trace.get());
    ASSERT_TRUE(fit.converged);
    std::vector<double> values;
    const std::vector<double> step = reference_step(*error, trace->iteration[0].parameter, s, values);
    for (int p = 0; p < error->parameters(); ++p) {
      const double taken = trace->iteration[1].parameter[at(p)] - trace->iteration[0].parameter[at(p)];
      EXPECT_NEAR(taken / error->prior()[at(p)], step[at(p)], 1e-9) << bias_drifts << ' ' << p;
    }
  }
}

TEST(ThreeSensorStep, WithoutAScaleOrAStationThereIsNoCost) {
  PaperScene s;
  for (int i = 0; i < 3; ++i) s.sheet.sensor[at(i)].coefficients.bias = {0.02, 0.0, 0.0, 0.0};
  s.error = *PaperError::make(s.sheet, s.gravity, SensorSet::first(3));
  paper::ThreeSensorStep three;
  ASSERT_TRUE(three.begin(s.problem(24)));
  EXPECT_TRUE(std::isfinite(three.look(s.problem(24), s.error.start())));
  EXPECT_TRUE(three.shows_all(s.problem(24), 1e-6));
  EXPECT_TRUE(std::isnan(three.look(s.problem(0), s.error.start())));
  PaperParameters theta = s.error.start();
  theta[4] = 0.0;
  EXPECT_TRUE(std::isnan(three.look(s.problem(24), theta)));

  // Below the least double next to the datasheet's own.
  s.sheet.sensor[1].coefficients.scale[0] = 1e100;
  const PaperError large = *PaperError::make(s.sheet, s.gravity, SensorSet::first(3));
  theta = large.start();
  theta[4] = 1e-300;
  EXPECT_TRUE(std::isnan(three.look({large, s.stations.data(), 24}, theta)));

  ASSERT_TRUE(three.begin(s.problem(4)));
  EXPECT_TRUE(std::isfinite(three.look(s.problem(4), s.error.start())));
  EXPECT_FALSE(three.shows_all(s.problem(4), 1e-6)) << "four stations";
}

}  // namespace
}  // namespace paper_three_test

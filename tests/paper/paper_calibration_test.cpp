/// The paper's fit: its step, its trace, what it leaves alone and what it refuses.
#include "plumb/paper/paper_calibration.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <type_traits>

#include "calibration/bench.hpp"
#include "paper/paper_fits.hpp"

namespace paper_calibration_test {
namespace {

using namespace calibration_test;
using plumb::PaperStep;

constexpr double kInf = std::numeric_limits<double>::infinity();

static_assert(std::is_trivially_copyable_v<PaperFit>);
static_assert(std::is_trivially_copyable_v<PaperTrace>);
static_assert(std::is_trivially_copyable_v<plumb::PaperError>);

TEST(PaperCalibration, StepIsThePseudoInverseOfRankNine) {
  const auto trace = std::make_unique<PaperTrace>();
  for (const int n : {3, 4, 5}) {
    const FittedScene s = n < 5 ? scene_of(4711) : scene_of_many(5, 4712, kSigma);
    const SensorSet used = SensorSet::first(n);
    const auto error = plumb::PaperError::make(s.sheet, standard_gravity(), used);
    ASSERT_TRUE(error.has_value());
    const PaperFit fit = fitted_by_paper(s, used, {}, trace.get());
    ASSERT_TRUE(fit.converged);
    std::vector<double> values;
    for (int k = 0; k + 1 < trace->size; ++k) {
      const plumb::PaperParameters& now = trace->iteration[at(k)].parameter;
      const plumb::PaperParameters& next = trace->iteration[at(k + 1)].parameter;
      const std::vector<double> step = reference_step(*error, now, s, values);
      for (int p = 0; p < error->parameters(); ++p) {
        EXPECT_NEAR((next[at(p)] - now[at(p)]) / error->prior()[at(p)], step[at(p)], 1e-9) << k << ' ' << p;
      }
    }
    const std::string name = "n" + std::to_string(n) + ".singular_value_";
    const std::size_t count = values.size();
    tell(name + "9_to_1", std::sqrt(values[count - 9] / values[count - 1]));
    tell(name + "10_to_9", std::sqrt(std::fabs(values[count - 10] / values[count - 9])));
    EXPECT_LT(std::sqrt(std::fabs(values[count - 10] / values[count - 9])), n == 5 ? 2e-2 : 1e-2);
    EXPECT_EQ(fit.rank, plumb::kPaperRank);
  }
}

TEST(PaperCalibration, TraceHasTheStartAndEveryIteration) {
  const FittedScene s = scene_of(42);
  const auto trace = std::make_unique<PaperTrace>();
  for (const PaperStep step : {PaperStep::minimum_norm, PaperStep::plain_inverse}) {
    PaperOptions options;
    options.step = step;
    options.max_iterations = 20;
    const PaperFit fit = fitted_by_paper(s, kAll, options, trace.get());
    ASSERT_EQ(trace->size, fit.iterations + 1);
    const auto error = plumb::PaperError::make(s.sheet, standard_gravity(), kAll);
    ASSERT_TRUE(error.has_value());
    EXPECT_EQ(trace->iteration[0].parameter, error->start());
    EXPECT_EQ(trace->iteration[0].change, 0.0);
    for (int k = 0; k < trace->size; ++k) {
      const plumb::PaperIteration& i = trace->iteration[at(k)];
      EXPECT_EQ(i.cost, error->cost(i.parameter, s.stations.data(), 48));
      if (k == 0 || k + 1 == trace->size) continue;
      EXPECT_GE(i.change, options.stop);
    }
    const plumb::PaperIteration& last = trace->iteration[at(fit.iterations)];
    EXPECT_EQ(last.cost, fit.cost);
    EXPECT_EQ(last.parameter[5], fit.model.sensor[1].scale[0]);
    EXPECT_EQ(last.parameter[8], fit.model.misalignment[1]);
    EXPECT_EQ(last.parameter[19], fit.model.misalignment[at(3 * plumb::kCapacity + 2)]);
    if (step == PaperStep::plain_inverse) continue;
    EXPECT_TRUE(fit.converged);
    EXPECT_LT(last.change, options.stop);
    tell("cost_falls_by", trace->iteration[0].cost / last.cost);
    EXPECT_GT(trace->iteration[0].cost, 1e3 * last.cost);
    for (int k = 0; k < trace->size; ++k) tell("cost." + std::to_string(k), trace->iteration[at(k)].cost);
  }
}

TEST(PaperCalibration, WithoutNoiseTheVectorHasTheLengthOfGravity) {
  for (const std::uint32_t bits : {0b1111U, 0b0111U, 0b1011U, 0b1101U, 0b1110U}) {
    const FittedScene s = scene_of(99, 0.0);
    const PaperFit fit = fitted_by_paper(s, SensorSet(bits));
    EXPECT_TRUE(fit.converged);
    const auto nominal = s.sheet.array();
    ASSERT_TRUE(nominal.has_value());
    for (const plumb::Station& station : s.stations) {
      const Vec3 x = plumb::paper_vector(*nominal, fit, station.mean, station.temperature_degc);
      EXPECT_NEAR(plumb::norm(x), plumb::kG0_mps2, 1e-9);
    }
  }
}

TEST(PaperCalibration, TemperatureTermsGoAlong) {
  const PaperFit still = fitted_by_paper(scene_over_temperature(false), kAll);
  EXPECT_TRUE(still.converged);
  EXPECT_LT(still.cost, 1e-16);
  // A drift tells the scale factors apart, but so faintly that rank nine leaves it alone.
  const PaperFit drifting = fitted_by_paper(scene_over_temperature(true), kAll);
  EXPECT_TRUE(drifting.converged);
  const double norm_g0 = plumb::g0_from_mps2(std::sqrt(drifting.cost) / (2.0 * plumb::kG0_mps2));
  tell("norm_left_by_a_drifting_bias_g0", norm_g0);
  EXPECT_LT(norm_g0, 2e-5);
}

TEST(PaperCalibration, OneCircleOfRollsShowsFiveDirections) {
  FittedScene s = scene_of(21);
  s.stations.clear();
  Noise noise(22);
  for (int k = 0; k < 24; ++k) {
    s.stations.push_back(station_at(s.sheet, s.truth, rolled(30.0, 15.0 * k), noise, kSigma));
  }
  EXPECT_EQ(fitted_by_paper(s, kAll).rank, 5);
  EXPECT_FALSE(fitted_by_paper(s, SensorSet::first(3)).sound());
}

TEST(PaperCalibration, DampingSlowsAndFrozenParametersStay) {
  FittedScene s = scene_of(31);
  PaperOptions options;
  options.damping = 0.5;
  const PaperFit slow = fitted_by_paper(s, kAll, options);
  const PaperFit fast = fitted_by_paper(s, kAll);
  EXPECT_TRUE(slow.converged);
  EXPECT_GT(slow.iterations, 15);
  EXPECT_NEAR(slow.cost / fast.cost, 1.0, 1e-4);  // what is left alone depends on the way
  s.sheet.sensor[2].prior = {0.0, 0.0, 0.0};
  const PaperFit frozen = fitted_by_paper(s, kAll);
  EXPECT_TRUE(frozen.converged);
  const PaperFit frozen_triple = fitted_by_paper(s, SensorSet::first(3));
  EXPECT_TRUE(frozen_triple.converged);
  EXPECT_EQ(frozen_triple.model.sensor[2].bias, s.sheet.sensor[2].coefficients.bias);
  EXPECT_EQ(frozen.model.sensor[2].scale, s.sheet.sensor[2].coefficients.scale);
  EXPECT_EQ(frozen.model.sensor[2].bias, s.sheet.sensor[2].coefficients.bias);
  for (int k = 0; k < 4; ++k) EXPECT_EQ(frozen.model.misalignment[at(2 * plumb::kCapacity + k)], 0.0);
  for (int i = 0; i < 4; ++i) s.sheet.sensor[at(i)].prior = {0.0, 0.0, 0.0};
  const PaperFit rigid = fitted_by_paper(s, kAll);
  EXPECT_EQ(rigid.rank, 0);
  EXPECT_FALSE(rigid.converged);
  EXPECT_EQ(rigid.stop, plumb::StopReason::not_finite);
  EXPECT_EQ(rigid.model.sensor[0].bias, s.sheet.sensor[0].coefficients.bias);
}

TEST(PaperCalibration, OtherSensorsAreLeftAloneAndIncompleteStationsSkipped) {
  FittedScene s = scene_of(51);
  const SensorSet used(0b1101U);
  const PaperFit whole = fitted_by_paper(s, used);
  EXPECT_EQ(whole.used, used);
  EXPECT_EQ(whole.model.sensor[1].scale, s.sheet.sensor[1].coefficients.scale);
  for (int k = 0; k < 4; ++k) {
    EXPECT_EQ(whole.model.misalignment[at(plumb::kCapacity + k)], 0.0);
    EXPECT_EQ(whole.model.misalignment[at(k * plumb::kCapacity + 1)], 0.0);
  }
  for (plumb::Station& station : s.stations) {
    station.mean[1] = std::numeric_limits<double>::quiet_NaN();
    station.delivered = station.delivered.without(1);
  }
  plumb::Station partial = s.stations[3];
  partial.delivered = SensorSet(0b0101U);
  plumb::Station empty = s.stations[3];
  empty.count = 0;
  s.stations.push_back(partial);
  s.stations.push_back(empty);
  const PaperFit rest = fitted_by_paper(s, used);
  EXPECT_EQ(rest.cost, whole.cost);
  for (int i = 0; i < 4; ++i) EXPECT_EQ(rest.model.sensor[at(i)].bias, whole.model.sensor[at(i)].bias);
}

TEST(PaperCalibration, AllSensorsAndEveryTripleOfTheArray) {
  const FittedScene s = scene_of(5);
  const auto all = std::make_unique<plumb::PaperCalibration>();
  ASSERT_TRUE(plumb::paper_calibrate_all(s.sheet, standard_gravity(), s.stations.data(),
                                         static_cast<int>(s.stations.size()), {}, *all)
                  .has_value());
  const auto nominal = s.sheet.array();
  ASSERT_TRUE(nominal.has_value());
  ASSERT_EQ(all->triples, 4);
  EXPECT_TRUE(all->all.sound());
  EXPECT_EQ(all->all.used, kAll);
  EXPECT_LT(all->all.cost, 1e-3 * all->all.start_cost);
  for (int k = 0; k < all->triples; ++k) {
    const PaperFit& fit = all->triple[at(k)];
    const PaperFit alone = fitted_by_paper(s, nominal->triple(k).set());
    EXPECT_EQ(fit.used, nominal->triple(k).set());
    EXPECT_TRUE(fit.sound());
    EXPECT_EQ(fit.cost, alone.cost);
    EXPECT_EQ(fit.model.sensor[at(fit.used.lowest())].bias, alone.model.sensor[at(fit.used.lowest())].bias);
  }
}

TEST(PaperCalibration, ATripleInOnePlaneIsLeftUnsound) {
  Noise noise(11);
  FittedScene s;
  plumb::AxisList axes{};
  axes[0] = {1.0, 0.0, 0.0};
  axes[1] = {0.0, 1.0, 0.0};
  axes[2] = {0.6, 0.8, 0.0};
  axes[3] = {0.0, 0.0, 1.0};
  s.sheet = datasheet_of(axes, 4, kSigma);
  s.truth = draw_truth(s.sheet, noise);
  s.stations = random_stations(s.sheet, s.truth, 48, noise, kSigma);
  const auto all = std::make_unique<plumb::PaperCalibration>();
  ASSERT_TRUE(plumb::paper_calibrate_all(s.sheet, standard_gravity(), s.stations.data(),
                                         static_cast<int>(s.stations.size()), {}, *all)
                  .has_value());
  EXPECT_EQ(all->triple[0].used, SensorSet::first(3));
  EXPECT_FALSE(all->triple[0].sound());
  EXPECT_EQ(all->triple[0].stop, plumb::StopReason::none);
  EXPECT_TRUE(all->triple[1].sound());
  const auto few = plumb::paper_calibrate_all(s.sheet, standard_gravity(), s.stations.data(), 8, {}, *all);
  ASSERT_FALSE(few.has_value());
  EXPECT_EQ(few.error().code, plumb::Errc::too_few_stations);
}

TEST(PaperCalibration, RefusesWhatItCannotUse) {
  using plumb::Errc;
  FittedScene s = scene_of(61);
  const auto refused = [&s](const PaperOptions& options, int count, SensorSet used, Errc code, int index) {
    PaperFit fit;
    const auto done = plumb::paper_calibrate(s.sheet, standard_gravity(), s.stations.data(), count, used, options, fit);
    ASSERT_FALSE(done.has_value());
    EXPECT_EQ(done.error().code, code);
    EXPECT_EQ(done.error().index, index);
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  PaperOptions o;
  for (const double bad : {0.0, -1.0, 1.5, nan}) {
    o.damping = bad;
    refused(o, 48, kAll, Errc::out_of_range, 0);
  }
  o = {};
  for (const double bad : {0.0, -1.0, nan}) {
    o.stop = bad;
    refused(o, 48, kAll, Errc::out_of_range, 1);
  }
  o = {};
  for (const int bad : {0, -3, plumb::kMaxPaperIterations + 1}) {
    o.max_iterations = bad;
    refused(o, 48, kAll, Errc::out_of_range, 2);
  }
  refused({}, 48, SensorSet(0b11U), Errc::too_few_sensors, -1);
  refused({}, 8, kAll, Errc::too_few_stations, -1);
  refused({}, -1, kAll, Errc::too_few_stations, -1);
  s.stations[12].mean[3] = nan;
  refused({}, 48, kAll, Errc::not_finite, 12);
  PaperFit fit;
  EXPECT_TRUE(plumb::paper_calibrate(s.sheet, standard_gravity(), s.stations.data(), 48, kAll.without(3), {}, fit));
  EXPECT_FALSE(plumb::paper_calibrate(s.sheet, standard_gravity(), nullptr, 48, kAll, {}, fit));
}

TEST(PaperCalibration, RefusesWhatIsNoNumber) {
  Bench b;
  PaperFit fit;
  PaperOptions endless;
  endless.stop = kInf;
  const auto refused =
      paper_calibrate(b.sheet, b.gravity, b.stations.data(), b.count(), SensorSet::first(4), endless, fit);
  ASSERT_FALSE(refused.has_value());
  EXPECT_EQ(refused.error().code, Errc::out_of_range);
  EXPECT_EQ(refused.error().index, 1);
  GravityReference far = b.gravity;
  far.g_mps2 = kInf;
  EXPECT_EQ(PaperError::make(b.sheet, far, SensorSet::first(4)).error().index, 4);
  auto all = std::make_unique<PaperCalibration>();
  Datasheet large = b.sheet;
  large.size = kPaperCapacity + 1;
  EXPECT_EQ(paper_calibrate_all(large, b.gravity, b.stations.data(), b.count(), {}, *all).error().code,
            Errc::too_many_sensors);
}

/// A trace that is full takes no more, and the fit goes on.
TEST(PaperCalibration, AFullTraceTakesNoMoreAndTheFitGoesOn) {
  Bench b;
  auto trace = std::make_unique<PaperTrace>();
  trace->size = kMaxPaperIterations + 1;
  PaperFit fit;
  EXPECT_TRUE(
      paper_calibrate(b.sheet, b.gravity, b.stations.data(), b.count(), SensorSet::first(4), {}, fit, trace.get())
          .has_value());
}

}  // namespace
}  // namespace paper_calibration_test

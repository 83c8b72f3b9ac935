// What stands at the edge of what the functions of this room take: nothing, too much, numbers that are none.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <string>

#include "calibration/edges_support.hpp"

namespace calibration_edges_test {
namespace {

using namespace calibration_test;

constexpr double kSigma = kEdgeSigma;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();

TEST(CalibrationEdge, FrozenScalesHaveNoCommonOne) {
  EXPECT_EQ((CommonScale{0.1, 0.0, 0.0}.sigmas()), 0.0);
  EXPECT_EQ((CommonScale{0.1, 0.0, 0.05}.sigmas()), 2.0);
}

/// Every number that a datasheet has, wrong on its own: refused, and the sensor is said where there is one.
// Negative: REQ-034
TEST(CalibrationEdge, ADatasheetWithOneWrongNumberIsRefused) {
  const std::vector<std::function<void(Bench&)>> wrong = {
      [](Bench& b) { b.gravity.g_mps2 = 0.0; },
      [](Bench& b) { b.gravity.g_mps2 = -9.8; },
      [](Bench& b) { b.gravity.g_mps2 = kInf; },
      [](Bench& b) { b.sheet.sensor[1].prior.bias_mps2 = -1.0; },
      [](Bench& b) { b.sheet.sensor[1].prior.axis_rad = -1.0; },
      [](Bench& b) { b.sheet.sensor[1].prior.axis_rad = kNan; },
      [](Bench& b) { b.sheet.sensor[1].prior.bias_mps2 = kInf; },
      [](Bench& b) { b.sheet.sensor[1].row.sigma_mps2 = kInf; },
      [](Bench& b) { b.sheet.sensor[1].row.sigma_mps2 = 0.0; },
      [](Bench& b) {
        b.sheet.sensor[1].row.axis = {0.0, 0.0, 1.1};
      },
      [](Bench& b) { b.sheet.sensor[1].row.id = {}; },
      [](Bench& b) { b.sheet.sensor[1].coefficients.scale[0] = kInf; },
      [](Bench& b) { b.sheet.size = 2; },
      [](Bench& b) { b.sheet.size = kCapacity + 1; },
  };
  for (std::size_t k = 0; k < wrong.size(); ++k) {
    Bench b;
    wrong[k](b);
    EXPECT_NE(b.refusal(), Errc::ok) << k;
  }
}

/// A name that fills its room to the last character is cut there, and no fault.
TEST(CalibrationEdge, ANameWithoutAnEndIsCut) {
  Bench b;
  b.sheet.sensor[2].row.id.fill('x');
  const auto c = b.run();
  ASSERT_TRUE(c.has_value());
  EXPECT_STREQ(c->array.row(2).id.data(), std::string(15, 'x').c_str());
}

TEST(CalibrationEdge, AFitThatNeverSettlesEndsAllTheSame) {
  Bench b(1, 12);
  b.options.stop_relative = -1.0;
  b.options.max_iterations = std::numeric_limits<int>::max();
  EXPECT_EQ(b.refusal(), Errc::diverged);
}

TEST(CalibrationEdge, WithoutFreedomNothingIsJudgedByTheResiduals) {
  Bench b(1, 3);
  b.options.require_full_rank = false;
  b.options.estimate_misfit = false;
  const auto c = b.run();
  EXPECT_LE(b.report.degrees_of_freedom, 0);
  EXPECT_EQ(b.report.p_value, 1.0);
  EXPECT_TRUE(c.has_value()) << describe(c.error().code);
}

TEST(CalibrationEdge, ABoundOfZeroLeavesNoRoom) {
  Bench scale;
  scale.options.max_scale_change = 0.0;
  EXPECT_EQ(scale.refusal(), Errc::implausible);
  Bench axis;
  axis.options.max_axis_change_rad = 0.0;
  EXPECT_EQ(axis.refusal(), Errc::implausible);
}

TEST(CalibrationEdge, AScatterBeyondAllBoundsIsNoFigure) {
  Bench b;
  for (Station& s : b.stations) {
    s.count = 4;
    s.scatter.fill(1e200);
  }
  b.run();
  for (const double noise : b.report.sample_noise_mps2) EXPECT_EQ(noise, 0.0);
}

/// The first sensor is the noisiest: those after it do not take its place.
TEST(CalibrationEdge, TheNoisiestSampleNamesTheSensor) {
  Bench b;
  Noise loud(3);
  for (Station& s : b.stations) {
    s.count = 16;
    const double per_mps2 = 3.0 / kG0_mps2;
    s.scatter.fill(8.0 * kSigma * per_mps2);
    s.scatter[0] = 20.0 * kSigma * per_mps2;
    for (int i = 0; i < 4; ++i) s.mean[at(i)] += 10.0 * kSigma * per_mps2 * loud.normal();
  }
  const auto c = b.run();
  ASSERT_FALSE(c.has_value());
  EXPECT_EQ(c.error().code, Errc::poor_fit);
  EXPECT_EQ(c.error().index, 0);
}

/// A station without samples beside a sensor that is loud: it is passed over.
TEST(CalibrationEdge, AStationWithoutSamplesCountsNowhere) {
  Bench b;
  Noise loud(3);
  for (Station& s : b.stations) s.mean[1] += 40.0 * kSigma * 3.0 / kG0_mps2 * loud.normal();
  b.options.max_sensor_excess = 1e9;
  b.options.max_norm_rms_mps2 = 1.0;
  b.options.reject_outliers = false;
  b.run();
  const FitReport without = b.report;
  ASSERT_EQ(without.loud_sensor, 1);
  b.stations.push_back(b.stations[0]);
  b.stations.back().count = 0;
  b.stations.back().roll_group = 4;
  b.run();
  EXPECT_EQ(b.report.stations, without.stations);
  EXPECT_EQ(b.report.loud_sensor, 1);
  EXPECT_NEAR(b.report.loud_misfit_mps2, without.loud_misfit_mps2, 1e-9);
  EXPECT_EQ(b.report.roll_groups, 0);
}

/// Channels swapped, and a station that one of them does not deliver: that one tells nothing of twins.
TEST(CalibrationEdge, TwinsAreLookedForWhereBothDeliver) {
  Bench b;
  for (Station& s : b.stations) s.mean[1] = s.mean[0];
  b.stations[3].count = 0;
  b.stations[4].delivered = SensorSet::first(4).without(3);
  EXPECT_EQ(b.refusal(), Errc::implausible);
}

struct Held {
  explicit Held(int count = 24) {
    for (int i = 0; i < sheet.size; ++i) sheet.sensor[at(i)].prior.axis_rad = 0.0;
    Noise noise(5);
    const Truth truth = draw_truth(sheet, noise, 0.2, 0.0);
    options.require_full_rank = false;
    options.estimate_misfit = false;
    stations = random_stations(sheet, truth, count, noise, kSigma);
  }
  Error run() {
    Calibrator fit(sheet, gravity, options);
    const StationList list(stations.data(), static_cast<int>(stations.size()));
    for (int k = 0; k < 200 && !fit.done(); ++k) fit.iterate_held(list);
    fit.iterate_held(list);  // after its end: nothing
    return fit.finish_held(list, out);
  }
  Datasheet sheet = paper_tool(kSigma);
  GravityReference gravity = standard_gravity();
  FitOptions options;
  std::vector<Station> stations;
  HeldFit out;
};

TEST(HeldFitEdge, TakesAsManyStationsAsItCountsAndNoMore) {
  Held fits;
  EXPECT_EQ(fits.run().code, Errc::ok);
  Held many(200);
  EXPECT_EQ(many.run().code, Errc::diverged);
}

TEST(StationListEdge, OnlyTheFirstCanBeLeftOut) {
  std::vector<StationMean> means(60);
  StationList list(means.data(), 60, SensorSet::first(4), 4);
  EXPECT_EQ(list.size(), 45);
  list.leave_out(StationList::kMarked - 1);
  list.leave_out(StationList::kMarked);
  EXPECT_EQ(list[StationList::kMarked - 1].count, 0U);
  EXPECT_EQ(list[StationList::kMarked].count, 1U);
  EXPECT_EQ(list[0].count, 1U);
}

TEST(HeldFitEdge, NumbersThatAreNoneAreRefused) {
  Held reading;
  reading.stations[5].mean[1] = kNan;
  EXPECT_EQ(reading.run().code, Errc::diverged);
  Held scale;
  scale.sheet.sensor[2].coefficients.scale[0] = 0.0;
  EXPECT_EQ(scale.run().code, Errc::not_finite);
  Held endless;
  endless.options.stop_relative = -1.0;
  endless.options.max_iterations = 20;
  EXPECT_EQ(endless.run().code, Errc::diverged);
  Held few(2);
  EXPECT_EQ(few.run().code, Errc::too_few_stations);
}

TEST(HeldFitEdge, SpecificForceHasTheOtherSign) {
  Held gravity, force;
  force.sheet.reads = Reads::specific_force;
  for (Station& s : force.stations) {
    for (int i = 0; i < 4; ++i) {
      // V = SF(T) (f + B), and f = -g.
      const SensorModel model = force.sheet.model();
      const double offset = model.bias_at(i, s.temperature_degc) * model.scale_at(i, s.temperature_degc);
      s.mean[at(i)] = 2.0 * offset - s.mean[at(i)];
    }
  }
  ASSERT_EQ(gravity.run().code, Errc::ok);
  ASSERT_EQ(force.run().code, Errc::ok);
  for (int i = 0; i < 4; ++i) {
    EXPECT_NEAR(force.out.bias_mps2[at(i)], -gravity.out.bias_mps2[at(i)], 1e-9) << i;
    EXPECT_NEAR(force.out.length[at(i)], gravity.out.length[at(i)], 1e-9) << i;
  }
}

/// Held biases and scales with stations that stray. As few as there are parameters: nothing is left to judge by.
TEST(HeldFitEdge, StraysRefuseItAndTooFewAreNotJudged) {
  Held strays;
  strays.stations[3].mean[1] += 0.2;
  strays.stations[9].mean[2] -= 0.2;
  EXPECT_NE(strays.run().code, Errc::ok) << "without the misfit there is no noise that explains them";
  Held few(4);
  few.run();
  EXPECT_LE(few.out.degrees_of_freedom, 0);
  EXPECT_EQ(few.out.p_value, 1.0);
}

}  // namespace
}  // namespace calibration_edges_test

/// What is named as unobservable is what the stations cannot see: moved along it, no residual changes.
#include "plumb/calibration/null_directions.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>

#include "calibration/bench.hpp"

namespace null_directions_test {
namespace {

using namespace calibration_test;
using plumb::ParameterKind;

constexpr double kSigma = 2e-4 * plumb::kG0_mps2;

struct Scene {
  plumb::Datasheet sheet;
  std::vector<plumb::Station> stations;
  std::unique_ptr<plumb::Calibration> fit;
  std::unique_ptr<plumb::NullCombinations> found = std::make_unique<plumb::NullCombinations>();
  int count = 0;
};

/// Noise-free stations, so that what is not seen is exactly not seen.
Scene scene_of(const plumb::Datasheet& sheet, const std::vector<Vec3>& directions) {
  Noise noise(17);
  Scene s;
  s.sheet = sheet;
  const Truth truth = draw_truth(s.sheet, noise, 0.5, 0.01);
  for (const Vec3& g : directions) s.stations.push_back(station_at(s.sheet, truth, g, noise, 0.0));
  plumb::FitOptions lenient;
  lenient.require_full_rank = false;
  const auto fit =
      plumb::calibrate(s.sheet, standard_gravity(), s.stations.data(), static_cast<int>(s.stations.size()), lenient);
  EXPECT_TRUE(fit.has_value());
  if (!fit) return s;
  s.fit = std::make_unique<plumb::Calibration>(*fit);
  s.count = plumb::null_combinations(s.sheet, s.fit->report, *s.found);
  EXPECT_EQ(s.count, std::min(s.fit->report.null_directions, plumb::kMaxNullDirections));
  return s;
}

std::vector<Vec3> circles(const std::vector<double>& inclinations, int rolls) {
  std::vector<Vec3> out;
  for (const double i : inclinations) {
    for (int k = 0; k < rolls; ++k) out.push_back(rolled(i, 360.0 * k / rolls));
  }
  return out;
}

/// The calibration with its parameters moved by `step` prior sigmas along a direction in prior units.
plumb::Calibration moved(const Scene& s, const plumb::NullDirection& direction, double step) {
  plumb::Calibration out = *s.fit;
  Truth t = fitted(s.sheet, *s.fit);
  std::array<plumb::SensorRow, plumb::kCapacity> rows{};
  for (int i = 0; i < s.sheet.size; ++i) {
    const auto& sensor = s.sheet.sensor[at(i)];
    const double* v = &direction.component[at(4 * i)];
    const Vec3 h = sensor.row.axis, x = {v[0], v[1], v[2]};
    const double along = plumb::dot(h, x);
    const Vec3 across = plumb::minus(x, plumb::scaled(h, along));
    const Vec3 w = plumb::plus(t.w[at(i)], plumb::plus(plumb::scaled(h, step * along * sensor.prior.scale),
                                                       plumb::scaled(across, step * sensor.prior.axis_rad)));
    const double length = plumb::norm(w), b = t.b[at(i)] + step * v[3] * sensor.prior.bias_mps2;
    rows[at(i)] = sensor.row;
    rows[at(i)].axis = plumb::scaled(w, 1.0 / length);
    rows[at(i)].sigma_mps2 /= length;
    out.model.sensor[at(i)].scale[0] = sensor.coefficients.scale[0] * length;
    out.model.sensor[at(i)].bias[0] = (sensor.coefficients.bias[0] + b) / length;
  }
  const auto array = plumb::SensorArray::make(rows.data(), s.sheet.size);
  EXPECT_TRUE(array.has_value());
  if (array) out.array = *array;
  return out;
}

/// rms change of the residuals per prior sigma moved.
double visibility(const Scene& s, const plumb::NullDirection& direction) {
  constexpr double kStep = 1e-3;
  const plumb::Calibration there = moved(s, direction, kStep), here = moved(s, direction, 0.0);
  double sum = 0.0;
  for (const plumb::Station& station : s.stations) {
    const auto a = plumb::station_residual(there, standard_gravity(), station);
    const auto b = plumb::station_residual(here, standard_gravity(), station);
    for (int i = 0; i < s.sheet.size; ++i) sum += std::pow(a.residual_mps2[at(i)] - b.residual_mps2[at(i)], 2);
  }
  return std::sqrt(sum / static_cast<double>(s.stations.size())) / kStep;
}

/// Any one value, for comparison: the stations see it.
double visibility_of_one(const Scene& s, int parameter) {
  plumb::NullDirection one;
  one.component[at(parameter)] = 1.0;
  return visibility(s, one);
}

void expect_unseen(const Scene& s) {
  double seen = 0.0;
  for (int k = 0; k < 4 * s.sheet.size; ++k) seen = std::fmax(seen, visibility_of_one(s, k));
  ASSERT_GT(seen, 0.01);
  for (int k = 0; k < s.count; ++k) {
    const plumb::NullCombination& c = (*s.found)[at(k)];
    EXPECT_LE(visibility(s, c.direction), 5e-3 * seen) << "combination " << k;
    ASSERT_GE(c.terms, 1);
    // The terms named are what it is made of.
    double named = 0.0;
    for (int t = 0; t < c.terms; ++t) named += c.term[at(t)].amount * c.term[at(t)].amount;
    EXPECT_GE(named, 0.9) << "combination " << k;
  }
}

bool has(const plumb::NullCombination& c, ParameterKind kind, int sensor) {
  for (int t = 0; t < c.terms; ++t) {
    if (c.term[at(t)].kind == kind && c.term[at(t)].sensor == sensor) return true;
  }
  return false;
}

int sensors_in(const plumb::NullCombination& c) {
  plumb::SensorSet set;
  for (int t = 0; t < c.terms; ++t) set = set.with(c.term[at(t)].sensor);
  return set.size();
}

TEST(NullCombinations, OfAFullSetAreNone) {
  Noise noise(3);
  std::vector<Vec3> directions;
  for (int k = 0; k < 24; ++k) directions.push_back(plumb::scaled(noise.direction(), plumb::kG0_mps2));
  EXPECT_EQ(scene_of(paper_tool(kSigma), directions).count, 0);
}

TEST(NullCombinations, OfOneCircleOfRollsAreABiasAgainstTheAxialPartOfEachSensor) {
  const Scene s = scene_of(paper_tool(kSigma), circles({30.0}, 24));
  ASSERT_EQ(s.count, 5);
  expect_unseen(s);
  // z is constant on the circle: for every sensor its bias trades against the z part of its row.
  int of_one_sensor = 0;
  for (int k = 0; k < s.count; ++k) {
    const plumb::NullCombination& c = (*s.found)[at(k)];
    if (sensors_in(c) != 1) continue;
    ++of_one_sensor;
    EXPECT_TRUE(has(c, ParameterKind::bias, c.term[0].sensor));
  }
  EXPECT_EQ(of_one_sensor, 4);
  // The axial sensor: nothing but bias against scale.
  bool axial = false;
  for (int k = 0; k < s.count; ++k) {
    const plumb::NullCombination& c = (*s.found)[at(k)];
    if (sensors_in(c) != 1 || c.term[0].sensor != 3) continue;
    axial = true;
    EXPECT_EQ(c.terms, 2);
    EXPECT_TRUE(has(c, ParameterKind::scale, 3));
  }
  EXPECT_TRUE(axial);
}

TEST(NullCombinations, OfTwoLevelsIsOne) {
  const Scene s = scene_of(paper_tool(kSigma), circles({30.0, 60.0}, 12));
  ASSERT_EQ(s.count, 1);
  expect_unseen(s);
}

TEST(NullCombinations, OfASingleStationNameOneSensorEachWhereOneIsEnough) {
  const Scene s = scene_of(paper_tool(kSigma), std::vector<Vec3>(12, rolled(0.0, 0.0)));
  ASSERT_EQ(s.count, 11);
  expect_unseen(s);
  int tilts = 0;
  for (int k = 0; k < s.count; ++k) {
    const plumb::NullCombination& c = (*s.found)[at(k)];
    for (int t = 0; t < c.terms; ++t) {
      if (c.term[at(t)].kind != ParameterKind::axis) continue;
      EXPECT_NEAR(plumb::norm(c.term[at(t)].turn), 1.0, 1e-9);
      EXPECT_NEAR(plumb::dot(c.term[at(t)].turn, s.sheet.sensor[at(c.term[at(t)].sensor)].row.axis), 0.0, 1e-9);
      if (c.terms == 1) ++tilts;
    }
  }
  EXPECT_GE(tilts, 4) << "an axis that turns out of sight of a vertical vector, for each sensor";
}

TEST(NullCombinations, OfTheStationsInOnePlane) {
  std::vector<Vec3> directions;
  for (int k = 0; k < 24; ++k) directions.push_back(rolled(90.0, 15.0 * k));
  const Scene s = scene_of(paper_tool(kSigma), directions);
  ASSERT_GT(s.count, 0);
  expect_unseen(s);
  // The axial sensor measures next to nothing there but its own tilt and bias.
  EXPECT_TRUE(has((*s.found)[0], ParameterKind::scale, 3));
  EXPECT_EQ((*s.found)[0].terms, 1);
}

TEST(NullCombinations, OfATriadOnTheConeOfItsAxes) {
  plumb::AxisList axes{};
  const int n = plumb::orthogonal_triad(axes);
  const Scene s = scene_of(datasheet_of(axes, n, kSigma), circles({54.7356}, 24));
  ASSERT_EQ(s.count, s.fit->report.null_directions);
  EXPECT_EQ(s.fit->report.rank, 5);
  expect_unseen(s);
}

TEST(NullCombinations, OfManySensorsStayWithOneSensor) {
  if (plumb::kCapacity < 8) GTEST_SKIP() << "eight sensors";
  plumb::AxisList axes{};
  const int n = plumb::cone_with_axis(axes, 8);
  const Scene s = scene_of(datasheet_of(axes, n, kSigma), circles({30.0}, 24));
  ASSERT_EQ(s.count, 9);
  expect_unseen(s);
  int of_one_sensor = 0;
  for (int k = 0; k < s.count; ++k) of_one_sensor += sensors_in((*s.found)[at(k)]) == 1 ? 1 : 0;
  EXPECT_EQ(of_one_sensor, 8);
}

TEST(NullCombinations, OfAReportOfAnythingAreBounded) {
  auto out = std::make_unique<plumb::NullCombinations>();
  const plumb::Datasheet d = paper_tool(kSigma);
  plumb::FitReport report;
  report.null_directions = 1000;
  report.gauge = 3;
  EXPECT_EQ(plumb::null_combinations(d, report, *out), 0) << "directions of no length";
  for (auto& direction : report.null_direction) direction.component.fill(std::nan(""));
  EXPECT_LE(plumb::null_combinations(d, report, *out), plumb::kMaxNullDirections);
  plumb::Datasheet none;
  EXPECT_EQ(plumb::null_combinations(none, report, *out), 0);
}

/// What a report by hand says is open: with and without the rotations that nobody sees, frozen axes among them.
TEST(NullCombinations, AReportByHandIsReadAsItStands) {
  Datasheet sheet = paper_tool(kSigma);
  auto found = std::make_unique<NullCombinations>();
  auto report = std::make_unique<FitReport>();
  report->null_directions = 2;
  report->null_direction[0].component[3] = 1.0;  // the bias of the first sensor
  report->null_direction[1].component[7] = std::sqrt(0.5);
  report->null_direction[1].component[11] = std::sqrt(0.5);
  for (const int gauge : {0, 1, 3}) {
    report->gauge = gauge;
    ASSERT_EQ(null_combinations(sheet, *report, *found), 2) << gauge;
    EXPECT_EQ((*found)[0].terms, 1) << gauge;
    EXPECT_EQ((*found)[0].term[0].kind, ParameterKind::bias);
    EXPECT_EQ((*found)[0].term[0].sensor, 0);
    EXPECT_FALSE((*found)[1].rotates_all);
  }
  sheet.sensor[2].prior.axis_rad = 0.0;
  EXPECT_EQ(null_combinations(sheet, *report, *found), 2);
  sheet.size = kCapacity + 1;
  EXPECT_EQ(null_combinations(sheet, *report, *found), 0);
}

/// All axes turned alike, and no rotation of which it is said that nobody sees it: told as one rotation.
TEST(NullCombinations, ACommonRotationIsReportedAsOne) {
  const Datasheet sheet = paper_tool(kSigma);
  auto found = std::make_unique<NullCombinations>();
  auto report = std::make_unique<FitReport>();
  report->null_directions = 1;
  double square = 0.0;
  auto& component = report->null_direction[0].component;
  for (int i = 0; i < 4; ++i) {
    const Vec3 d = cross(sheet.sensor[at(i)].row.axis, {0.0, 0.0, 1.0});
    for (int p = 0; p < 3; ++p) component[at(4 * i + p)] = d[at(p)] / sheet.sensor[at(i)].prior.axis_rad;
    square += dot(d, d) / (sheet.sensor[at(i)].prior.axis_rad * sheet.sensor[at(i)].prior.axis_rad);
  }
  for (double& c : component) c /= std::sqrt(square);
  ASSERT_EQ(null_combinations(sheet, *report, *found), 1);
  EXPECT_TRUE((*found)[0].rotates_all);
  EXPECT_NEAR(std::fabs((*found)[0].rotation[2]), 1.0, 1e-6);
}

}  // namespace
}  // namespace null_directions_test

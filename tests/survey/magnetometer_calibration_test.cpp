// Magnetometers calibrated by the fit that is made for gravity: the field too has one length and any direction. What
// that leaves open, a common rotation of all axes, is then told by the dip.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <iostream>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "plumb/array/named.hpp"
#include "plumb/calibration/null_directions.hpp"
#include "plumb/survey/joint_alignment.hpp"
#include "turned_tool.hpp"

namespace magnetometer_calibration_test {
namespace {

using namespace plumb;
using namespace plumb::survey;
using namespace simulated_survey;
using namespace turned_tool;

constexpr double kField_nt = 50000.0;  // that of `World`
constexpr double kNoise_nt = 20.0;
constexpr double kMps2PerNt = kG0_mps2 / kField_nt;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// A reading in nT is a force in units in which the field is g0 long: all that the fit has to be told.
Datasheet magnetometers(const std::vector<Vec3>& axes) {
  Datasheet out;
  out.size = static_cast<int>(axes.size());
  for (int i = 0; i < out.size; ++i) {
    DatasheetSensor& s = out.sensor[at(i)];
    s.row.id = make_id(("M" + std::to_string(i + 1)).c_str());
    s.row.axis = axes[at(i)];
    s.row.sigma_mps2 = kNoise_nt * kMps2PerNt;
    s.coefficients.scale = {1.0 / kMps2PerNt, 0.0, 0.0, 0.0};
    s.prior = {0.05 * kG0_mps2, 0.03, 0.035};
  }
  return out;
}

std::vector<Vec3> triad() { return {Vec3{1.0, 0.0, 0.0}, Vec3{0.0, 1.0, 0.0}, Vec3{0.0, 0.0, 1.0}}; }
std::vector<Vec3> four_skewed() {
  AxisList axes{};
  const int n = paper_tetrahedron(axes);
  return {axes.begin(), axes.begin() + n};
}

using Random = std::mt19937_64;
double within(Random& random, double most) { return std::uniform_real_distribution<double>(-most, most)(random); }
Vec3 direction(Random& random) {
  std::normal_distribution<double> normal;
  const Vec3 v{normal(random), normal(random), normal(random)};
  return scaled(v, 1.0 / norm(v));
}

/// reading = W B + hard iron: scale errors, cross-axis errors and soft iron are all in W.
struct Magnets {
  std::vector<Vec3> w;
  std::vector<double> hard_nt;

  Magnets(const std::vector<Vec3>& axes, Random& random) {
    Mat3 soft{1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};  // symmetric
    for (std::size_t r = 0; r < 3; ++r) {
      for (std::size_t c = 0; c <= r; ++c) {
        const double part = within(random, 0.03);
        soft[3 * r + c] += part;
        if (c < r) soft[3 * c + r] += part;
      }
    }
    for (const Vec3& axis : axes) {
      const Vec3 tilted = times(rotation_of(scaled(direction(random), rad_from_deg(1.0))), axis);
      w.push_back(scaled(times(soft, tilted), 1.0 + within(random, 0.02)));
      hard_nt.push_back(within(random, 0.05) * kField_nt);
    }
  }
  Station station(const Vec3& field_nt, Random& random) const {
    std::normal_distribution<double> normal;
    Station out;
    for (std::size_t i = 0; i < w.size(); ++i)
      out.mean[i] = dot(w[i], field_nt) + hard_nt[i] + kNoise_nt * normal(random);
    out.delivered = SensorSet::first(static_cast<int>(w.size()));
    out.temperature_degc = 25.0;
    out.count = 1;
    return out;
  }
};

std::vector<Station> stations_at(const Magnets& truth, const std::vector<Vec3>& directions, Random& random) {
  std::vector<Station> out;
  for (const Vec3& d : directions) out.push_back(truth.station(scaled(d, kField_nt), random));
  return out;
}

std::vector<Vec3> all_over(int count, Random& random) {
  std::vector<Vec3> out;
  for (int k = 0; k < count; ++k) out.push_back(direction(random));
  return out;
}

GravityReference field_as_gravity() { return {kG0_mps2, 0.0, GravityModel::value}; }

struct Fitted {
  Vec3 w{};
  double hard_nt = 0.0;
  Vec3 sigma_w{};
  double sigma_nt = 0.0;
};

Fitted fitted(const Datasheet& sheet, const Calibration& c, int i) {
  const SensorCoefficients& now = c.model.sensor[at(i)];
  const double length = now.scale[0] / sheet.sensor[at(i)].coefficients.scale[0];
  const double* sigma = &c.report.sigma[at(4 * i)];
  return {scaled(c.array.axis(i), length),
          now.bias[0] * length / kMps2PerNt,
          {sigma[0], sigma[1], sigma[2]},
          sigma[3] / kMps2PerNt};
}

double weighted(const Vec3& a, const Vec3& sigma) {
  return std::fabs(a[0]) * sigma[0] + std::fabs(a[1]) * sigma[1] + std::fabs(a[2]) * sigma[2];
}

/// The field in the frame of the calibrated axes, by least squares [tesla]; its covariance from noise alone.
struct Solved {
  Vec3 tesla{};
  Eigen::Matrix3d covariance;
};
Solved field_of(const Calibration& c, const Station& station) {
  const Readings readings = c.model.apply(station.mean, station.temperature_degc, station.delivered);
  Eigen::Matrix3d m = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (int i = 0; i < c.array.size(); ++i) {
    const Vec3& h = c.array.axis(i);
    const Eigen::Vector3d row(h[0], h[1], h[2]);
    m += row * row.transpose();
    right += row * readings[at(i)];
  }
  const Eigen::Vector3d x = m.ldlt().solve(right) / kMps2PerNt * 1e-9;
  return {{x[0], x[1], x[2]}, m.inverse() * std::pow(kNoise_nt * 1e-9, 2)};
}

void expect_recovered(const std::vector<Vec3>& axes, int rank) {
  const Datasheet sheet = magnetometers(axes);
  double squares = 0.0, held_out = 0.0;
  int count = 0, held = 0;
  for (unsigned seed = 1; seed <= 100; ++seed) {
    Random random(seed);
    const Magnets truth(axes, random);
    const std::vector<Station> stations = stations_at(truth, all_over(48, random), random);
    const auto fit = calibrate(sheet, field_as_gravity(), stations.data(), 48);
    ASSERT_TRUE(fit.has_value()) << "seed " << seed;
    EXPECT_EQ(fit->report.rank, rank);
    EXPECT_EQ(fit->report.gauge, 3);
    EXPECT_EQ(fit->report.null_directions, 0);
    for (int i = 0; i < sheet.size; ++i) {
      const Fitted one = fitted(sheet, *fit, i);
      squares += std::pow((one.hard_nt - truth.hard_nt[at(i)]) / one.sigma_nt, 2);
      ++count;
      EXPECT_NEAR(norm(one.w), norm(truth.w[at(i)]), 5.0 * weighted(scaled(one.w, 1.0 / norm(one.w)), one.sigma_w));
      for (int j = 0; j < i; ++j) {  // angles: a common rotation leaves them
        const Fitted other = fitted(sheet, *fit, j);
        EXPECT_NEAR(dot(one.w, other.w), dot(truth.w[at(i)], truth.w[at(j)]),
                    5.0 * (weighted(one.w, other.sigma_w) + weighted(other.w, one.sigma_w)));
      }
    }
    for (const Station& s : stations_at(truth, all_over(20, random), random)) {
      held_out += std::pow(norm(field_of(*fit, s).tesla) * 1e9 - kField_nt, 2);
      ++held;
    }
  }
  EXPECT_NEAR(squares / count, 1.0, 5.0 * std::sqrt(2.0 / count));
  const double rms_nt = std::sqrt(held_out / held);
  std::cout << "[ measured ] " << sheet.size << " magnetometers: squares of bias error over sigma " << squares / count
            << ", length of the field at stations held out " << rms_nt << " nT rms\n";
  EXPECT_LT(rms_nt, 1.5 * kNoise_nt);
}

TEST(MagnetometerCalibration, TheFitForGravityRecoversATriad) { expect_recovered(triad(), 9); }
TEST(MagnetometerCalibration, TheFitForGravityRecoversFourSkewedOnes) { expect_recovered(four_skewed(), 13); }

TEST(MagnetometerCalibration, RollsAloneLeaveNamedCombinationsOpen) {
  // A tool rolled about z keeps the field at one angle to it: its bias is its scale.
  for (const std::vector<Vec3>& axes : {triad(), four_skewed()}) {
    Random random(3);
    const Datasheet sheet = magnetometers(axes);
    const Magnets truth(axes, random);
    std::vector<Vec3> rolls;
    for (int k = 0; k < 24; ++k) {
      const double roll = 2.0 * kPi * k / 24.0;
      rolls.push_back({0.8 * std::cos(roll), 0.8 * std::sin(roll), 0.6});
    }
    FitReport report;
    const std::vector<Station> stations = stations_at(truth, rolls, random);
    const auto fit = calibrate(sheet, field_as_gravity(), stations.data(), 24, {}, &report);
    ASSERT_FALSE(fit.has_value());
    EXPECT_EQ(fit.error().code, Errc::unobservable);
    EXPECT_GT(report.null_directions, 0);
    const auto named = std::make_unique<NullCombinations>();
    const int combinations = null_combinations(sheet, report, *named);
    ASSERT_GT(combinations, 0);
    bool bias_against_scale = false;
    for (int k = 0; k < combinations; ++k) {
      const NullCombination& c = (*named)[at(k)];
      bool bias = false, scale = false;
      for (int t = 0; t < c.terms; ++t) {
        bias = bias || c.term[at(t)].kind == ParameterKind::bias;
        scale = scale || c.term[at(t)].kind == ParameterKind::scale;
      }
      bias_against_scale = bias_against_scale || (bias && scale);
    }
    EXPECT_TRUE(bias_against_scale);
  }
}

/// A tool whose accelerometers are good, and the magnetometers those of `truth`.
struct SixAxes {
  const Magnets& truth;
  const Calibration& calibration;
  Random& random;

  ReferencedStation at_attitude(const Truth& attitude) const {
    std::normal_distribution<double> normal;
    const Measurement true_one = station_of(attitude, World{});
    ReferencedStation out{true_one, reference_of(World{})};
    for (double& g : out.measured.gravity_mps2) g += 1e-3 * normal(random);
    const Solved field = field_of(calibration, truth.station(scaled(true_one.field_tesla, 1e9), random));
    out.measured.field_tesla = field.tesla;
    out.measured.random = independent_covariance(1e-3, 0.0);
    for (std::size_t r = 0; r < 3; ++r) {
      for (std::size_t c = 0; c < 3; ++c)
        out.measured.random[6 * (3 + r) + 3 + c] = field.covariance(static_cast<int>(r), static_cast<int>(c));
    }
    return out;
  }
};

void expect_azimuths(const std::vector<Vec3>& axes) {
  const Datasheet sheet = magnetometers(axes);
  int azimuths = 0, beyond = 0;
  double squares = 0.0, before = 0.0, largest_turn_rad = 0.0;
  for (unsigned seed = 1; seed <= 50; ++seed) {
    Random random(1000 + seed);
    const Magnets truth(axes, random);
    const std::vector<Station> stations = stations_at(truth, all_over(48, random), random);
    const auto fit = calibrate(sheet, field_as_gravity(), stations.data(), 48);
    ASSERT_TRUE(fit.has_value()) << "seed " << seed;
    const SixAxes tool{truth, *fit, random};
    AlignmentSettings settings;
    settings.stated_rad = rad_from_deg(2.0);
    settings.tool = {};
    for (int i = 0; i < sheet.size; ++i) {
      const Fitted one = fitted(sheet, *fit, i);
      settings.tool.magnetometer_bias_tesla = std::max(settings.tool.magnetometer_bias_tesla, one.sigma_nt * 1e-9);
      settings.tool.magnetometer_scale = std::max(settings.tool.magnetometer_scale, norm(one.sigma_w));
    }
    std::vector<ReferencedStation> shots;
    for (const Truth& attitude : scattered(30)) shots.push_back(tool.at_attitude(attitude));
    const auto alignment = align_magnetometers(shots, settings);
    ASSERT_TRUE(alignment.has_value()) << alignment.error().text();
    largest_turn_rad = std::max(largest_turn_rad, norm(alignment->turn_rad));
    for (const Truth& attitude : build_up(7.0 * seed, 20, 8.0, 95.0)) {
      const ReferencedStation next = tool.at_attitude(attitude);
      const CorrectedStation good = aligned(next.measured, *alignment);
      const auto azimuth = attitude_of(good.measured, good.total).azimuth;
      const auto raw = attitude_of(next.measured, next.measured.random).azimuth;
      ASSERT_TRUE(azimuth && raw);
      const double miss = std::remainder(azimuth->angle.rad - attitude.azimuth_rad, 2.0 * kPi);
      beyond += std::fabs(miss) > protection_level_rad(azimuth->angle, 1e-4) ? 1 : 0;
      squares += std::pow(miss / azimuth->angle.sigma_rad, 2);
      before += std::pow(std::remainder(raw->angle.rad - attitude.azimuth_rad, 2.0 * kPi), 2);
      ++azimuths;
    }
  }
  std::cout << "[ measured ] " << sheet.size << " magnetometers: turned by up to " << deg_from_rad(largest_turn_rad)
            << " deg; azimuths off by " << deg_from_rad(std::sqrt(before / azimuths))
            << " deg rms before alignment; after it squares of error over sigma " << squares / azimuths << ", "
            << beyond << " of " << azimuths << " beyond the protection level\n";
  EXPECT_EQ(azimuths, 1000);
  EXPECT_LE(beyond, 1);  // 0.1 expected
  EXPECT_NEAR(squares / azimuths, 1.0, 0.25);
  EXPECT_GT(before / azimuths, std::pow(rad_from_deg(0.5), 2));
}

TEST(MagnetometerCalibration, TheDipAlignsACalibratedTriad) { expect_azimuths(triad()); }
TEST(MagnetometerCalibration, TheDipAlignsFourSkewedOnes) { expect_azimuths(four_skewed()); }

}  // namespace
}  // namespace magnetometer_calibration_test

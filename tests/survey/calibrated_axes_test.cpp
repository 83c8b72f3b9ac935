// Two groups of a tool, each calibrated by itself: the dip brings their axes into one frame.
#include "plumb/survey/calibrated_axes.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cstdio>
#include <random>
#include <string>
#include <vector>

#include "plumb/array/named.hpp"
#include "turned_tool.hpp"

namespace calibrated_axes_test {
namespace {

using namespace plumb;
using namespace plumb::survey;

constexpr double kField_ut = 50.0, kDip_rad = 1.2;
constexpr double kField = io::kInside_per_ut * kField_ut, kFieldNoise = io::kInside_per_ut * 0.02;
constexpr double kForceNoise_mps2 = 0.003;
using Random = std::mt19937_64;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

Vec3 direction(Random& random) {
  std::normal_distribution<double> normal;
  const Vec3 v{normal(random), normal(random), normal(random)};
  return scaled(v, 1.0 / norm(v));
}

/// Four skewed sensors with errors as their datasheet states them.
struct Group {
  Datasheet sheet;
  std::vector<Vec3> w;
  std::vector<double> bias;
  double noise = 0.0;

  Group(double length, double noise_of_it, Random& random) : noise(noise_of_it) {
    std::normal_distribution<double> normal;
    AxisList axes{};
    sheet.size = paper_tetrahedron(axes);
    sheet.reads = Reads::gravity;
    for (int i = 0; i < sheet.size; ++i) {
      DatasheetSensor& s = sheet.sensor[at(i)];
      s.row.id = make_id(("S" + std::to_string(i + 1)).c_str());
      s.row.axis = axes[at(i)];
      s.row.sigma_mps2 = noise;
      s.prior = {0.01 * length, 0.01, 0.0175};
      const Vec3 tilted = times(turned_tool::rotation_of(scaled(direction(random), 0.0175)), axes[at(i)]);
      w.push_back(scaled(tilted, 1.0 + 0.01 * normal(random)));
      bias.push_back(0.01 * length * normal(random));
    }
  }
  Station station(const Vec3& vector, double time_s, double noise_now, Random& random) const {
    std::normal_distribution<double> normal;
    Station out;
    for (std::size_t i = 0; i < w.size(); ++i) out.mean[i] = dot(w[i], vector) + bias[i] + noise_now * normal(random);
    out.delivered = SensorSet::first(static_cast<int>(w.size()));
    out.temperature_degc = 25.0;
    out.count = 1;
    out.begin_s = time_s;
    out.end_s = time_s + 1.0;
    return out;
  }
};

struct Tool {
  Random random;
  Group force, field;
  std::vector<Station> of_force, of_field;
  io::MagneticReference reference;

  explicit Tool(unsigned seed, int stations = 40)
      : random(seed), force(kG0_mps2, kForceNoise_mps2, random), field(kField, kFieldNoise, random) {
    reference.source = "stated";
    reference.total_ut = kField_ut;
    reference.total_sigma_ut = 0.01;
    reference.dip_known = true;
    reference.dip_rad = kDip_rad;
    reference.dip_sigma_rad = 1e-4;
    for (int k = 0; k < stations; ++k) {
      const auto [g, b] = vectors();
      of_force.push_back(force.station(g, 10.0 * k, force.noise, random));
      of_field.push_back(field.station(b, 10.0 * k + 0.5, field.noise, random));
    }
  }
  std::pair<Vec3, Vec3> vectors() {
    const Vec3 down = direction(random);
    Vec3 north = cross(down, direction(random));
    north = scaled(north, 1.0 / norm(north));
    return {scaled(down, kG0_mps2),
            scaled(plus(scaled(down, std::sin(kDip_rad)), scaled(north, std::cos(kDip_rad))), kField)};
  }
  GravityReference gravity() const { return {kG0_mps2, 1e-4, GravityModel::value}; }
  GravityReference length() const { return {kField, io::kInside_per_ut * 0.01, GravityModel::magnetic}; }
};

/// The rotation of a calibration's frame against the true one: x = R v.
Eigen::Matrix3d frame_of(const Group& group, const Calibration& calibration, const GravityReference& length,
                         Random& random) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (int k = 0; k < 200; ++k) {
    const Vec3 v = scaled(direction(random), length.g_mps2);
    const Vec3 x = station_residual(calibration, length, group.station(v, 0.0, 0.0, random)).gravity_mps2;
    sum += Eigen::Vector3d(x[0], x[1], x[2]) * Eigen::Vector3d(v[0], v[1], v[2]).transpose();
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(sum, Eigen::ComputeFullU | Eigen::ComputeFullV);
  return svd.matrixU() * svd.matrixV().transpose();
}

// Verifies: REQ-249
TEST(CalibratedAxes, AreBroughtIntoTheFrameOfTheAccelerometers) {
  double squares = 0.0, before = 0.0, after = 0.0;
  int within = 0;
  constexpr int kTools = 60;
  for (unsigned seed = 1; seed <= kTools; ++seed) {
    Tool tool(seed);
    const auto force = calibrate(tool.force.sheet, tool.gravity(), tool.of_force.data(), 40);
    const auto field = calibrate(tool.field.sheet, tool.length(), tool.of_field.data(), 40);
    ASSERT_TRUE(force && field);
    const CommonStations common = common_stations({*force, tool.gravity(), tool.of_force},
                                                  {*field, tool.length(), tool.of_field}, tool.reference);
    ASSERT_EQ(common.stations.size(), 40U);
    const auto found = align_axes(common, tool.reference, 0.0175);
    ASSERT_TRUE(found.has_value()) << found.error().text();
    const Eigen::Matrix3d own = frame_of(tool.force, *force, tool.gravity(), tool.random);
    const Eigen::Matrix3d other = frame_of(tool.field, *field, tool.length(), tool.random);
    const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> turn(found->rotation.data());
    const Eigen::AngleAxisd left(own * (turn * other).transpose());  // still to be turned
    const Eigen::Vector3d w = left.angle() * left.axis();
    const std::array<double, 9> c = rotation_covariance(*found);
    const Eigen::Matrix3d covariance = Eigen::Map<const Eigen::Matrix3d>(c.data());
    const double square = w.dot(covariance.ldlt().solve(w));
    squares += square / 3.0 / kTools;
    within += square < 7.81 ? 1 : 0;  // 95 %
    before += std::pow(Eigen::AngleAxisd(own * other.transpose()).angle(), 2) / kTools;
    after += w.squaredNorm() / kTools;
  }
  std::printf(
      "[ measured ] turned by %.3f deg rms, %.4f deg when aligned; squares over variances %.2f, %d of %d within 95 "
      "%%\n",
      deg_from_rad(std::sqrt(before)), deg_from_rad(std::sqrt(after)), squares, within, kTools);
  EXPECT_LT(std::sqrt(after), 0.1 * std::sqrt(before));
  EXPECT_LT(squares, 1.0 + 4.0 * std::sqrt(2.0 / 3.0 / kTools));
  EXPECT_GT(squares, 0.3);  // no bound that says nothing
  EXPECT_GE(within, 53);    // 99.9 % of draws of 95 %
}

// Negative: REQ-249
TEST(CalibratedAxes, AreRefusedWhereTheStationsDoNotShowThem) {
  Tool tool(3);
  const auto force = calibrate(tool.force.sheet, tool.gravity(), tool.of_force.data(), 40);
  const auto field = calibrate(tool.field.sheet, tool.length(), tool.of_field.data(), 40);
  ASSERT_TRUE(force && field);
  const auto few = [&](int stations) {
    const std::vector<Station> some(tool.of_field.begin(), tool.of_field.begin() + stations);
    return align_axes(
        common_stations({*force, tool.gravity(), tool.of_force}, {*field, tool.length(), some}, tool.reference),
        tool.reference, 0.0175);
  };
  EXPECT_TRUE(few(20).has_value());
  ASSERT_FALSE(few(5).has_value());
  EXPECT_EQ(few(5).error().why, NoAlignment::too_few_stations);
  // Stations at other times are not those of the accelerometers.
  std::vector<Station> later = tool.of_field;
  for (Station& s : later) s.begin_s = s.end_s += 5.0;
  EXPECT_TRUE(common_stations({*force, tool.gravity(), tool.of_force}, {*field, tool.length(), later}, tool.reference)
                  .stations.empty());
  // Exchanged magnetometers are no misalignment.
  io::MagneticReference other = tool.reference;
  other.dip_rad -= 0.3;
  const auto wrong = align_axes(
      common_stations({*force, tool.gravity(), tool.of_force}, {*field, tool.length(), tool.of_field}, other), other,
      0.0175);
  ASSERT_FALSE(wrong.has_value());
}

}  // namespace
}  // namespace calibrated_axes_test

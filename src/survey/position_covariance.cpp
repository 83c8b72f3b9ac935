#include "plumb/survey/position_covariance.hpp"

#include <algorithm>
#include <cmath>

#include "algebra.hpp"
#include "plumb/survey/survey_run.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace survey {
namespace {

using Matrix3 = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
using Matrix32 = Eigen::Matrix<double, 3, 2, Eigen::RowMajor>;
constexpr int kTerms = static_cast<int>(kTermCount);
constexpr int kCarried = static_cast<int>(kAlignmentUnknowns);
constexpr int kFirstTerm = kCarried - kTerms;

constexpr double kNearlyStraight_rad = 0.02;

Eigen::Vector3d tangent_of(const PathStation& s) {
  if (!s.azimuth_known) return {0.0, 0.0, s.inclination_rad < 0.5 * kPi ? 1.0 : -1.0};
  const double sine = std::sin(s.inclination_rad);
  return {sine * std::cos(s.azimuth_rad), sine * std::sin(s.azimuth_rad), std::cos(s.inclination_rad)};
}

/// By inclination and azimuth.
Matrix32 tangent_derivatives(const PathStation& s) {
  const double si = std::sin(s.inclination_rad), ci = std::cos(s.inclination_rad);
  const double sa = std::sin(s.azimuth_rad), ca = std::cos(s.azimuth_rad);
  Matrix32 out;
  out << ci * ca, -si * sa, ci * sa, si * ca, -si, 0.0;
  return out;
}

Vec3 vec3_of(const Eigen::Vector3d& v) { return {v[0], v[1], v[2]}; }

/// What moves a position: summed over the stations before it is squared, or added squared.
class Sums {
 public:
  /// `by_tangent`: how the position changes with the tangent of this station.
  void add_common(const Matrix3& by_tangent, const PathStationErrors& at) {
    if (!at.station.azimuth_known) {
      vertical_ += by_tangent * at.tilt_sigma_rad;
      return;
    }
    const Matrix32 by_angles = by_tangent * tangent_derivatives(at.station);
    carried_ += by_angles * matrix_of<2, kCarried>(at.carried);
    azimuth_ += by_angles.col(1);
    sag_ += by_angles.col(0) * std::sin(at.station.inclination_rad);
  }
  void add_random(const Matrix3& by_tangent, const PathStationErrors& at) {
    if (!at.station.azimuth_known) return;
    const Matrix32 by_angles = by_tangent * tangent_derivatives(at.station);
    random_ += by_angles * matrix_of<2, 2>(at.random_rad2) * by_angles.transpose();
  }
  /// A length that is wrong by `constant` and by `scale` times a stated error.
  void add_length(const Eigen::Vector3d& by_length, double constant, double scale) {
    depth_ += by_length * constant;
    depth_scale_ += by_length * scale;
  }
  Matrix3 covariance(const CommonErrors& common) const {
    const auto alone = [](const Eigen::Vector3d& sum, double sigma) -> Matrix3 {
      return sum * sum.transpose() * (sigma * sigma);
    };
    return carried_ * matrix_of<kCarried, kCarried>(common.carried) * carried_.transpose() +
           alone(azimuth_, common.declination_sigma_rad) + alone(sag_, common.sag_sigma_rad) +
           alone(depth_, common.depth_sigma_m) + alone(depth_scale_, common.depth_scale_sigma) +
           vertical_.leftCols<2>() * vertical_.leftCols<2>().transpose() + random_;
  }

 private:
  using Carried = Eigen::Matrix<double, 3, kCarried, Eigen::RowMajor>;
  Carried carried_ = Carried::Zero();
  Eigen::Vector3d azimuth_ = Eigen::Vector3d::Zero(), sag_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d depth_ = Eigen::Vector3d::Zero(), depth_scale_ = Eigen::Vector3d::Zero();
  Matrix3 vertical_ = Matrix3::Zero(), random_ = Matrix3::Zero();
};

}  // namespace

CarriedCovariance carried_covariance(const ToolErrors& tool) noexcept {
  Estimate exact;
  for (std::size_t k = 0; k < kTermCount; ++k) {
    const double sigma = sigma_of(static_cast<Term>(k), tool);
    exact.covariance[(kTermCount + 1) * k] = sigma * sigma;
  }
  return carried_covariance(exact);
}

CarriedCovariance carried_covariance(const Estimate& estimate) noexcept {
  CarriedCovariance out{};
  Eigen::Map<Eigen::Matrix<double, kCarried, kCarried, Eigen::RowMajor>>(out.data())
      .bottomRightCorner<kTerms, kTerms>() = matrix_of<kTerms, kTerms>(estimate.covariance);
  return out;
}

CarriedWeights carried_weights(const Measurement& station) noexcept {
  const std::array<double, 72> of_terms = term_weights(station);
  CarriedWeights out{};
  Eigen::Map<Eigen::Matrix<double, 6, kCarried, Eigen::RowMajor>>(out.data()).rightCols<kTerms>() =
      matrix_of<6, kTerms>(of_terms);
  return out;
}

PathStationErrors path_errors(const SurveyStation& judged, North north, const CarriedWeights& weights) {
  PathStationErrors out;
  const Measurement& m = judged.measured;
  const OrUndefined<Angle> azimuth = azimuth_from(judged, north);
  out.station = {m.md_m, judged.attitude.inclination->rad, azimuth.has_value(), azimuth ? azimuth->rad : 0.0};
  if (!azimuth) {
    const double inclination = out.station.inclination_rad;
    out.tilt_sigma_rad = std::hypot(judged.attitude.inclination->sigma_rad, std::min(inclination, kPi - inclination));
    return out;
  }
  const std::array<double, 24> all = angle_jacobian(m.gravity_mps2, m.field_tesla);
  Eigen::Matrix<double, 2, 6, Eigen::RowMajor> angles;
  angles.row(0) = matrix_of<4, 6>(all).row(0);
  angles.row(1) = matrix_of<4, 6>(all).row(3);
  Eigen::Map<Eigen::Matrix<double, 2, kCarried, Eigen::RowMajor>>(out.carried.data()) =
      angles * matrix_of<6, kCarried>(weights);
  Eigen::Matrix<double, 2, 2, Eigen::RowMajor> random = angles * matrix_of<6, 6>(m.random) * angles.transpose();
  if (north != North::magnetic) {
    const double anew = judged.reference.field.declination_rad_sigma.random;
    random(1, 1) += anew * anew;
  }
  std::copy_n(random.data(), 4, out.random_rad2.begin());
  return out;
}

StepDerivatives step_derivatives(const Vec3& first, const Vec3& second, double length_m) noexcept {
  const Eigen::Vector3d a(first[0], first[1], first[2]), b(second[0], second[1], second[2]);
  const double half = std::asin(std::min(1.0, 0.5 * (b - a).norm()));
  // f = tan(half) / half, and q = f' / (2 sin(2 half)), by which f changes with minus the cosine of the dogleg.
  const double h2 = half * half;
  double f = 1.0 + h2 * (1.0 / 3.0 + h2 * (2.0 / 15.0)), q = 1.0 / 6.0 + h2 * (11.0 / 45.0);
  if (half > kNearlyStraight_rad) {
    const double cosine = std::cos(half);
    f = std::tan(half) / half;
    q = (1.0 / (cosine * cosine) - f) / (2.0 * half * std::sin(2.0 * half));
  }
  const Eigen::Vector3d sum = a + b;
  StepDerivatives out;
  Eigen::Map<Matrix3>(out.by_first.data()) = 0.5 * length_m * (f * Matrix3::Identity() - q * sum * b.transpose());
  Eigen::Map<Matrix3>(out.by_second.data()) = 0.5 * length_m * (f * Matrix3::Identity() - q * sum * a.transpose());
  Eigen::Map<Eigen::Vector3d>(out.by_length.data()) = 0.5 * f * sum;
  return out;
}

std::vector<PositionCovariance> position_covariances(const std::vector<PathStationErrors>& stations,
                                                     const CommonErrors& common) {
  std::vector<PositionCovariance> out;
  Sums done;  // all but what the last station's own tangent does
  Matrix3 last = Matrix3::Zero();
  for (std::size_t k = 0; k < stations.size(); ++k) {
    if (k > 0) {
      const PathStationErrors& before = stations[k - 1];
      const StepDerivatives step =
          step_derivatives(vec3_of(tangent_of(before.station)), vec3_of(tangent_of(stations[k].station)),
                           stations[k].station.md_m - before.station.md_m);
      done.add_common(last + matrix_of<3, 3>(step.by_first), before);
      done.add_random(last + matrix_of<3, 3>(step.by_first), before);
      last = matrix_of<3, 3>(step.by_second);
      const double here_m = stations[k].station.md_m, before_m = before.station.md_m;
      const bool first = k == 1;  // the depth before is exact
      done.add_length(Eigen::Map<const Eigen::Vector3d>(step.by_length.data()), first ? 1.0 : 0.0,
                      first ? here_m : here_m - before_m);
    }
    Sums here = done;
    here.add_common(last, stations[k]);
    here.add_random(last, stations[k]);
    const Matrix3 covariance = here.covariance(common);
    out.emplace_back();
    std::copy_n(covariance.data(), 9, out.back().begin());
  }
  return out;
}

}  // namespace survey
}  // namespace PLUMB_ABI
}  // namespace plumb

#include "plumb/survey/attitude.hpp"

#include <algorithm>
#include <cmath>

#include "algebra.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace survey {
namespace {

enum Row : int { kInclination, kGravityToolface, kMagneticToolface, kAzimuth };

/// What says whether the angles exist.
struct Sizes {
  double gravity = 0.0, across = 0.0;  ///< |G|, hypot(Gx, Gy)
  double field_across = 0.0;           ///< hypot(Bx, By)
  double horizontal_tesla = 0.0;       ///< |G x B| / |G|
  double tilt_limit_rad = 0.0, across_limit_tesla = 0.0, horizontal_limit_tesla = 0.0;
};

double largest_sigma(const Eigen::Ref<const Eigen::MatrixXd>& covariance) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(covariance, Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(0.0, solver.eigenvalues().maxCoeff()));
}

Sizes sizes_of(const Measurement& at, const Covariance6& total) {
  const Matrix6 c = matrix_of<6, 6>(total);
  const Vec3& g = at.gravity_mps2;
  const Vec3& b = at.field_tesla;
  Sizes out;
  out.gravity = norm(g);
  out.across = std::hypot(g[0], g[1]);
  out.field_across = std::hypot(b[0], b[1]);
  out.horizontal_tesla = norm(cross(g, b)) / out.gravity;
  const double k = kUndefinedWithinSigmas;
  const Vec6& bound = at.bias_bound;
  out.tilt_limit_rad = (k * largest_sigma(c.topLeftCorner<2, 2>()) + std::hypot(bound[0], bound[1])) / out.gravity;
  out.across_limit_tesla = k * largest_sigma(c.block<2, 2>(3, 3)) + std::hypot(bound[3], bound[4]);
  const double tilt_rad =
      (k * largest_sigma(c.topLeftCorner<3, 3>()) + norm({bound[0], bound[1], bound[2]})) / out.gravity;
  out.horizontal_limit_tesla = std::hypot(k * largest_sigma(c.bottomRightCorner<3, 3>()), norm(b) * tilt_rad) +
                               norm({bound[3], bound[4], bound[5]});
  return out;
}

bool all_finite(const Measurement& at, const Covariance6& total) {
  const auto finite = [](double x) { return std::isfinite(x); };
  return std::all_of(at.gravity_mps2.begin(), at.gravity_mps2.end(), finite) &&
         std::all_of(at.field_tesla.begin(), at.field_tesla.end(), finite) &&
         std::all_of(total.begin(), total.end(), finite) &&
         std::all_of(at.bias_bound.begin(), at.bias_bound.end(), finite);
}

Attitude undefined(NoAngle why) {
  const tl::unexpected<Undefined> none(Undefined{why, 0.0, 0.0});
  return Attitude{none, none, none, none, {}};
}

}  // namespace

std::array<double, 24> angle_jacobian(const Vec3& g, const Vec3& b) noexcept {
  std::array<double, 24> out{};
  const double g2 = dot(g, g), length = std::sqrt(g2), h = std::hypot(g[0], g[1]), h2 = h * h;
  const double f2 = b[0] * b[0] + b[1] * b[1];
  if (h > 0.0) {
    out[0] = g[2] * g[0] / (h * g2);
    out[1] = g[2] * g[1] / (h * g2);
    out[2] = -h / g2;
    out[6] = g[1] / h2;
    out[7] = -g[0] / h2;
  } else if (g2 > 0.0) {
    out[0] = 1.0 / length;  // along any direction across
  }
  if (f2 > 0.0) {
    out[12 + 3] = b[1] / f2;
    out[12 + 4] = -b[0] / f2;
  }
  const double w = g[0] * b[1] - g[1] * b[0], across = g[0] * b[0] + g[1] * b[1];
  const double s = length * w, c = b[2] * h2 - g[2] * across, q = s * s + c * c;
  if (!(q > 0.0)) return out;
  const Vec6 ds{g[0] / length * w + length * b[1],
                g[1] / length * w - length * b[0],
                g[2] / length * w,
                -length * g[1],
                length * g[0],
                0.0};
  const Vec6 dc{
      2.0 * b[2] * g[0] - g[2] * b[0], 2.0 * b[2] * g[1] - g[2] * b[1], -across, -g[2] * g[0], -g[2] * g[1], h2};
  for (std::size_t k = 0; k < 6; ++k) out[18 + k] = (c / q) * ds[k] - (s / q) * dc[k];
  return out;
}

Attitude attitude_of(const Measurement& station, const Covariance6& total) {
  if (!all_finite(station, total)) return undefined(NoAngle::not_finite);
  if (!(norm(station.gravity_mps2) > 0.0)) return undefined(NoAngle::no_gravity);
  const Vec3& g = station.gravity_mps2;
  const Vec3& b = station.field_tesla;
  const Sizes size = sizes_of(station, total);
  std::array<double, 24> derivatives = angle_jacobian(g, b);
  std::array<double, 4> value{std::atan2(size.across, g[2]), full_turn_rad(std::atan2(-g[0], -g[1])),
                              full_turn_rad(std::atan2(b[0], b[1])), 0.0};
  value[kAzimuth] = full_turn_rad(std::atan2(size.gravity * (g[0] * b[1] - g[1] * b[0]),
                                             b[2] * size.across * size.across - g[2] * (g[0] * b[0] + g[1] * b[1])));

  // Of a tool near vertical the direction of the tilt says nothing: the inclination takes the larger of its sigmas.
  const double tilt_rad = std::atan2(size.across, std::fabs(g[2]));
  const bool vertical = tilt_rad <= size.tilt_limit_rad;
  const bool no_across = size.field_across <= size.across_limit_tesla;
  const bool no_horizontal = size.horizontal_tesla <= size.horizontal_limit_tesla;
  const bool defined[] = {true, !vertical, !no_across, !vertical && !no_horizontal};
  for (std::size_t row = 0; row < 4; ++row) {
    if (!defined[row]) std::fill_n(derivatives.begin() + static_cast<std::ptrdiff_t>(6 * row), 6, 0.0);
  }
  const auto j = matrix_of<4, 6>(derivatives);
  Eigen::Matrix<double, 4, 4, Eigen::RowMajor> c = j * matrix_of<6, 6>(total) * j.transpose();
  if (vertical) {
    const double sigma =
        (size.tilt_limit_rad * size.gravity - std::hypot(station.bias_bound[0], station.bias_bound[1])) /
        (kUndefinedWithinSigmas * size.gravity);
    c(0, 0) = std::max(c(0, 0), sigma * sigma);
  }
  const auto angle = [&](int row) {
    double bias = 0.0;
    for (int k = 0; k < 6; ++k) bias += std::fabs(j(row, k)) * station.bias_bound[static_cast<std::size_t>(k)];
    return Angle{value[static_cast<std::size_t>(row)], std::sqrt(std::max(0.0, c(row, row))), bias};
  };
  Attitude out = undefined(NoAngle::vertical);
  out.inclination = angle(kInclination);
  if (vertical) out.inclination->bias_rad = std::hypot(station.bias_bound[0], station.bias_bound[1]) / size.gravity;
  const tl::unexpected<Undefined> upright(Undefined{NoAngle::vertical, tilt_rad, size.tilt_limit_rad});
  out.gravity_toolface = vertical ? OrUndefined<Angle>(upright) : angle(kGravityToolface);
  out.magnetic_toolface = no_across ? OrUndefined<Angle>(tl::unexpected<Undefined>(
                                          Undefined{NoAngle::across_field, size.field_across, size.across_limit_tesla}))
                                    : angle(kMagneticToolface);
  if (vertical)
    out.azimuth = upright;
  else if (no_horizontal)
    out.azimuth = tl::unexpected<Undefined>(
        Undefined{NoAngle::no_horizontal, size.horizontal_tesla, size.horizontal_limit_tesla});
  else
    out.azimuth = MagneticAzimuth{angle(kAzimuth)};
  std::copy_n(c.data(), 16, out.covariance.begin());
  return out;
}

Totals totals_of(const Vec3& g, const Vec3& b) noexcept {
  return {norm(g), norm(b), std::atan2(dot(g, b), norm(cross(g, b)))};
}

std::array<double, 18> totals_jacobian(const Vec3& gravity_mps2, const Vec3& field_tesla) noexcept {
  std::array<double, 18> out{};
  const double lg = norm(gravity_mps2), lb = norm(field_tesla);
  if (!(lg > 0.0 && lb > 0.0)) return out;
  const Vec3 g = scaled(gravity_mps2, 1.0 / lg), b = scaled(field_tesla, 1.0 / lb);
  const double sine = dot(g, b), cosine = norm(cross(g, b));
  Vec3 to_g = minus(b, scaled(g, sine)), to_b = minus(g, scaled(b, sine));
  if (cosine > 1e-9) {
    to_g = scaled(to_g, 1.0 / cosine);
    to_b = scaled(to_b, 1.0 / cosine);
  } else {
    const Vec3 axis = std::fabs(g[0]) < 0.7 ? Vec3{1.0, 0.0, 0.0} : Vec3{0.0, 1.0, 0.0};
    to_g = cross(g, axis);
    to_g = scaled(to_g, 1.0 / norm(to_g));
    to_b = scaled(to_g, -1.0);
  }
  for (std::size_t k = 0; k < 3; ++k) {
    out[k] = g[k];
    out[6 + 3 + k] = b[k];
    out[12 + k] = to_g[k] / lg;
    out[12 + 3 + k] = to_b[k] / lb;
  }
  return out;
}

}  // namespace survey
}  // namespace PLUMB_ABI
}  // namespace plumb

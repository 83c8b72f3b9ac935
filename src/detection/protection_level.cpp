#include "plumb/detection/protection_level.hpp"
#include "plumb/detection/estimate_error.hpp"

#include <algorithm>
#include <cmath>

namespace plumb {
inline namespace PLUMB_ABI {

using std::size_t;

namespace {

/// Sine of the angle from which on two axes span a plane.
constexpr double kLeastSine = 0.05;

/// The plane of some axes: its normal, and two directions in it.
struct Plane {
  bool spanned = false;
  Vec3 normal{}, first{}, second{};
};

Plane plane_of(const SensorArray& array, SensorSet set) noexcept {
  Plane out;
  if (set.empty()) return out;
  out.first = array.axis(set.lowest());
  double most = 0.0;
  for (int i = 0; i < array.size(); ++i) {
    if (!set.has(i)) continue;
    const Vec3 across = cross(out.first, array.axis(i));
    const double sine = norm(across);
    if (sine <= most) continue;
    most = sine;
    out.normal = scaled(across, 1.0 / sine);
  }
  out.spanned = most > kLeastSine;
  out.first = scaled(out.first, 1.0 / norm(out.first));
  out.second = cross(out.normal, out.first);
  return out;
}

/// The part of the vector in a plane by least squares, in which all sensors weigh alike.
class InPlane {
 public:
  InPlane(const BlockTests& tests, SensorSet set, const Plane& plane) noexcept : tests_(tests), set_(set) {
    const SensorArray& array = tests.array();
    double aa = 0.0, ab = 0.0, bb = 0.0;
    for (int i = 0; i < array.size(); ++i) {
      if (!set.has(i)) continue;
      const double a = dot(array.axis(i), plane.first), b = dot(array.axis(i), plane.second);
      aa += a * a;
      ab += a * b;
      bb += b * b;
    }
    const double determinant = aa * bb - ab * ab;  // above zero: the axes span the plane
    on_first_ = plus(scaled(plane.first, bb / determinant), scaled(plane.second, -ab / determinant));
    on_second_ = plus(scaled(plane.second, aa / determinant), scaled(plane.first, -ab / determinant));
    plane_ = plane;
  }
  Vec3 estimate() const noexcept {
    Vec3 out{};
    for (int i = 0; i < tests_.array().size(); ++i) {
      if (set_.has(i)) out = plus(out, scaled(column(i), tests_.block().mean_mps2[static_cast<size_t>(i)]));
    }
    return out;
  }
  /// How far that may be off if the vector is `x_mps2`: each sensor counts with the most that it may be off by.
  double off_mps2(const Vec3& x_mps2, double k) const noexcept {
    const SensorArray& array = tests_.array();
    const BlockEvidence& block = tests_.block();
    const AttitudeProducts attitude(x_mps2);
    double out = k * array.uncertainty().common_scale * norm(x_mps2);
    for (int i = 0; i < array.size(); ++i) {
      if (!set_.has(i)) continue;
      const double sigma = array.sigma_mps2(i);
      const double left = array.perfectly_known() ? 0.0 : array.uncertainty().at(i, i, attitude);
      const double spread = std::sqrt(sigma * sigma / block.samples + std::fmax(left, 0.0));
      out += norm(column(i)) * (k * spread + static_cast<double>(block.tolerance_mps2[static_cast<size_t>(i)]));
    }
    return out;
  }

 private:
  Vec3 column(int i) const noexcept {
    const Vec3& h = tests_.array().axis(i);
    return plus(scaled(on_first_, dot(h, plane_.first)), scaled(on_second_, dot(h, plane_.second)));
  }

  const BlockTests& tests_;
  SensorSet set_;
  Plane plane_;
  Vec3 on_first_{}, on_second_{};
};

}  // namespace

int faults_covered(const ProtectionTerms& terms, int suspected, int confirmed_grade) noexcept {
  const int bearable = std::min(confirmed_grade, 3);
  if (suspected > 0) return std::max({terms.faults, suspected, bearable});
  return terms.unvalidated ? std::max(terms.faults, std::min(terms.faults + 1, bearable)) : terms.faults;
}

double separation_rad(const BlockTests& tests, const Vec3& x_mps2, SensorSet rest, const SetTest& test,
                      const ProtectionTerms& terms) noexcept {
  const double noise = tilt_sigma_rad(test.x_mps2, test.covariance);
  const double left = calibration_tilt_sigma_rad(tests.array(), test, rest);
  const double spread = std::sqrt(noise * noise + left * left);
  const double drift = tolerance_turn_rad(tests.array(), tests.block(), rest, test);
  return angle_between_rad(test.x_mps2, x_mps2) + terms.k_integrity * spread + drift;
}

double mirror_separation_rad(const BlockTests& tests, const Vec3& x_mps2, SensorSet rest,
                             const ProtectionTerms& terms) noexcept {
  const Plane plane = plane_of(tests.array(), rest);
  if (!plane.spanned || !tests.block().usable.contains(rest)) return kPi;
  const InPlane part(tests, rest, plane);
  const Vec3 v = part.estimate();
  const GravityReference& gravity = tests.gravity();
  const double longest = gravity.g_mps2 + TestLimits::gravity * gravity.sigma_mps2 + tests.limits().acceleration_mps2 +
                         tests.block().spread_mps2_sq / (2.0 * gravity.g_mps2);
  const auto across_mps2 = [longest](double in_plane) {
    const double square = longest * longest - in_plane * in_plane;
    return square > 0.0 ? std::sqrt(square) : 0.0;
  };
  // What calibration leaves open depends on the attitude, which is one of two.
  const Vec3 up = scaled(plane.normal, across_mps2(norm(v)));
  const double off =
      std::fmax(part.off_mps2(plus(v, up), terms.k_integrity), part.off_mps2(minus(v, up), terms.k_integrity));
  const double least = std::fmax(0.0, norm(v) - off);
  if (!(least <= longest)) return 0.0;
  const Vec3 farthest = scaled(plane.normal, across_mps2(least));
  const double one = angle_between_rad(x_mps2, plus(v, farthest));
  const double other = angle_between_rad(x_mps2, minus(v, farthest));
  return std::fmin(kPi, std::fmax(one, other) + angle_of(off, std::fmax(0.0, longest - off)));
}

}  // namespace PLUMB_ABI
}  // namespace plumb

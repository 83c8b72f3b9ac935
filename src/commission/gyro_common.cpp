#include "plumb/commission/gyro_common.hpp"

#include <algorithm>
#include <cmath>

#include "gyro_series.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace commission {
namespace {

constexpr int kSteps = 20;
constexpr double kSettled = 1e-10;

using Vector9 = Eigen::Matrix<double, 9, 1>;
using Matrix9 = Eigen::Matrix<double, 9, 9>;
using Wide = Eigen::Matrix<double, 3, 9>;
using Square = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

Eigen::Matrix3d cross_of(const Eigen::Vector3d& v) {
  Eigen::Matrix3d out;
  out << 0, -v[2], v[1], v[2], 0, -v[0], -v[1], v[0], 0;
  return out;
}

/// Gravity carried through a turn, and how that follows the nine entries of the matrix.
struct Carried {
  Eigen::Vector3d after;
  Wide slope;
};

/// Steps of constant mean rate. With R_k from the body at the beginning to that at step k, an entry's change e adds
/// R_end (before x sum of R_k' e w_k dt): the derivative of the carried direction.
Carried carry(const std::vector<Vec3>& rate, const GravityTurn& turn, double period_s, const Eigen::Matrix3d& matrix) {
  Eigen::Matrix3d r = Eigen::Matrix3d::Identity();
  Wide sum = Wide::Zero();
  for (std::size_t k = turn.begin; k < turn.end; ++k) {
    const Eigen::Vector3d w = 0.5 * (eigen_of_gyro(rate[k]) + eigen_of_gyro(rate[k + 1])) * period_s;
    const Eigen::Vector3d angle = matrix * w;
    const double size = angle.norm();
    const auto turned = [&](double part) -> Eigen::Matrix3d {
      if (!(size > 0.0)) return r;
      return Eigen::AngleAxisd(-part * size, angle / size).toRotationMatrix() * r;
    };
    const Eigen::Matrix3d middle = turned(0.5);
    for (Eigen::Index a = 0; a < 3; ++a) sum.middleCols<3>(3 * a) += middle.row(a).transpose() * w.transpose();
    r = turned(1.0);
  }
  const Eigen::Vector3d before = eigen_of_gyro(turn.before).normalized();
  return {r * before, r * cross_of(before) * sum};
}

CommissionExpected<std::vector<Vec3>> rates_for(const GyroLog& log, const GyroFit& fit,
                                                const std::vector<GravityTurn>& turns) {
  std::vector<Vec3> rate = common_rates(log, fit);
  if (rate.empty())
    return gyro_refusal("the log has other axes than the fit, or no period: use the array that was fitted");
  for (std::size_t t = 0; t < turns.size(); ++t) {
    const GravityTurn& turn = turns[t];
    if (turn.end <= turn.begin || turn.end >= rate.size() || !(turn.sigma_rad > 0.0) || !(norm(turn.before) > 0.0) ||
        !(norm(turn.after) > 0.0))
      return gyro_refusal("turn %d: it must end after it begins, within the log, with directions and a sigma above 0",
                          static_cast<int>(t));
    for (std::size_t k = turn.begin; k <= turn.end; ++k) {
      if (!std::isfinite(norm(rate[k])))
        return gyro_refusal(
            "turn %d: an axis is saturated or not given at sample %d; leave the turn out or turn more slowly",
            static_cast<int>(t), static_cast<int>(k));
    }
  }
  return rate;
}

/// What the turns say at a matrix, in units of their sigmas.
struct Normal {
  Matrix9 matrix = Matrix9::Zero();
  Vector9 right = Vector9::Zero();
  double square = 0.0;
  double square_rad2 = 0.0;
};

Normal normal_of(const std::vector<Vec3>& rate, const std::vector<GravityTurn>& turns, double period_s,
                 const Eigen::Matrix3d& matrix) {
  Normal out;
  for (const GravityTurn& turn : turns) {
    const Carried carried = carry(rate, turn, period_s, matrix);
    const Eigen::Vector3d rest = eigen_of_gyro(turn.after).normalized() - carried.after;
    const double weight = 1.0 / (turn.sigma_rad * turn.sigma_rad);
    out.matrix += weight * carried.slope.transpose() * carried.slope;
    out.right += weight * carried.slope.transpose() * rest;
    out.square += weight * rest.squaredNorm();
    const Vec3 end{carried.after[0], carried.after[1], carried.after[2]};
    const double angle_rad = angle_between_rad(end, turn.after);
    out.square_rad2 += angle_rad * angle_rad;
  }
  return out;
}

/// Names the entry that the least determined direction is mostly of.
CommissionExpected<Matrix9> covariance_of(const Matrix9& normal, double limit) {
  const Eigen::SelfAdjointEigenSolver<Matrix9> eigen(normal);
  const double least = eigen.eigenvalues()[0];
  if (least * limit * limit > 1.0)
    return Matrix9(eigen.eigenvectors() * eigen.eigenvalues().cwiseInverse().asDiagonal() *
                   eigen.eigenvectors().transpose());
  Eigen::Index at = 0;
  eigen.eigenvectors().col(0).cwiseAbs().maxCoeff(&at);
  int open = 0;
  for (Eigen::Index k = 0; k < 9; ++k) open += eigen.eigenvalues()[k] * limit * limit > 1.0 ? 0 : 1;
  const auto name = [](Eigen::Index axis) { return "xyz"[axis]; };
  if (at / 3 == at % 3)
    return gyro_refusal(
        "the turns leave %d of 9 directions open, above all the scale about %c: add turns about %c with gravity "
        "across it",
        open, name(at / 3), name(at / 3));
  return gyro_refusal(
      "the turns leave %d of 9 directions open, above all what a turn about %c reads as one about %c: add turns "
      "about %c in other attitudes, none with gravity along it",
      open, name(at % 3), name(at / 3), name(at % 3));
}

}  // namespace

CommissionExpected<CommonMatrix> fit_common(const GyroLog& log, const GyroFit& fit,
                                            const std::vector<GravityTurn>& turns, const CommonSettings& settings) {
  if (turns.size() < 5)
    return gyro_refusal("%d turns: each tells two of nine numbers, 5 are needed at least",
                        static_cast<int>(turns.size()));
  if (!fit.bias_from_rest)
    return gyro_refusal("biases are not from rest: a common one would pass for a turn; mark the samples at rest");
  const auto rate = rates_for(log, fit, turns);
  if (!rate) return tl::unexpected<std::string>(rate.error());
  Square matrix = Square::Identity();
  CommonMatrix out;
  for (out.steps = 1; out.steps <= kSteps; ++out.steps) {
    const Normal normal = normal_of(*rate, turns, log.period_s, matrix);
    const auto covariance = covariance_of(normal.matrix, settings.sigma);
    if (!covariance) return tl::unexpected<std::string>(covariance.error());
    const Vector9 step = *covariance * normal.right;
    if (step.norm() > kSettled) {
      matrix += Eigen::Map<const Square>(step.data());
      if ((matrix - Square::Identity()).cwiseAbs().maxCoeff() < settings.largest) continue;
      return gyro_refusal(
          "the common matrix differs from 1 by more than %.2g: gyros and accelerometers have other frames; turn "
          "the nominal axes into that of the accelerometers first",
          settings.largest);
    }
    const auto count = static_cast<double>(turns.size());
    const double free = std::max(1.0, 2.0 * count - 9.0);
    const double rms = std::sqrt(normal.square / free);
    if (rms > settings.allowed_sigmas)
      return gyro_refusal(
          "gravity as carried is off by %.2g of the stated sigmas rms, %.2g is allowed: a station moved, a turn is "
          "paired wrongly, or biases have drifted",
          rms, settings.allowed_sigmas);
    out.residual_rad = std::sqrt(normal.square_rad2 / count);
    Eigen::Map<Square>(out.matrix.data()) = matrix;
    Eigen::Map<Matrix9>(out.covariance.data()) = *covariance * std::max(1.0, rms * rms);
    return out;
  }
  return gyro_refusal("the common matrix does not settle in %d steps: shorten the turns to less than half a revolution",
                      kSteps);
}

GyroFit with_common(const GyroFit& fit, const CommonMatrix& common) {
  GyroFit out = fit;
  out.absolute = true;
  const Eigen::Matrix3d inverse = Eigen::Map<const Square>(common.matrix.data()).inverse();
  const Eigen::Map<const Matrix9> covariance(common.covariance.data());
  for (FittedGyro& one : out.axis) {
    const Eigen::RowVector3d row = eigen_of_gyro(one.row).transpose() * inverse;
    one.row = {row[0], row[1], row[2]};
    Wide slope;  // of the row by the entries: -(row e_a) (e_b' inverse)
    for (Eigen::Index a = 0; a < 3; ++a) {
      for (Eigen::Index b = 0; b < 3; ++b) slope.col(3 * a + b) = -row[a] * inverse.row(b).transpose();
    }
    const Eigen::Matrix3d own = Eigen::Map<const Square>(one.row_covariance.data());
    Eigen::Map<Square>(one.row_covariance.data()) =
        inverse.transpose() * own * inverse + slope * covariance * slope.transpose();
  }
  return out;
}

CommissionExpected<double> turn_residual_rad(const GyroLog& log, const GyroFit& fit,
                                             const std::vector<GravityTurn>& turns) {
  if (turns.empty()) return gyro_refusal("no turns: nothing to hold the fit against");
  const auto rate = rates_for(log, fit, turns);
  if (!rate) return tl::unexpected<std::string>(rate.error());
  const Normal normal = normal_of(*rate, turns, log.period_s, Eigen::Matrix3d::Identity());
  return std::sqrt(normal.square_rad2 / static_cast<double>(turns.size()));
}

}  // namespace commission
}  // namespace PLUMB_ABI
}  // namespace plumb

#include "plumb/commission/motion_fit.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "plumb/motion/motion_parity.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace commission {
namespace {

constexpr Eigen::Index kPerUnit = 16;  // nine of the rows, three biases, three of the arm, one lag
constexpr int kSteps = 8;
/// Neighbours among block pairs share a block: their triangle means correlate by 1/4 on either side.
constexpr double kOverlap = 1.5;
/// Data must tell more than this about a parameter than was known beforehand, or it counts as left open.
constexpr double kSeen = 0.5;

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

/// One block pair.
struct Pair {
  Vector reading;
  Vector slope;
  Eigen::Matrix3d omega;
};

std::vector<Pair> pairs_of(const MotionLog& log, int scale) {
  MotionSetup setup;
  setup.gyros = kGyros;
  const int sensors = static_cast<int>(3 * log.unit.size());
  MotionWindow window(sensors, setup.gyros, log.period_s);
  std::vector<Pair> out;
  for (std::size_t k = 0; k < log.samples(); ++k) {
    window.add(sample_of(log, k));
    if ((window.ended() >> static_cast<unsigned>(scale) & 1U) == 0) continue;
    const MotionMeans means = window.means(scale);
    if (!means.gyro[0].given || !means.gyro[1].given || means.usable.size() < sensors) continue;
    const Mat3 omega = rotation_term(setup, means, RotationSource::gyro, 0.0).omega_per_s2;
    out.push_back({Eigen::Map<const Vector>(means.reading_mps2.data(), sensors),
                   Eigen::Map<const Vector>(means.slope_mps3.data(), sensors),
                   Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(omega.data())});
  }
  return out;
}

Eigen::Matrix3d rows_of(const FittedUnit& unit) {
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(unit.rows.data());
}
Eigen::Vector3d eigen_of(const Vec3& v) { return {v[0], v[1], v[2]}; }

Matrix axes_of(const std::vector<FittedUnit>& units) {
  Matrix out(static_cast<Eigen::Index>(3 * units.size()), 3);
  for (std::size_t u = 0; u < units.size(); ++u)
    out.middleRows<3>(static_cast<Eigen::Index>(3 * u)) = rows_of(units[u]);
  return out;
}

/// What is left of a pair's readings once bias, skew and lever arms are taken off.
Vector corrected(const std::vector<FittedUnit>& units, const Pair& pair, bool with_arms) {
  Vector out = pair.reading;
  for (std::size_t u = 0; u < units.size(); ++u) {
    const auto at = static_cast<Eigen::Index>(3 * u);
    out.segment<3>(at) -= eigen_of(units[u].bias_mps2) + units[u].lag_s * pair.slope.segment<3>(at);
    if (with_arms) out.segment<3>(at) -= rows_of(units[u]) * pair.omega * eigen_of(units[u].arm_m);
  }
  return out;
}

/// Takes off what a specific force explains.
struct Parity {
  Matrix to_force;  // from readings
  Matrix project;   // onto what no force explains

  explicit Parity(const std::vector<FittedUnit>& units) {
    const Matrix axes = axes_of(units);
    to_force = (axes.transpose() * axes).ldlt().solve(axes.transpose());
    project = Matrix::Identity(axes.rows(), axes.rows()) - axes * to_force;
  }
};

/// How the corrected readings of a pair follow the parameters.
Matrix derivative(const std::vector<FittedUnit>& units, const Pair& pair, const Eigen::Vector3d& force) {
  const auto n = static_cast<Eigen::Index>(units.size());
  Matrix out = Matrix::Zero(3 * n, kPerUnit * (n - 1));
  for (Eigen::Index u = 1; u < n; ++u) {
    const FittedUnit& unit = units[static_cast<std::size_t>(u)];
    const Eigen::Vector3d felt = force + pair.omega * eigen_of(unit.arm_m);
    const Eigen::Index column = kPerUnit * (u - 1);
    for (Eigen::Index c = 0; c < 3; ++c) {
      out.block<1, 3>(3 * u + c, column + 3 * c) = felt.transpose();
      out(3 * u + c, column + 9 + c) = 1.0;
    }
    out.block<3, 3>(3 * u, column + 12) = rows_of(unit) * pair.omega;
    out.block<3, 1>(3 * u, column + 15) = pair.slope.segment<3>(3 * u);
  }
  return out;
}

Vector sigmas_of(const FitSettings& settings) {
  Vector out(kPerUnit);
  out << Vector::Constant(9, settings.axis), Vector::Constant(3, settings.bias_mps2),
      Vector::Constant(3, settings.arm_m), settings.lag_s;
  return out;
}

void move(const Vector& step, std::vector<FittedUnit>* units) {
  for (std::size_t u = 1; u < units->size(); ++u) {
    const Vector s = step.segment(kPerUnit * static_cast<Eigen::Index>(u - 1), kPerUnit);
    FittedUnit& unit = (*units)[u];
    for (std::size_t k = 0; k < 9; ++k) unit.rows[k] += s[static_cast<Eigen::Index>(k)];
    for (std::size_t c = 0; c < 3; ++c) {
      unit.bias_mps2[c] += s[static_cast<Eigen::Index>(9 + c)];
      unit.arm_m[c] += s[static_cast<Eigen::Index>(12 + c)];
    }
    unit.lag_s += s[15];
  }
}

Vector offset_of(const std::vector<FittedUnit>& units, const std::vector<FittedUnit>& start) {
  Vector out(kPerUnit * static_cast<Eigen::Index>(units.size() - 1));
  for (std::size_t u = 1; u < units.size(); ++u) {
    Vector o(kPerUnit);
    for (std::size_t k = 0; k < 9; ++k) o[static_cast<Eigen::Index>(k)] = units[u].rows[k] - start[u].rows[k];
    o.segment<3>(9) = eigen_of(units[u].bias_mps2);
    o.segment<3>(12) = eigen_of(units[u].arm_m);
    o[15] = units[u].lag_s;
    out.segment(kPerUnit * static_cast<Eigen::Index>(u - 1), kPerUnit) = o;
  }
  return out;
}

/// Normal equations in units of the prior sigmas, without the prior, for residuals of one m/s^2.
struct Normal {
  Matrix matrix;
  Vector right;
  double square = 0.0;  // of what is left
};

Normal normal_of(const std::vector<FittedUnit>& units, const std::vector<Pair>& pairs, const Vector& prior) {
  const Parity parity(units);
  const auto size = prior.size();
  Normal out{Matrix::Zero(size, size), Vector::Zero(size)};
  for (const Pair& pair : pairs) {
    const Vector y = corrected(units, pair, true), rest = parity.project * y;
    const Matrix slope = parity.project * derivative(units, pair, parity.to_force * y) * prior.asDiagonal();
    out.matrix += slope.transpose() * slope;
    out.right += slope.transpose() * rest;
    out.square += rest.squaredNorm();
  }
  return out;
}

std::string name_of(Eigen::Index parameter) {
  const std::string unit = "unit " + std::to_string(parameter / kPerUnit + 2) + ": ";
  const auto k = static_cast<std::size_t>(parameter % kPerUnit);
  const std::string axis(1, "xyz"[k % 3]);
  if (k < 9 && k / 3 == k % 3) return unit + "scale of " + axis;
  if (k < 9) return unit + "turn of " + std::string(1, "xyz"[k / 3]) + " towards " + axis;
  if (k < 12) return unit + "bias of " + axis;
  return k < 15 ? unit + "lever arm along " + axis : unit + "skew";
}

/// In words, where motion tells less of some combination than was known before; empty where it tells enough.
std::string left_open(const Matrix& normal) {
  const Eigen::SelfAdjointEigenSolver<Matrix> seen(normal);
  std::string out;
  for (Eigen::Index d = 0; d < normal.rows() && seen.eigenvalues()[d] < kSeen; ++d) {
    Vector part = seen.eigenvectors().col(d).cwiseAbs();
    std::string terms;
    for (int most = 0; most < 3; ++most) {
      Eigen::Index k = 0;
      if (part.maxCoeff(&k) < 0.3) break;
      terms += (terms.empty() ? "" : ", ") + name_of(k);
      part[k] = 0.0;
    }
    out += (out.empty() ? "" : "; ") + (terms.empty() ? std::string("a mixture of many") : terms);
  }
  return out;
}

void state_uncertainty(const Matrix& covariance, const std::vector<Pair>& pairs, std::vector<FittedUnit>* units) {
  const Vector sigma = covariance.diagonal().cwiseSqrt();
  for (std::size_t u = 1; u < units->size(); ++u) {
    const Vector s = sigma.segment(kPerUnit * static_cast<Eigen::Index>(u - 1), kPerUnit);
    FittedUnit& unit = (*units)[u];
    for (std::size_t k = 0; k < 9; ++k) unit.rows_sigma[k] = s[static_cast<Eigen::Index>(k)];
    for (std::size_t c = 0; c < 3; ++c) {
      unit.bias_sigma_mps2[c] = s[static_cast<Eigen::Index>(9 + c)];
      unit.arm_sigma_m[c] = s[static_cast<Eigen::Index>(12 + c)];
    }
    unit.lag_sigma_s = s[15];
  }
  const Parity parity(*units);
  for (const Pair& pair : pairs) {
    const Eigen::Vector3d force = parity.to_force * corrected(*units, pair, true);
    for (std::size_t i = 3; i < 3 * units->size(); ++i) {
      const Eigen::Index c = static_cast<Eigen::Index>(i % 3), first = kPerUnit * static_cast<Eigen::Index>(i / 3 - 1);
      Vector z = Vector::Zero(covariance.rows());
      z.segment<3>(first + 3 * c) = force;
      z[first + 9 + c] = 1.0;
      double& most = (*units)[i / 3].model_sigma_mps2[i % 3];
      most = std::max(most, std::sqrt(z.dot(covariance * z)));
    }
  }
}

std::vector<FittedUnit> mounted(const std::vector<UnitAlignment>& alignment) {
  std::vector<FittedUnit> out(alignment.size());
  for (std::size_t u = 0; u < out.size(); ++u) {
    const Mat3& turn = alignment[u].to_frame;
    out[u].rows = {turn[0], turn[3], turn[6], turn[1], turn[4], turn[7], turn[2], turn[5], turn[8]};
  }
  return out;
}

}  // namespace

CommissionExpected<MotionFit> fit_motion(const MotionLog& aligned_log, const std::vector<UnitAlignment>& alignment,
                                         const FitSettings& settings) {
  const std::vector<Pair> pairs = pairs_of(aligned_log, settings.scale);
  const std::vector<FittedUnit> start = mounted(alignment);
  const auto parameters = kPerUnit * static_cast<Eigen::Index>(start.size() - 1);
  const double residuals = static_cast<double>(pairs.size() * (3 * start.size() - 3));
  if (residuals < 2.0 * static_cast<double>(parameters)) {
    return tl::unexpected<std::string>("too few block pairs for a fit: " + std::to_string(pairs.size()) +
                                       ". Remedy: record a longer motion");
  }
  const Vector sigmas = sigmas_of(settings).replicate(static_cast<Eigen::Index>(start.size() - 1), 1);
  const Matrix identity = Matrix::Identity(parameters, parameters);
  MotionFit out;
  out.unit = start;
  double weight = 1.0;  // of a residual of one m/s^2
  Normal normal = normal_of(out.unit, pairs, sigmas);
  for (int step = 0; step < kSteps; ++step) {
    const Vector right = weight * normal.right - offset_of(out.unit, start).cwiseQuotient(sigmas);
    move(sigmas.cwiseProduct((weight * normal.matrix + identity).ldlt().solve(right)), &out.unit);
    normal = normal_of(out.unit, pairs, sigmas);
    weight = (residuals - static_cast<double>(parameters)) / (kOverlap * normal.square);
  }
  const std::string open = left_open(weight * normal.matrix);
  if (!open.empty()) {
    return tl::unexpected<std::string>("the motion leaves open: " + open +
                                       ". Remedy: record a motion that turns and accelerates along all axes");
  }
  const Matrix covariance = sigmas.asDiagonal() * (weight * normal.matrix + identity).inverse() * sigmas.asDiagonal();
  state_uncertainty(covariance, pairs, &out.unit);
  out.block_pairs = static_cast<int>(pairs.size());
  out.residual_mps2 = std::sqrt(normal.square / residuals);
  return out;
}

double residual_of(const MotionLog& aligned_log, const MotionFit& fit, int scale, bool with_arms) {
  const Parity parity(fit.unit);
  double square = 0.0, count = 0.0;
  for (const Pair& pair : pairs_of(aligned_log, scale)) {
    const Vector y = corrected(fit.unit, pair, with_arms);
    square += (parity.project * y).squaredNorm();
    count += static_cast<double>(y.size() - 3);
  }
  return count > 0.0 ? std::sqrt(square / count) : 0.0;
}

}  // namespace commission
}  // namespace PLUMB_ABI
}  // namespace plumb

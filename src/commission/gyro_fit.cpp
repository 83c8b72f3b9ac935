#include "plumb/commission/gyro_fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "gyro_series.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace commission {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;
using Index = Eigen::Index;

constexpr int kSteps = 20;
/// A step below this part of what the log tells ends the fit.
constexpr double kSettled = 1e-3;
/// An eigenvalue of the scaled normal matrix below this part of the largest is an open direction.
constexpr double kOpen = 1e-9;
constexpr Index kTerms = 10;  // of a sample: rate, 1, its derivative, force
constexpr Index kOne = 3, kSlope = 4, kForce = 7;

/// Which parameters an axis has, in this order: three of the row, bias, delay, three of the force.
struct Layout {
  bool rest, delay, force;
  static constexpr Index bias_at = 3, delay_at = 4;
  Index force_at() const { return delay ? 5 : 4; }
  Index size() const { return force_at() + (force ? 3 : 0); }
  /// Dimensions that gyros alone do not tell.
  Index common() const { return 9 + (rest ? 0 : 3) + (delay ? 1 : 0) + (force ? 9 : 0); }
};

/// What a log says at the present parameters, all in units of the axes' noise.
struct Sums {
  Matrix parity;                                // projects onto what no rate explains
  Matrix solve;                                 // from weighted readings to the rate
  Matrix terms = Matrix::Zero(kTerms, kTerms);  // sum of the products of a sample's terms
  Matrix right;                                 // sum of rest times terms, a row an axis
  double square = 0.0;                          // of what is left
  double block_square = 0.0;
  int samples = 0, blocks = 0, rest = 0;
  Vector rest_left;  // mean at rest, less what the parameters say
};

/// Samples at rest count by their means alone: there the bias of every axis is seen, as no rate hides it.
Sums sums_of(const GyroLog& log, const GyroFit& fit, const Layout& layout, const GyroRest& at_rest) {
  const Matrix rows = weighted_rows(fit.nominal, fit.axis);
  Matrix y = corrected_rates(log, fit.nominal, fit.axis);
  for (std::size_t i = 0; i < fit.nominal.size(); ++i) y.row(static_cast<Index>(i)) /= fit.nominal[i].noise_radps;
  Sums out;
  out.solve = rate_solver(rows);
  out.parity = Matrix::Identity(rows.rows(), rows.rows()) - rows * out.solve;
  out.right = Matrix::Zero(rows.rows(), kTerms);
  const Matrix w = out.solve * y;
  Vector mean = Vector::Zero(rows.rows());
  Index in_block = 0;
  for (Index k = 0; k < y.cols(); ++k) {
    if (k % kGyroBlock == 0) {
      mean.setZero();
      in_block = 0;
    }
    const bool inner = k > 0 && k + 1 < y.cols();
    Vector term = Vector::Zero(kTerms);
    term.head<3>() = w.col(k);
    term[kOne] = 1.0;
    // A central difference: its noise is not correlated with the rest of this sample, whatever the interpolation does.
    if (layout.delay)
      term.segment<3>(kSlope) = inner ? Eigen::Vector3d((w.col(k + 1) - w.col(k - 1)) / (2.0 * log.period_s))
                                      : Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
    if (layout.force) term.tail<3>() = eigen_of_gyro(log.force_mps2[static_cast<std::size_t>(k)]) - at_rest.force_mps2;
    if (!term.allFinite() || (layout.rest && log.at_rest[static_cast<std::size_t>(k)])) continue;
    const Vector rest = y.col(k) - rows * w.col(k);
    out.terms += term * term.transpose();
    out.right += rest * term.transpose();
    out.square += rest.squaredNorm();
    ++out.samples;
    mean += rest / kGyroBlock;
    if (++in_block < kGyroBlock) continue;
    out.block_square += mean.squaredNorm();
    ++out.blocks;
  }
  out.rest = layout.rest ? at_rest.samples : 0;
  out.rest_left = Vector::Zero(rows.rows());
  for (std::size_t i = 0; layout.rest && i < fit.axis.size(); ++i)
    out.rest_left[static_cast<Index>(i)] = (at_rest.rate_radps[static_cast<Index>(i)] - fit.axis[i].bias_radps -
                                            eigen_of_gyro(fit.axis[i].per_force).dot(at_rest.force_mps2)) /
                                           fit.nominal[i].noise_radps;
  return out;
}

/// Variance of a weighted reading: of white noise, or as much more as means over blocks show.
double variance_of(const Sums& sums, Index axes, Index parameters) {
  const double free = static_cast<double>(axes - 3);
  const double sample = sums.square / std::max(1.0, sums.samples * free - static_cast<double>(parameters));
  const double block = sums.blocks < 10 ? 0.0 : kGyroBlock * sums.block_square / (sums.blocks * free);
  return std::max(sample, block);
}

/// From the parameters of an axis to the factors of its terms.
Matrix factors_of(const FittedGyro& axis, const Layout& layout) {
  Matrix out = Matrix::Zero(kTerms, layout.size());
  out.topLeftCorner<3, 3>().setIdentity();
  out(kOne, Layout::bias_at) = 1.0;
  if (layout.delay) out.block<3, 1>(kSlope, Layout::delay_at) = -eigen_of_gyro(axis.row);
  if (layout.force) out.block<3, 3>(kForce, layout.force_at()).setIdentity();
  return out;
}

/// Parameters in units in which each has about the same effect: rms of the terms.
Vector units_of(const Sums& sums, const Layout& layout) {
  const auto rms = [&](Index at) { return std::sqrt(sums.terms.diagonal().segment<3>(at).sum() / sums.samples); };
  Vector out = Vector::Ones(layout.size());
  out.head<3>().setConstant(1.0 / rms(0));
  if (layout.delay) out[Layout::delay_at] = 1.0 / rms(kSlope);
  if (layout.force) out.segment<3>(layout.force_at()).setConstant(1.0 / rms(kForce));
  return out;
}

struct Solved {
  Vector step;        // all parameters, axis by axis
  Matrix covariance;  // for a variance of one
  Index open = 0;     // directions that the log leaves open
};

/// The least step: what is common to all axes stays where it is.
Solved solved(const Sums& sums, const GyroFit& fit, const Layout& layout) {
  const Index p = layout.size(), n = static_cast<Index>(fit.axis.size());
  const Vector unit = units_of(sums, layout);
  std::vector<Matrix> factor;
  for (std::size_t i = 0; i < fit.axis.size(); ++i)
    factor.push_back(factors_of(fit.axis[i], layout) * unit.asDiagonal() / fit.nominal[i].noise_radps);
  Matrix normal(n * p, n * p);
  Vector right(n * p);
  for (Index i = 0; i < n; ++i) {
    const Matrix& of = factor[static_cast<std::size_t>(i)];
    right.segment(p * i, p) = of.transpose() * sums.right.row(i).transpose();
    right[p * i + Layout::bias_at] += sums.rest * of(kOne, Layout::bias_at) * sums.rest_left[i];
    for (Index j = 0; j < n; ++j)
      normal.block(p * i, p * j, p, p) =
          sums.parity(i, j) * of.transpose() * sums.terms * factor[static_cast<std::size_t>(j)];
  }
  for (Index i = 0; i < n; ++i) {
    const double of = factor[static_cast<std::size_t>(i)](kOne, Layout::bias_at);
    normal(p * i + Layout::bias_at, p * i + Layout::bias_at) += sums.rest * of * of;
  }
  const Eigen::SelfAdjointEigenSolver<Matrix> eigen(normal);
  Vector inverse = eigen.eigenvalues();
  Solved out;
  const double least = kOpen * inverse.maxCoeff();
  for (Index k = 0; k < inverse.size(); ++k) {
    out.open += inverse[k] > least ? 0 : 1;
    inverse[k] = inverse[k] > least ? 1.0 / inverse[k] : 0.0;
  }
  const Vector all = unit.replicate(n, 1);
  out.covariance = all.asDiagonal() * eigen.eigenvectors() * inverse.asDiagonal() * eigen.eigenvectors().transpose() *
                   all.asDiagonal();
  out.step = out.covariance * (right.array() / all.array()).matrix();
  return out;
}

/// Biases are fitted at the force of the rests, and kept at no force.
void move(const Vector& step, const Layout& layout, const Eigen::Vector3d& rest_force, std::vector<FittedGyro>* axes) {
  const Index p = layout.size();
  for (std::size_t i = 0; i < axes->size(); ++i) {
    const Vector s = step.segment(p * static_cast<Index>(i), p);
    FittedGyro& one = (*axes)[i];
    for (std::size_t c = 0; c < 3; ++c) {
      one.row[c] += s[static_cast<Index>(c)];
      if (layout.force) one.per_force[c] += s[layout.force_at() + static_cast<Index>(c)];
    }
    one.bias_radps += s[Layout::bias_at];
    if (layout.force) one.bias_radps -= s.segment<3>(layout.force_at()).dot(rest_force);
    if (layout.delay) one.delay_s += s[Layout::delay_at];
  }
}

/// What is common to all axes, to where the header says.
void pin(const Layout& layout, const Eigen::Vector3d& rest_force, GyroFit* fit) {
  const Index n = static_cast<Index>(fit->axis.size());
  Matrix rows(n, 3), wanted(n, 3), force(n, 3);
  Vector bias(n);
  double delay_s = 0.0;
  for (Index i = 0; i < n; ++i) {
    const auto at = static_cast<std::size_t>(i);
    rows.row(i) = eigen_of_gyro(fit->axis[at].row);
    wanted.row(i) = eigen_of_gyro(fit->nominal[at].axis);
    force.row(i) = eigen_of_gyro(fit->axis[at].per_force);
    bias[i] = fit->axis[at].bias_radps;
    delay_s += fit->axis[at].delay_s / static_cast<double>(n);
  }
  const Matrix solve = rate_solver(rows);
  force -= rows * (solve * force);
  bias -= rows * (solve * bias);
  rows *= solve * wanted;
  for (Index i = 0; i < n; ++i) {
    FittedGyro& one = fit->axis[static_cast<std::size_t>(i)];
    one.row = {rows(i, 0), rows(i, 1), rows(i, 2)};
    if (!layout.rest) one.bias_radps = bias[i];
    one.bias_radps += (eigen_of_gyro(one.per_force).transpose() - force.row(i)).dot(rest_force.transpose());
    one.per_force = {force(i, 0), force(i, 1), force(i, 2)};
    one.delay_s -= delay_s;
  }
}

CommissionExpected<bool> shaped(const GyroLog& log, const std::vector<GyroNominal>& nominal,
                                const GyroFitSettings& settings) {
  if (nominal.size() < 4)
    return gyro_refusal("%d gyro axes: at least 4 are needed, because three explain any reading",
                        static_cast<int>(nominal.size()));
  if (!gyro_shape_fits(log, nominal.size()))
    return gyro_refusal("the log must have a period above 0 and %d axes of equal length: check columns and rows",
                        static_cast<int>(nominal.size()));
  if (settings.force && log.force_mps2.empty())
    return gyro_refusal("g-sensitivity needs the specific force at every sample: give force_mps2 or leave it out");
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < nominal.size(); ++i) {
    const Eigen::Vector3d axis = eigen_of_gyro(nominal[i].axis);
    if (!(std::fabs(axis.norm() - 1.0) < 1e-3) || !(nominal[i].noise_radps > 0.0))
      return gyro_refusal("gyro axis %s: the nominal axis must have length 1 and its noise be above 0",
                          gyro_name(nominal, i).c_str());
    spread += axis * axis.transpose();
  }
  if (Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvalues()[0] < 0.01)
    return gyro_refusal("the nominal gyro axes lie in one plane: a rate across it is not sensed");
  return true;
}

tl::unexpected<std::string> too_few(const GyroLog& log, const std::vector<GyroNominal>& nominal, int samples,
                                    int least) {
  std::size_t worst = 0;
  int most = 0;
  for (std::size_t i = 0; i < nominal.size(); ++i) {
    int lost = 0;
    for (std::size_t k = 0; k < log.samples(); ++k) lost += gyro_given(log, nominal, i, k) ? 0 : 1;
    if (lost <= most) continue;
    most = lost;
    worst = i;
  }
  if (most == 0) return gyro_refusal("%d samples: at least %d are needed; record for longer", samples, least);
  return gyro_refusal(
      "%d samples at which all axes are given, at least %d are needed: axis %s is saturated or not given at %d "
      "of %d; turn more slowly or leave the axis out",
      samples, least, gyro_name(nominal, worst).c_str(), most, static_cast<int>(log.samples()));
}

/// The body must have turned about every axis by more than the noise of the rate, and than rows off nominal pretend.
CommissionExpected<bool> moved(const Sums& sums, const Layout& layout, double variance, double least_ratio) {
  Eigen::Matrix3d spread = sums.terms.topLeftCorner<3, 3>() / sums.samples;
  const Eigen::Vector3d mean = sums.terms.block<3, 1>(0, kOne) / sums.samples;
  if (!layout.rest) spread -= mean * mean.transpose();
  const Eigen::Matrix3d noise = variance * sums.solve * sums.solve.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(spread - noise);
  const Eigen::Vector3d weakest = eigen.eigenvectors().col(0);
  const auto rms = [&](Eigen::Index k) { return std::sqrt(std::max(eigen.eigenvalues()[k], 0.0)); };
  const double least = std::max(std::sqrt(weakest.dot(noise * weakest)), least_ratio * rms(2));
  if (rms(0) > least) return true;
  return gyro_refusal(
      "the body turned too little about (%.2f, %.2f, %.2f): %.3g rad/s rms, %.3g is needed beside noise and the "
      "other axes; turn it about that axis too, or faster",
      weakest[0], weakest[1], weakest[2], rms(0), least);
}

/// The row's covariance told well enough in every direction.
CommissionExpected<bool> row_told(const std::string& axis, const Eigen::Matrix3d& covariance, double limit) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(covariance);
  const double sigma = std::sqrt(std::max(eigen.eigenvalues()[2], 0.0));
  if (sigma <= limit) return true;
  const Eigen::Vector3d along = eigen.eigenvectors().col(2);
  return gyro_refusal(
      "the body turned too little about (%.2f, %.2f, %.2f): there the row of gyro axis %s is told to %.2g, %.2g is "
      "needed; turn it about that axis too, faster or for longer",
      along[0], along[1], along[2], axis.c_str(), sigma, limit);
}

/// Standard deviations from the fit's covariance into the axes; refused where one is too large.
CommissionExpected<bool> told(const Matrix& covariance, Index open, const Layout& layout,
                              const GyroFitSettings& settings, const Eigen::Vector3d& rest_force, GyroFit* fit) {
  if (open > layout.common())
    return gyro_refusal(
        "the motion leaves %d combinations of rows, biases and delays open: turn about more axes, with changing "
        "rates; an axis that no other axes check has no delay",
        static_cast<int>(open - layout.common()));
  const Index p = layout.size();
  const auto check = [](const std::string& axis, const char* what, double sigma,
                        double limit) -> CommissionExpected<bool> {
    if (sigma <= limit) return true;
    return gyro_refusal(
        "the motion tells %s of gyro axis %s to %.3g only, %.3g is needed: turn about more axes, with changing "
        "rates, or for longer",
        what, axis.c_str(), sigma, limit);
  };
  for (std::size_t i = 0; i < fit->axis.size(); ++i) {
    const Matrix own = covariance.block(p * static_cast<Index>(i), p * static_cast<Index>(i), p, p);
    FittedGyro& one = fit->axis[i];
    for (Index r = 0; r < 3; ++r) {
      for (Index c = 0; c < 3; ++c) one.row_covariance[static_cast<std::size_t>(3 * r + c)] = own(r, c);
    }
    double force = 0.0;
    for (Index c = 0; layout.force && c < 3; ++c) {
      const double sigma = std::sqrt(own(layout.force_at() + c, layout.force_at() + c));
      one.per_force_sigma[static_cast<std::size_t>(c)] = sigma;
      force = std::max(force, sigma);
    }
    if (layout.delay) one.delay_sigma_s = std::sqrt(own(Layout::delay_at, Layout::delay_at));
    Vector bias = Vector::Unit(p, Layout::bias_at);
    if (layout.force) bias.segment<3>(layout.force_at()) = -rest_force;
    one.bias_sigma_radps = std::sqrt(bias.dot(own * bias));
    const std::string name = gyro_name(fit->nominal, i);
    const auto row = row_told(name, own.topLeftCorner<3, 3>(), settings.row_sigma);
    if (!row) return row;
    for (const auto& result : {check(name, "the delay [s]", one.delay_sigma_s, settings.delay_sigma_s),
                               check(name, "the g-sensitivity [rad/s per m/s2]", force, settings.force_sigma),
                               check(name, "the bias [rad/s]", one.bias_sigma_radps, settings.bias_sigma_radps)}) {
      if (!result) return result;
    }
  }
  return true;
}

GyroFit start_of(const std::vector<GyroNominal>& nominal, const GyroFitSettings& settings) {
  GyroFit out;
  out.nominal = nominal;
  out.least_rest = settings.least_rest;
  for (const GyroNominal& one : nominal) {
    out.axis.emplace_back();
    out.axis.back().row = one.axis;
  }
  return out;
}

/// The axis whose delay is beyond the limit; -1: none.
int latest(const GyroFit& fit, double limit_s) {
  for (std::size_t i = 0; i < fit.axis.size(); ++i) {
    if (!(std::fabs(fit.axis[i].delay_s) <= limit_s)) return static_cast<int>(i);
  }
  return -1;
}

bool has_rest(const GyroLog& log) {
  return std::find(log.at_rest.begin(), log.at_rest.end(), true) != log.at_rest.end();
}

}  // namespace

CommissionExpected<GyroFit> fit_gyros(const GyroLog& log, const std::vector<GyroNominal>& nominal,
                                      const GyroFitSettings& settings) {
  const auto shape = shaped(log, nominal, settings);
  if (!shape) return tl::unexpected<std::string>(shape.error());
  const Layout layout{has_rest(log), settings.delay, settings.force};
  const GyroRest rest = gyro_rest(log, nominal);
  if (layout.rest && rest.samples < settings.least_rest)
    return gyro_refusal("%d samples at rest: at least %d are needed for biases; rest longer or state none",
                        rest.samples, settings.least_rest);
  GyroFit out = start_of(nominal, settings);
  out.bias_from_rest = layout.rest;
  if (layout.rest) take_bias(rest, &out.axis);
  const Index n = static_cast<Index>(nominal.size()), parameters = n * layout.size() - layout.common();
  while (++out.steps <= kSteps) {
    const Sums sums = sums_of(log, out, layout, rest);
    if (sums.samples < settings.least_samples) return too_few(log, nominal, sums.samples, settings.least_samples);
    const double variance = variance_of(sums, n, parameters);
    const auto turned = moved(sums, layout, 0.0, out.steps > 1 ? 0.0 : settings.least_ratio);
    if (!turned) return tl::unexpected<std::string>(turned.error());
    const Solved now = solved(sums, out, layout);
    double largest = 0.0;
    for (Index k = 0; k < now.step.size(); ++k)
      largest = std::max(largest, now.step[k] * now.step[k] / (variance * now.covariance(k, k) + 1e-20));
    const bool settled = largest < kSettled * kSettled;
    if (!settled) {
      move(now.step, layout, rest.force_mps2, &out.axis);
      pin(layout, rest.force_mps2, &out);
    }
    const int late = latest(out, settings.delay_limit_s);
    if (!settled && late < 0 && out.steps < kSteps) continue;
    // What the motion leaves open comes first: it is why a delay runs away or steps do not settle.
    auto seen = moved(sums, layout, variance, 0.0);
    if (seen) seen = told(variance * now.covariance, now.open, layout, settings, rest.force_mps2, &out);
    if (!seen) return tl::unexpected<std::string>(seen.error());
    if (late >= 0)
      return gyro_refusal(
          "gyro axis %s is delayed by %.3g s or more against the others, %.3g s is the limit: bring it to "
          "their clock first",
          gyro_name(nominal, static_cast<std::size_t>(late)).c_str(), out.axis[static_cast<std::size_t>(late)].delay_s,
          settings.delay_limit_s);
    if (!settled) break;
    out.residual = gyro_residual(log, out);
    return out;
  }
  return gyro_refusal("the fit does not settle in %d steps: nominal axes may be wrong, see signs and order", kSteps);
}

}  // namespace commission
}  // namespace PLUMB_ABI
}  // namespace plumb

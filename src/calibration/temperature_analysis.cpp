/// What the stations of a fit over temperature tell of each coefficient: posterior, sigmas, shares.
#include <cmath>

#include "plumb/numeric/cholesky.hpp"
#include "temperature_model.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

using numbers::at;

namespace fit {
namespace {

/// Square root of the prior times a vector whose entries are `step` apart.
void times_prior(const Joint& joint, double* v, int step) noexcept {
  const int per = joint.per_sensor();
  for (int i = 0; i < joint.sensors(); ++i) {
    double* const own = v + at(per * i) * at(step);
    const Vec3 w = times(joint.roots[at(i)].axes, Vec3{own[0], own[at(step)], own[at(2 * step)]});
    for (int p = 0; p < 3; ++p) own[at(p * step)] = w[at(p)];
    own[at(3 * step)] *= joint.roots[at(i)].bias;
    for (int j = 1; j <= joint.order; ++j) {
      own[at((2 + 2 * j) * step)] *= joint.scale_sigma[at(i)][at(j)];
      own[at((3 + 2 * j) * step)] *= joint.bias_sigma[at(i)][at(j)];
    }
  }
}

/// Takes the best common rotation out of such a vector.
void without_rotation(const Joint& joint, const Parameters& theta, double* v, int step) noexcept {
  const int per = joint.per_sensor();
  Parameters change{};
  for (int i = 0; i < joint.sensors(); ++i) {
    for (int p = 0; p < 3; ++p) change[at(4 * i + p)] = v[at((per * i + p) * step)];
  }
  remove_rotation(theta, joint.sensors(), Roll{}, change);
  for (int i = 0; i < joint.sensors(); ++i) {
    for (int p = 0; p < 3; ++p) v[at((per * i + p) * step)] = change[at(4 * i + p)];
  }
}

/// A covariance in prior units to natural ones, the rotation taken out.
void joint_to_natural(const Joint& joint, const Parameters& theta, double* c) noexcept {
  const int size = joint.parameters();
  for (int k = 0; k < size; ++k) {
    times_prior(joint, c + k, size);
    without_rotation(joint, theta, c + k, size);
  }
  for (int k = 0; k < size; ++k) {
    times_prior(joint, c + at(k) * at(size), 1);
    without_rotation(joint, theta, c + at(k) * at(size), 1);
  }
}

/// Variance of a combination of one sensor's parameters.
double joint_variance_of(const std::array<double, kJointPerSensor>& by, const double* block, int per,
                         int size) noexcept {
  double sum = 0.0;
  for (int p = 0; p < per; ++p) {
    for (int q = 0; q < per; ++q) sum += by[at(p)] * block[p * size + q] * by[at(q)];
  }
  return std::fmax(sum, 0.0);
}

double share_of(double variance, double prior) noexcept {
  return prior > 0.0 ? std::fmax(1.0 - variance / prior, 0.0) : 0.0;
}

/// SF_k = SF_0 |W| sum_j M_kj s_j and B_k = sum_j M_kj b_j / |W|, M from Chebyshev to powers; prior and posterior
/// covariance have the same layout.
void note_coefficients(const JointAnalysis& a, const double* prior, const double* posterior_, int i,
                       SensorTemperature& out) noexcept {
  const Joint& joint = a.joint;
  const int per = joint.per_sensor(), size = joint.parameters();
  const std::size_t corner = at(per * i) * at(size) + at(per * i);
  const double reference = joint.datasheet.sensor[at(i)].coefficients.reference_degc;
  const Vec3 w = row_of(a.state.theta, i);
  const double length = norm(w), nominal = joint.sheet.sensor[at(i)].coefficients.scale[0];
  Cubic bias = a.state.bias[at(i)];
  bias[0] += a.state.theta[at(4 * i + 3)];
  const Cubic scale_powers = powers_from_chebyshev(a.state.scale[at(i)], joint.use_degc, reference);
  const Cubic bias_powers = powers_from_chebyshev(bias, joint.use_degc, reference);
  for (std::size_t k = 0; k < scale_powers.size(); ++k) {
    std::array<double, kJointPerSensor> by_scale{}, by_bias{};
    for (std::size_t p = 0; p < 3; ++p) {
      by_scale[p] = nominal * scale_powers[k] * w[p] / length;
      by_bias[p] = -bias_powers[k] * w[p] / (length * length * length);
    }
    by_bias[3] = k == 0 ? 1.0 / length : 0.0;
    for (int j = 1; j <= joint.order; ++j) {
      Cubic unit{};
      unit[at(j)] = 1.0;
      const double power = powers_from_chebyshev(unit, joint.use_degc, reference)[k];
      by_scale[at(2 + 2 * j)] = nominal * length * power;
      by_bias[at(3 + 2 * j)] = power / length;
    }
    const double scale_variance = joint_variance_of(by_scale, posterior_ + corner, per, size);
    const double bias_variance = joint_variance_of(by_bias, posterior_ + corner, per, size);
    out.scale[k] = {nominal * length * scale_powers[k], std::sqrt(scale_variance),
                    share_of(scale_variance, joint_variance_of(by_scale, prior + corner, per, size))};
    out.bias[k] = {joint.sign * bias_powers[k] / length, std::sqrt(bias_variance),
                   share_of(bias_variance, joint_variance_of(by_bias, prior + corner, per, size))};
  }
}

}  // namespace

bool to_posterior(const Joint& joint, const Parameters& theta, double* information) noexcept {
  const int size = joint.parameters();
  for (int k = 0; k < size; ++k) information[k * size + k] += 1.0;
  if (!cholesky_factor(information, size, size)) return false;
  cholesky_inverse(information, size, size);
  joint_to_natural(joint, theta, information);
  return true;
}

bool analyse(const JointAnalysis& a, TemperatureWork& work, TemperatureReport& report, FitReport& fit) noexcept {
  const Joint& joint = a.joint;
  const int size = joint.parameters(), per = joint.per_sensor();
  double* const information = work.information.data();
  double* const prior = work.vectors.data();
  if (!find_rank(a, work, report)) return false;
  if (!to_posterior(joint, a.state.theta, information)) return false;
  for (int k = 0; k < size * size; ++k) prior[k] = 0.0;
  for (int k = 0; k < size; ++k) prior[k * size + k] = 1.0;
  joint_to_natural(joint, a.state.theta, prior);
  for (int i = 0; i < joint.sensors(); ++i) {
    note_coefficients(a, prior, information, i, report.sensor[at(i)]);
    for (int p = 0; p < 4; ++p) {
      const std::size_t k = at(per * i + p) * at(size + 1);
      const double variance = std::fmax(information[k], 0.0);
      fit.sigma[at(4 * i + p)] = std::sqrt(variance);
      fit.data_share[at(4 * i + p)] = share_of(variance, prior[k]);
    }
  }
  return true;
}

}  // namespace fit
}  // namespace PLUMB_ABI
}  // namespace plumb

// Residuals of gravity, field and dip at one station, and how sure they are at random.
#pragma once

#include "algebra.hpp"
#include "plumb/survey/terms.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace survey {

using TermMatrix = Eigen::Matrix<double, 3, static_cast<int>(kTermCount)>;

inline Eigen::Vector3d totals_residual(const Measurement& at, const Reference& reference) {
  const Totals t = totals_of(at.gravity_mps2, at.field_tesla);
  return {t.gravity_mps2 - reference.gravity.g_mps2, t.field_tesla - reference.field.total_tesla,
          t.dip_rad - reference.field.dip_rad};
}

inline Eigen::Matrix<double, 3, 6> totals_derivatives(const Measurement& at) {
  return matrix_of<3, 6>(totals_jacobian(at.gravity_mps2, at.field_tesla));
}

inline Eigen::Matrix3d random_covariance(const ReferencedStation& station) {
  const Eigen::Matrix<double, 3, 6> j = totals_derivatives(station.measured);
  Eigen::Matrix3d out = j * matrix_of<6, 6>(station.measured.random) * j.transpose();
  const geomagnetic::FieldReference& field = station.reference.field;
  out(1, 1) += field.total_tesla_sigma.random * field.total_tesla_sigma.random;
  out(2, 2) += field.dip_rad_sigma.random * field.dip_rad_sigma.random;
  return out;
}

inline Eigen::Vector3d common_sigma(const Reference& reference) {
  return {reference.gravity.sigma_mps2, reference.field.total_tesla_sigma.common, reference.field.dip_rad_sigma.common};
}

}  // namespace survey
}  // namespace PLUMB_ABI
}  // namespace plumb

// Two vectors of gravity's length that sensors in one plane leave, by a pseudo-inverse: what `mirror_separation_rad`
// says in closed form.
#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <vector>

#include "plumb/detection/protection_level.hpp"

namespace plumb_test {
inline namespace PLUMB_ABI {

using namespace plumb;

/// The farther of the two vectors of gravity's length that coplanar sensors leave, by a pseudo-inverse of rank 2.
inline double mirrored_rad(const BlockTests& tests, SensorSet set, const Vec3& x, const ProtectionTerms& terms) {
  const SensorArray& array = tests.array();
  if (set.size() < 2) return kPi;
  Eigen::MatrixXd rows(set.size(), 3);
  Eigen::VectorXd y(set.size()), most(set.size());
  std::vector<int> member;
  for (int i = 0; i < array.size(); ++i) {
    if (set.has(i)) member.push_back(i);
  }
  for (int k = 0; k < set.size(); ++k) {
    const Vec3& h = array.axis(member[static_cast<std::size_t>(k)]);
    rows.row(k) << h[0], h[1], h[2];
    y(k) = tests.block().mean_mps2[static_cast<std::size_t>(member[static_cast<std::size_t>(k)])];
  }
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(rows, Eigen::ComputeFullU | Eigen::ComputeFullV);
  if (svd.singularValues()(1) < 0.0354) return kPi;  // two axes within 3 deg of one line span no plane
  const Eigen::MatrixXd inverse = svd.matrixV().leftCols(2) * svd.singularValues().head(2).cwiseInverse().asDiagonal() *
                                  svd.matrixU().leftCols(2).transpose();
  const Eigen::Vector3d v = inverse * y, normal = svd.matrixV().col(2);
  const GravityReference& g = tests.gravity();
  const double longest = g.g_mps2 + 3.0 * g.sigma_mps2 + tests.limits().acceleration_mps2 +
                         tests.block().spread_mps2_sq / (2.0 * g.g_mps2);
  const auto far = [&](double in_plane) { return std::sqrt(std::max(0.0, longest * longest - in_plane * in_plane)); };
  const auto vec = [](const Eigen::Vector3d& a) { return Vec3{a(0), a(1), a(2)}; };
  double off = 0.0;
  for (const double side : {-1.0, 1.0}) {
    const Eigen::Vector3d there = v + side * far(v.norm()) * normal;
    double sum = 0.0;
    for (int k = 0; k < set.size(); ++k) {
      const int i = member[static_cast<std::size_t>(k)];
      const double variance = array.sigma_mps2(i) * array.sigma_mps2(i) / tests.block().samples +
                              std::max(0.0, array.uncertainty().at(i, i, vec(there)));
      const double tau = static_cast<double>(tests.block().tolerance_mps2[static_cast<std::size_t>(i)]);
      sum += inverse.col(k).norm() * (terms.k_integrity * std::sqrt(variance) + tau);
    }
    off = std::max(off, sum);
  }
  const double least = std::max(0.0, v.norm() - off);
  if (least > longest) return 0.0;
  const double one = angle_between_rad(x, vec(v + far(least) * normal));
  const double other = angle_between_rad(x, vec(v - far(least) * normal));
  return std::min(kPi, std::max(one, other) + std::atan2(off, std::max(0.0, longest - off)));
}

}  // namespace PLUMB_ABI
}  // namespace plumb_test

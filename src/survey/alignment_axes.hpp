// What stations tell of the rotation between the triads: the unknowns, and the principal axes of their information.
#pragma once

#include <optional>
#include <vector>

#include "plumb/survey/joint_alignment.hpp"
#include "totals_residual.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace survey {
namespace alignment {

// Rotation, terms, and what the references of gravity, field and dip are off by.
constexpr int kFirstTerm = 3;
constexpr int kFirstReference = static_cast<int>(kAlignmentUnknowns);
constexpr int kDip = kFirstReference + 2;
constexpr int kUnknowns = kFirstReference + 3;
using Unknowns = Eigen::Matrix<double, kUnknowns, 1>;
using Information = Eigen::Matrix<double, kUnknowns, kUnknowns>;

struct State {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Unknowns x = Unknowns::Zero();  ///< in units; of the rotation 0

  void turn(const Eigen::Vector3d& by_rad);
};

struct Problem {
  AlignmentSettings settings;
  Unknowns unit, prior;                     ///< prior: 1 where one unit is known beforehand, else 0
  Eigen::Matrix<bool, kUnknowns, 1> fixed;  ///< stated to be exact
  std::vector<Eigen::Matrix3d> weight;      ///< of each station's residuals

  TermValues terms_of(const Unknowns& x) const;
  Information with_priors(const Information& of_stations) const;
  Information covariance(const Information& of_stations) const;  ///< of the exact ones 0
};

/// A station without errors of the tool, its field turned, and how that changes with rotation and terms.
struct Turned {
  Measurement at;
  Eigen::Matrix<double, 6, kFirstReference> weights;
};
Turned turned_station(const Measurement& reading, const Eigen::Matrix3d& rotation, const TermValues& terms);

/// The weakest first.
std::array<AlignmentAxis, 3> axes_of(const State& at, const Information& of_stations, const Problem& problem,
                                     const std::vector<ReferencedStation>& stations);

}  // namespace alignment
}  // namespace survey
}  // namespace PLUMB_ABI
}  // namespace plumb

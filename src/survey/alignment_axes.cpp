#include "alignment_axes.hpp"

#include <algorithm>
#include <cmath>

namespace plumb {
inline namespace PLUMB_ABI {
namespace survey {
namespace alignment {
namespace {

Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& v) {
  Eigen::Matrix3d out;
  out << 0.0, -v[2], v[1], v[2], 0.0, -v[0], -v[1], v[0], 0.0;
  return out;
}

Eigen::Vector3d vector_of(const Vec3& v) { return {v[0], v[1], v[2]}; }

/// Information of the rotation when the unknowns from `first` on are not known any better than their priors and the
/// stations say.
Eigen::Matrix3d marginal(const Information& information, int first) {
  const int others = kUnknowns - first;
  const Eigen::MatrixXd b = information.block(0, first, 3, others);
  const Eigen::MatrixXd c = information.block(first, first, others, others);
  const Eigen::Matrix3d out = information.topLeftCorner<3, 3>() - b * c.ldlt().solve(b.transpose());
  return 0.5 * (out + out.transpose());
}

/// Magnetic east of a station in tool axes, and its covariance.
struct East {
  Eigen::Vector3d direction;
  Eigen::Matrix3d covariance;
  double weight = 0.0;
};

East east_of(const Turned& turned, const Matrix6& total, double weight) {
  const Eigen::Vector3d g = vector_of(turned.at.gravity_mps2), b = vector_of(turned.at.field_tesla);
  const Eigen::Vector3d c = g.cross(b);
  East out;
  out.weight = weight;
  out.direction = c.normalized();
  Eigen::Matrix<double, 3, 6> slope;
  slope << -cross_matrix(b), cross_matrix(g);
  slope = (Eigen::Matrix3d::Identity() - out.direction * out.direction.transpose()) * slope / c.norm();
  out.covariance = slope * total * slope.transpose();
  return out;
}

/// With what the stations, and what is stated of the alignment, leave of rotation and tool.
std::vector<East> easts_of(const State& at, const Information& of_stations, const Problem& problem,
                           const std::vector<ReferencedStation>& stations) {
  Information judged = of_stations;
  judged.diagonal().head<3>().array() += 1.0;
  const Information natural = problem.unit.asDiagonal() * problem.covariance(judged) * problem.unit.asDiagonal();
  std::vector<East> out;
  for (std::size_t i = 0; i < stations.size(); ++i) {
    const Turned turned = turned_station(stations[i].measured, at.rotation, problem.terms_of(at.x));
    const Matrix6 total =
        matrix_of<6, 6>(stations[i].measured.random) +
        turned.weights * natural.topLeftCorner<kFirstReference, kFirstReference>() * turned.weights.transpose();
    out.push_back(east_of(turned, total, problem.weight[i](2, 2)));
  }
  return out;
}

void look(const std::vector<East>& easts, bool dip_known, AlignmentAxis& axis) {
  const Eigen::Vector3d n = vector_of(axis.direction);
  double weights = 0.0, sum = 0.0, squares = 0.0, blur = 0.0;
  for (const East& east : easts) {
    const double part = east.direction.dot(n);
    weights += east.weight;
    sum += east.weight * part;
    squares += east.weight * part * part;
    blur += east.weight * n.dot(east.covariance * n);
  }
  axis.mean = sum / weights;
  axis.seen = std::sqrt(std::max(0.0, squares / weights - (dip_known ? 0.0 : axis.mean * axis.mean)));
  axis.blur = std::sqrt(blur / weights);
}

std::string error_name(int unknown) {
  if (unknown >= kFirstReference) {
    const char* const names[] = {"the reference of gravity", "the reference of the field", "the reference of the dip"};
    return names[unknown - kFirstReference];
  }
  return to_string(static_cast<Term>(unknown - kFirstTerm));
}

void correlate(const Information& covariance, const Problem& problem, AlignmentAxis& axis) {
  const Eigen::Vector3d n = vector_of(axis.direction);
  const double variance = n.dot(covariance.topLeftCorner<3, 3>() * n);
  for (int k = kFirstTerm; k < kUnknowns; ++k) {
    if (problem.fixed[k]) continue;
    const double found = covariance.block<3, 1>(0, k).dot(n) / std::sqrt(variance * covariance(k, k));
    if (std::fabs(found) <= std::fabs(axis.correlation)) continue;
    axis.correlation = found;
    axis.with = error_name(k);
  }
}

}  // namespace

void State::turn(const Eigen::Vector3d& by_rad) {
  const double angle = by_rad.norm();
  if (angle > 0.0) rotation = Eigen::AngleAxisd(angle, by_rad / angle).toRotationMatrix() * rotation;
}

TermValues Problem::terms_of(const Unknowns& x) const {
  TermValues out{};
  for (std::size_t k = 0; k < kTermCount; ++k) {
    const int at = kFirstTerm + static_cast<int>(k);
    out[k] = x[at] * unit[at];
  }
  return out;
}

Information Problem::with_priors(const Information& of_stations) const {
  Information out = of_stations;
  out.diagonal() += prior;
  for (int k = 0; k < kUnknowns; ++k) {
    if (!fixed[k]) continue;
    out.row(k).setZero();
    out.col(k).setZero();
    out(k, k) = 1.0;
  }
  return out;
}

Information Problem::covariance(const Information& of_stations) const {
  Information out = with_priors(of_stations).ldlt().solve(Information::Identity());
  for (int k = 0; k < kUnknowns; ++k) {
    if (fixed[k]) out(k, k) = 0.0;
  }
  return out;
}

Turned turned_station(const Measurement& reading, const Eigen::Matrix3d& rotation, const TermValues& terms) {
  Turned out;
  out.at = without(terms, reading);
  const std::array<double, 72> of_terms = term_weights(out.at);
  out.weights.setZero();
  out.weights.rightCols<static_cast<int>(kTermCount)>() = -matrix_of<6, static_cast<int>(kTermCount)>(of_terms);
  for (std::size_t k = 0; k < kTermCount; ++k)  // of (reading - b) / (1 + s): both derivatives have a 1 / (1 + s)
    out.weights.col(kFirstTerm + static_cast<int>(k)) /= 1.0 + terms[k / 3 % 2 == 0 ? k + 3 : k];
  out.weights.bottomRows<3>() = (rotation * out.weights.bottomRows<3>()).eval();
  const Eigen::Vector3d field = rotation * vector_of(out.at.field_tesla);
  out.weights.bottomLeftCorner<3, 3>() = -cross_matrix(field);
  for (std::size_t k = 0; k < 3; ++k) out.at.field_tesla[k] = field[static_cast<int>(k)];
  return out;
}

std::array<AlignmentAxis, 3> axes_of(const State& at, const Information& of_stations, const Problem& problem,
                                     const std::vector<ReferencedStation>& stations) {
  const Information information = problem.with_priors(of_stations);
  const Eigen::Matrix3d together = marginal(information, kFirstTerm);
  const Eigen::Matrix3d alone = marginal(information, kFirstReference);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(together);
  const double nothing = 1e-12 * information.topLeftCorner<3, 3>().diagonal().maxCoeff();  // what a subtraction leaves
  const double stated = problem.settings.stated_rad;
  const auto sigma = [&](double found) { return found > nothing ? stated / std::sqrt(found) : HUGE_VAL; };
  const bool invertible = solver.eigenvalues()[0] > nothing;
  const Information covariance = invertible ? problem.covariance(of_stations) : Information::Zero();
  const std::vector<East> easts = easts_of(at, of_stations, problem, stations);
  std::array<AlignmentAxis, 3> out;
  for (int k = 0; k < 3; ++k) {
    AlignmentAxis& axis = out[static_cast<std::size_t>(k)];
    Eigen::Vector3d n = solver.eigenvectors().col(k);
    int largest = 0;
    n.cwiseAbs().maxCoeff(&largest);
    if (n[largest] < 0.0) n = -n;
    axis.direction = {n[0], n[1], n[2]};
    axis.sigma_rad = sigma(solver.eigenvalues()[k]);
    axis.sigma_alone_rad = sigma(n.dot(alone * n));
    look(easts, problem.settings.dip_known, axis);
    axis.told = axis.sigma_rad < stated && axis.seen > kUndefinedWithinSigmas * axis.blur;
    if (invertible) correlate(covariance, problem, axis);
  }
  return out;
}

}  // namespace alignment
}  // namespace survey
}  // namespace PLUMB_ABI
}  // namespace plumb

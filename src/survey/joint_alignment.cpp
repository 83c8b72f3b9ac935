#include "plumb/survey/joint_alignment.hpp"

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>

#include "alignment_axes.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace survey {
namespace {

using namespace alignment;

constexpr int kMostSteps = 50;
constexpr double kStepEnough = 1e-11;         // of a unit
constexpr double kDecisive = 1e-6;            // what a station leaves of the determinant when it is held out
constexpr std::size_t kMoreThanUnknowns = 3;  // stations beyond the unknowns without a prior

AlignmentRefusal because(NoAlignment why, double value = 0.0, double limit = 0.0) {
  AlignmentRefusal out;
  out.why = why;
  out.value = value;
  out.limit = limit;
  return out;
}

tl::unexpected<AlignmentRefusal> refused(NoAlignment why, double value = 0.0, double limit = 0.0) {
  return tl::unexpected<AlignmentRefusal>(because(why, value, limit));
}

/// Of a chi-square as large.
double chance_of(double chi_square, int freedom) {
  return boost::math::cdf(boost::math::complement(boost::math::chi_squared(freedom), chi_square));
}

/// Inverse of the covariance of a station's three residuals; nothing where it states no random error.
std::optional<Eigen::Matrix3d> weight_of(const Eigen::Matrix3d& c) {
  const Eigen::Vector3d scale = c.diagonal().cwiseSqrt();
  if (!(scale.minCoeff() > 0.0)) return std::nullopt;
  const auto per_scale = scale.cwiseInverse().asDiagonal();
  const Eigen::LLT<Eigen::Matrix3d> factor(per_scale * c * per_scale);
  if (factor.info() != Eigen::Success) return std::nullopt;
  return per_scale * factor.solve(Eigen::Matrix3d::Identity()) * per_scale;
}

tl::expected<Problem, AlignmentRefusal> prepare(const std::vector<ReferencedStation>& stations,
                                                const AlignmentSettings& settings) {
  const std::size_t needed = (settings.dip_known ? 3U : 4U) + kMoreThanUnknowns;
  if (stations.size() < needed)
    return refused(NoAlignment::too_few_stations, static_cast<double>(stations.size()), static_cast<double>(needed));
  Problem out;
  out.settings = settings;
  const Eigen::Vector3d sigma = common_sigma(stations.front().reference);
  for (int k = 0; k < kUnknowns; ++k) {
    const double stated = k < kFirstTerm        ? settings.stated_rad
                          : k < kFirstReference ? sigma_of(static_cast<Term>(k - kFirstTerm), settings.tool)
                                                : sigma[k - kFirstReference];
    out.prior[k] = k < kFirstTerm || (k == kDip && !settings.dip_known) ? 0.0 : 1.0;
    out.fixed[k] = out.prior[k] > 0.0 && !(stated > 0.0);
    out.unit[k] = stated > 0.0 ? stated : k == kDip ? settings.stated_rad : 1.0;
  }
  for (std::size_t i = 0; i < stations.size(); ++i) {
    const Eigen::Vector3d r = totals_residual(stations[i].measured, stations[i].reference);
    const Eigen::Matrix3d c = random_covariance(stations[i]);
    if (!r.allFinite() || !c.allFinite()) return refused(NoAlignment::not_finite, static_cast<double>(i));
    const std::optional<Eigen::Matrix3d> weight = weight_of(c);
    if (!weight) return refused(NoAlignment::no_random_error, static_cast<double>(i));
    out.weight.push_back(*weight);
  }
  return out;
}

/// Normal equations without priors, in units of the unknowns.
struct Normal {
  Information information = Information::Zero();
  Unknowns right = Unknowns::Zero();
  double squares = 0.0;
};

struct Row {
  Eigen::Matrix<double, 3, kUnknowns> slope;
  Eigen::Vector3d residual;
};

Row row_of(const ReferencedStation& station, const Problem& problem, const State& at) {
  const Turned turned = turned_station(station.measured, at.rotation, problem.terms_of(at.x));
  Row out;
  out.slope.leftCols<kFirstReference>() = totals_derivatives(turned.at) * turned.weights;
  out.slope.rightCols<3>() = -Eigen::Matrix3d::Identity();
  out.slope = out.slope * problem.unit.asDiagonal();
  out.residual = totals_residual(turned.at, station.reference) - at.x.tail<3>().cwiseProduct(problem.unit.tail<3>());
  return out;
}

Normal normal_at(const State& at, const Problem& problem, const std::vector<ReferencedStation>& stations) {
  Normal out;
  for (std::size_t i = 0; i < stations.size(); ++i) {
    const Row row = row_of(stations[i], problem, at);
    out.information += row.slope.transpose() * problem.weight[i] * row.slope;
    out.right -= row.slope.transpose() * (problem.weight[i] * row.residual);
    out.squares += row.residual.dot(problem.weight[i] * row.residual);
  }
  return out;
}

struct Solution {
  State at;
  Normal normal;
  int steps = 0;
};

tl::expected<Solution, AlignmentRefusal> solve(const Problem& problem, const std::vector<ReferencedStation>& stations) {
  Solution out;
  for (out.steps = 1; out.steps <= kMostSteps; ++out.steps) {
    out.normal = normal_at(out.at, problem, stations);
    Unknowns right = out.normal.right - problem.prior.cwiseProduct(out.at.x);
    for (int k = 0; k < kUnknowns; ++k) {
      if (problem.fixed[k]) right[k] = 0.0;
    }
    const Unknowns step = problem.with_priors(out.normal.information).ldlt().solve(right);
    if (!step.allFinite()) break;
    out.at.turn(step.head<3>() * problem.settings.stated_rad);
    out.at.x.tail<kUnknowns - kFirstTerm>() += step.tail<kUnknowns - kFirstTerm>();
    if (step.cwiseAbs().maxCoeff() < kStepEnough * (1.0 + out.at.x.cwiseAbs().maxCoeff())) {
      out.normal = normal_at(out.at, problem, stations);
      return out;
    }
  }
  return refused(NoAlignment::not_converged, out.steps);
}

tl::expected<std::array<AlignmentAxis, 3>, AlignmentRefusal> observable(
    const State& at, const Normal& normal, const Problem& problem, const std::vector<ReferencedStation>& stations) {
  const std::array<AlignmentAxis, 3> axes = axes_of(at, normal.information, problem, stations);
  AlignmentRefusal out = because(NoAlignment::correlated, axes[0].sigma_rad, problem.settings.stated_rad);
  out.dip_known = problem.settings.dip_known;
  out.axis = axes;
  for (const AlignmentAxis& axis : axes) {
    out.rank += axis.told ? 1 : 0;
    const bool by_the_tool = axis.sigma_alone_rad < out.limit && axis.seen > kUndefinedWithinSigmas * axis.blur;
    if (!axis.told && !by_the_tool) out.why = NoAlignment::not_observable;
  }
  if (out.rank == 3) return axes;
  return tl::unexpected<AlignmentRefusal>(out);
}

/// Of a linear fit: r without the station is (1 - S W)^-1 r, with covariance W^-1 (W^-1 - S)^-1 W^-1, S = A P A'.
HeldOut held_out_of(const Solution& found, const Problem& problem, const Information& covariance,
                    const std::vector<ReferencedStation>& stations) {
  HeldOut out;
  double squares = 0.0, normalised = 0.0;
  int count = 0;
  for (std::size_t i = 0; i < stations.size(); ++i) {
    const Row row = row_of(stations[i], problem, found.at);
    const Eigen::Matrix3d s = row.slope * covariance * row.slope.transpose();
    const Eigen::Matrix3d left = Eigen::Matrix3d::Identity() - s * problem.weight[i];
    if (!(left.determinant() > kDecisive)) {
      ++out.decisive;
      continue;
    }
    const Eigen::Matrix3d inverse = left.inverse();
    const double residual = (inverse * row.residual)[2];
    const double one = residual / std::sqrt((inverse * problem.weight[i].inverse())(2, 2));
    squares += residual * residual;
    normalised += one * one;
    ++count;
    if (!(std::fabs(one) <= std::fabs(out.worst_normalised))) {
      out.worst = static_cast<int>(i);
      out.worst_normalised = one;
    }
  }
  out.rms_rad = std::sqrt(squares / std::max(count, 1));
  out.normalised = std::sqrt(normalised / std::max(count, 1));
  return out;
}

void fill(const Solution& found, const Problem& problem, const Information& covariance, JointAlignment& out) {
  Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(out.rotation.data()) = found.at.rotation;
  const Eigen::AngleAxisd turn(found.at.rotation);
  Eigen::Map<Eigen::Vector3d>(out.turn_rad.data()) = turn.angle() * turn.axis();
  out.value = problem.terms_of(found.at.x);
  const Information natural = problem.unit.asDiagonal() * covariance * problem.unit.asDiagonal();
  constexpr int kKept = static_cast<int>(kAlignmentUnknowns);
  Eigen::Map<Eigen::Matrix<double, kKept, kKept, Eigen::RowMajor>>(out.covariance.data()) =
      natural.topLeftCorner<kKept, kKept>();
  for (int k = 0; k < 3; ++k) out.sigma_rad[static_cast<std::size_t>(k)] = std::sqrt(natural(k, k));
  const Unknowns value = found.at.x.cwiseProduct(problem.unit);
  out.gravity_offset_mps2 = value[kFirstReference];
  out.field_offset_tesla = value[kFirstReference + 1];
  out.dip_offset_rad = value[kDip];
  out.dip_sigma_rad = std::sqrt(natural(kDip, kDip));
  out.steps = found.steps;
  out.chi_square = found.normal.squares + found.at.x.cwiseAbs2().dot(problem.prior);
}

/// Residuals, and the rotation against what is stated of it.
tl::expected<void, AlignmentRefusal> believable(const JointAlignment& found, const AlignmentSettings& settings) {
  if (found.chance < settings.misfit_false_alarm)
    return refused(NoAlignment::misfit, found.chi_square,
                   boost::math::quantile(
                       boost::math::complement(boost::math::chi_squared(found.freedom), settings.misfit_false_alarm)));
  Eigen::Matrix3d c;
  for (int a = 0; a < 3; ++a) {
    for (int b = 0; b < 3; ++b)
      c(a, b) = found.covariance[static_cast<std::size_t>(a) * kAlignmentUnknowns + static_cast<std::size_t>(b)];
  }
  c.diagonal().array() += settings.stated_rad * settings.stated_rad;
  const Eigen::Map<const Eigen::Vector3d> turn(found.turn_rad.data());
  if (chance_of(turn.dot(c.ldlt().solve(turn)), 3) < settings.misfit_false_alarm)
    return refused(NoAlignment::implausible, turn.norm(), settings.stated_rad);
  return {};
}

}  // namespace

tl::expected<JointAlignment, AlignmentRefusal> align_magnetometers(const std::vector<ReferencedStation>& stations,
                                                                   const AlignmentSettings& settings) {
  const auto problem = prepare(stations, settings);
  if (!problem) return tl::unexpected<AlignmentRefusal>(problem.error());
  const State start;
  if (const auto seen = observable(start, normal_at(start, *problem, stations), *problem, stations); !seen)
    return tl::unexpected<AlignmentRefusal>(seen.error());
  const auto found = solve(*problem, stations);
  if (!found) return tl::unexpected<AlignmentRefusal>(found.error());
  const auto seen = observable(found->at, found->normal, *problem, stations);
  if (!seen) return tl::unexpected<AlignmentRefusal>(seen.error());

  JointAlignment out;
  out.axis = *seen;
  const Information covariance = problem->covariance(found->normal.information);
  fill(*found, *problem, covariance, out);
  out.freedom = 3 * static_cast<int>(stations.size()) - (settings.dip_known ? 3 : 4);
  out.chance = chance_of(out.chi_square, out.freedom);
  out.held_out = held_out_of(*found, *problem, covariance, stations);
  if (const auto good = believable(out, settings); !good) return tl::unexpected<AlignmentRefusal>(good.error());
  return out;
}

CorrectedStation aligned(const Measurement& station, const JointAlignment& alignment) {
  const Eigen::Matrix3d rotation = matrix_of<3, 3>(alignment.rotation);
  const Turned turned = turned_station(station, rotation, alignment.value);
  Matrix6 both = Matrix6::Identity();
  both.bottomRightCorner<3, 3>() = rotation;
  const Matrix6 random = both * matrix_of<6, 6>(station.random) * both.transpose();
  constexpr int kKept = static_cast<int>(kAlignmentUnknowns);
  const Matrix6 total =
      random + turned.weights * matrix_of<kKept, kKept>(alignment.covariance) * turned.weights.transpose();
  CorrectedStation out;
  out.measured = turned.at;
  std::copy_n(random.data(), 36, out.measured.random.begin());
  const Eigen::Map<const Eigen::Vector3d> bound(station.bias_bound.data() + 3);
  Eigen::Map<Eigen::Vector3d>(out.measured.bias_bound.data() + 3) = rotation.cwiseAbs() * bound;
  std::copy_n(total.data(), 36, out.total.begin());
  return out;
}

CarriedWeights alignment_weights(const Measurement& station, const JointAlignment& alignment) {
  CarriedWeights out{};
  Eigen::Map<Eigen::Matrix<double, 6, kFirstReference, Eigen::RowMajor>>(out.data()) =
      turned_station(station, matrix_of<3, 3>(alignment.rotation), alignment.value).weights;
  return out;
}

}  // namespace survey
}  // namespace PLUMB_ABI
}  // namespace plumb

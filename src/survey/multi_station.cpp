#include "plumb/survey/multi_station.hpp"

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>

#include "totals_residual.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace survey {
namespace {

constexpr int kTerms = static_cast<int>(kTermCount);
constexpr int kReferences = 3;
constexpr int kUnknowns = kTerms + kReferences;
constexpr int kMostSteps = 50;
constexpr double kStepEnough = 1e-11;  // of a stated sigma
using Unknowns = Eigen::Matrix<double, kUnknowns, 1>;
using Information = Eigen::Matrix<double, kUnknowns, kUnknowns>;

EstimateRefusal because(NoEstimate why, double value = 0.0, double limit = 0.0) {
  EstimateRefusal out;
  out.why = why;
  out.value = value;
  out.limit = limit;
  return out;
}

/// Units of the unknowns, and which of them have a prior of one unit.
struct Problem {
  Unknowns unit;
  std::array<bool, kTermCount> asked{};
  std::array<bool, static_cast<std::size_t>(kUnknowns)> fixed{};  ///< stated to be exact
  std::vector<Eigen::Matrix3d> weight;

  bool is_asked(int k) const { return k < kTerms && asked[static_cast<std::size_t>(k)]; }
  bool is_fixed(int k) const { return fixed[static_cast<std::size_t>(k)]; }
};

TermValues terms_of(const Unknowns& x, const Problem& problem) {
  TermValues out{};
  for (int k = 0; k < kTerms; ++k) out[static_cast<std::size_t>(k)] = x[k] * problem.unit[k];
  return out;
}

tl::expected<Problem, EstimateRefusal> prepare(const std::vector<ReferencedStation>& stations,
                                               const MultiStationSettings& settings) {
  Problem out;
  for (const Term term : settings.terms) {
    bool& asked = out.asked[static_cast<std::size_t>(term)];
    if (asked) return tl::unexpected<EstimateRefusal>(because(NoEstimate::nothing_asked));
    asked = true;
  }
  if (settings.terms.empty()) return tl::unexpected<EstimateRefusal>(because(NoEstimate::nothing_asked));
  const std::size_t needed = settings.terms.size() + 3;
  if (stations.size() < needed)
    return tl::unexpected<EstimateRefusal>(
        because(NoEstimate::too_few_stations, static_cast<double>(stations.size()), static_cast<double>(needed)));
  const Eigen::Vector3d sigma = common_sigma(stations.front().reference);
  for (int k = 0; k < kUnknowns; ++k) {
    const double stated = k < kTerms ? sigma_of(static_cast<Term>(k), settings.tool) : sigma[k - kTerms];
    const double usual = k < kTerms ? sigma_of(static_cast<Term>(k), iscwsa_tool()) : 1.0;
    out.unit[k] = stated > 0.0 ? stated : usual;
    out.fixed[static_cast<std::size_t>(k)] = !(stated > 0.0) && !out.is_asked(k);
  }
  for (std::size_t i = 0; i < stations.size(); ++i) {
    const Eigen::Vector3d r = totals_residual(stations[i].measured, stations[i].reference);
    const Eigen::Matrix3d c = random_covariance(stations[i]);
    if (!r.allFinite() || !c.allFinite())
      return tl::unexpected<EstimateRefusal>(because(NoEstimate::not_finite, static_cast<double>(i)));
    const Eigen::Vector3d scale = c.diagonal().cwiseSqrt();
    const Eigen::Matrix3d correlation = scale.cwiseInverse().asDiagonal() * c * scale.cwiseInverse().asDiagonal();
    const Eigen::LLT<Eigen::Matrix3d> factor(correlation);
    if (!(scale.minCoeff() > 0.0) || factor.info() != Eigen::Success)
      return tl::unexpected<EstimateRefusal>(because(NoEstimate::no_random_error, static_cast<double>(i)));
    const Eigen::Matrix3d inverse = factor.solve(Eigen::Matrix3d::Identity());
    out.weight.push_back(scale.cwiseInverse().asDiagonal() * inverse * scale.cwiseInverse().asDiagonal());
  }
  return out;
}

/// Normal equations at x, in units of the unknowns: information of the stations, right side and sum of squares, no
/// prior.
struct Normal {
  Information information = Information::Zero();
  Unknowns right = Unknowns::Zero();
  double squares = 0.0;
};

Normal normal_at(const Unknowns& x, const Problem& problem, const std::vector<ReferencedStation>& stations) {
  Normal out;
  const TermValues terms = terms_of(x, problem);
  for (std::size_t i = 0; i < stations.size(); ++i) {
    const Measurement at = without(terms, stations[i].measured);
    const std::array<double, 72> weights = term_weights(at);
    Eigen::Matrix<double, 3, kUnknowns> slope;
    const Eigen::Matrix<double, 3, 6> j = totals_derivatives(at);
    slope.leftCols<kTerms>() = -j * matrix_of<6, kTerms>(weights);
    for (int k = 0; k < kTerms; ++k)  // of (reading - b) / (1 + s): both derivatives have a 1 / (1 + s)
      slope.col(k) /= 1.0 + terms[static_cast<std::size_t>(k / 3 % 2 == 0 ? k + 3 : k)];
    slope.rightCols<kReferences>() = -Eigen::Matrix3d::Identity();
    slope = slope * problem.unit.asDiagonal();
    Eigen::Vector3d r = totals_residual(at, stations[i].reference);
    for (int k = 0; k < kReferences; ++k) r[k] -= x[kTerms + k] * problem.unit[kTerms + k];
    out.information += slope.transpose() * problem.weight[i] * slope;
    out.right -= slope.transpose() * (problem.weight[i] * r);
    out.squares += r.dot(problem.weight[i] * r);
  }
  return out;
}

/// The stations' information with the priors; exact unknowns stay where they are.
Information with_priors(const Information& of_stations, const Problem& problem, bool references_known) {
  Information out = of_stations;
  for (int k = 0; k < kUnknowns; ++k) {
    if (problem.is_fixed(k)) {
      out.row(k).setZero();
      out.col(k).setZero();
      out(k, k) = 1.0;
    } else if (!problem.is_asked(k) && (k < kTerms || references_known)) {
      out(k, k) += 1.0;
    }
  }
  return out;
}

struct Solution {
  Unknowns x = Unknowns::Zero();
  Normal normal;
  int steps = 0;
};

tl::expected<Solution, EstimateRefusal> solve(const Problem& problem, const std::vector<ReferencedStation>& stations) {
  Solution out;
  for (out.steps = 1; out.steps <= kMostSteps; ++out.steps) {
    out.normal = normal_at(out.x, problem, stations);
    Unknowns right = out.normal.right;
    for (int k = 0; k < kUnknowns; ++k) {
      if (problem.is_fixed(k))
        right[k] = 0.0;
      else if (!problem.is_asked(k))
        right[k] -= out.x[k];
    }
    const Eigen::LDLT<Information> factor(with_priors(out.normal.information, problem, true));
    const Unknowns step = factor.solve(right);
    if (!step.allFinite()) break;
    out.x += step;
    if (step.cwiseAbs().maxCoeff() < kStepEnough * (1.0 + out.x.cwiseAbs().maxCoeff())) {
      out.normal = normal_at(out.x, problem, stations);
      return out;
    }
  }
  return tl::unexpected<EstimateRefusal>(because(NoEstimate::not_converged, out.steps));
}

/// The weakest combination of the terms that are asked for, were the references unknown.
tl::expected<void, EstimateRefusal> check_observable(const Normal& normal, const Problem& problem,
                                                     const std::vector<Term>& terms) {
  std::vector<int> asked, others;
  for (const Term term : terms) asked.push_back(static_cast<int>(term));
  for (int k = 0; k < kUnknowns; ++k) {
    if (!problem.is_asked(k)) others.push_back(k);
  }
  const Information all = with_priors(normal.information, problem, false);
  const Eigen::MatrixXd a = all(asked, asked), b = all(asked, others), c = all(others, others);
  const Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> inverse(c);
  Eigen::MatrixXd left = a - b * inverse.solve(b.transpose());
  left = 0.5 * (left + left.transpose()).eval();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(left);
  const double noise = 1e-12 * a.diagonal().maxCoeff();  // what the subtraction leaves of nothing
  const double weakest = solver.eigenvalues()[0];
  if (weakest > std::max(1.0, noise)) return {};
  EstimateRefusal out = because(NoEstimate::not_observable, weakest > noise ? 1.0 / std::sqrt(weakest) : HUGE_VAL, 1.0);
  for (std::size_t k = 0; k < terms.size(); ++k)
    out.direction[static_cast<std::size_t>(terms[k])] = solver.eigenvectors()(static_cast<Eigen::Index>(k), 0);
  return tl::unexpected<EstimateRefusal>(out);
}

tl::expected<void, EstimateRefusal> check_correlations(const Information& covariance,
                                                       const MultiStationSettings& settings, Estimate& out) {
  const auto correlation = [&](int a, int b) {
    return std::fabs(covariance(a, b)) / std::sqrt(covariance(a, a) * covariance(b, b));
  };
  EstimateRefusal worst = because(NoEstimate::correlated, 0.0, settings.max_correlation);
  for (std::size_t i = 0; i < settings.terms.size(); ++i) {
    const int a = static_cast<int>(settings.terms[i]);
    for (std::size_t j = 0; j < i; ++j) {
      const double found = correlation(a, static_cast<int>(settings.terms[j]));
      if (!(found <= worst.value)) {
        worst.value = found;
        worst.first = settings.terms[j];
        worst.second = settings.terms[i];
      }
    }
    for (int k = kTerms; k < kUnknowns; ++k) {
      if (covariance(k, k) > 0.0)
        out.largest_reference_correlation = std::max(out.largest_reference_correlation, correlation(a, k));
    }
  }
  out.largest_correlation = worst.value;
  if (worst.value <= settings.max_correlation) return {};
  return tl::unexpected<EstimateRefusal>(worst);
}

void fill(const Solution& found, const Problem& problem, const Information& covariance, Estimate& out) {
  out.value = terms_of(found.x, problem);
  for (int a = 0; a < kTerms; ++a) {
    for (int b = 0; b < kTerms; ++b)
      out.covariance[static_cast<std::size_t>(a * kTerms + b)] = covariance(a, b) * problem.unit[a] * problem.unit[b];
    out.sigma[static_cast<std::size_t>(a)] = std::sqrt(covariance(a, a)) * problem.unit[a];
  }
  const Unknowns offsets = found.x.cwiseProduct(problem.unit);
  out.gravity_offset_mps2 = offsets[kTerms];
  out.field_offset_tesla = offsets[kTerms + 1];
  out.dip_offset_rad = offsets[kTerms + 2];
  out.steps = found.steps;
  out.chi_square = found.normal.squares;
  for (int k = 0; k < kUnknowns; ++k) {
    if (!problem.is_asked(k)) out.chi_square += found.x[k] * found.x[k];
  }
}

}  // namespace

tl::expected<Estimate, EstimateRefusal> estimate_terms(const std::vector<ReferencedStation>& stations,
                                                       const MultiStationSettings& settings) {
  const auto problem = prepare(stations, settings);
  if (!problem) return tl::unexpected<EstimateRefusal>(problem.error());
  const Normal first = normal_at(Unknowns::Zero(), *problem, stations);
  if (const auto seen = check_observable(first, *problem, settings.terms); !seen)
    return tl::unexpected<EstimateRefusal>(seen.error());
  const auto found = solve(*problem, stations);
  if (!found) return tl::unexpected<EstimateRefusal>(found.error());
  if (const auto seen = check_observable(found->normal, *problem, settings.terms); !seen)
    return tl::unexpected<EstimateRefusal>(seen.error());

  Estimate out;
  out.terms = settings.terms;
  Information covariance = with_priors(found->normal.information, *problem, true).ldlt().solve(Information::Identity());
  for (int k = 0; k < kUnknowns; ++k) {
    if (problem->is_fixed(k)) covariance(k, k) = 0.0;
  }
  if (const auto told = check_correlations(covariance, settings, out); !told)
    return tl::unexpected<EstimateRefusal>(told.error());
  fill(*found, *problem, covariance, out);
  out.freedom = 3 * static_cast<int>(stations.size()) - static_cast<int>(settings.terms.size());
  const boost::math::chi_squared law(out.freedom);
  out.chance = boost::math::cdf(boost::math::complement(law, out.chi_square));
  if (out.chance < settings.misfit_false_alarm)
    return tl::unexpected<EstimateRefusal>(
        because(NoEstimate::misfit, out.chi_square,
                boost::math::quantile(boost::math::complement(law, settings.misfit_false_alarm))));
  return out;
}

tl::expected<Estimate, EstimateRefusal> estimate_axial_interference(const std::vector<ReferencedStation>& stations,
                                                                    const ToolErrors& tool) {
  MultiStationSettings settings;
  settings.terms = {Term::magnetometer_bias_z};
  settings.tool = tool;
  return estimate_terms(stations, settings);
}

}  // namespace survey
}  // namespace PLUMB_ABI
}  // namespace plumb

#include "plumb/commission/array_fit.hpp"

#include <algorithm>
#include <cmath>

#include "array_model.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace commission {
namespace {

using Eigen::Index;
using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;
using Pair = ArrayPairs::Pair;

constexpr int kSteps = 6;
/// Neighbours among block pairs share a block: their triangle means correlate by 1/4 on either side.
constexpr double kOverlap = 1.5;
/// How much of the change from sample to sample the filter of a gyro may hide, 1 sigma.
constexpr double kFilter = 0.3;
/// Apart within a chip, where every sensor stands alone.
constexpr double kNothing_m = 1e-9;
/// Least known share of an entry in directions that are open for it to be named.
constexpr double kNamed = 0.1;

/// Columns that the unknowns are made of, each with the sigma of what is known of it beforehand.
struct Basis {
  Matrix column;
  Vector prior;
  Index arms = 0, lags = 0, rectifications = 0;  ///< the first columns are theirs, in this order
};

/// Orthonormal columns of n numbers whose mean is zero.
Matrix mean_zero(Index n) {
  const Matrix q = Eigen::HouseholderQR<Matrix>(Matrix::Ones(n, 1)).householderQ();
  return q.rightCols(n - 1);
}

/// Anything within its bound is as likely.
double spread(double bound) { return bound / std::sqrt(3.0); }

void put_known(const ArrayOnBoard& on_board, const ArrayLayout& at, Vector& prior) {
  for (Index i = 0; i < at.sensors; ++i) {
    const MotionErrors& e = on_board.setup.errors[static_cast<std::size_t>(i)];
    prior.segment<3>(at.row(i)) << spread(e.scale), spread(e.axis_rad), spread(e.axis_rad);
    prior[at.bias() + i] = spread(e.bias_mps2);
  }
  const GyroErrors& g = on_board.setup.gyro;
  for (Index k = 0; k < 9; ++k) prior[at.gyro() + k] = spread(k % 4 == 0 ? g.scale : g.axis_rad);
  prior.segment<3>(at.gyro() + static_cast<Index>(kGyroBias)).setConstant(spread(g.bias_radps));
  prior[at.gyro() + static_cast<Index>(kGyroLag)] = spread(g.lag_s);
  prior[at.gyro() + static_cast<Index>(kGyroFilter)] = kFilter;
}

/// Columns of `count` vectors whose mean is zero.
Matrix shifts_apart(Index count) {
  const Matrix apart = mean_zero(count);
  Matrix out = Matrix::Zero(3 * count, 3 * (count - 1));
  for (Index u = 0; u < count; ++u) {
    for (Index d = 0; d + 1 < count; ++d) out.block<3, 3>(3 * u, 3 * d) = apart(u, d) * Eigen::Matrix3d::Identity();
  }
  return out;
}

/// A common shift of all arms is another reference point, a common lag another instant: no reading shows either, and
/// the means are zero.
Basis basis_of(const ArrayOnBoard& on_board, const ArrayLayout& at, const ArrayFitSettings& settings) {
  Basis out;
  out.arms = 3 * (at.arms - 1), out.lags = at.sensors - 1, out.rectifications = at.sensors;
  const Index rest = at.within_chip(0) - at.rectification(), first = out.arms + out.lags;
  const Index chips = 3 * (at.sensors - 1);
  out.column = Matrix::Zero(at.size(), first + rest + chips);
  out.prior = Vector::Ones(first + rest + chips);
  if (at.arms > 1) out.column.topLeftCorner(3 * at.arms, out.arms) = shifts_apart(at.arms);
  out.column.block(at.lag(), out.arms, at.sensors, out.lags) = mean_zero(at.sensors);
  out.column.block(at.rectification(), first, rest, rest).setIdentity();
  out.column.bottomRightCorner(3 * at.sensors, chips) = shifts_apart(at.sensors);
  for (Index i = 0; i < at.sensors; ++i) {  // along the axis and across it
    const Vec3& h = on_board.array.axis(static_cast<int>(i));
    const Eigen::HouseholderQR<Matrix> qr(Eigen::Vector3d(h[0], h[1], h[2]));
    out.column.block<3, 3>(at.row(i), first + at.row(i) - at.rectification()) = Matrix(qr.householderQ());
  }
  Vector known = Vector::Zero(at.size());
  put_known(on_board, at, known);
  out.prior.head(out.arms).setConstant(settings.arm_m);
  out.prior.segment(out.arms, out.lags).setConstant(settings.lag_s);
  out.prior.segment(first, out.rectifications).setConstant(settings.rectification);
  out.prior.segment(first + at.sensors, rest - at.sensors) = known.segment(at.row(0), rest - at.sensors);
  out.prior.tail(chips).setConstant(at.arms < at.sensors ? settings.within_chip_m : kNothing_m);
  return out;
}

/// Normal equations in units of the prior sigmas, without the prior, for residuals in sigmas.
struct Normal {
  Matrix matrix;
  Vector right;
  double square = 0.0;  ///< of what is left
};

Normal normal_of(const ArrayModel& model, const std::vector<Pair>& pairs, const Basis& basis) {
  const Matrix to = basis.column * basis.prior.asDiagonal();
  Normal out{Matrix::Zero(to.cols(), to.cols()), Vector::Zero(to.cols())};
  for (const Pair& pair : pairs) {
    const Vector rest = model.parity(pair);
    const Matrix slope = model.slope(pair) * to;
    out.matrix.selfadjointView<Eigen::Lower>().rankUpdate(slope.transpose());
    out.right += slope.transpose() * rest;
    out.square += rest.squaredNorm();
  }
  out.matrix = out.matrix.selfadjointView<Eigen::Lower>();
  return out;
}

struct Solution {
  Vector z;       ///< in units of the prior sigmas
  Matrix normal;  ///< weighted, without the prior
  double square = 0.0;
};

Solution solve(ArrayModel& model, const std::vector<Pair>& pairs, const Basis& basis) {
  const Index size = basis.prior.size();
  const Matrix identity = Matrix::Identity(size, size), to = basis.column * basis.prior.asDiagonal();
  const double residuals = static_cast<double>(pairs.size()) * static_cast<double>(model.at().sensors - 3);
  Solution out{Vector::Zero(size), Matrix(), 0.0};
  model.set(Vector::Zero(model.at().size()));
  Normal normal = normal_of(model, pairs, basis);
  double weight = residuals / (kOverlap * normal.square);
  for (int step = 0; step < kSteps; ++step) {
    out.z += (weight * normal.matrix + identity).ldlt().solve(weight * normal.right - out.z);
    model.set(to * out.z);
    normal = normal_of(model, pairs, basis);
    weight = residuals / (kOverlap * normal.square);
  }
  out.normal = weight * normal.matrix;
  out.square = normal.square;
  return out;
}

/// What the motion alone says of a group of columns, the others known as they are beforehand.
Matrix told_of(const Matrix& normal, Index first, Index count) {
  const Index size = normal.rows();
  std::vector<Index> group, others;
  for (Index k = 0; k < size; ++k) (k >= first && k < first + count ? group : others).push_back(k);
  const auto n = static_cast<Index>(others.size());
  const Matrix cross = normal(group, others);
  const Matrix known = normal(others, others) + Matrix::Identity(n, n);
  return normal(group, group) - cross * known.ldlt().solve(cross.transpose());
}

/// One group of unknowns: where it stands, what the user states of each, and what counts as open without that.
struct Group {
  Index column, columns, entry, entries;
  std::vector<double> stated;  ///< by entry; negative: not
  double most;
};

/// A column of a group: its estimate, three sigma of it, and the most that the stated bounds leave along it.
struct Direction {
  double found = 0.0, bound = 0.0, stated = 0.0;
  bool all_stated = true;
};

Direction along(const Group& group, const Vector& e) {
  Direction out;
  for (Index k = 0; k < group.entries; ++k) {
    if (std::fabs(e[k]) < 1e-6) continue;
    const double bound = group.stated[static_cast<std::size_t>(k)];
    out.all_stated = out.all_stated && bound >= 0.0;
    out.stated += std::fabs(e[k]) * std::max(bound, 0.0);
  }
  return out;
}

/// Turns the columns of a group so that each is told or open by itself; an open one is known as well as was stated.
/// Returns by entry what share of it is open.
Vector close(const Group& group, const Solution& found, Basis& basis, int& open, bool& holds) {
  Vector share = Vector::Zero(group.entries);
  const double prior = basis.prior[group.column];
  const Eigen::SelfAdjointEigenSolver<Matrix> told(told_of(found.normal, group.column, group.columns));
  const Matrix turned = basis.column.middleCols(group.column, group.columns) * told.eigenvectors();
  const Vector z = told.eigenvectors().transpose() * found.z.segment(group.column, group.columns);
  basis.column.middleCols(group.column, group.columns) = turned;
  std::vector<Direction> all;
  for (Index d = 0; d < group.columns; ++d) {
    all.push_back(along(group, turned.col(d).segment(group.entry, group.entries)));
    all.back().found = std::fabs(prior * z[d]);
    all.back().bound = kBoundSigmas * prior / std::sqrt(std::max(told.eigenvalues()[d], 1e-12));
    // What is stated and does not hold in one direction is not believed in another.
    holds = holds && !(all.back().all_stated && all.back().found > all.back().stated + all.back().bound);
  }
  for (Index d = 0; d < group.columns; ++d) {
    const Direction& one = all[static_cast<std::size_t>(d)];
    const bool stated = holds && one.all_stated && one.found <= one.stated + one.bound / kBoundSigmas;
    if (one.bound <= (stated ? one.stated : group.most)) continue;
    ++open;
    share += turned.col(d).segment(group.entry, group.entries).cwiseAbs2();
    if (stated && one.stated > 0.0) basis.prior[group.column + d] = one.stated / kBoundSigmas;
  }
  return share;
}

std::vector<Group> groups_of(const ArrayOnBoard& on_board, const ArrayModel& model, const Basis& basis,
                             const ArrayFitSettings& settings) {
  const ArrayLayout& at = model.at();
  Group arms{0,
             basis.arms,
             0,
             3 * at.arms,
             std::vector<double>(static_cast<std::size_t>(3 * at.arms), 0.0),
             settings.most_arm_m};
  Group lags{basis.arms, basis.lags, at.lag(), at.sensors, {}, settings.most_lag_s};
  Group rest{basis.arms + basis.lags,    basis.rectifications, at.rectification(), at.sensors, {},
             settings.most_rectification};
  for (Index i = 0; i < at.sensors; ++i) {
    const auto k = static_cast<std::size_t>(i);
    for (std::size_t c = 0; c < 3; ++c) {
      double& bound = arms.stated[static_cast<std::size_t>(at.arm(model.unit(i))) + c];
      bound = on_board.lever_bound_m[k] < 0.0 || bound < 0.0 ? -1.0 : std::max(bound, on_board.lever_bound_m[k]);
    }
    lags.stated.push_back(on_board.lag_bound_s[k]);
    rest.stated.push_back(on_board.rectification_bound[k]);
  }
  return {arms, lags, rest};
}

void read_sensors(const ArrayModel& model, const Matrix& covariance, ArrayFit& out) {
  const ArrayLayout& at = model.at();
  const Vector& x = model.x();
  for (Index i = 0; i < at.sensors; ++i) {
    const Eigen::Vector3d h = model.nominal(i), turn = x.segment<3>(at.row(i)) - h * h.dot(x.segment<3>(at.row(i)));
    const Eigen::Matrix3d c = covariance.block<3, 3>(at.row(i), at.row(i));
    const double along = h.dot(c * h);
    out.scale.push_back({h.dot(x.segment<3>(at.row(i))), std::sqrt(along), false});
    out.axis_rad.push_back({turn.norm(), std::sqrt(std::max(c.trace() - along, 0.0)), false});
    out.bias_mps2.push_back({x[at.bias() + i], std::sqrt(covariance(at.bias() + i, at.bias() + i)), false});
  }
}

ArrayFit fit_of(const ArrayModel& model, const Matrix& covariance, const std::vector<Vector>& open) {
  const ArrayLayout& at = model.at();
  const auto entry = [&](Index k, double share) {
    return Estimate{model.x()[k], std::sqrt(covariance(k, k)), share > kNamed};
  };
  ArrayFit out;
  out.unknown.assign(model.x().data(), model.x().data() + at.size());
  for (Index i = 0; i < at.sensors; ++i) {
    out.arm_m.emplace_back();
    for (Index c = 0; c < 3; ++c) {
      const Index a = at.arm(model.unit(i)) + c, b = at.within_chip(i) + c;
      out.arm_m.back()[static_cast<std::size_t>(c)] = {
          model.x()[a] + model.x()[b], std::sqrt(covariance(a, a) + covariance(b, b) + 2.0 * covariance(a, b)),
          open[0][a] > kNamed};
    }
    out.lag_s.push_back(entry(at.lag() + i, open[1][i]));
    out.rectification.push_back(entry(at.rectification() + i, open[2][i]));
  }
  read_sensors(model, covariance, out);
  for (std::size_t k = 0; k < 9; ++k) out.gyro[k] = entry(at.gyro() + static_cast<Index>(k), 0.0);
  for (std::size_t k = 0; k < 3; ++k)
    out.gyro_bias_radps[k] = entry(at.gyro() + static_cast<Index>(kGyroBias + k), 0.0);
  out.gyro_lag_s = entry(at.gyro() + static_cast<Index>(kGyroLag), 0.0);
  return out;
}

/// rms of a residual in m/s^2, of sensors that have about one noise.
double rms_of(double square, const ArrayOnBoard& on_board, std::size_t pairs) {
  double sum = 0.0;
  for (int i = 0; i < on_board.array.size(); ++i) sum += std::pow(on_board.array.sigma_mps2(i), 2);
  const double n = on_board.array.size();
  return std::sqrt(square / (static_cast<double>(pairs) * (n - 3.0)) * sum / n);
}

double square_of(const ArrayModel& model, const std::vector<Pair>& pairs) {
  double out = 0.0;
  for (const Pair& pair : pairs) out += model.parity(pair).squaredNorm();
  return out;
}

}  // namespace

int pairs_needed(const ArrayOnBoard& on_board) {
  const ArrayModel model(on_board);
  const Index unknowns = basis_of(on_board, model.at(), {}).prior.size(), per_pair = model.at().sensors - 3;
  return static_cast<int>((2 * unknowns + per_pair - 1) / per_pair);
}

CommissionExpected<ArrayFit> fit_array(const ArrayOnBoard& on_board, const ArrayPairs& pairs,
                                       const ArrayFitSettings& settings) {
  ArrayModel model(on_board);
  Basis basis = basis_of(on_board, model.at(), settings);
  const int needed = pairs_needed(on_board), given = pairs.size();
  if (given < needed)
    return tl::unexpected<std::string>("the fit needs " + std::to_string(needed) + " block pairs and has " +
                                       std::to_string(given) + ". Remedy: record longer");
  const double before = square_of(model, pairs.all());
  Solution found = solve(model, pairs.all(), basis);
  std::vector<Vector> open;
  int open_directions = 0;
  std::vector<bool> holds;
  for (const Group& group : groups_of(on_board, model, basis, settings)) {
    bool stated_holds = true;
    open.push_back(close(group, found, basis, open_directions, stated_holds));
    holds.push_back(stated_holds);
  }
  found = solve(model, pairs.all(), basis);
  const Matrix identity = Matrix::Identity(basis.prior.size(), basis.prior.size());
  const Matrix to = basis.column * basis.prior.asDiagonal();
  const Matrix covariance = to * (found.normal + identity).inverse() * to.transpose();
  ArrayFit out = fit_of(model, covariance, open);
  out.stated_arms_hold = holds.front();
  out.parameters = static_cast<int>(model.at().row(0));
  out.gauge = 4;
  out.rank = out.parameters - out.gauge - open_directions;
  out.block_pairs = static_cast<int>(pairs.all().size());
  out.residual_mps2 = rms_of(found.square, on_board, pairs.all().size());
  out.residual_before_mps2 = rms_of(before, on_board, pairs.all().size());
  return out;
}

double residual_of(const ArrayOnBoard& on_board, const ArrayPairs& pairs, const ArrayFit& fit) {
  ArrayModel model(on_board);
  model.set(Eigen::Map<const Vector>(fit.unknown.data(), model.at().size()));
  return rms_of(square_of(model, pairs.all()), on_board, pairs.all().size());
}

}  // namespace commission
}  // namespace PLUMB_ABI
}  // namespace plumb

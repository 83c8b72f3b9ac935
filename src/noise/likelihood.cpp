#include "likelihood.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace plumb {
inline namespace PLUMB_ABI {
namespace noise {
namespace {

using Matrix = Eigen::Matrix<double, kNoiseTerms, kNoiseTerms>;
using Vector = Eigen::Matrix<double, kNoiseTerms, 1>;

constexpr int kMostSteps = 60;
constexpr int kMostHalvings = 12;
/// A step that gains less of the deviance ends the search: a thousandth of what decides an interval is 4e-3.
constexpr double kGain = 1e-6;
/// Bins on either side whose power guesses that of one of them.
constexpr std::size_t kNeighbours = 8;

double power_of(const PowerBin& bin, const Variances& squares) noexcept {
  double out = 0.0;
  for (std::size_t t = 0; t < kNoiseTerms; ++t) out += squares[t] * bin.unit_power[t];
  return out;
}

/// Least of x'Hx - 2 g'x over x >= 0, with x[held] as it is: every set of terms is tried, there are 16 at most.
Variances least_squares(const Matrix& h, const Vector& g, const Held& held) {
  // In units in which the diagonal is 1.
  Vector unit;
  for (int t = 0; t < unit.size(); ++t) unit[t] = h(t, t) > 0.0 ? 1.0 / std::sqrt(h(t, t)) : 0.0;
  const Matrix scaled = unit.asDiagonal() * h * unit.asDiagonal();
  Vector wanted = unit.cwiseProduct(g);
  Vector fixed = Vector::Zero();
  if (held.term && unit[static_cast<int>(*held.term)] > 0.0)
    fixed[static_cast<int>(*held.term)] = held.square / unit[static_cast<int>(*held.term)];
  wanted -= scaled * fixed;
  Vector best = Vector::Zero();
  double least = 0.0;
  for (unsigned set = 1; set < (1U << kNoiseTerms); ++set) {
    if (held.term && ((set >> *held.term) & 1U) != 0U) continue;
    std::array<int, kNoiseTerms> terms{};
    int size = 0;
    for (int t = 0; t < static_cast<int>(kNoiseTerms); ++t) {
      if (((set >> t) & 1U) != 0U) terms[static_cast<std::size_t>(size++)] = t;
    }
    Eigen::MatrixXd part(size, size);
    Eigen::VectorXd aim(size);
    for (int i = 0; i < size; ++i) {
      aim[i] = wanted[terms[static_cast<std::size_t>(i)]];
      for (int j = 0; j < size; ++j)
        part(i, j) = scaled(terms[static_cast<std::size_t>(i)], terms[static_cast<std::size_t>(j)]);
    }
    const Eigen::VectorXd x = part.ldlt().solve(aim);
    if (!x.allFinite() || (x.array() < 0.0).any()) continue;
    const double value = x.dot(part * x) - 2.0 * aim.dot(x);
    if (!(value < least)) continue;
    least = value;
    best.setZero();
    for (int i = 0; i < size; ++i) best[terms[static_cast<std::size_t>(i)]] = x[i];
  }
  best += fixed;
  Variances out{};
  for (std::size_t t = 0; t < kNoiseTerms; ++t) out[t] = best[static_cast<int>(t)] * unit[static_cast<int>(t)];
  if (held.term) out[*held.term] = held.square;
  return out;
}

}  // namespace

Likelihood::Likelihood(std::vector<PowerBin> bins) : bins_(std::move(bins)) {}

Maximum Likelihood::evaluate(const Variances& squares, const Held& held) const {
  Maximum out;
  out.squares = squares;
  double across = 0.0, along = 0.0;
  for (const PowerBin& bin : bins_) {
    const double power = power_of(bin, squares);
    if (!(power > 0.0)) {
      out.deviance = std::numeric_limits<double>::infinity();
      return out;
    }
    out.deviance += bin.count * std::log(power) + bin.power_sum / power;
    across += bin.component * bin.component_of_line / power;
    along += bin.component_of_line * bin.component_of_line / power;
  }
  if (!(along > 0.0)) return out;
  out.slope = held.slope.value_or(across / along);
  // (c - slope r)^2 in place of c^2
  out.deviance += out.slope * (out.slope * along - 2.0 * across);
  out.slope_variance = 1.0 / along;
  out.deviance += std::log(along);
  return out;
}

Variances Likelihood::next(const Maximum& at, const Held& held) const {
  Matrix h = Matrix::Zero();
  Vector g = Vector::Zero();
  for (const PowerBin& bin : bins_) {
    const double line = bin.component_of_line;
    double power_sum = bin.power_sum;
    if (line != 0.0) {
      power_sum += at.slope * line * (at.slope * line - 2.0 * bin.component);
      power_sum += line * line * at.slope_variance;
    }
    const double power = power_of(bin, at.squares);
    const Eigen::Map<const Vector> unit(bin.unit_power.data());
    h.noalias() += (bin.count / (power * power)) * unit * unit.transpose();
    g.noalias() += (power_sum / (power * power)) * unit;
  }
  return least_squares(h, g, held);
}

Maximum Likelihood::first_guess(const Held& held) const {
  // Weighed by the mean power of the neighbours.
  Matrix h = Matrix::Zero();
  Vector g = Vector::Zero();
  for (std::size_t b = 0; b < bins_.size(); ++b) {
    const std::size_t from = b > kNeighbours ? b - kNeighbours : 0, to = std::min(bins_.size(), b + kNeighbours + 1);
    double sum = 0.0, count = 0.0;
    for (std::size_t i = from; i < to; ++i) {
      sum += bins_[i].power_sum;
      count += bins_[i].count;
    }
    const double power = sum / count;
    if (!(power > 0.0)) continue;
    const Eigen::Map<const Vector> unit(bins_[b].unit_power.data());
    h.noalias() += (bins_[b].count / (power * power)) * unit * unit.transpose();
    g.noalias() += (bins_[b].power_sum / (power * power)) * unit;
  }
  return evaluate(least_squares(h, g, held), held);
}

Maximum Likelihood::maximum(const Held& held, const Maximum* start) const {
  Variances from{};
  if (start != nullptr) {
    from = start->squares;
    if (held.term) from[*held.term] = held.square;
  }
  Maximum best = start != nullptr ? evaluate(from, held) : first_guess(held);
  if (!std::isfinite(best.deviance)) best = first_guess(held);
  for (int step = 0; step < kMostSteps && std::isfinite(best.deviance); ++step) {
    const Variances aim = next(best, held);
    double part = 1.0, gain = 0.0;
    for (int halving = 0; halving < kMostHalvings; ++halving) {
      Variances squares{};
      for (std::size_t t = 0; t < kNoiseTerms; ++t) squares[t] = best.squares[t] + part * (aim[t] - best.squares[t]);
      const Maximum tried = evaluate(squares, held);
      gain = best.deviance - tried.deviance;
      part *= 0.5;
      if (gain > 0.0) {
        best = tried;
        break;
      }
    }
    if (!(gain > kGain)) break;
  }
  return best;
}

Precision precision(const std::vector<PowerBin>& bins, const Variances& squares) {
  Matrix h = Matrix::Zero();
  double along = 0.0;
  for (const PowerBin& bin : bins) {
    const double power = power_of(bin, squares);
    if (!(power > 0.0)) continue;
    const Eigen::Map<const Vector> unit(bin.unit_power.data());
    h.noalias() += (0.5 * bin.count / (power * power)) * unit * unit.transpose();
    along += bin.component_of_line * bin.component_of_line / power;
  }
  Precision out;
  Vector scale;
  for (int t = 0; t < scale.size(); ++t) scale[t] = h(t, t) > 0.0 ? 1.0 / std::sqrt(h(t, t)) : 0.0;
  const Matrix scaled = scale.asDiagonal() * h * scale.asDiagonal();
  const Matrix inverse = scaled.ldlt().solve(Matrix::Identity());
  for (std::size_t t = 0; t < kNoiseTerms; ++t) {
    const int i = static_cast<int>(t);
    out.of_squares[t] = inverse(i, i) * scale[i] * scale[i];
  }
  out.of_slope = along > 0.0 ? 1.0 / along : 0.0;
  return out;
}

}  // namespace noise
}  // namespace PLUMB_ABI
}  // namespace plumb

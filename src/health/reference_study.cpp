#include "plumb/health/reference_study.hpp"

#include <cmath>

#include "plumb/core/detail/numbers.hpp"
#include "plumb/numeric/cholesky.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

using numbers::at;

namespace {

constexpr int kParameters = 4;  // kappa G, a
constexpr std::size_t kSquare = 16;

}  // namespace

const char* to_string(NormMismatchKind kind) noexcept {
  switch (kind) {
    case NormMismatchKind::none: return "none";
    case NormMismatchKind::undecided: return "undecided";
    case NormMismatchKind::common_scale: return "common_scale";
    case NormMismatchKind::common_bias: return "common_bias";
  }
  return "?";
}

namespace {

/// None for a bound, read back from a snapshot, whose square vanishes.
double weight_of(double bound_mps2) noexcept {
  const double square = bound_mps2 * bound_mps2;
  return square > 0.0 ? 1.0 / square : 0.0;
}

/// Square of the common bias at most and at least, each of its components known to within `bend`.
struct Extent {
  double most = 0.0, least = 0.0;
};

Extent extent_of(const std::array<double, kParameters>& p, const std::array<double, kParameters>& bend) noexcept {
  Extent out;
  for (int i = 1; i < kParameters; ++i) {
    const double size = std::fabs(p[at(i)]);
    out.most += (size + bend[at(i)]) * (size + bend[at(i)]);
    const double sure = std::fmax(0.0, size - bend[at(i)]);
    out.least += sure * sure;
  }
  return out;
}

}  // namespace

bool ReferenceStudy::add(const Vec3& direction, double length_error_mps2, double bound_mps2, double apart_rad,
                         double noise_mps2) noexcept {
  const double length = norm(direction);
  if (size_ == kMax || !(length > 0.0) || !(bound_mps2 > 0.0)) return false;
  const Vec3 u = scaled(direction, 1.0 / length);
  for (int k = 0; k < size_; ++k) {
    if (!(angle_between_rad(entry_[at(k)].direction(), u) >= apart_rad)) return false;
  }
  Entry& e = entry_[at(size_)];
  for (std::size_t i = 0; i < 3; ++i) e.u[i] = static_cast<float>(u[i]);
  e.off_mps2 = static_cast<float>(length_error_mps2);
  e.bound_mps2 = static_cast<float>(bound_mps2);
  e.noise_mps2 = static_cast<float>(noise_mps2);
  ++size_;
  return true;
}

bool ReferenceStudy::agrees(double length_error_mps2, double bound_mps2) const noexcept {
  for (int k = 0; k < size_; ++k) {
    const Entry& e = entry_[at(k)];
    if (!(std::fabs(e.off() - length_error_mps2) <= e.bound() + bound_mps2)) return false;
  }
  return true;
}

NormMismatch ReferenceStudy::find(double g_mps2, double gravity_bound_mps2, double usable_rad) const noexcept {
  NormMismatch out;
  out.attitudes = size_;
  out.kind = size_ > 0 ? NormMismatchKind::undecided : NormMismatchKind::none;
  if (size_ < kLeast) return out;

  // Least squares with rows (1, u), weighted by the bounds.
  std::array<double, kSquare> m{};
  std::array<double, kParameters> p{};
  const auto row = [this](int k, int j) { return j == 0 ? 1.0 : static_cast<double>(entry_[at(k)].u[at(j - 1)]); };
  for (int k = 0; k < size_; ++k) {
    const double weight = weight_of(entry_[at(k)].bound());
    for (int i = 0; i < kParameters; ++i) {
      p[at(i)] += weight * row(k, i) * entry_[at(k)].off();
      for (int j = 0; j < kParameters; ++j) m[at(kParameters * i + j)] += weight * row(k, i) * row(k, j);
    }
  }
  if (!cholesky_factor(m.data(), kParameters, kParameters)) return out;
  cholesky_solve(m.data(), kParameters, kParameters, p.data());
  cholesky_inverse(m.data(), kParameters, kParameters);
  const Vec3 a = {p[1], p[2], p[3]};

  // How far bounded errors may have bent each parameter, and how well the model explains what was seen. A bias across
  // gravity lengthens the vector by its square over 2 G, which the model omits.
  std::array<double, kParameters> bend{};
  double low = -1e9, high = 1e9, hard_mps2 = 0.0, noise_square = 0.0;
  bool explained = true;
  const double curve = dot(a, a) / (2.0 * g_mps2);
  for (int k = 0; k < size_; ++k) {
    const Entry& e = entry_[at(k)];
    const double bound = e.bound() + curve;
    const double weight = weight_of(e.bound());
    for (int i = 0; i < kParameters; ++i) {
      double gain = 0.0;
      for (int j = 0; j < kParameters; ++j) gain += m[at(kParameters * i + j)] * row(k, j) * weight;
      bend[at(i)] += std::fabs(gain) * bound;
      if (i > 0) continue;
      hard_mps2 += std::fabs(gain) * std::fmax(0.0, bound - e.noise());
      noise_square += gain * gain * e.noise() * e.noise();
    }
    if (!(std::fabs(e.off() - p[0] - dot(a, e.direction())) <= bound)) explained = false;
    low = std::fmax(low, e.off() - e.bound());
    high = std::fmin(high, e.off() + e.bound());
  }
  if (!explained) return out;
  const Extent bias = extent_of(p, bend);
  out.length_mps2 = p[0];
  out.bias_mps2 = a;
  out.turn_rad = angle_with_sine(std::fmin(1.0, std::sqrt(bias.most) / g_mps2));
  const bool one_length = low <= high;
  const bool off = low > 0.0 || high < 0.0;
  if (one_length && off && out.turn_rad <= usable_rad) {
    out.kind = NormMismatchKind::common_scale;
    out.length_bound_mps2 = std::fmin(bend[0], hard_mps2 + std::sqrt(noise_square));
    out.configure_mps2 = g_mps2 + p[0];
  } else if (!one_length && bias.least > 0.0 && std::fabs(p[0]) <= gravity_bound_mps2 + bend[0]) {
    out.kind = NormMismatchKind::common_bias;
  }
  return out;
}

}  // namespace PLUMB_ABI
}  // namespace plumb

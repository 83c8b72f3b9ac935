#include "plumb/health/detail/trend.hpp"

#include <cmath>

namespace plumb {
inline namespace PLUMB_ABI {

using std::size_t;

namespace {

/// Beyond it the numbers mean nothing, and a float would not hold them.
constexpr double kMostRate = 1e30;

}  // namespace

void Trend::add(const SensorArray& array, const BlockEvidence& block, SensorSet used, const Vec3& x_mps2,
                double time_s) noexcept {
  const double keep = 1.0 - 1.0 / kMemoryBlocks;
  const double before = keep * weight_;
  weight_ = before + 1.0;
  const double step = time_s - time_s_;
  const double shift = before > 0.0 ? step / weight_ : step;
  time_square_ = keep * time_square_ + (before > 0.0 ? before / weight_ * step * step : 0.0);
  time_s_ += shift;
  for (int i = 0; i < array.size(); ++i) {
    const auto a = static_cast<size_t>(i);
    const double residual = used.has(i) ? block.mean_mps2[a] - dot(array.axis(i), x_mps2) : 0.0;
    const double off = residual - mean_[a];
    product_[a] = keep * product_[a] + (before > 0.0 ? before / weight_ * step * off : 0.0);
    square_[a] = keep * square_[a] + (before > 0.0 ? before / weight_ * off * off : 0.0);
    mean_[a] += before > 0.0 ? off / weight_ : off;
  }
}

double Trend::rate_mps2_per_h(int i, double check) const noexcept {
  const auto a = static_cast<size_t>(i);
  if (weight_ < kLeastBlocks || !(time_square_ > 0.0) || !(check > 0.05)) return 0.0;
  const double slope = product_[a] / time_square_;
  const double left = square_[a] - slope * product_[a];
  const double sigma = std::sqrt(std::fmax(0.0, left) / (weight_ * time_square_));
  if (!(std::fabs(slope) > kToldSigmas * sigma && sigma > 0.0)) return 0.0;
  return std::fmax(-kMostRate, std::fmin(kMostRate, 3600.0 * slope / check));
}

}  // namespace PLUMB_ABI
}  // namespace plumb

#include "plumb/array/common_bias.hpp"

#include <cmath>
#include <cstddef>
#include <cstdint>

#include "linear.hpp"
#include "plumb/core/detail/numbers.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

using numbers::at;

namespace {

/// Reversing sensors leaves H'H as it is: all that changes with the polarities s is the sum of the s_i h_i.
struct AxisTotals {
  array_detail::Rows axes;
  Mat3 normal{};
};

AxisTotals totals_of(const SensorArray& array) noexcept {
  AxisTotals out;
  for (int i = 0; i < array.size(); ++i) out.axes.add(array.axis(i));
  out.normal = array_detail::inverse_normal(out.axes);
  return out;
}

/// Of a bias s_i on sensor i: n - |V's|^2, the part that looks like a vector.
double hidden_part(const AxisTotals& sums, const Vec3& sum) noexcept { return dot(sum, times(sums.normal, sum)); }

CommonBias effect_of(const AxisTotals& sums, SensorSet reversed) noexcept {
  CommonBias out;
  const int n = sums.axes.count;
  if (n == 0) return out;
  Vec3 sum{};
  for (int i = 0; i < n; ++i) sum = plus(sum, scaled(sums.axes.row[at(i)], reversed.has(i) ? -1.0 : 1.0));
  out.vector_error = times(sums.normal, sum);
  // Not 1 - hidden/n: the root of a difference of equals leaves half of the digits.
  double square = 0.0;
  for (int i = 0; i < n; ++i) {
    const double left = (reversed.has(i) ? -1.0 : 1.0) - dot(sums.axes.row[at(i)], out.vector_error);
    square += left * left;
  }
  out.visibility = std::sqrt(square / n);
  return out;
}

}  // namespace

CommonBias common_bias(const SensorArray& array) noexcept { return effect_of(totals_of(array), SensorSet{}); }

PolarityPlan best_polarity(const SensorArray& array) noexcept {
  const AxisTotals sums = totals_of(array);
  const int n = array.size();
  PolarityPlan out;
  if (n == 0) return out;
  // What is left in the range of H is to be least. Gray code: each pattern differs from the one before in one sensor,
  // and all signs turned round is the same tool upside down, so the first stays.
  constexpr double kBetter = 1e-9;
  Vec3 sum{};
  for (int i = 0; i < n; ++i) sum = plus(sum, sums.axes.row[at(i)]);
  double least = hidden_part(sums, sum);
  SensorSet pattern;
  const std::uint32_t patterns = std::uint32_t{1} << static_cast<unsigned>(n - 1);
  for (std::uint32_t k = 1; k < patterns; ++k) {
    int turned = 1;
    for (std::uint32_t bits = k; (bits & 1U) == 0; bits >>= 1U) ++turned;
    const bool was = pattern.has(turned);
    pattern = was ? pattern.without(turned) : pattern.with(turned);
    sum = plus(sum, scaled(sums.axes.row[at(turned)], was ? 2.0 : -2.0));
    const double hidden = hidden_part(sums, sum);
    const bool fewer = hidden < least + kBetter && pattern.size() < out.reverse.size();
    if (hidden < least - kBetter || fewer) {
      least = hidden < least ? hidden : least;
      out.reverse = pattern;
    }
  }
  out.effect = effect_of(sums, out.reverse);
  return out;
}

}  // namespace PLUMB_ABI
}  // namespace plumb

#include "plumb/detection/combination_mae.hpp"

#include <cmath>

namespace plumb {
inline namespace PLUMB_ABI {

using std::size_t;

std::int32_t to_mae_units(double error_mps2) noexcept {
  const double units = std::fabs(error_mps2) / kMaeUnit_mps2;
  // Written so that a NaN takes the clamp: no comparison with it is true.
  if (units < static_cast<double>(kMaeClamp)) return static_cast<std::int32_t>(std::lround(units));
  return kMaeClamp;
}

void CombinationMae::configure(int triples, int window) noexcept {
  triples_ = triples;
  window_ = window < 1 ? 1 : window > kWindowCapacity ? kWindowCapacity : window;
  clear();
}

void CombinationMae::clear() noexcept {
  ring_.fill(-1);
  sum_.fill(0);
  count_.fill(0);
  head_ = 0;
  clear_all_sensor();
}

void CombinationMae::clear_all_sensor() noexcept {
  all_ring_.fill(-1);
  all_sum_ = 0;
  all_count_ = 0;
}

void CombinationMae::replace(std::int32_t& slot, std::int32_t value, std::int64_t& sum, std::uint16_t& count) noexcept {
  if (slot >= 0) {
    sum -= slot;
    --count;
  }
  slot = value;
  if (value >= 0) {
    sum += value;
    ++count;
  }
}

void CombinationMae::add(const SensorArray& array, const Readings& y_mps2, SensorSet usable,
                         const LeastSquares& in_service, double g_mps2) noexcept {
  const size_t first = row(head_);
  for (int k = 0; k < triples_; ++k) {
    const Triple& triple = array.triple(k);
    std::int32_t value = -1;
    if (usable.has(triple.sensors[0]) && usable.has(triple.sensors[1]) && usable.has(triple.sensors[2])) {
      const double square =
          squared_length(triple.form, y_mps2[triple.sensors[0]], y_mps2[triple.sensors[1]], y_mps2[triple.sensors[2]]);
      value = to_mae_units(std::sqrt(square < 0.0 ? 0.0 : square) - g_mps2);  // a NaN goes through to the clamp
    }
    replace(ring_[first + static_cast<size_t>(k)], value, sum_[static_cast<size_t>(k)], count_[static_cast<size_t>(k)]);
  }
  const std::int32_t all = in_service.valid ? to_mae_units(norm(in_service.estimate(y_mps2)) - g_mps2) : -1;
  replace(all_ring_[static_cast<size_t>(head_)], all, all_sum_, all_count_);
  head_ = head_ + 1 == window_ ? 0 : head_ + 1;
}

std::int64_t CombinationMae::fresh_triple_sum(int k) const noexcept {
  std::int64_t sum = 0;
  for (int slot = 0; slot < window_; ++slot) {
    const std::int32_t v = ring_[row(slot) + static_cast<size_t>(k)];
    if (v >= 0) sum += v;
  }
  return sum;
}

void CombinationMae::rebuild() noexcept {
  sum_.fill(0);
  count_.fill(0);
  all_sum_ = 0;
  all_count_ = 0;
  for (int slot = 0; slot < window_; ++slot) {
    for (int k = 0; k < triples_; ++k) {
      const std::int32_t v = ring_[row(slot) + static_cast<size_t>(k)];
      if (v < 0) continue;
      sum_[static_cast<size_t>(k)] += v;
      ++count_[static_cast<size_t>(k)];
    }
    const std::int32_t all = all_ring_[static_cast<size_t>(slot)];
    if (all < 0) continue;
    all_sum_ += all;
    ++all_count_;
  }
}

}  // namespace PLUMB_ABI
}  // namespace plumb

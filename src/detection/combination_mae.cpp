#include "plumb/detection/combination_mae.hpp"

#include <cmath>
#include <cstring>

namespace plumb {
inline namespace PLUMB_ABI {

using std::size_t;

namespace {

/// A double beyond this has no fraction left: adding and subtracting it rounds to the nearest integer, ties to even, in
/// a way that several triples can go at once.
constexpr double kNoFraction = 4503599627370496.0;
/// Triples side by side, in registers that every x86-64 and every ARMv8 has (vectors of GCC and Clang; elsewhere the
/// compiler takes them apart). Lane by lane the same operations in the same order: the same bits.
using Two = double __attribute__((vector_size(16)));
using TwoInts = std::int32_t __attribute__((vector_size(8)));
using FourInts = std::int32_t __attribute__((vector_size(16)));
constexpr int kAtOnce = 4;
static_assert(kTripleCapacity % kAtOnce == 0, "the last triples of a full array are not read beyond its end");

template <class V, class T>
V load(const T* from) noexcept {
  V out;
  std::memcpy(&out, from, sizeof out);
  return out;
}
template <class V, class T>
void store(const V& v, T* to) noexcept {
  std::memcpy(to, &v, sizeof v);
}

constexpr Two both(double v) noexcept { return Two{v, v}; }

/// Written so that a NaN takes the clamp: no comparison with it is true.
inline Two whole_units(Two error_mps2) noexcept {
  const Two units = (error_mps2 < both(0.0) ? -error_mps2 : error_mps2) / both(kMaeUnit_mps2);
  const Two held = units < both(static_cast<double>(kMaeClamp)) ? units : both(static_cast<double>(kMaeClamp));
  return (held + both(kNoFraction)) - both(kNoFraction);
}

/// Errors of two triples in units. Beyond the last triple of the array the forms are zero, and the sensors the first.
inline TwoInts errors_of(const SensorArray& array, const Readings& y, int first, double g_mps2) noexcept {
  const auto& s = array.triple(first).sensors;
  const auto& r = array.triple(first + 1).sensors;
  const Two a = {y[s[0]], y[r[0]]}, b = {y[s[1]], y[r[1]]}, c = {y[s[2]], y[r[2]]};
  const auto q = [&array, first](size_t k) { return load<Two>(array.form_coefficients(k) + first); };
  const Two square = squared_length(q(0), q(1), q(2), q(3), q(4), q(5), a, b, c);
  const Two kept = square < both(0.0) ? both(0.0) : square;  // a NaN goes through to the clamp
  const Two length = {std::sqrt(kept[0]), std::sqrt(kept[1])};
  return __builtin_convertvector(whole_units(length - both(g_mps2)), TwoInts);
}

}  // namespace

std::int32_t to_mae_units(double error_mps2) noexcept {
  return static_cast<std::int32_t>(whole_units(both(error_mps2))[0]);
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

void CombinationMae::add(const SensorArray& array, const Readings& y_mps2, SensorSet usable, const Vec3* in_service,
                         double g_mps2) noexcept {
  const size_t row_begin = row(head_);
  const bool all_usable = usable.contains(array.all());
  for (int first = 0; first < triples_; first += kAtOnce) {
    const TwoInts low = errors_of(array, y_mps2, first, g_mps2), high = errors_of(array, y_mps2, first + 2, g_mps2);
    const FourInts now = __builtin_shufflevector(low, high, 0, 1, 2, 3);
    const auto k = static_cast<size_t>(first);
    const size_t slot = row_begin + k;
    const bool four = first + kAtOnce <= triples_;
    const FourInts old = four ? load<FourInts>(&ring_[slot]) : FourInts{-1, -1, -1, -1};
    if (all_usable && (old[0] | old[1] | old[2] | old[3]) >= 0) {
      store(now, &ring_[slot]);
      const FourInts more = now - old;
      for (size_t t = 0; t < kAtOnce; ++t) sum_[k + t] += more[t];
      continue;
    }
    for (int t = 0; t < kAtOnce && first + t < triples_; ++t) {
      const auto a = static_cast<size_t>(t);
      const bool present = usable.contains(array.triple(first + t).set());
      replace(ring_[slot + a], present ? now[t] : -1, sum_[k + a], count_[k + a]);
    }
  }
  const std::int32_t all = in_service != nullptr ? to_mae_units(norm(*in_service) - g_mps2) : -1;
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

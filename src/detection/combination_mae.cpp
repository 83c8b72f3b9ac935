#include "plumb/detection/combination_mae.hpp"

#include <cmath>
#include <cstring>

#include "plumb/detection/near_lengths.hpp"

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define PLUMB_SANITIZED
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer) || __has_feature(memory_sanitizer)
#define PLUMB_SANITIZED
#endif
#endif

namespace plumb {
inline namespace PLUMB_ABI {

using std::size_t;

namespace {

/// A double beyond this has no fraction left: adding and subtracting it rounds to the nearest integer, ties to even, in
/// a way that several triples can go at once.
constexpr double kNoFraction = 4503599627370496.0;
/// Four triples side by side (vectors of GCC and Clang). Lane by lane the same operations in the same order as for one
/// triple alone, and none of them fused: the same bits, however wide the registers are.
using Four = double __attribute__((vector_size(32)));
using FourInts = std::int32_t __attribute__((vector_size(16)));
constexpr int kAtOnce = 4;
/// A processor of 32 bits has no registers for them: the compiler would take them apart again, by way of the stack.
constexpr bool kVectors = sizeof(void*) >= 8;

/// Under Linux on x86-64 a function may be compiled twice, and the loader takes the one that fits the processor.
/// Everywhere else, and where a sanitizer would be asked before it has started, there is one.
#if defined(__x86_64__) && defined(__gnu_linux__) && !defined(PLUMB_SANITIZED)
#define PLUMB_FOR_WIDE_REGISTERS __attribute__((target_clones("avx2", "default")))
#else
#define PLUMB_FOR_WIDE_REGISTERS
#endif

/// Written so that a NaN takes the clamp: no comparison with it is true.
inline double whole_units(double error_mps2) noexcept {
  const double units = (error_mps2 < 0.0 ? -error_mps2 : error_mps2) * kMaeUnits_per_mps2;
  const double held = units < static_cast<double>(kMaeClamp) ? units : static_cast<double>(kMaeClamp);
  return (held + kNoFraction) - kNoFraction;
}

/// A sensor of a triple as an index that no damage to the triple leads out of the readings.
constexpr size_t index_of(std::uint8_t sensor) noexcept {
  if constexpr ((kCapacity & (kCapacity - 1)) == 0) return sensor & static_cast<unsigned>(kCapacity - 1);
  return sensor < kCapacity ? sensor : 0;
}

/// Error of one triple in units.
inline std::int32_t error_of(const SensorArray& array, const Readings& y, int triple, double g_mps2) noexcept {
  const auto& s = array.triple(triple).sensors;
  const auto q = [&array, triple](size_t k) { return array.form_coefficients(k)[triple]; };
  const double square =
      squared_length(q(0), q(1), q(2), q(3), q(4), q(5), y[index_of(s[0])], y[index_of(s[1])], y[index_of(s[2])]);
  const double kept = square < 0.0 ? 0.0 : square;  // a NaN goes through to the clamp
  return static_cast<std::int32_t>(whole_units(std::sqrt(kept) - g_mps2));
}

}  // namespace

std::int32_t to_mae_units(double error_mps2) noexcept { return static_cast<std::int32_t>(whole_units(error_mps2)); }

void CombinationMae::configure(int triples, int window) noexcept {
  triples_ = static_cast<std::uint16_t>(triples);
  window_ = static_cast<std::uint16_t>(window < 1 ? 1 : window > kWindowCapacity ? kWindowCapacity : window);
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

/// Four triples at a time, as long as every one of them has a value in this slot before; returns the first triple that
/// is not done. `error_of` written out: a vector must not be handed to a function that is compiled for narrower
/// registers.
PLUMB_FOR_WIDE_REGISTERS
int CombinationMae::replace_fours(const SensorArray& array, const Readings& y_mps2, int first, double g_mps2) noexcept {
  constexpr auto kClamp = static_cast<double>(kMaeClamp);
  const Four none = {0.0, 0.0, 0.0, 0.0};
  const Four most = {kClamp, kClamp, kClamp, kClamp};
  for (; first + kAtOnce <= triples_; first += kAtOnce) {
    const auto k = static_cast<size_t>(first);
    std::int32_t* const slot = &ring_[row(head_) + k];
    FourInts old;
    std::memcpy(&old, slot, sizeof old);
    if ((old[0] | old[1] | old[2] | old[3]) < 0) return first;
    const auto& s = array.triple(first).sensors;
    const auto& t = array.triple(first + 1).sensors;
    const auto& u = array.triple(first + 2).sensors;
    const auto& v = array.triple(first + 3).sensors;
    const Four a = {y_mps2[index_of(s[0])], y_mps2[index_of(t[0])], y_mps2[index_of(u[0])], y_mps2[index_of(v[0])]};
    const Four b = {y_mps2[index_of(s[1])], y_mps2[index_of(t[1])], y_mps2[index_of(u[1])], y_mps2[index_of(v[1])]};
    const Four c = {y_mps2[index_of(s[2])], y_mps2[index_of(t[2])], y_mps2[index_of(u[2])], y_mps2[index_of(v[2])]};
    // Not in a loop, for which the compiler would keep them on the stack.
    Four q0, q1, q2, q3, q4, q5;
    std::memcpy(&q0, array.form_coefficients(0) + first, sizeof q0);
    std::memcpy(&q1, array.form_coefficients(1) + first, sizeof q1);
    std::memcpy(&q2, array.form_coefficients(2) + first, sizeof q2);
    std::memcpy(&q3, array.form_coefficients(3) + first, sizeof q3);
    std::memcpy(&q4, array.form_coefficients(4) + first, sizeof q4);
    std::memcpy(&q5, array.form_coefficients(5) + first, sizeof q5);
    const Four square = q0 * a * a + q1 * b * b + q2 * c * c + q3 * a * b + q4 * a * c + q5 * b * c;
    const Four kept = square < none ? none : square;
    const Four length = {std::sqrt(kept[0]), std::sqrt(kept[1]), std::sqrt(kept[2]), std::sqrt(kept[3])};
    const Four error = length - g_mps2;
    const Four units = (error < none ? -error : error) * kMaeUnits_per_mps2;
    const Four held = units < most ? units : most;
    const FourInts now = __builtin_convertvector((held + kNoFraction) - kNoFraction, FourInts);
    std::memcpy(slot, &now, sizeof now);
    const FourInts more = now - old;
    for (size_t i = 0; i < kAtOnce; ++i) sum_[k + i] += more[i];
  }
  return first;
}

void CombinationMae::add(const SensorArray& array, const Readings& y_mps2, SensorSet usable, const Vec3* in_service,
                         double g_mps2) noexcept {
  const bool all_usable = usable.contains(array.all());
  int first = 0;
  while (first < triples_) {
    if (kVectors && all_usable) first = replace_fours(array, y_mps2, first, g_mps2);
    // Four that do not all have a value there yet, the rest behind the last four, or all where a sensor is not usable.
    const int end = kVectors && all_usable && first + kAtOnce <= triples_ ? first + kAtOnce : triples_;
    for (; first < end; ++first) {
      const auto k = static_cast<size_t>(first);
      const bool present = all_usable || usable.contains(array.triple(first).set());
      const std::int32_t now = present ? error_of(array, y_mps2, first, g_mps2) : -1;
      replace(ring_[row(head_) + k], now, sum_[k], count_[k]);
    }
  }
  const std::int32_t all = in_service != nullptr ? to_mae_units(norm(*in_service) - g_mps2) : -1;
  replace(all_ring_[static_cast<size_t>(head_)], all, all_sum_, all_count_);
  head_ = head_ + 1 == window_ ? 0 : head_ + 1;
}

#if PLUMB_SINGLE
void CombinationMae::add(const SensorArray& array, const Readings& y_mps2, SensorSet usable, const NearLengths& lengths,
                         const Differences& d_mps2, std::int32_t all_units, double g_mps2) noexcept {
  const SensorSet near = NearLengths::near(d_mps2, usable);
  const bool all_near = near.contains(array.all());
  for (int k = 0; k < triples_; ++k) {
    const auto a = static_cast<size_t>(k);
    std::int32_t now = -1;
    if (all_near || near.contains(array.triple(k).set())) now = lengths.triple_units(array, k, d_mps2);
    if (now < 0 && usable.contains(array.triple(k).set())) now = error_of(array, y_mps2, k, g_mps2);
    replace(ring_[row(head_) + a], now, sum_[a], count_[a]);
  }
  replace(all_ring_[static_cast<size_t>(head_)], all_units, all_sum_, all_count_);
  head_ = head_ + 1 == window_ ? 0 : head_ + 1;
}
#endif

std::int64_t CombinationMae::fresh_triple_sum(int k) const noexcept {
  std::int64_t sum = 0;
  for (int slot = 0; slot < window_; ++slot) {
    const std::int32_t v = ring_[row(slot) + static_cast<size_t>(k)];
    if (v >= 0) sum += v;
  }
  return sum;
}

bool CombinationMae::holds() const noexcept {
  // An absent value is -1, all bits set: the words of a ring, as numbers without sign, add up to its sums and to that
  // for each absent one. One flipped bit, in a ring, in a sum or in a count, and they do not.
  constexpr std::uint64_t kAbsent = 0xFFFF'FFFFU;
  const auto words_of = [](const std::int32_t* v, size_t count) noexcept {
    std::uint64_t sum = 0, odd = 0;
    for (; count >= 2; count -= 2, v += 2) {
      std::uint64_t both = 0;
      std::memcpy(&both, v, sizeof both);
      sum += both & kAbsent;
      odd += both >> 32U;
    }
    return sum + odd + (count != 0 ? static_cast<std::uint32_t>(*v) : 0U);
  };
  const size_t window = window_, slots = window * triples_;
  std::uint64_t sum = 0, present = 0;
  for (size_t k = 0; k < triples_; ++k) {
    sum += static_cast<std::uint64_t>(sum_[k]);
    present += count_[k];
  }
  const std::uint64_t all = words_of(all_ring_.data(), window);
  return words_of(ring_.data(), slots) == sum + (slots - present) * kAbsent &&
         all == static_cast<std::uint64_t>(all_sum_) + (window - all_count_) * kAbsent;
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

// The kernel of src/detection/lanes.cpp with Google Highway, operation by operation. Highway includes this file once
// for every processor that it compiles for. With HWY_COMPILE_ONLY_STATIC it compiles for the processor of the
// compiler's flags alone.
#include "lanes_highway.hpp"

#include <array>
#include <cstddef>
#include <type_traits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lanes_highway.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#ifndef PLUMB_BENCH_LANES_HIGHWAY
#define PLUMB_BENCH_LANES_HIGHWAY
namespace plumb_bench {
inline namespace PLUMB_ABI {
namespace highway {

using plumb::kCapacity;
using plumb::kTripleCapacity;
using plumb::SensorArray;
using plumb::TripleRange;
using std::size_t;

using Member = std::conditional_t<kCapacity <= 8, std::int64_t, std::uint8_t>;
struct Members {
  std::array<std::array<Member, kTripleCapacity>, 3> sensor{};
  constexpr Members() noexcept {
    size_t next = 0;
    for (Member i = 0; i < kCapacity; ++i) {
      for (auto j = static_cast<Member>(i + 1); j < kCapacity; ++j) {
        for (auto k = static_cast<Member>(j + 1); k < kCapacity; ++k) {
          sensor[0][next] = i;
          sensor[1][next] = j;
          sensor[2][next++] = k;
        }
      }
    }
  }
};
constexpr Members kMembers;
constexpr double kUnitsLast_mps2 = 0x1p30;
constexpr double kMost_mps2 = plumb::kMaeClamp * plumb::kMaeUnit_mps2;

}  // namespace highway
}  // namespace PLUMB_ABI
}  // namespace plumb_bench
#endif

HWY_BEFORE_NAMESPACE();
namespace plumb_bench {
inline namespace PLUMB_ABI {
namespace highway {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// The reading of one member of as many triples as there are lanes. Faster with AVX2 than GatherIndex.
template <class D>
HWY_INLINE hn::Vec<D> readings_of(D d, const double* y, const Member* s) {
  constexpr size_t kLanes = hn::MaxLanes(D());
  if constexpr (kLanes == 1) return hn::Set(d, y[s[0]]);
#if HWY_TARGET != HWY_SCALAR
  if constexpr (kLanes == 2) return hn::InterleaveLower(d, hn::Set(d, y[s[0]]), hn::Set(d, y[s[1]]));
#endif
#if HWY_TARGET <= HWY_AVX2
  if constexpr (kLanes == 4) {
    const hn::Half<D> half;
    return hn::Combine(d, readings_of(half, y, s + 2), readings_of(half, y, s));
  }
#endif
#if HWY_TARGET <= HWY_AVX3
  const hn::RebindToSigned<D> wide;
  if constexpr (kLanes == 8 && kCapacity <= 8) {
    return hn::TableLookupLanes(hn::LoadU(d, y), hn::IndicesFromVec(d, hn::LoadU(wide, s)));
  } else if constexpr (kLanes == 8) {
    const auto at = hn::PromoteTo(hn::Rebind<std::int32_t, D>(), hn::LoadU(hn::Rebind<std::uint8_t, D>(), s));
    return hn::GatherIndex(d, y, hn::PromoteTo(wide, at));
  }
#endif
}

template <class D>
HWY_INLINE hn::Vec<D> squares_of(D d, const SensorArray& array, const double* y, size_t members, size_t k) {
  const size_t m = kTripleCapacity == hn::MaxLanes(D()) ? 0 : members + k;
  const auto a = readings_of(d, y, &kMembers.sensor[0][m]);
  const auto b = readings_of(d, y, &kMembers.sensor[1][m]);
  const auto c = readings_of(d, y, &kMembers.sensor[2][m]);
  const auto term = [&](size_t i, auto s, auto t)
                        HWY_ATTR { return hn::Mul(hn::Mul(hn::LoadU(d, array.form_coefficients(i) + k), s), t); };
  auto sum = hn::Add(hn::Add(term(0, a, a), term(1, b, b)), term(2, c, c));
  sum = hn::Add(hn::Add(sum, term(3, a, b)), term(4, a, c));
  return hn::Add(sum, term(5, b, c));
}

/// Max and Min hand a NaN on as lanes.cpp does on x86-64 with vectors only: Highway leaves that to the processor.
template <class D>
HWY_INLINE bool replace(D d, hn::Vec<D> square, double g_mps2, std::int32_t* slots, std::int64_t* sums) {
  const hn::RebindToSigned<D> signed64;
  const hn::RebindToUnsigned<D> unsigned64;
  const hn::Rebind<std::int32_t, D> signed32;
  const hn::Rebind<std::uint32_t, D> unsigned32;
  const auto old = hn::LoadU(signed32, slots);
  if (!hn::AllFalse(signed32, hn::Lt(old, hn::Zero(signed32)))) return false;
  const auto length = hn::Sqrt(hn::Max(hn::Zero(d), square));
  const auto error = hn::Abs(hn::Sub(length, hn::Set(d, g_mps2)));
  const auto held = hn::Add(hn::Min(error, hn::Set(d, kMost_mps2)), hn::Set(d, kUnitsLast_mps2));
  const auto now = hn::BitCast(signed32, hn::TruncateTo(unsigned32, hn::BitCast(unsigned64, held)));
  hn::StoreU(now, signed32, slots);
  const auto sum = hn::LoadU(signed64, sums);
  if constexpr (hn::MaxLanes(D()) == 2) {  // without AVX2 cheaper than to widen what has a sign
    const auto before = hn::Or(hn::PromoteTo(unsigned64, hn::BitCast(unsigned32, old)),
                               hn::BitCast(unsigned64, hn::Set(d, kUnitsLast_mps2)));
    const auto more = hn::Sub(hn::BitCast(signed64, held), hn::BitCast(signed64, before));
    hn::StoreU(hn::Add(sum, more), signed64, sums);
  } else {
    hn::StoreU(hn::Add(sum, hn::PromoteTo(signed64, hn::Sub(now, old))), signed64, sums);
  }
  return true;
}

template <size_t kMost>
HWY_INLINE int replace_all(const SensorArray& array, const double* y, double g_mps2, std::int32_t* slots,
                           std::int64_t* sums, TripleRange range) {
  const hn::CappedTag<double, kMost> d;
  constexpr size_t n = hn::MaxLanes(hn::CappedTag<double, kMost>());
  const auto members = static_cast<size_t>(kTripleCapacity - range.end), end = static_cast<size_t>(range.end);
  auto k = static_cast<size_t>(range.first);
  if (k + n > end) return range.first;
  auto square = squares_of(d, array, y, members, k);
  if (k + 2 * n <= end) {
    auto next = squares_of(d, array, y, members, k + n);
    for (; k + 3 * n <= end; k += n) {
      const auto after = squares_of(d, array, y, members, k + 2 * n);
      if (!replace(d, square, g_mps2, slots + k, sums + k)) return static_cast<int>(k);
      square = next;
      next = after;
    }
    if (!replace(d, square, g_mps2, slots + k, sums + k)) return static_cast<int>(k);
    square = next;
    k += n;
  }
  return static_cast<int>(replace(d, square, g_mps2, slots + k, sums + k) ? k + n : k);
}

int replace_here(const SensorArray& array, const double* y_mps2, double g_mps2, std::int32_t* slots, std::int64_t* sums,
                 TripleRange range) {
  constexpr size_t kMost = hn::MaxLanes(hn::CappedTag<double, 8>());
  if constexpr (kMost == 8 && kTripleCapacity >= 8)
    range.first = replace_all<8>(array, y_mps2, g_mps2, slots, sums, range);
  if constexpr (kMost >= 4) range.first = replace_all<4>(array, y_mps2, g_mps2, slots, sums, range);
  return replace_all<2>(array, y_mps2, g_mps2, slots, sums, range);
}

}  // namespace HWY_NAMESPACE
}  // namespace highway
}  // namespace PLUMB_ABI
}  // namespace plumb_bench
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace plumb_bench {
inline namespace PLUMB_ABI {
namespace highway {

HWY_EXPORT(replace_here);

}  // namespace highway

int replace_by_highway(const plumb::SensorArray& array, const double* y_mps2, double g_mps2, std::int32_t* slots,
                       std::int64_t* sums, plumb::TripleRange range) {
  using namespace highway;
  return HWY_DYNAMIC_DISPATCH(replace_here)(array, y_mps2, g_mps2, slots, sums, range);
}

}  // namespace PLUMB_ABI
}  // namespace plumb_bench
#endif

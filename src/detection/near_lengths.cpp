#include "plumb/detection/detail/near_lengths.hpp"

#if PLUMB_SINGLE

#include <cmath>

#include "plumb/core/detail/storage_map.hpp"
#include "plumb/detection/combination_mae.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

using std::size_t;

namespace {

/// Lengths outside are left to double: in range the sums of units fit 32 bits, and the root is that of a number well
/// above its rounding.
constexpr double kLeastLength_mps2 = 4.0, kMostLength_mps2 = 100.0;
/// Largest change of a square, as a part of it: the square stays above a quarter of what it was.
constexpr double kMostLengthChange = 0.75;
/// From here on a double, or a float, has no fraction: adding and subtracting it rounds to the nearest integer.
constexpr double kSignedNoFraction = 6755399441055744.0;  // with room for a sign: 1.5 * 2^52
constexpr float kNoFractionSingle = 8388608.0F;
constexpr auto kUnits_per_mps2 = static_cast<float>(kMaeUnits_per_mps2);

}  // namespace

void NearLength::take(double square_m2ps4, double g_mps2) noexcept {
  *this = NearLength{};
  const double length = std::sqrt(square_m2ps4);
  if (!(length >= kLeastLength_mps2 && length <= kMostLength_mps2)) return;  // a NaN is not
  const double error_units = (length - g_mps2) * kMaeUnits_per_mps2;
  const double whole = (error_units + kSignedNoFraction) - kSignedNoFraction;
  square_m2ps4_ = static_cast<float>(square_m2ps4);
  length_mps2_ = static_cast<float>(length);
  reach_m2ps4_ = static_cast<float>(kMostLengthChange * square_m2ps4);
  fraction_units_ = static_cast<float>(error_units - whole);
  whole_units_ = static_cast<std::int32_t>(whole);
}

std::int32_t NearLength::units(float change_m2ps4) const noexcept {
  if (!(std::fabs(change_m2ps4) <= reach_m2ps4_)) return -1;
  // The difference of two roots without the cancellation.
  const float change_mps2 = change_m2ps4 / (length_mps2_ + std::sqrt(square_m2ps4_ + change_m2ps4));
  const float units = change_mps2 * kUnits_per_mps2 + fraction_units_;
  const float size = std::fabs(units);
  const float rounded = size < kNoFractionSingle ? (size + kNoFractionSingle) - kNoFractionSingle : size;
  const auto moved = static_cast<std::int32_t>(rounded);
  const std::int32_t sum = units < 0.0F ? whole_units_ - moved : whole_units_ + moved;
  return sum < 0 ? -sum : sum;
}

void NearLengths::take(const SensorArray& array, const LeastSquares& map, const Mat3& frame,
                       const BlockAccumulator& block, double g_mps2) noexcept {
  *this = NearLengths{};
  known_ = block.seen();
  const Readings& y = block.origin_mps2();
  for (int k = 0; k < array.triple_count(); ++k) {
    const Triple& t = array.triple(k);
    if (!known_.contains(t.set())) continue;
    const TripleForm q = array.form(k);
    const double a = y[t.sensors[0]], b = y[t.sensors[1]], c = y[t.sensors[2]];
    Form& form = triple_[static_cast<size_t>(k)];
    for (size_t i = 0; i < q.size(); ++i) form.square[i] = static_cast<float>(q[i]);
    form.slope = {static_cast<float>(2.0 * q[0] * a + q[3] * b + q[4] * c),
                  static_cast<float>(2.0 * q[1] * b + q[3] * a + q[5] * c),
                  static_cast<float>(2.0 * q[2] * c + q[4] * a + q[5] * b)};
    form.length.take(squared_length(q, a, b, c), g_mps2);
  }
  if (map.valid && known_.contains(map.used)) {
    const Vec3 x = map.estimate(y);
    for (size_t i = 0; i < column_.size(); ++i) {
      for (size_t axis = 0; axis < 3; ++axis) column_[i][axis] = static_cast<float>(map.column[i][axis]);
    }
    for (size_t k = 0; k < frame_.size(); ++k) frame_[k] = static_cast<float>(frame[k]);
    for (size_t axis = 0; axis < 3; ++axis) twice_[axis] = static_cast<float>(2.0 * x[axis]);
    length_.take(dot(x, x), g_mps2);
    framed_mps2_ = times(frame, x);
  }
  check_ = check();
}

SensorSet NearLengths::near(const Differences& d, SensorSet usable) noexcept {
  SensorSet out = usable;
  std::uint32_t left = usable.bits;
  for (int i = 0; left != 0 && i < kCapacity; ++i, left >>= 1U) {
    if (!(std::fabs(d[static_cast<size_t>(i)]) <= kNearReach_mps2)) out = out.without(i);
  }
  return out;
}

std::int32_t NearLengths::triple_units(const SensorArray& array, int k, const Differences& d) const noexcept {
  const auto& s = array.triple(k).sensors;
  const Form& f = triple_[static_cast<size_t>(k)];
  const std::array<float, 6>& q = f.square;
  const float a = d[s[0] % d.size()], b = d[s[1] % d.size()], c = d[s[2] % d.size()];
  const float change = near_change(f.slope, q, a, b, c);
  return f.length.units(change);
}

NearLengths::Estimate NearLengths::estimate(const Differences& d, SensorSet in_service) const noexcept {
  std::array<float, 3> x{};
  std::uint32_t left = in_service.bits;
  for (size_t i = 0; left != 0 && i < column_.size(); ++i, left >>= 1U) {
    if ((left & 1U) == 0) continue;
    for (size_t axis = 0; axis < 3; ++axis) x[axis] += column_[i][axis] * d[i];
  }
  Estimate out;
  out.units = length_.units(x[0] * (twice_[0] + x[0]) + x[1] * (twice_[1] + x[1]) + x[2] * (twice_[2] + x[2]));
  for (size_t row = 0; row < 3; ++row) {
    const float moved = frame_[3 * row] * x[0] + frame_[3 * row + 1] * x[1] + frame_[3 * row + 2] * x[2];
    out.framed_mps2[row] = framed_mps2_[row] + static_cast<double>(moved);
  }
  return out;
}

std::uint64_t NearLengths::check() const noexcept {
  constexpr size_t kSummed = sizeof triple_ + sizeof column_ + sizeof frame_ + sizeof twice_ + sizeof length_ +
                             sizeof known_ + sizeof framed_mps2_;
  static_assert(kSummed + sizeof check_ == sizeof(NearLengths), "no padding, and the sum behind all that it is over");
  return sum_of_bytes(static_cast<const unsigned char*>(static_cast<const void*>(this)), kSummed);
}

bool NearLengths::holds() const noexcept {
  return known_.empty() || check_ == check();  // forgotten: it will be taken before it is used
}

}  // namespace PLUMB_ABI
}  // namespace plumb

#endif

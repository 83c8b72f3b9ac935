#include "plumb/motion/motion_sets.hpp"

#include <cmath>

#include "plumb/numeric/symmetric_eigen.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace {

/// Null vector of the axes by cofactors, not yet of unit length: of four their volumes, of three their areas in the
/// plane that they are nearest to, of two the sign that turns one against the other.
std::array<double, 4> null_of(const SensorArray& array, const MotionSet& set) noexcept {
  const auto h = [&](std::size_t k) -> const Vec3& { return array.axis(set.sensor[k]); };
  if (set.size == 2) return {1.0, dot(h(0), h(1)) < 0.0 ? 1.0 : -1.0, 0.0, 0.0};
  if (set.size == 3) {
    const std::array<Vec3, 3> area{cross(h(1), h(2)), cross(h(2), h(0)), cross(h(0), h(1))};
    std::size_t largest = 0;
    for (std::size_t k = 1; k < 3; ++k) largest = norm(area[k]) > norm(area[largest]) ? k : largest;
    return {dot(area[0], area[largest]), dot(area[1], area[largest]), dot(area[2], area[largest]), 0.0};
  }
  return {det3(h(1), h(2), h(3)), -det3(h(0), h(2), h(3)), det3(h(0), h(1), h(3)), -det3(h(0), h(1), h(2))};
}

/// Smallest singular value of some axes; 0 where it is not to be had.
double smallest_singular(const SensorArray& array, SensorSet set) noexcept {
  std::array<double, 9> gram{}, vectors{};
  std::array<double, 3> values{};
  for (int i = 0; i < array.size(); ++i) {
    if (!set.has(i)) continue;
    const Vec3& h = array.axis(i);
    for (std::size_t a = 0; a < 3; ++a) {
      for (std::size_t b = 0; b < 3; ++b) gram[3 * a + b] += h[a] * h[b];
    }
  }
  if (!symmetric_eigen(gram.data(), 3, 3, values.data(), vectors.data()) || !(values[0] > 1e-4)) return 0.0;
  return std::sqrt(values[0]);
}

SensorSet members_of(const MotionSet& set) noexcept {
  SensorSet out;
  for (std::size_t k = 0; k < set.size; ++k) out = out.with(set.sensor[k]);
  return out;
}

}  // namespace

MotionSets::MotionSets(const SensorArray& array) noexcept {
  const int n = array.size() < kMotionCapacity ? array.size() : kMotionCapacity;
  for (int size = 2; size <= 4 && size <= n; ++size) {
    const SensorSet all = SensorSet::first(n);
    for (SensorSet s = SensorSet::first(size); all.contains(s); s = next_of_same_size(s)) add(array, s);
  }
}

bool MotionSets::any_within(SensorSet sensors) const noexcept {
  for (int k = 0; k < size_; ++k) {
    if (sensors.contains((*this)[k].all)) return true;
  }
  return false;
}

bool MotionSets::has_subset_of(SensorSet members) const noexcept {
  for (int k = 0; k < size_; ++k) {
    if (members.contains(members_of((*this)[k]))) return true;
  }
  return false;
}

void MotionSets::add(const SensorArray& array, SensorSet members) noexcept {
  if (size_ == kMotionSets || has_subset_of(members)) return;
  MotionSet set;
  for (SensorSet rest = members; !rest.empty(); rest = rest.without(rest.lowest())) {
    set.sensor[set.size++] = static_cast<std::uint8_t>(rest.lowest());
  }
  set.null = null_of(array, set);
  double square = 0.0;
  for (const double v : set.null) square += v * v;
  if (!(square > 1e-12)) return;
  for (double& v : set.null) v /= std::sqrt(square);
  for (std::size_t k = 0; k < set.size; ++k) {
    set.rest = plus(set.rest, scaled(array.axis(set.sensor[k]), set.null[k]));
  }
  if (norm(set.rest) > kMotionRest) return;
  set.all = set.size == 4 ? members : array.units().whole(members);
  set.least_singular = smallest_singular(array, set.all);
  if (set.least_singular == 0.0) set.all = members;
  if (set.least_singular == 0.0) {
    largest_blind_rest_ = std::fmax(largest_blind_rest_, norm(set.rest));
  } else {
    largest_gain_ = std::fmax(largest_gain_, norm(set.rest) / set.least_singular);
  }
  sets_[static_cast<std::size_t>(size_++)] = set;
}

}  // namespace PLUMB_ABI
}  // namespace plumb

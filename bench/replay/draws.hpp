// Random choices of one case, from the streams of the scenario room.
#pragma once

#include <cstddef>
#include <cstdint>

#include "plumb/core/vec3.hpp"
#include "plumb/scenario/random.hpp"

namespace plumb_replay {
inline namespace PLUMB_ABI {

class Draws {
 public:
  Draws(std::uint64_t seed, std::uint64_t number)
      : stream_(plumb::scenario::derive_seed(seed, number), plumb::scenario::Purpose::test) {}

  /// 0 .. count - 1.
  int below(int count) { return static_cast<int>(stream_.bits(next_++) % static_cast<std::uint64_t>(count)); }
  bool one_in(int count) { return below(count) == 0; }
  double between(double low, double high) { return stream_.uniform(next_++, low, high); }
  double normal() { return stream_.normal(next_++); }
  /// Of either sign. One call, not a product of two: which factor the compiler draws first is its own choice.
  double either_sign(double low, double high) {
    const double size = between(low, high);
    return one_in(2) ? size : -size;
  }
  plumb::Vec3 direction() { return stream_.direction(next_++); }
  plumb::Vec3 vector(double shortest, double longest) {
    const double length = between(shortest, longest);
    return plumb::scaled(direction(), length);
  }
  std::uint64_t seed() { return stream_.bits(next_++) >> 12U; }
  template <class T, std::size_t N>
  T any_of(const T (&list)[N]) {
    return list[below(static_cast<int>(N))];
  }

 private:
  plumb::scenario::Stream stream_;
  std::uint64_t next_ = 0;
};

}  // namespace PLUMB_ABI
}  // namespace plumb_replay

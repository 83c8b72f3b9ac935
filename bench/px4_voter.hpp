/// How PX4 watches its accelerometers, beside what a step of plumb costs. Re-stated from reading the sources that
/// px4_voter.cpp names; none of their words or code is repeated. It compares no unit with another: a unit loses by
/// errors that its driver counts, by silence, and by saying the same number too often.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace plumb_bench {

struct Px4Reading {
  std::array<float, 3> axis{};
  std::uint32_t driver_errors = 0;
};

/// One unit of three axes: what PX4 keeps of it, and how far it trusts it, 0 to 1.
class Px4Unit {
 public:
  void take(std::uint64_t time_us, const Px4Reading& reading) noexcept;
  float trust(std::uint64_t now_us) noexcept;

 private:
  /// Of one axis: the last value, a slow mean, and mean and scatter of what is left without that.
  struct Axis {
    float last = 0.0F, slow = 0.0F, mean = 0.0F, square = 0.0F, scatter = 0.0F;
  };
  std::array<Axis, 3> axis_{};
  std::uint64_t time_us_ = 0;
  std::uint32_t taken_ = 0, repeats_ = 0, driver_errors_ = 0;
  float error_density_ = 0.0F;
};

/// Units of equal priority, one of which is in use.
class Px4Units {
 public:
  explicit Px4Units(std::size_t count) : unit_(count) {}
  /// One reading of each, in their order. The unit to use; -1: none.
  int step(std::uint64_t time_us, const Px4Reading* readings) noexcept;

 private:
  std::vector<Px4Unit> unit_;
  int used_ = -1;
};

}  // namespace plumb_bench

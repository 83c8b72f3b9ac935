/// The specific force that a monitor publishes in motion, held to the truth.
#pragma once

#include <array>
#include <cstdint>

#include "flight_case.hpp"

namespace plumb_bench {

/// Samples of the blocks behind `MotionVerdict::block`.
inline constexpr std::size_t kForceBlock = 32;

/// The true force of the last samples, for the means that a published one is compared with.
class TrueForce {
 public:
  void add(const plumb::Vec3& force) { force_[count_++ % force_.size()] = force; }
  std::size_t count() const { return count_; }
  /// Triangle mean over two blocks of `n` samples, without the newest sample: the monitor waits for one more.
  plumb::Vec3 mean(std::size_t n) const {
    plumb::Vec3 out{};
    for (std::size_t k = 0; k < 2 * n; ++k) {
      const double up = static_cast<double>(k < n ? k : 2 * n - 1 - k) + 0.5;
      const plumb::Vec3& f = force_[(count_ - 1 - 2 * n + k) % force_.size()];
      out = plumb::plus(out, plumb::scaled(f, up / static_cast<double>(n * n)));
    }
    return out;
  }

 private:
  std::array<plumb::Vec3, 2 * kForceBlock + 1> force_{};
  std::size_t count_ = 0;
};

/// Enters one comparison of a force with the truth.
inline void check_bound(const plumb::SpecificForce& force, const plumb::Vec3& truth, BoundTally* tally) {
  const double error = plumb::norm(plumb::minus(force.force_mps2, truth));
  ++tally->checks;
  if (!(error <= force.bound_mps2)) ++tally->violations;
  tally->bound_sum_mps2 += force.bound_mps2;
  tally->square_sum += error * error;
}

}  // namespace plumb_bench

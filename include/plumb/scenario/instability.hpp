/// Slow wander of a bias: Gauss-Markov noise and a random walk, at any row without the rows before it.
#pragma once

#include <cstdint>
#include <vector>

#include "plumb/core/config.hpp"
#include "plumb/scenario/random.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace scenario {

struct InstabilityLaw {
  double sigma_mps2 = 0.0;     ///< first-order Gauss-Markov noise, 1 sigma; 0 = none
  double correlation_s = 100;  ///< its correlation time
  double walk_mps2 = 0.0;      ///< random walk: 1 sigma after one second, growing with the root of time; 0 = none

  bool any() const noexcept { return sigma_mps2 > 0.0 || walk_mps2 > 0.0; }
};

/// One sensor's wander over one run. A value is found by halving the run again and again: both processes are Markov, so
/// that the middle of an interval is normal once its ends are known. The process is exact at every tick, a value costs
/// one normal draw per halving, and it is a pure function of (law, run, seed, sensor, tick).
class Instability {
 public:
  /// `ticks` sample periods of `period_s` [s].
  Instability(const InstabilityLaw& law, std::uint64_t ticks, double period_s, std::uint64_t seed, int sensor);

  /// Error of the bias [m/s^2] at tick <= ticks.
  double at(std::uint64_t tick) const noexcept;

 private:
  /// Middle = weight (left + right) + sigma z.
  struct Halving {
    double weight = 0.5;
    double sigma = 0.0;
  };
  struct Process {
    Stream stream;
    double first = 0.0, last = 0.0;
    std::vector<Halving> halvings;
  };
  static double value(const Process& process, std::uint64_t tick) noexcept;

  Process wander_;
  Process walk_;
};

}  // namespace scenario
}  // namespace PLUMB_ABI
}  // namespace plumb

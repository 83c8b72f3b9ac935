// The exponent with which time grows: slope of log time over log size, least squares over the sizes measured so far.
#pragma once

#include <benchmark/benchmark.h>

#include <cmath>
#include <ctime>
#include <map>

namespace plumb_bench {

/// Processor time of the loop of a benchmark, which its function cannot ask of Google Benchmark.
class Stopwatch {
 public:
  double seconds_each(const benchmark::State& state) const {
    const double all = static_cast<double>(std::clock() - begin_) / CLOCKS_PER_SEC;
    return all / static_cast<double>(state.iterations());
  }

 private:
  std::clock_t begin_ = std::clock();
};

class Growth {
 public:
  /// Google Benchmark calls a function several times, the last time for long: that one stands.
  void set(double size, double seconds) { seconds_[size] = seconds; }

  /// NaN where there are fewer than two sizes.
  double exponent() const {
    const double count = static_cast<double>(seconds_.size());
    double x = 0.0, y = 0.0, xx = 0.0, xy = 0.0;
    for (const auto& [size, seconds] : seconds_) {
      const double a = std::log(size), b = std::log(seconds);
      x += a / count;
      y += b / count;
      xx += a * a / count;
      xy += a * b / count;
    }
    return count < 2.0 ? std::nan("") : (xy - x * y) / (xx - x * x);
  }

 private:
  std::map<double, double> seconds_;
};

}  // namespace plumb_bench

#include "phase_covariance.hpp"

#include <cmath>
#include <cstdlib>

#include "plumb/core/units.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace noise {
namespace {

/// The second difference taken twice.
constexpr double kWeights[5] = {1.0, -4.0, 6.0, -4.0, 1.0};

}  // namespace

Variances per_sample(const Variances& squares, double period_s) noexcept {
  Variances out{};
  out[index(Term::quantisation)] = squares[index(Term::quantisation)] / (period_s * period_s);
  out[index(Term::white)] = squares[index(Term::white)] / period_s;
  out[index(Term::bias_instability)] = squares[index(Term::bias_instability)];
  out[index(Term::random_walk)] = squares[index(Term::random_walk)] * period_s;
  return out;
}

double smooth_phase_covariance(const Variances& unit, double lag) noexcept {
  const double t = std::fabs(lag);
  if (!(t > 0.0)) return 0.0;
  const double flicker = unit[index(Term::bias_instability)] / (2.0 * kPi);
  return -0.5 * unit[index(Term::white)] * t + (flicker > 0.0 ? flicker * t * t * std::log(t) : 0.0) +
         unit[index(Term::random_walk)] / 12.0 * t * t * t;
}

double second_difference_covariance(const Variances& unit, double step, double lag) noexcept {
  double out = 0.0;
  for (int i = 0; i < 5; ++i) {
    const double at = lag + (i - 2) * step;
    out += kWeights[i] * smooth_phase_covariance(unit, at);
    if (at == 0.0) out += kWeights[i] * unit[index(Term::quantisation)];
  }
  return out;
}

}  // namespace noise
}  // namespace PLUMB_ABI
}  // namespace plumb

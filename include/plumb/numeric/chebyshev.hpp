/// Cubics in the Chebyshev polynomials of a scaled variable, and in powers of the plain one. Exact both ways; fitted in
/// powers over a wide span a cubic is conditioned a million times worse.
#pragma once

#include <array>

#include "plumb/core/config.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

/// Four coefficients, lowest order first.
using Cubic = std::array<double, 4>;

/// Span of x that is scaled to [-1, 1]; highest > lowest.
struct ChebyshevSpan {
  double lowest = -1.0;
  double highest = 1.0;

  double middle() const noexcept { return 0.5 * (lowest + highest); }
  double half_width() const noexcept { return 0.5 * (highest - lowest); }
  double scaled(double x) const noexcept { return (x - middle()) / half_width(); }
};

/// T_0 .. T_3 at tau: 1, tau, 2 tau^2 - 1, 4 tau^3 - 3 tau; any tau.
Cubic chebyshev_values(double tau) noexcept;

/// p with  sum p_k (x - centre)^k = sum c_k T_k(scaled(x)).
Cubic powers_from_chebyshev(const Cubic& c, const ChebyshevSpan& span, double centre) noexcept;
/// Its inverse.
Cubic chebyshev_from_powers(const Cubic& p, const ChebyshevSpan& span, double centre) noexcept;

}  // namespace PLUMB_ABI
}  // namespace plumb

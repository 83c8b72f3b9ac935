#include "plumb/numeric/chebyshev.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace {

/// q with  sum q_k x^k = sum p_k (a x + b)^k.
Cubic substituted(const Cubic& p, double a, double b) noexcept {
  return {p[0] + b * (p[1] + b * (p[2] + b * p[3])), a * (p[1] + b * (2.0 * p[2] + 3.0 * b * p[3])),
          a * a * (p[2] + 3.0 * b * p[3]), a * a * a * p[3]};
}

}  // namespace

Cubic chebyshev_values(double tau) noexcept { return {1.0, tau, 2.0 * tau * tau - 1.0, tau * (4.0 * tau * tau - 3.0)}; }

Cubic powers_from_chebyshev(const Cubic& c, const ChebyshevSpan& span, double centre) noexcept {
  const Cubic in_tau = {c[0] - c[2], c[1] - 3.0 * c[3], 2.0 * c[2], 4.0 * c[3]};
  return substituted(in_tau, 1.0 / span.half_width(), span.scaled(centre));
}

Cubic chebyshev_from_powers(const Cubic& p, const ChebyshevSpan& span, double centre) noexcept {
  const Cubic in_tau = substituted(p, span.half_width(), span.middle() - centre);
  const double c3 = 0.25 * in_tau[3], c2 = 0.5 * in_tau[2];
  return {in_tau[0] + c2, in_tau[1] + 3.0 * c3, c2, c3};
}

}  // namespace PLUMB_ABI
}  // namespace plumb

/// The terms of noise that an accelerometer at rest shows, and what each adds to the Allan variance.
///
/// Source: IEEE Std 952-1997, annex C (definitions of Q, N, B, K, R and their slopes); Greenhall and Riley, Uncertainty
/// of stability variances based on finite differences, 2003 (the covariances).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "plumb/core/config.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace noise {

enum class Term : std::uint8_t {
  quantisation,      ///< Q, unit s: Allan variance 3 Q^2/tau^2, slope -1 of the deviation
  white,             ///< N, unit/sqrt(Hz): N^2/tau, slope -1/2 (velocity random walk)
  bias_instability,  ///< B, unit: (2 ln 2/pi) B^2, flat; 1/f noise
  random_walk,       ///< K, unit/sqrt(s): K^2 tau/3, slope +1/2 (acceleration random walk)
  drift_rate,        ///< R, unit/s: R^2 tau^2/2, slope +1
};
inline constexpr std::size_t kTerms = 5;
/// The terms that are noise; the drift rate is a line.
inline constexpr std::size_t kNoiseTerms = 4;
inline constexpr std::array<Term, kTerms> kAllTerms = {Term::quantisation, Term::white, Term::bias_instability,
                                                       Term::random_walk, Term::drift_rate};
constexpr std::size_t index(Term term) noexcept { return static_cast<std::size_t>(term); }

/// "quantisation", "white_noise", ...: as in JSON.
const char* to_string(Term term) noexcept;
/// "Q", "N", "B", "K", "R".
const char* symbol(Term term) noexcept;

/// One number a term, by `index`: coefficients Q, N, B, K [unit of the readings with the time units above] and R, which
/// may be negative.
using Coefficients = std::array<double, kTerms>;
/// Squares Q^2, N^2, B^2, K^2.
using Variances = std::array<double, kNoiseTerms>;

Variances squares(const Coefficients& coefficients) noexcept;

/// What the term adds to the Allan variance at averaging time tau_s > 0 [unit^2].
double allan_variance(Term term, double coefficient, double tau_s) noexcept;
/// All terms together.
double allan_variance(const Coefficients& coefficients, double tau_s) noexcept;

/// What each noise term, with the coefficient 1, adds to the power of the component at `cycles` per sample (0 < cycles
/// <= 1/2) of samples that are means over `period_s` [unit^2; white noise of variance 1 a sample has power 1]. Aliases
/// are included; no edge effects.
Variances power_of_unit_terms(double cycles, double period_s) noexcept;

}  // namespace noise
}  // namespace PLUMB_ABI
}  // namespace plumb

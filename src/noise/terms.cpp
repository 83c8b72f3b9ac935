#include "plumb/noise/terms.hpp"

#include <cmath>

#include "plumb/core/units.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace noise {
namespace {

/// sum over j >= 0 of (x + j)^-3, x > 0: terms one by one, then Euler and Maclaurin for the rest, within 1e-9.
double hurwitz_zeta_3(double x) noexcept {
  constexpr int kOneByOne = 8;
  double sum = 0.0;
  for (int j = 0; j < kOneByOne; ++j) sum += 1.0 / std::pow(x + j, 3);
  const double rest = x + kOneByOne, square = rest * rest;
  return sum + 0.5 / square + 0.5 / (square * rest) + 0.25 / (square * square);
}

}  // namespace

const char* to_string(Term term) noexcept {
  switch (term) {
    case Term::quantisation: return "quantisation";
    case Term::white: return "white_noise";
    case Term::bias_instability: return "bias_instability";
    case Term::random_walk: return "random_walk";
    case Term::drift_rate: return "drift_rate";
  }
  return "?";
}

const char* symbol(Term term) noexcept {
  switch (term) {
    case Term::quantisation: return "Q";
    case Term::white: return "N";
    case Term::bias_instability: return "B";
    case Term::random_walk: return "K";
    case Term::drift_rate: return "R";
  }
  return "?";
}

Variances squares(const Coefficients& coefficients) noexcept {
  Variances out{};
  for (std::size_t t = 0; t < kNoiseTerms; ++t) out[t] = coefficients[t] * coefficients[t];
  return out;
}

double allan_variance(Term term, double coefficient, double tau_s) noexcept {
  const double square = coefficient * coefficient;
  switch (term) {
    case Term::quantisation: return 3.0 * square / (tau_s * tau_s);
    case Term::white: return square / tau_s;
    case Term::bias_instability: return 2.0 * std::log(2.0) / kPi * square;
    case Term::random_walk: return square * tau_s / 3.0;
    case Term::drift_rate: return 0.5 * square * tau_s * tau_s;
  }
  return 0.0;
}

double allan_variance(const Coefficients& coefficients, double tau_s) noexcept {
  double out = 0.0;
  for (const Term term : kAllTerms) out += allan_variance(term, coefficients[index(term)], tau_s);
  return out;
}

Variances power_of_unit_terms(double cycles, double period_s) noexcept {
  const double sine = std::sin(kPi * cycles), sine_squared = sine * sine;
  Variances out{};
  out[index(Term::quantisation)] = 4.0 * sine_squared / (period_s * period_s);
  out[index(Term::white)] = 1.0 / period_s;
  // B^2/(2 pi f), averaged over a sample and folded: sums of |cycles + j|^-3 over all whole j.
  out[index(Term::bias_instability)] =
      sine_squared * (hurwitz_zeta_3(cycles) + hurwitz_zeta_3(1.0 - cycles)) / (2.0 * kPi * kPi * kPi);
  // Differences of means of a random walk: variance 2/3, neighbours 1/6.
  out[index(Term::random_walk)] = period_s * (2.0 / 3.0 + std::cos(2.0 * kPi * cycles) / 3.0) / (4.0 * sine_squared);
  return out;
}

}  // namespace noise
}  // namespace PLUMB_ABI
}  // namespace plumb

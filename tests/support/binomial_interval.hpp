/// Clopper and Pearson's interval for tests of the run-time floors, without a library: exact binomial tails by
/// recurrence of the terms.
#pragma once

#include <cmath>
#include <cstdint>

namespace plumb_test {

/// P(X >= k) for X binomial(n, p), k >= 1: terms from k upwards (or 1 - those below, whichever falls).
inline double binomial_upper_tail(std::int64_t k, std::int64_t n, double p) {
  const auto log_term = [&](std::int64_t j) {
    return std::lgamma(static_cast<double>(n) + 1.0) - std::lgamma(static_cast<double>(j) + 1.0) -
           std::lgamma(static_cast<double>(n - j) + 1.0) + static_cast<double>(j) * std::log(p) +
           static_cast<double>(n - j) * std::log1p(-p);
  };
  const bool rising = static_cast<double>(k) < static_cast<double>(n) * p;  // then the terms below k are the small ones
  double term = std::exp(log_term(rising ? k - 1 : k));
  double sum = 0.0;
  for (std::int64_t j = rising ? k - 1 : k; j >= 0 && j <= n && term > 1e-18 * sum; j += rising ? -1 : 1) {
    sum += term;
    if (rising) {
      term *= static_cast<double>(j) / static_cast<double>(n - j + 1) * (1.0 - p) / p;
    } else {
      term *= static_cast<double>(n - j) / static_cast<double>(j + 1) * p / (1.0 - p);
    }
  }
  return rising ? 1.0 - sum : sum;
}

struct Interval {
  double low = 0.0, high = 1.0;
};

/// The rates that k of n does not refute at `confidence`.
inline Interval clopper_pearson(std::int64_t k, std::int64_t n, double confidence) {
  const double alpha = 0.5 * (1.0 - confidence);
  // p with P(X >= at_least) = tail, by bisection of log p.
  const auto solve = [n](std::int64_t at_least, double tail) {
    double low = -46.0, high = 0.0;
    for (int i = 0; i < 60; ++i) {
      const double middle = 0.5 * (low + high);
      (binomial_upper_tail(at_least, n, std::exp(middle)) > tail ? high : low) = middle;
    }
    return std::exp(0.5 * (low + high));
  };
  Interval out;
  if (k > 0) out.low = solve(k, alpha);
  if (k < n) out.high = solve(k + 1, 1.0 - alpha);
  return out;
}

}  // namespace plumb_test

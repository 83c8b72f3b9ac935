/// The likelihood of the powers of a log, and its maximum over the terms of noise (private to src/noise).
///
/// The power of a bin is chi-square with a scale that is linear in the squares of the coefficients, none of which is
/// negative. The freedom that a fitted line takes is accounted for (restricted likelihood, REML), also where the line
/// is held to find its interval. The maximum is found by Fisher scoring: least squares again and again, with weights
/// from the last fit.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "plumb/noise/terms.hpp"
#include "power_bins.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace noise {

/// What is held while the rest is fitted.
struct Held {
  std::optional<std::size_t> term;  ///< index of a noise term, with its square
  double square = 0.0;
  std::optional<double> slope;  ///< of the line [unit/s]
};

struct Maximum {
  Variances squares{};
  double slope = 0.0;
  double slope_variance = 0.0;  ///< by these squares
  double deviance = 0.0;        ///< -2 log likelihood, less a constant
};

class Likelihood {
 public:
  explicit Likelihood(std::vector<PowerBin> bins);

  Maximum maximum(const Held& held, const Maximum* start = nullptr) const;

  const std::vector<PowerBin>& bins() const noexcept { return bins_; }

 private:
  Maximum evaluate(const Variances& squares, const Held& held) const;
  Variances next(const Maximum& at, const Held& held) const;
  Maximum first_guess(const Held& held) const;

  std::vector<PowerBin> bins_;
};

/// Variances of the estimates of the squares and of the slope from such bins (Cramer and Rao), where these are the true
/// squares.
struct Precision {
  Variances of_squares{};
  double of_slope = 0.0;
};
Precision precision(const std::vector<PowerBin>& bins, const Variances& squares);

}  // namespace noise
}  // namespace PLUMB_ABI
}  // namespace plumb

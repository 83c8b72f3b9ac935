/// The overlapping Allan deviation of a log at rest, with intervals by chi-square.
///
/// Source: Riley, Handbook of Frequency Stability Analysis, NIST SP 1065, section 5.2.4 (estimator), 5.3 and 5.4
/// (chi-square and equivalent degrees of freedom); Greenhall and Riley, PTTI 2003 (variance from covariances of the
/// second difference).
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "plumb/noise/terms.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace noise {

struct AllanPoint {
  std::size_t samples = 0;  ///< averaged: tau = samples * period
  double tau_s = 0.0;
  double deviation = 0.0;  ///< unit of the readings; 0 where they do not change
  double freedom = 0.0;    ///< equivalent degrees of freedom; 0 until `add_intervals`
  double low = 0.0;        ///< 95 % interval of the deviation
  double high = 0.0;
};

/// Sums of the first 0, 1, .. n readings less their mean: n + 1 numbers, from which a mean over any stretch is one
/// difference.
std::vector<double> prefix_sums(const std::vector<double>& readings);

/// Allan variance of means over `samples` readings, from every place of the log: linear in its length. Needs
/// sums.size() > 2 * samples >= 2; 0 otherwise.
double allan_variance(const std::vector<double>& sums, std::size_t samples) noexcept;

/// Averaging times from one sample to a third of the log, `per_octave` >= 1 of them for every factor of two.
std::vector<std::size_t> averaging_lengths(std::size_t readings, int per_octave);

/// The deviation at each of `averaging_lengths`, without intervals.
std::vector<AllanPoint> allan_deviation(const std::vector<double>& sums, double period_s, int per_octave);

/// Equivalent degrees of freedom of the overlapping estimate over `samples` of `readings` readings, if the noise is
/// that of these terms (the drift rate does not count): 2 E^2/Var of the mean of squared second differences of the
/// phase, by their covariances. At least 1.
double equivalent_freedom(const Coefficients& noise, std::size_t readings, std::size_t samples,
                          double period_s) noexcept;

/// 95 % intervals by chi-square, with the degrees of freedom of that noise.
void add_intervals(std::vector<AllanPoint>& points, const Coefficients& noise, std::size_t readings, double period_s);

}  // namespace noise
}  // namespace PLUMB_ABI
}  // namespace plumb

/// The terms of noise in a log at rest, each with its interval.
///
/// Method: maximum likelihood on the powers of the cosine components of the log (docs/noise.md). The intervals are
/// those of the profile likelihood: what a coefficient may be while the others fit as well as they can.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "plumb/noise/terms.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace noise {

/// Frequencies from low_hz to high_hz.
struct Band {
  double low_hz = 0.0;
  double high_hz = 0.0;
};

struct TermEstimate {
  double value = 0.0;  ///< most likely; only R may be negative. Units as in terms.hpp
  /// 95 % interval. low = 0 (R: low <= 0 <= high): the log does not show the term.
  double low = 0.0;
  double high = 0.0;
  bool visible = false;
  /// Of a term that is not visible: how much longer the log must get to show a coefficient of half of `high` with 95 %;
  /// nothing where 100 times its length does not.
  std::optional<double> more_hours;
};

struct NoiseFit {
  std::array<TermEstimate, kTerms> terms{};  ///< by `index`
  /// The fit goes by frequencies up to this: less than half the sampling rate where the highest ones are not of these
  /// terms (an output filter).
  double highest_hz = 0.0;
  /// Largest deviation of the power in an octave from the fitted one, as a ratio (1 = none), beyond what chance does;
  /// and where. 1 where the terms describe the log.
  double misfit = 1.0;
  double misfit_hz = 0.0;

  const TermEstimate& of(Term term) const noexcept { return terms[index(term)]; }
  Coefficients values() const noexcept;
};

/// Fewest readings of a fit.
inline constexpr std::size_t kLeastReadings = 256;

/// Readings one `period_s` apart, at least kLeastReadings of them, all finite, not all alike; any unit. `left_out`:
/// bands with lines in the spectrum, which are none of the terms.
NoiseFit fit_noise(const std::vector<double>& readings, double period_s, const std::vector<Band>& left_out);

}  // namespace noise
}  // namespace PLUMB_ABI
}  // namespace plumb

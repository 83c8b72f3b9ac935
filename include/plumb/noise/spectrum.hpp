/// The power spectrum of a log at rest, and the peaks that stand above its floor.
///
/// Source: Welch, The use of fast Fourier transform for the estimation of power spectra, IEEE Trans. Audio
/// Electroacoust. AU-15, 1967: overlapping pieces under a Hann window.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "plumb/noise/fit.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace noise {

/// What a peak may come from, by its frequency alone.
enum class PeakOrigin : std::uint8_t { unknown, mains_50_hz, mains_60_hz, harmonic };
const char* to_string(PeakOrigin origin) noexcept;

struct Peak {
  double frequency_hz = 0.0;
  double amplitude = 0.0;   ///< of a sine of that power [unit of the readings]
  double over_floor = 0.0;  ///< power density at its top over that of the floor
  double width_hz = 0.0;    ///< of what stands above the floor; a sine: four bins
  PeakOrigin origin = PeakOrigin::unknown;
  int order = 0;  ///< harmonic: how many times the frequency of the first peak; mains: how many times its frequency
  bool aliased = false;  ///< that frequency is beyond half the sampling rate, and is seen folded
};

struct Spectrum {
  double bin_hz = 0.0;          ///< bin k is at k * bin_hz
  double averages = 0.0;        ///< independent pieces behind a bin
  std::vector<double> density;  ///< one-sided [unit^2/Hz]; bin 0 is 0
  std::vector<double> floor;    ///< median of the bins around, as a mean
  std::vector<Peak> peaks;      ///< by frequency; the kMostPeaks largest over the floor
};
inline constexpr std::size_t kMostPeaks = 16;
/// Fewest readings of a spectrum.
inline constexpr std::size_t kLeastForSpectrum = 128;

/// Readings one `period_s` apart, at least kLeastForSpectrum of them. The time is linear in their number.
Spectrum power_spectrum(const std::vector<double>& readings, double period_s);

/// The frequencies that these peaks reach in a fit to a log of `readings`: their width, and as far as a piece without a
/// taper carries their power above the noise.
std::vector<Band> bands_of(const Spectrum& spectrum, std::size_t readings, double period_s);

}  // namespace noise
}  // namespace PLUMB_ABI
}  // namespace plumb

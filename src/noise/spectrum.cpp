#include "plumb/noise/spectrum.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <unsupported/Eigen/FFT>

#include "peaks.hpp"
#include "plumb/core/units.hpp"
#include "power_bins.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace noise {
namespace {

constexpr std::size_t kLongestPiece = 8192, kShortestPiece = 32;
/// Pieces that a log is cut into at least, where it is long enough for pieces of any length.
constexpr std::size_t kFewestPieces = 8;
/// Two pieces that overlap by half under a Hann window share 1/36 of their variance.
constexpr double kSharedByNeighbours = 1.0 + 2.0 / 36.0;

std::size_t piece_of(std::size_t readings) {
  std::size_t piece = kShortestPiece;
  while (piece < kLongestPiece && 2 * piece * kFewestPieces <= readings) piece *= 2;
  return piece;
}

}  // namespace

Spectrum power_spectrum(const std::vector<double>& readings, double period_s) {
  std::vector<double> rest = readings;
  take_line_off(rest, period_s);
  const std::size_t piece = piece_of(rest.size()), bins = piece / 2;
  std::vector<double> window(piece), part(piece);
  double power = 0.0;
  for (std::size_t i = 0; i < piece; ++i) {
    window[i] = 0.5 - 0.5 * std::cos(2.0 * kPi * static_cast<double>(i) / static_cast<double>(piece));
    power += window[i] * window[i];
  }
  Eigen::FFT<double> fourier;
  fourier.SetFlag(Eigen::FFT<double>::HalfSpectrum);
  std::vector<std::complex<double>> components;
  Spectrum out;
  out.bin_hz = 1.0 / (static_cast<double>(piece) * period_s);
  out.density.assign(bins + 1, 0.0);
  std::size_t pieces = 0;
  for (std::size_t at = 0; at + piece <= rest.size(); at += piece / 2, ++pieces) {
    double mean = 0.0;
    for (std::size_t i = 0; i < piece; ++i) mean += rest[at + i] / static_cast<double>(piece);
    for (std::size_t i = 0; i < piece; ++i) part[i] = window[i] * (rest[at + i] - mean);
    fourier.fwd(components, part);
    for (std::size_t k = 1; k <= bins; ++k) out.density[k] += std::norm(components[k]);
  }
  for (std::size_t k = 1; k <= bins; ++k)
    out.density[k] *= (k < bins ? 2.0 : 1.0) * period_s / (power * static_cast<double>(pieces));
  out.averages = std::max(1.0, static_cast<double>(pieces) / kSharedByNeighbours);
  find_floor_and_peaks(out, 0.5 / period_s);
  return out;
}

std::vector<Band> bands_of(const Spectrum& spectrum, std::size_t readings, double period_s) {
  /// A line may add this part to the power of the noise beside its band; a band is at most this part of all
  /// frequencies.
  constexpr double kLeak = 0.03, kWidest = 0.1;
  const double length_s = static_cast<double>(longest_piece_of_fit(readings)) * period_s, half_rate_hz = 0.5 / period_s;
  std::vector<Band> out;
  for (const Peak& peak : spectrum.peaks) {
    const std::size_t bin =
        std::min(spectrum.floor.size() - 1, static_cast<std::size_t>(std::lround(peak.frequency_hz / spectrum.bin_hz)));
    // A sine of amplitude A has A^2 n/2 in its component of n, noise the density over 2 T in each; what leaks falls as
    // 1/(pi distance)^2.
    const double ratio = peak.amplitude * peak.amplitude * length_s / std::max(spectrum.floor[bin], 1e-300);
    const double leak_hz = std::sqrt(ratio / kLeak) / kPi * 0.5 / length_s;
    const double reach = std::min(0.5 * peak.width_hz + spectrum.bin_hz + leak_hz, kWidest * half_rate_hz);
    out.push_back({peak.frequency_hz - reach, peak.frequency_hz + reach});
  }
  return out;
}

}  // namespace noise
}  // namespace PLUMB_ABI
}  // namespace plumb

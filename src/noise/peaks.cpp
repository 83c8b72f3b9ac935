#include "peaks.hpp"

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>

namespace plumb {
inline namespace PLUMB_ABI {
namespace noise {
namespace {

/// Bins from f/kAround to f*kAround make the floor at f, at most kMost on either side, and as many above as below where
/// there are kFewest: slow terms make a steep spectrum, of which the median is in the middle.
constexpr double kAround = 1.25;
constexpr std::size_t kFewest = 3, kUsual = 12, kMost = 160;
/// Chance of one false peak in a spectrum, and the least that one stands above the floor.
constexpr double kFalsePeak = 1e-3, kLeastOverFloor = 2.0;
/// A peak goes on while the density is above this times the floor.
constexpr double kFoot = 1.5;
/// The lowest bins hold what the Hann window takes of slow terms.
constexpr std::size_t kFirstBin = 4;
constexpr int kMainsOrders = 6, kHarmonics = 12;

/// Median of chi-square over its mean (Wilson and Hilferty).
double median_over_mean(double freedom) { return std::pow(1.0 - 2.0 / (9.0 * freedom), 3); }

std::vector<double> floor_of(const std::vector<double>& density, double freedom) {
  std::vector<double> out(density.size(), 0.0), around;
  const std::size_t last = density.size() - 1;
  for (std::size_t k = 1; k <= last; ++k) {
    const auto f = static_cast<double>(k);
    const std::size_t reach = std::clamp(static_cast<std::size_t>(f * kAround) - k, kUsual, kMost);
    const std::size_t side = std::max(kFewest, std::min({reach, k - 1, last - k}));
    const std::size_t from = k > side ? k - side : 1, to = std::min(last, k + side);
    around.assign(density.begin() + static_cast<std::ptrdiff_t>(from),
                  density.begin() + static_cast<std::ptrdiff_t>(to) + 1);
    const auto middle = around.begin() + static_cast<std::ptrdiff_t>(around.size() / 2);
    std::nth_element(around.begin(), middle, around.end());
    out[k] = *middle / median_over_mean(freedom);
  }
  out[0] = out[1];
  return out;
}

/// Bins first .. last above the foot, with a bin above the limit among them.
Peak peak_of(const Spectrum& s, std::size_t first, std::size_t last) {
  Peak out;
  double power = 0.0, moment = 0.0;
  for (std::size_t k = first; k <= last; ++k) {
    const double above = std::max(0.0, s.density[k] - s.floor[k]) * s.bin_hz;
    power += above;
    moment += above * static_cast<double>(k) * s.bin_hz;
    out.over_floor = std::max(out.over_floor, s.density[k] / s.floor[k]);
  }
  out.frequency_hz = moment / power;
  out.amplitude = std::sqrt(2.0 * power);
  out.width_hz = static_cast<double>(last - first + 1) * s.bin_hz;
  return out;
}

/// The frequency that is seen where one is sampled at twice half_rate_hz.
double folded(double frequency_hz, double half_rate_hz) {
  const double rest = std::fmod(frequency_hz, 2.0 * half_rate_hz);
  return rest > half_rate_hz ? 2.0 * half_rate_hz - rest : rest;
}

/// Mains of 50 or 60 Hz wander by less than 0.2 % of their frequency.
bool is_mains(Peak& peak, double mains_hz, PeakOrigin origin, double bin_hz, double half_rate_hz) {
  for (int order = 1; order <= kMainsOrders; ++order) {
    const double true_hz = order * mains_hz, seen_hz = folded(true_hz, half_rate_hz);
    if (seen_hz < static_cast<double>(kFirstBin) * bin_hz) continue;
    if (std::fabs(peak.frequency_hz - seen_hz) > 0.5 * bin_hz + 2e-3 * true_hz) continue;
    peak.origin = origin;
    peak.order = order;
    peak.aliased = true_hz > half_rate_hz;
    return true;
  }
  return false;
}

void name_origins(Spectrum& s, double half_rate_hz) {
  for (Peak& peak : s.peaks) {
    if (peak.width_hz > 0.02 * half_rate_hz && peak.width_hz > 8.0 * s.bin_hz) continue;  // no line
    if (is_mains(peak, 50.0, PeakOrigin::mains_50_hz, s.bin_hz, half_rate_hz)) continue;
    (void)is_mains(peak, 60.0, PeakOrigin::mains_60_hz, s.bin_hz, half_rate_hz);
  }
  if (s.peaks.empty()) return;
  const double first_hz = s.peaks.front().frequency_hz;
  for (std::size_t p = 1; p < s.peaks.size(); ++p) {
    Peak& peak = s.peaks[p];
    if (peak.origin != PeakOrigin::unknown) continue;
    const double order = std::round(peak.frequency_hz / first_hz);
    if (order < 2.0 || order > kHarmonics) continue;
    if (std::fabs(peak.frequency_hz - order * first_hz) > 0.5 * s.bin_hz * (1.0 + 0.2 * order)) continue;
    peak.origin = PeakOrigin::harmonic;
    peak.order = static_cast<int>(order);
  }
}

}  // namespace

const char* to_string(PeakOrigin origin) noexcept {
  switch (origin) {
    case PeakOrigin::unknown: return "unknown";
    case PeakOrigin::mains_50_hz: return "mains_50_hz";
    case PeakOrigin::mains_60_hz: return "mains_60_hz";
    case PeakOrigin::harmonic: return "harmonic";
  }
  return "?";
}

void find_floor_and_peaks(Spectrum& s, double half_rate_hz) {
  const double freedom = 2.0 * s.averages;
  s.floor = floor_of(s.density, freedom);
  const auto bins = static_cast<double>(s.density.size());
  const boost::math::chi_squared law(freedom);
  const double limit =
      std::max(kLeastOverFloor, boost::math::quantile(boost::math::complement(law, kFalsePeak / bins)) / freedom);
  std::vector<Peak> found;
  for (std::size_t k = kFirstBin; k < s.density.size(); ++k) {
    if (!(s.floor[k] > 0.0) || s.density[k] < limit * s.floor[k]) continue;
    std::size_t first = k, last = k;
    while (first > kFirstBin && s.density[first - 1] > kFoot * s.floor[first - 1]) --first;
    while (last + 1 < s.density.size() && s.density[last + 1] > kFoot * s.floor[last + 1]) ++last;
    found.push_back(peak_of(s, first, last));
    k = last;
  }
  std::sort(found.begin(), found.end(), [](const Peak& a, const Peak& b) { return a.over_floor > b.over_floor; });
  if (found.size() > kMostPeaks) found.resize(kMostPeaks);
  std::sort(found.begin(), found.end(), [](const Peak& a, const Peak& b) { return a.frequency_hz < b.frequency_hz; });
  s.peaks = std::move(found);
  name_origins(s, half_rate_hz);
}

}  // namespace noise
}  // namespace PLUMB_ABI
}  // namespace plumb

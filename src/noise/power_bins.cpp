#include "power_bins.hpp"

#include <algorithm>
#include <cmath>

#include "cosine_transform.hpp"
#include "phase_covariance.hpp"
#include "plumb/core/units.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace noise {
namespace {

/// A log up to this long is transformed as a whole.
constexpr std::size_t kWhole = std::size_t{1} << 18;
/// Pieces of longer ones; their components from kPieceFirst on count, the lower frequencies come from means over kMean.
constexpr std::size_t kPiece = std::size_t{1} << 14, kPieceFirst = 256, kMean = 32;
/// The lowest components stand alone, each with its line; higher ones are taken together within this ratio of
/// frequencies.
constexpr std::size_t kAlone = 64;
constexpr double kBinRatio = 1.025;
/// The lowest components of 1/f noise feel the ends of the log: their power is computed from covariances up to this
/// one.
constexpr std::size_t kFlickerExact = 16;
/// ... on a log of this length, which stands for any longer one: beyond the ends only the ratio of lengths counts.
constexpr std::size_t kFlickerLength = 512;

/// Power of component k of 1/f noise over that of power_of_unit_terms, k = 1 .. kFlickerExact.
std::vector<double> flicker_ends() {
  std::vector<double> out(kFlickerExact + 1, 1.0);
  const std::size_t m = kFlickerLength;
  Variances unit{};
  unit[index(Term::bias_instability)] = 1.0;
  std::vector<double> covariance(m);
  for (std::size_t lag = 0; lag < m; ++lag)
    covariance[lag] = second_difference_covariance(unit, 1.0, static_cast<double>(lag));
  for (std::size_t k = 1; k <= kFlickerExact; ++k) {
    // The component is a sum of differences of the readings, weighed by a sine.
    const double angle = kPi * static_cast<double>(k) / static_cast<double>(m);
    std::vector<double> sine(m);
    for (std::size_t i = 0; i < m; ++i) sine[i] = std::sin(angle * static_cast<double>(i));
    double power = 0.0;
    for (std::size_t i = 1; i < m; ++i) {
      power += sine[i] * sine[i] * covariance[0];
      for (std::size_t j = 1; j < i; ++j) power += 2.0 * sine[i] * sine[j] * covariance[i - j];
    }
    const double across = 2.0 * std::sin(0.5 * angle);
    const double expected =
        power_of_unit_terms(0.5 * static_cast<double>(k) / static_cast<double>(m), 1.0)[index(Term::bias_instability)];
    out[k] = power * 2.0 / static_cast<double>(m) / (across * across) / expected;
  }
  return out;
}

/// Components first .. last of pieces of `length` samples.
struct Place {
  std::size_t length = 0;
  double period_s = 0.0;
  bool whole = false;  ///< one piece, with the line in its lowest components
};

PowerBin bin_at(const Place& place, std::size_t first, std::size_t last) {
  static const std::vector<double> ends = flicker_ends();
  PowerBin bin;
  const double n = static_cast<double>(place.length), middle = 0.5 * static_cast<double>(first + last);
  const double cycles = 0.5 * middle / n;
  bin.frequency_hz = cycles / place.period_s;
  bin.unit_power = power_of_unit_terms(cycles, place.period_s);
  if (first == last && first <= kFlickerExact) bin.unit_power[index(Term::bias_instability)] *= ends[first];
  if (place.whole && first == last && first % 2 == 1) {
    const double half = 0.5 * kPi * middle / n;
    bin.component_of_line = -place.period_s * std::sqrt(2.0 / n) / (2.0 * std::sin(half) * std::tan(half));
  }
  return bin;
}

std::size_t last_of_bin(std::size_t first, std::size_t end) {
  if (first <= kAlone) return first;
  return std::min(end - 1, static_cast<std::size_t>(static_cast<double>(first) * kBinRatio));
}

bool inside(const std::vector<Band>& bands, double frequency_hz) {
  return std::any_of(bands.begin(), bands.end(),
                     [=](const Band& b) { return frequency_hz >= b.low_hz && frequency_hz <= b.high_hz; });
}

/// Adds the components first .. end - 1 of pieces of `readings`.
void add_components(const std::vector<double>& readings, const Place& place, std::size_t first, std::size_t end,
                    const std::vector<Band>& left_out, std::vector<PowerBin>& out) {
  CosineTransform transform;
  std::vector<double> components, power(end, 0.0);
  std::size_t pieces = 0;
  for (std::size_t at = 0; at + place.length <= readings.size(); at += place.length, ++pieces) {
    transform.apply(readings.data() + at, place.length, components);
    for (std::size_t k = first; k < end; ++k) power[k] += components[k] * components[k];
    if (place.whole) {
      ++pieces;
      break;
    }
  }
  const double hz = 0.5 / (static_cast<double>(place.length) * place.period_s);
  for (std::size_t k = first; k < end;) {
    const std::size_t last = last_of_bin(k, end);
    PowerBin bin = bin_at(place, k, last);
    for (std::size_t i = k; i <= last; ++i) {
      if (inside(left_out, static_cast<double>(i) * hz)) continue;
      bin.power_sum += power[i];
      bin.count += static_cast<double>(pieces);
    }
    if (bin.component_of_line != 0.0) bin.component = components[k];
    if (bin.count > 0.0) out.push_back(bin);
    k = last + 1;
  }
}

std::vector<double> means_of(const std::vector<double>& readings) {
  std::vector<double> out;
  out.reserve(readings.size() / kMean);
  for (std::size_t at = 0; at + kMean <= readings.size(); at += kMean) {
    double sum = 0.0;
    for (std::size_t i = 0; i < kMean; ++i) sum += readings[at + i];
    out.push_back(sum / static_cast<double>(kMean));
  }
  return out;
}

/// Components of `place` below this frequency.
std::size_t components_below(const Place& place, double highest_hz) {
  const double all = 2.0 * static_cast<double>(place.length) * place.period_s * highest_hz;
  return all < static_cast<double>(place.length) ? static_cast<std::size_t>(std::ceil(all)) : place.length;
}

double piece_first_hz(double period_s) {
  return 0.5 * static_cast<double>(kPieceFirst) / (static_cast<double>(kPiece) * period_s);
}

}  // namespace

std::size_t longest_piece_of_fit(std::size_t readings) noexcept {
  return readings > kWhole ? kPiece : fast_length(readings);
}

double take_line_off(std::vector<double>& readings, double period_s) noexcept {
  const double n = static_cast<double>(readings.size()), middle = 0.5 * (n - 1.0);
  const double first = readings.empty() ? 0.0 : readings.front();
  double mean = 0.0, slope = 0.0, k = 0.0;
  for (const double y : readings) {
    mean += (y - first) / n;
    slope += (k - middle) * (y - first);
    k += 1.0;
  }
  slope /= n * (n * n - 1.0) / 12.0;
  k = 0.0;
  for (double& y : readings) {
    y = (y - first) - mean - slope * (k - middle);
    k += 1.0;
  }
  return slope / period_s;
}

std::vector<PowerBin> power_bins(std::vector<double> readings, double period_s, const std::vector<Band>& left_out) {
  std::vector<PowerBin> out;
  double highest_hz = 0.5 / period_s;
  while (readings.size() > kWhole) {
    const Place place{kPiece, period_s, false};
    add_components(readings, place, kPieceFirst, components_below(place, highest_hz), left_out, out);
    highest_hz = piece_first_hz(period_s);
    readings = means_of(readings);
    period_s *= static_cast<double>(kMean);
  }
  const Place place{fast_length(readings.size()), period_s, true};
  add_components(readings, place, 1, components_below(place, highest_hz), left_out, out);
  return out;
}

std::vector<PowerBin> empty_bins(std::size_t readings, double period_s) {
  const Place place{readings, period_s, true};
  std::vector<PowerBin> out;
  for (std::size_t k = 1; k < readings;) {
    const std::size_t last = last_of_bin(k, readings);
    PowerBin bin = bin_at(place, k, last);
    bin.count = static_cast<double>(last - k + 1);
    out.push_back(bin);
    k = last + 1;
  }
  return out;
}

}  // namespace noise
}  // namespace PLUMB_ABI
}  // namespace plumb

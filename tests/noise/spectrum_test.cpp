// Lines in a spectrum, and white noise without any.
#include "plumb/noise/spectrum.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "plumb/core/units.hpp"
#include "simulated_noise.hpp"

namespace spectrum_test {
namespace {

using namespace plumb;
using namespace plumb::noise;

constexpr double kPeriod_s = 1.0 / 400.0;

std::vector<double> white(std::size_t readings, std::uint64_t seed) {
  return simulated_noise::normals(seed, 7, readings);
}

void add_line(std::vector<double>& readings, double frequency_hz, double amplitude) {
  for (std::size_t k = 0; k < readings.size(); ++k)
    readings[k] += amplitude * std::sin(2.0 * kPi * frequency_hz * static_cast<double>(k) * kPeriod_s);
}

TEST(NoiseSpectrum, OfWhiteNoiseIsFlatAndHasItsPower) {
  const Spectrum spectrum = power_spectrum(white(100000, 1), kPeriod_s);
  // Variance 1 over 200 Hz.
  double sum = 0.0, floors = 0.0;
  for (std::size_t k = 1; k < spectrum.density.size(); ++k) {
    sum += spectrum.density[k] * spectrum.bin_hz;
    floors += spectrum.floor[k] * spectrum.bin_hz;
  }
  EXPECT_NEAR(sum, 1.0, 0.02);
  EXPECT_NEAR(floors, 1.0, 0.04);
}

TEST(NoiseSpectrum, WhiteNoiseHasNoPeaks) {
  int peaks = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed)
    peaks += power_spectrum(white(20000, seed), kPeriod_s).peaks.empty() ? 0 : 1;
  EXPECT_LE(peaks, 1);  // one in a thousand spectra by chance
}

TEST(NoiseSpectrum, SlowNoiseHasNoPeaks) {
  int peaks = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    simulated_noise::Source source({0.0, 1e-3, 2e-2, 2e-2, 1e-3}, 20000, kPeriod_s);
    peaks += power_spectrum(source.draw(seed), kPeriod_s).peaks.empty() ? 0 : 1;
  }
  EXPECT_LE(peaks, 1);
}

TEST(NoiseSpectrum, NamesLinesByFrequencyAndAmplitude) {
  std::vector<double> readings = white(100000, 3);
  add_line(readings, 23.4, 0.5);
  add_line(readings, 46.8, 0.3);
  add_line(readings, 150.0, 0.2);
  const Spectrum spectrum = power_spectrum(readings, kPeriod_s);
  ASSERT_EQ(spectrum.peaks.size(), 3U);
  EXPECT_NEAR(spectrum.peaks[0].frequency_hz, 23.4, 0.05);
  EXPECT_NEAR(spectrum.peaks[0].amplitude, 0.5, 0.04);
  EXPECT_GT(spectrum.peaks[0].over_floor, 50.0);
  EXPECT_EQ(spectrum.peaks[0].origin, PeakOrigin::unknown);
  EXPECT_EQ(spectrum.peaks[1].origin, PeakOrigin::harmonic);
  EXPECT_EQ(spectrum.peaks[1].order, 2);
  EXPECT_EQ(spectrum.peaks[2].origin, PeakOrigin::mains_50_hz);
  EXPECT_EQ(spectrum.peaks[2].order, 3);
  EXPECT_FALSE(spectrum.peaks[2].aliased);
}

TEST(NoiseSpectrum, KnowsFoldedMains) {
  // 240 Hz, the fourth of 60 Hz, sampled at 400 Hz: seen at 160 Hz.
  std::vector<double> readings = white(100000, 4);
  add_line(readings, 240.0, 0.3);
  const Spectrum spectrum = power_spectrum(readings, kPeriod_s);
  ASSERT_EQ(spectrum.peaks.size(), 1U);
  EXPECT_NEAR(spectrum.peaks[0].frequency_hz, 160.0, 0.05);
  EXPECT_EQ(spectrum.peaks[0].origin, PeakOrigin::mains_60_hz);
  EXPECT_EQ(spectrum.peaks[0].order, 4);
  EXPECT_TRUE(spectrum.peaks[0].aliased);
}

TEST(NoiseSpectrum, BandsOfLinesKeepThemOutOfTheFit) {
  std::vector<double> readings;
  for (const double y : white(60000, 5)) readings.push_back(y);
  add_line(readings, 80.0, 3.0);
  const Spectrum spectrum = power_spectrum(readings, kPeriod_s);
  const std::vector<Band> bands = bands_of(spectrum, readings.size(), kPeriod_s);
  ASSERT_EQ(bands.size(), 1U);
  EXPECT_LT(bands[0].low_hz, 79.9);
  EXPECT_GT(bands[0].high_hz, 80.1);
  const NoiseFit fit = fit_noise(readings, kPeriod_s, bands);
  EXPECT_EQ(fit.misfit, 1.0);
  EXPECT_NEAR(fit.of(Term::white).value, std::sqrt(kPeriod_s), 0.02 * std::sqrt(kPeriod_s));
}

}  // namespace
}  // namespace spectrum_test

/// Logs at rest whose noise is known, made without the code that is tested.
#pragma once

#include <cmath>
#include <complex>
#include <cstddef>
#include <cstdint>
#include <unsupported/Eigen/FFT>
#include <vector>

#include "plumb/noise/terms.hpp"
#include "plumb/scenario/random.hpp"

namespace simulated_noise {

inline std::vector<double> normals(std::uint64_t seed, std::uint32_t part, std::size_t count) {
  std::vector<double> out(count);
  const plumb::scenario::Stream stream(seed, plumb::scenario::Purpose::test, part);
  stream.normals(0, static_cast<int>(count), out.data());
  return out;
}

/// White noise through the filter (1 - 1/z)^(-1/2), whose power is 1/f (Kasdin, Discrete simulation of colored noise,
/// Proc. IEEE 83, 1995), after twice the length of the log in which the filter fills.
class Flicker {
 public:
  explicit Flicker(std::size_t readings) : readings_(readings) {
    while (length_ < 4 * readings) length_ *= 2;
    fourier_.SetFlag(Eigen::FFT<double>::HalfSpectrum);
    std::vector<double> filter(length_, 0.0);
    filter[0] = 1.0;
    for (std::size_t k = 1; k < length_ / 2; ++k)
      filter[k] = filter[k - 1] * (static_cast<double>(k) - 0.5) / static_cast<double>(k);
    fourier_.fwd(filter_, filter);
  }

  /// With B = 1.
  std::vector<double> draw(std::uint64_t seed, std::uint32_t part) {
    std::vector<double> out;
    std::vector<std::complex<double>> spectrum;
    fourier_.fwd(spectrum, normals(seed, part, length_));
    for (std::size_t k = 0; k < spectrum.size(); ++k) spectrum[k] *= filter_[k];
    fourier_.inv(out, spectrum, static_cast<Eigen::Index>(length_));
    return {out.end() - static_cast<std::ptrdiff_t>(readings_), out.end()};
  }

 private:
  std::size_t readings_;
  std::size_t length_ = 1;
  Eigen::FFT<double> fourier_;
  std::vector<std::complex<double>> filter_;
};

/// Logs of one length and one noise.
class Source {
 public:
  Source(const plumb::noise::Coefficients& truth, std::size_t readings, double period_s)
      : truth_(truth), readings_(readings), period_s_(period_s), flicker_(readings) {}

  std::vector<double> draw(std::uint64_t seed) {
    using plumb::noise::index;
    using plumb::noise::Term;
    const double quantum = truth_[index(Term::quantisation)] / period_s_,
                 white = truth_[index(Term::white)] / std::sqrt(period_s_),
                 walk = truth_[index(Term::random_walk)] * std::sqrt(period_s_),
                 instability = truth_[index(Term::bias_instability)],
                 drift = truth_[index(Term::drift_rate)] * period_s_;
    const std::vector<double> whites = normals(seed, 1, readings_), steps = normals(seed, 2, readings_),
                              codes = normals(seed, 3, readings_ + 1);
    std::vector<double> out(readings_);
    if (instability > 0.0) out = flicker_.draw(seed, 4);
    double bias = 0.0;
    for (std::size_t k = 0; k < readings_; ++k) {
      out[k] = instability * out[k] + white * whites[k] + quantum * (codes[k + 1] - codes[k]) + bias +
               drift * static_cast<double>(k);
      bias += walk * steps[k];
    }
    return out;
  }

 private:
  plumb::noise::Coefficients truth_;
  std::size_t readings_;
  double period_s_;
  Flicker flicker_;
};

}  // namespace simulated_noise

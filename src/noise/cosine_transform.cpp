#include "cosine_transform.hpp"

#include <cmath>
#include <complex>
#include <unsupported/Eigen/FFT>

#include "plumb/core/units.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace noise {

struct CosineTransform::Plan {
  Plan() { fourier.SetFlag(Eigen::FFT<double>::HalfSpectrum); }

  Eigen::FFT<double> fourier;
  std::vector<double> folded;
  std::vector<std::complex<double>> spectrum;
};

CosineTransform::CosineTransform() : plan_(std::make_unique<Plan>()) {}
CosineTransform::~CosineTransform() = default;

// Makhoul, A fast cosine transform in one and two dimensions, 1980: the even samples, then the odd ones backwards.
void CosineTransform::apply(const double* values, std::size_t count, std::vector<double>& components) {
  std::vector<double>& folded = plan_->folded;
  std::vector<std::complex<double>>& spectrum = plan_->spectrum;
  folded.resize(count);
  for (std::size_t i = 0; 2 * i < count; ++i) folded[i] = values[2 * i];
  for (std::size_t i = 0; 2 * i + 1 < count; ++i) folded[count - 1 - i] = values[2 * i + 1];
  plan_->fourier.fwd(spectrum, folded);
  components.resize(count);
  const double n = static_cast<double>(count), scale = std::sqrt(2.0 / n);
  for (std::size_t k = 0; 2 * k <= count; ++k) {
    const std::complex<double> turned = std::polar(scale, -kPi * static_cast<double>(k) / (2.0 * n)) * spectrum[k];
    components[k] = turned.real();
    if (k > 0 && 2 * k < count) components[count - k] = -turned.imag();
  }
  components[0] /= std::sqrt(2.0);
}

std::size_t fast_length(std::size_t count) noexcept {
  for (std::size_t length = count / 4 * 4; length > 4; length -= 4) {
    std::size_t rest = length;
    for (const std::size_t factor : {2U, 3U, 5U}) {
      while (rest % factor == 0) rest /= factor;
    }
    if (rest == 1) return length;
  }
  return 4;
}

}  // namespace noise
}  // namespace PLUMB_ABI
}  // namespace plumb

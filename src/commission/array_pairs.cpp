#include "array_pairs.hpp"

#include <algorithm>

#include "plumb/motion/motion_parity.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace commission {
namespace {

using Samples = std::vector<MotionSample>;
using Row9 = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

/// Steps of the derivatives by what the gyro is off by: small, for what is of the second order is left out.
constexpr double kStep = 1e-4;
constexpr double kLagStep_s = 1e-5;

/// The rate of sample k as it would be, were the gyro off by a step of unknown p.
Vec3 changed_rate(const Samples& samples, std::size_t k, std::size_t gyro, std::size_t p, double period_s) {
  const auto rate = [&samples, gyro](std::size_t at) { return samples[at].rate_radps[gyro]; };
  Vec3 out = rate(k);
  if (p < kGyroBias) {
    out[p / 3] += kStep * out[p % 3];
  } else if (p < kGyroLag) {
    out[p - kGyroBias] -= kStep;
  } else if (k > 0 && k + 1 < samples.size() && p == kGyroFilter) {
    const Vec3 around = scaled(plus(rate(k + 1), rate(k - 1)), 0.5);
    out = plus(out, scaled(minus(out, around), kStep));
  } else if (k > 0 && k + 1 < samples.size()) {
    out = plus(out, scaled(minus(rate(k + 1), rate(k - 1)), kLagStep_s / (2.0 * period_s)));
  }
  return out;
}

double step_of(std::size_t p) noexcept { return p == kGyroLag ? kLagStep_s : kStep; }

MotionSample only_rates(const MotionSample& sample) {
  MotionSample out;
  out.time_s = sample.time_s;
  out.rate_given = sample.rate_given;
  return out;
}

Row9 omega_of(const MotionSetup& setup, const MotionMeans& means) {
  return Eigen::Map<const Row9>(rotation_term(setup, means, RotationSource::gyro, 0.0).omega_per_s2.data());
}

bool complete(const MotionMeans& means, int gyros, SensorSet all) {
  if (means.samples == 0 || !means.usable.contains(all)) return false;
  for (std::size_t g = 0; g < static_cast<std::size_t>(gyros); ++g) {
    if (!means.gyro[g].given) return false;
  }
  return true;
}

}  // namespace

ArrayPairs::ArrayPairs(const ArrayOnBoard& on_board, const Samples& samples, std::size_t first, std::size_t end,
                       int scale) {
  const int sensors = on_board.array.size(), gyros = on_board.setup.gyros;
  const double period_s = on_board.setup.sample_period_s;
  // Only the rotation of the readings is asked for: no bound may take its place.
  MotionSetup setup;
  setup.gyros = gyros;
  MotionWindow window(sensors, gyros, period_s);
  std::vector<MotionWindow> changed(kGyroUnknowns, MotionWindow(1, gyros, period_s));
  for (std::size_t k = first; k < end; ++k) {
    window.add(samples[k]);
    for (std::size_t p = 0; p < kGyroUnknowns; ++p) {
      MotionSample other = only_rates(samples[k]);
      for (std::size_t g = 0; g < static_cast<std::size_t>(gyros); ++g)
        other.rate_radps[g] = changed_rate(samples, k, g, p, period_s);
      changed[p].add(other);
    }
    if ((window.ended() >> static_cast<unsigned>(scale) & 1U) == 0) continue;
    const MotionMeans means = window.means(scale);
    if (!complete(means, gyros, on_board.array.all())) {
      ++incomplete_;
      continue;
    }
    Pair pair;
    pair.reading = Eigen::Map<const Eigen::VectorXd>(means.reading_mps2.data(), sensors);
    pair.slope = Eigen::Map<const Eigen::VectorXd>(means.slope_mps3.data(), sensors);
    pair.power = Eigen::Map<const Eigen::VectorXd>(means.square_m2ps4.data(), sensors) - pair.reading.cwiseAbs2();
    pair.omega = omega_of(setup, means);
    for (std::size_t p = 0; p < kGyroUnknowns; ++p)
      pair.omega_by[p] = (omega_of(setup, changed[p].means(scale)) - pair.omega) / step_of(p);
    pairs_.push_back(std::move(pair));
  }
}

int ArrayPairs::size() const noexcept { return static_cast<int>(pairs_.size()); }
ArrayPairs::ArrayPairs(ArrayPairs&&) noexcept = default;
ArrayPairs::~ArrayPairs() = default;

}  // namespace commission
}  // namespace PLUMB_ABI
}  // namespace plumb

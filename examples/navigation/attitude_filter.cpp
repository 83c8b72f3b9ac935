// The same attitude filter twice, through the failure of an accelerometer at 30 s: once on plumb's vector, once on the
// least squares of all four accelerometers, taken where the gyro stands still and the length is that of gravity
// within 5 %. Prints a table for attitude_filter.gp: time, error with plumb, its stated sigma, error without [deg].
#include "attitude_filter.hpp"

#include <cstdio>

#include "body.hpp"

namespace {

constexpr double kDegrees = 57.29577951308232;

plumb::HealthMonitor monitor;
Body body(30.0);

double error_deg(const AttitudeFilter& filter) {
  const Eigen::Vector3d& a = filter.gravity_mps2();
  const Eigen::Vector3d& b = body.gravity_mps2();
  return std::atan2(a.cross(b).norm(), a.dot(b)) * kDegrees;
}

// What a stack without plumb does: all sensors, one least squares, one gate on the length.
void correct_without(AttitudeFilter& filter, const plumb::Sample& sample) {
  Eigen::Matrix<double, 4, 3> axes;
  Eigen::Vector4d readings;
  for (int i = 0; i < 4; ++i) {
    for (int c = 0; c < 3; ++c) axes(i, c) = body.setup().array.axis(i)[static_cast<std::size_t>(c)];
    readings[i] = sample.raw[static_cast<std::size_t>(i)];
  }
  const Eigen::Matrix3d inverse = (axes.transpose() * axes).inverse();
  const Eigen::Vector3d vector = inverse * axes.transpose() * readings;
  const bool length_fits = std::abs(vector.norm() - plumb::kG0_mps2) < 0.05 * plumb::kG0_mps2;
  if (body.gyro_radps().norm() < 0.02 && length_fits) filter.correct(vector, kSigma_mps2 * kSigma_mps2 * inverse);
}

}  // namespace

int main() {
  if (!monitor.configure(body.setup())) return 1;
  AttitudeFilter with(kGyroSigma_radps, 5e-4), without(kGyroSigma_radps, 5e-4);
  for (int k = 0; k < 7200; ++k) {
    const plumb::Sample sample = body.next();
    const plumb::Verdict& v = monitor.step(sample);
    with.turn(body.gyro_radps(), kStep_s);
    without.turn(body.gyro_radps(), kStep_s);
    with.correct(v);
    correct_without(without, sample);
    if (k >= 100 && k % 10 == 0) {
      std::printf("%.1f %.4f %.4f %.4f %s\n", sample.time_s, error_deg(with), with.tilt_sigma_rad() * kDegrees,
                  error_deg(without), plumb::to_string(v.validity));
    }
  }
}

#include "plumb/session/rate_group.hpp"

#include <Eigen/Dense>
#include <cmath>
#include <limits>

namespace plumb {
inline namespace PLUMB_ABI {
namespace session {
namespace {

/// True rows A, nominal ones N = A + E: the fit pins A K with K = A^+ N, so a rate w by the pinned rows is K w, and
/// |K - 1| = |A^+ E| <= |E| / (least singular value of N - |E|).
double common_of(const io::ArrayFile& group) {
  const SensorArray& array = group.array;
  Eigen::MatrixXd rows(array.size(), 3);
  double square = 0.0;
  for (int i = 0; i < array.size(); ++i) {
    const RateErrors& e = group.rate.errors[static_cast<std::size_t>(i)];
    if (!(e.scale > 0.0) || !(e.axis_rad > 0.0)) return std::numeric_limits<double>::infinity();
    square += e.scale * e.scale + e.axis_rad * e.axis_rad * (1.0 + e.scale) * (1.0 + e.scale);
    for (int c = 0; c < 3; ++c) rows(i, c) = array.axis(i)[static_cast<std::size_t>(c)];
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(rows.transpose() * rows);
  const double least = std::sqrt(std::fmax(eigen.eigenvalues()[0], 0.0)), error = std::sqrt(square);
  return least > error ? error / (least - error) : std::numeric_limits<double>::infinity();
}

}  // namespace

io::FileExpected<RateGroup> rate_group(const io::ArrayFile& group, const io::GyroCalibration* calibration) {
  RateGroup out;
  out.model = group.datasheet.model();
  out.array = group.array;
  out.setup = group.rate;
  if (calibration == nullptr) return out;
  out.calibrated = true;
  std::array<SensorRow, kCapacity> rows{};
  const auto n = static_cast<std::size_t>(group.array.size());
  for (std::size_t i = 0; i < n; ++i) {
    const io::GyroCalibration::Axis& found = calibration->axis[i];
    const double length = norm(found.row);
    rows[i] = group.array.row(static_cast<int>(i));
    rows[i].axis = scaled(found.row, 1.0 / length);
    rows[i].sigma_mps2 /= length;
    SensorCoefficients& c = out.model.sensor[i];
    for (double& one : c.scale) one *= length;
    c.bias[0] += found.bias_radps;
    for (double& one : c.bias) one /= length;
    out.setup.errors[i] = found.bound;
    out.setup.errors[i].bias_radps += kStabilitySigmas * group.stability[i].mps2;
  }
  const Expected<SensorArray> made = SensorArray::make(rows.data(), static_cast<int>(n));
  if (!made) {
    io::FileError error = io::from_error(made.error());
    error.file = group.path;
    return tl::unexpected<io::FileError>(error);
  }
  out.array = *made;
  if (!calibration->absolute) out.common = common_of(group);
  return out;
}

double with_common_part(const RateGroup& group, double rate_radps, double bound_radps) noexcept {
  if (!(group.common > 0.0)) return bound_radps;
  return bound_radps + group.common * (std::fabs(rate_radps) + bound_radps);
}

}  // namespace session
}  // namespace PLUMB_ABI
}  // namespace plumb

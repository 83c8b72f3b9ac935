#include "plumb/survey/calibrated_axes.hpp"

#include <algorithm>
#include <cmath>

#include "plumb/array/geometry.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace survey {
namespace {

constexpr double kTesla_per_inside = 1e-6 / io::kInside_per_ut;

/// A vector of a group at one station, and the covariance of what is drawn anew there.
struct Seen {
  Vec3 vector{};
  Mat3 random{};
  bool known = false;
};

Seen seen_by(const CalibratedGroup& group, const Station& station) {
  const SensorArray& array = group.calibration.array;
  const LeastSquares map = least_squares(array, station.delivered & array.all());
  Seen out;
  if (!map.valid || station.count < 1) return out;
  out.vector = station_residual(group.calibration, group.reference, station).gravity_mps2;
  for (int i = 0; i < array.size(); ++i) {
    const auto s = static_cast<std::size_t>(i);
    const double noise = array.row(i).sigma_mps2, misfit = array.uncertainty().misfit_mps2[s];
    const double variance = noise * noise / static_cast<double>(station.count) + misfit * misfit;
    for (std::size_t r = 0; r < 3; ++r) {
      for (std::size_t c = 0; c < 3; ++c) out.random[3 * r + c] += map.column[s][r] * map.column[s][c] * variance;
    }
  }
  out.known = std::isfinite(norm(out.vector)) && norm(out.vector) > 0.0;
  return out;
}

/// 1 sigma of a component of the vector by what the calibration leaves, rms over the axes.
double left_by(const Calibration& calibration) {
  const LeastSquares map = least_squares(calibration.array, calibration.array.all());
  double squares = 0.0;
  for (int i = 0; i < calibration.array.size(); ++i) {
    const auto s = static_cast<std::size_t>(i);
    squares += dot(map.column[s], map.column[s]) * std::pow(calibration.report.e_cal_mps2[s], 2);
  }
  return std::sqrt(squares / 3.0);
}

void put(const Mat3& block, double unit, std::size_t first, Covariance6& out) {
  for (std::size_t r = 0; r < 3; ++r) {
    for (std::size_t c = 0; c < 3; ++c) out[6 * (first + r) + first + c] = block[3 * r + c] * unit * unit;
  }
}

}  // namespace

CommonStations common_stations(const CalibratedGroup& accelerometers, const CalibratedGroup& magnetometers,
                               const io::MagneticReference& field) {
  CommonStations out;
  const double force = left_by(accelerometers.calibration), inside = left_by(magnetometers.calibration);
  out.tool.accelerometer_bias_mps2 = force;
  out.tool.accelerometer_scale = force / accelerometers.reference.g_mps2;
  out.tool.magnetometer_bias_tesla = inside * kTesla_per_inside;
  out.tool.magnetometer_scale = inside / magnetometers.reference.g_mps2;
  ReferencedStation one;
  one.reference.gravity = accelerometers.reference;
  one.reference.field.source = field.source;
  one.reference.field.total_tesla = 1e-6 * field.total_ut;
  one.reference.field.total_tesla_sigma = {1e-6 * field.total_sigma_ut, 0.0};
  one.reference.field.dip_rad = field.dip_rad;
  one.reference.field.dip_rad_sigma = {field.dip_sigma_rad, 0.0};
  for (const Station& still : magnetometers.stations) {
    const auto shared = std::find_if(
        accelerometers.stations.begin(), accelerometers.stations.end(),
        [&](const Station& other) { return other.begin_s <= still.end_s && still.begin_s <= other.end_s; });
    if (shared == accelerometers.stations.end()) continue;
    const Seen down = seen_by(accelerometers, *shared), along = seen_by(magnetometers, still);
    if (!down.known || !along.known) continue;
    one.measured.md_m = static_cast<double>(out.stations.size());
    one.measured.gravity_mps2 = down.vector;
    one.measured.field_tesla = scaled(along.vector, kTesla_per_inside);
    put(down.random, 1.0, 0, one.measured.random);
    put(along.random, kTesla_per_inside, 3, one.measured.random);
    out.stations.push_back(one);
  }
  return out;
}

tl::expected<JointAlignment, AlignmentRefusal> align_axes(const CommonStations& common,
                                                          const io::MagneticReference& field, double stated_rad) {
  AlignmentSettings settings;
  settings.tool = common.tool;
  settings.dip_known = field.dip_known;
  settings.stated_rad = stated_rad;
  return align_magnetometers(common.stations, settings);
}

std::array<double, 9> rotation_covariance(const JointAlignment& alignment) noexcept {
  std::array<double, 9> out{};
  for (std::size_t r = 0; r < 3; ++r) {
    for (std::size_t c = 0; c <= r; ++c)
      out[3 * r + c] = out[3 * c + r] = alignment.covariance[kAlignmentUnknowns * r + c];
  }
  return out;
}

}  // namespace survey
}  // namespace PLUMB_ABI
}  // namespace plumb

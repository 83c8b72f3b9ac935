#include "flight_errors.hpp"

#include "flight_random.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace scenario {
namespace {

/// Errors of one sensor or triad in order.
class ErrorDraws {
 public:
  ErrorDraws(const Stream& stream, bool vertices) noexcept : stream_(stream), vertices_(vertices) {}

  double next(double half_width) noexcept {
    const std::uint64_t index = next_++;
    if (vertices_) return (stream_.bits(index) & 1U) != 0 ? half_width : -half_width;
    return stream_.uniform(index, -half_width, half_width);
  }
  Vec3 next_three(double half_width) noexcept {
    Vec3 out{};
    for (double& x : out) x = next(half_width);
    return out;
  }

 private:
  Stream stream_;
  bool vertices_;
  std::uint64_t next_ = 0;
};

}  // namespace

std::vector<FlightSensorErrors> draw_sensor_errors(const FlightSpec& spec) {
  std::vector<FlightSensorErrors> out;
  for (std::uint32_t i = 0; i < spec.axis.size(); ++i) {
    ErrorDraws draws(flight_stream_of(spec.seed, flight_stream::kErrors + i), spec.vertices);
    FlightSensorErrors one;
    one.scale = draws.next(spec.box.scale);
    one.axis_x_rad = draws.next(spec.box.axis_rad);
    one.axis_y_rad = draws.next(spec.box.axis_rad);
    one.bias_mps2 = draws.next(spec.box.bias_mps2);
    one.lever_error_m = draws.next_three(spec.box.lever_m);
    one.skew_s = draws.next(spec.box.skew_s);
    one.bandwidth = draws.next(spec.box.bandwidth);
    one.rectification = draws.next(spec.box.rectification);
    out.push_back(one);
  }
  return out;
}

std::vector<FlightGyroErrors> draw_gyro_errors(const FlightSpec& spec) {
  std::vector<FlightGyroErrors> out;
  for (int g = 0; g < spec.gyros; ++g) {
    const auto sub = flight_stream::kGyroErrors + static_cast<std::uint32_t>(g);
    ErrorDraws draws(flight_stream_of(spec.seed, sub), spec.vertices);
    FlightGyroErrors one;
    one.scale = draws.next_three(spec.box.gyro_scale);
    one.axis_x_rad = draws.next_three(spec.box.gyro_axis_rad);
    one.axis_y_rad = draws.next_three(spec.box.gyro_axis_rad);
    one.bias_radps = draws.next_three(spec.box.gyro_bias_radps);
    one.skew_s = draws.next(spec.box.gyro_skew_s);
    one.bandwidth = draws.next(spec.box.gyro_bandwidth);
    out.push_back(one);
  }
  return out;
}

}  // namespace scenario
}  // namespace PLUMB_ABI
}  // namespace plumb

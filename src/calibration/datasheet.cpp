#include "plumb/calibration/datasheet.hpp"

#include <cmath>
#include <cstddef>

namespace plumb {
inline namespace PLUMB_ABI {

namespace {

/// Of a packed lower triangle, a >= b.
constexpr std::size_t packed(int a, int b) noexcept {
  const auto row = static_cast<std::size_t>(a);
  return row * (row + 1) / 2 + static_cast<std::size_t>(b);
}

}  // namespace

SensorModel Datasheet::model() const noexcept {
  SensorModel out;
  out.size = size;
  out.reads = reads;
  for (int i = 0; i < size; ++i) {
    out.sensor[static_cast<std::size_t>(i)] = sensor[static_cast<std::size_t>(i)].coefficients;
  }
  return out;
}

Expected<SensorArray> Datasheet::array() const noexcept {
  std::array<SensorRow, kCapacity> rows{};
  if (size > kCapacity) return fail(Errc::too_many_sensors, -1, size, kCapacity);
  for (int i = 0; i < size; ++i) rows[static_cast<std::size_t>(i)] = sensor[static_cast<std::size_t>(i)].row;
  return SensorArray::make(rows.data(), size);
}

RowUncertainty Datasheet::uncertainty() const noexcept {
  RowUncertainty out;
  for (int i = 0; i < size && i < kCapacity; ++i) {
    const DatasheetSensor& s = sensor[static_cast<std::size_t>(i)];
    const double along = s.prior.scale * s.prior.scale, across = s.prior.axis_rad * s.prior.axis_rad;
    for (int p = 0; p < 3; ++p) {
      for (int q = 0; q <= p; ++q) {
        const double hh = s.row.axis[static_cast<std::size_t>(p)] * s.row.axis[static_cast<std::size_t>(q)];
        out.covariance[packed(4 * i + p, 4 * i + q)] = along * hh + across * ((p == q ? 1.0 : 0.0) - hh);
      }
    }
    out.covariance[packed(4 * i + 3, 4 * i + 3)] = s.prior.bias_mps2 * s.prior.bias_mps2;
  }
  return out;
}

Prior prior_in(const SensorArray& array, int i) noexcept {
  const auto variance = [&array, i](int p, int q) { return array.row_covariance(4 * i + p, 4 * i + q); };
  const Vec3& h = array.axis(i);
  double trace = 0.0, along = 0.0;
  for (int p = 0; p < 3; ++p) {
    trace += variance(p, p);
    for (int q = 0; q < 3; ++q) {
      along += h[static_cast<std::size_t>(p)] * h[static_cast<std::size_t>(q)] * variance(p, q);
    }
  }
  Prior out;
  out.bias_mps2 = std::sqrt(std::fmax(variance(3, 3), 0.0));
  out.scale = std::sqrt(std::fmax(along, 0.0));
  out.axis_rad = std::sqrt(std::fmax(trace - along, 0.0) / 2.0);
  return out;
}

}  // namespace PLUMB_ABI
}  // namespace plumb

#include "chip_form.hpp"

#include <cmath>

#include "plumb/core/units.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace coefficients {
namespace {

constexpr std::size_t at(int i) noexcept { return static_cast<std::size_t>(i); }
const char* const kAxisNames[] = {"x", "y", "z"};

Vec3 row_of(const Mat3& m, std::size_t k) noexcept { return {m[3 * k], m[3 * k + 1], m[3 * k + 2]}; }

/// x, y and z of the chip in the tool frame, by the nominal axes: x as it is, y turned to be across it, z across both.
Mat3 frame_of(const io::ArrayFile& array, const ChipPlace& place) {
  const auto axis = [&](std::size_t k) { return scaled(array.array.axis(place.sensor[k]), place.sign[k]); };
  if (!place.whole())
    throw io::Refusal(io::FileError{array.path, 0, place.name, "lacks an axis of the chip",
                                    "name all three sensors of the chip: --instance 1=a1,a2,a3"});
  const Vec3 x = axis(0);
  const Vec3 across = minus(axis(1), scaled(x, dot(axis(1), x)));
  const double length = norm(across);
  constexpr double kLeastAngle = 0.5;
  if (!(length > kLeastAngle))
    throw io::Refusal(io::FileError{array.path, 0, place.name, "has axes that are nearly parallel",
                                    "correct the axis lines of its sensors, or name others with --instance"});
  const Vec3 y = scaled(across, 1.0 / length);
  Vec3 z = cross(x, y);
  if (dot(z, axis(2)) < 0.0) z = scaled(z, -1.0);
  return {x[0], x[1], x[2], y[0], y[1], y[2], z[0], z[1], z[2]};
}

/// Of a scale; 0 where there is none.
double inverse_length(double scale) { return scale > 0.0 ? 1.0 / scale : 0.0; }

/// offset[k] (T - from)^k as powers of T - to.
std::array<double, 4> shifted(const std::array<Vec3, 4>& offset, std::size_t axis, double from_degc, double to_degc) {
  const double d = to_degc - from_degc;
  const double o0 = offset[0][axis], o1 = offset[1][axis], o2 = offset[2][axis], o3 = offset[3][axis];
  return {o0 + d * (o1 + d * (o2 + d * o3)), o1 + d * (2.0 * o2 + d * 3.0 * o3), o2 + 3.0 * d * o3, o3};
}

/// Log values per m/s^2 of what a driver gives, and what it takes off.
struct Driver {
  double scale = 1.0, bias_mps2 = 0.0;
};
Driver driver_of(const io::ArrayFile& array, int sensor) {
  const io::RawUnit& unit = array.input.unit;
  if (unit.kind == io::RawUnit::Kind::acceleration) return {1.0 / unit.base_per_unit, 0.0};
  const SensorCoefficients& nominal = array.datasheet.sensor[at(sensor)].coefficients;
  return {nominal.scale[0], nominal.bias[0]};
}

/// Scale and bias of one sensor: the reading is offset + length a, in the unit of the chip and in its sense.
SensorCoefficients model_of(const io::ArrayFile& array, const ChipCoefficients& chip, std::size_t axis, double length,
                            int sensor, int sign) {
  const SensorCoefficients& nominal = array.datasheet.sensor[at(sensor)].coefficients;
  const Driver driver = chip.unit == ReadingUnit::mps2 ? driver_of(array, sensor) : Driver{};
  SensorCoefficients out = nominal;  // with its drift, where the chip states none
  out.scale[0] = driver.scale * length;
  for (std::size_t k = 1; k < 4; ++k) out.scale[k] = out.scale[0] * (nominal.scale[k] / nominal.scale[0]);
  if (!chip.has_temperature_terms()) {
    out.bias[0] = (sign * chip.offset[0][axis] + driver.bias_mps2) / length;
    return out;
  }
  const std::array<double, 4> offset = shifted(chip.offset, axis, chip.reference_degc, nominal.reference_degc);
  for (std::size_t k = 0; k < 4; ++k) out.bias[k] = (sign * offset[k] + (k == 0 ? driver.bias_mps2 : 0.0)) / length;
  return out;
}

}  // namespace

bool ChipCoefficients::is_diagonal() const noexcept {
  for (std::size_t k = 0; k < 9; ++k) {
    if (k % 4 != 0 && matrix[k] != 0.0) return false;
  }
  return true;
}

Mat3 inverse_of(const Mat3& m) noexcept {
  const Vec3 a = row_of(m, 0), b = row_of(m, 1), c = row_of(m, 2);
  const double det = det3(a, b, c);
  if (!(std::fabs(det) > 0.0) || !std::isfinite(det)) return {};
  const Vec3 columns[] = {scaled(cross(b, c), 1.0 / det), scaled(cross(c, a), 1.0 / det),
                          scaled(cross(a, b), 1.0 / det)};
  Mat3 out{};
  for (std::size_t r = 0; r < 3; ++r) {
    for (std::size_t k = 0; k < 3; ++k) out[3 * r + k] = columns[k][r];
  }
  return out;
}

std::vector<SensorStatement> sensors_of(const io::ArrayFile& array, const ChipCoefficients& chip,
                                        const ChipPlace& place) {
  const bool diagonal = chip.is_diagonal();
  const Mat3 frame = diagonal ? kNoTurn : frame_of(array, place);
  const Mat3 inverse = diagonal ? kNoTurn : inverse_of(chip.matrix);
  std::vector<SensorStatement> out;
  for (std::size_t k = 0; k < 3; ++k) {
    const int sensor = place.sensor[k];
    if (sensor < 0) continue;
    SensorStatement one;
    one.sensor = sensor;
    one.source = chip.name + " " + kAxisNames[k];
    one.axis = array.array.axis(sensor);
    double length = diagonal ? inverse_length(chip.matrix[4 * k]) : norm(row_of(inverse, k));
    if (!(length > 0.0) || !std::isfinite(length))
      throw io::Refusal(io::FileError{"", 0, one.source, "has a scale that is not above 0, or no number",
                                      "correct the coefficients: a chip that reads the other way round is named by "
                                      "--instance 0=a1,-a2,a3"});
    if (!diagonal) {
      const Vec3 row = row_of(inverse, k);
      const Vec3 n = scaled(row, place.sign[k] / length);
      Vec3 axis{};
      for (std::size_t c = 0; c < 3; ++c) axis = plus(axis, scaled(row_of(frame, c), n[c]));
      one.axis = scaled(axis, 1.0 / norm(axis));
    }
    one.model = model_of(array, chip, k, length, sensor, place.sign[k]);
    one.span = chip.span;
    out.push_back(one);
  }
  return out;
}

ChipCoefficients diagonal_chip(const io::ArrayFile& array, const SensorModel& model, const ChipPlace& place) {
  ChipCoefficients out;
  for (std::size_t k = 0; k < 3; ++k) {
    const int sensor = place.sensor[k];
    if (sensor < 0) continue;
    const SensorCoefficients& c = model.sensor[at(sensor)];
    const Driver driver = driver_of(array, sensor);
    const double length = c.scale[0] / driver.scale;
    out.matrix[4 * k] = 1.0 / length;
    out.offset[0][k] = place.sign[k] * (c.bias[0] * length - driver.bias_mps2);
  }
  return out;
}

ChipCoefficients full_chip(const io::ArrayFile& array, const SensorModel& model, const SensorArray& axes,
                           const ChipPlace& place) {
  const Mat3 frame = frame_of(array, place);
  Mat3 readings{};  // what the channels read of a, in the sense of the chip
  ChipCoefficients out;
  out.unit = ReadingUnit::log;
  for (std::size_t k = 0; k < 3; ++k) {
    const SensorCoefficients& c = model.sensor[at(place.sensor[k])];
    const Vec3 n = times(frame, axes.axis(place.sensor[k]));
    for (std::size_t j = 0; j < 3; ++j) readings[3 * k + j] = place.sign[k] * c.scale[0] * n[j];
    out.offset[0][k] = place.sign[k] * c.scale[0] * c.bias[0];
  }
  out.matrix = inverse_of(readings);
  if (out.matrix == Mat3{})
    throw io::Refusal(io::FileError{array.path, 0, place.name, "has axes that lie in one plane",
                                    "name three sensors that do not, with --instance"});
  return out;
}

}  // namespace coefficients
}  // namespace PLUMB_ABI
}  // namespace plumb

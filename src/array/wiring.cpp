#include "plumb/array/wiring.hpp"

#include <cmath>
#include <cstddef>

#include "linear.hpp"
#include "plumb/core/detail/numbers.hpp"
#include "plumb/core/units.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

using numbers::at;

namespace {

Vec3 row_of(const Mat3& m, std::size_t r) noexcept { return {m[3 * r], m[3 * r + 1], m[3 * r + 2]}; }

array_detail::Rows rows_of(const Mat3& m) noexcept {
  array_detail::Rows rows;
  for (std::size_t r = 0; r < 3; ++r) rows.add(row_of(m, r));
  return rows;
}

/// Largest angle between a vector and its image under an orthogonal matrix.
double turn_of(const Mat3& k) noexcept {
  if (det3(row_of(k, 0), row_of(k, 1), row_of(k, 2)) < 0.0) return kPi;
  const Vec3 twice_sine = {k[7] - k[5], k[2] - k[6], k[3] - k[1]};
  return std::atan2(norm(twice_sine), k[0] + k[4] + k[8] - 1.0);
}

}  // namespace

Wiring Wiring::correct() noexcept {
  Wiring out;
  for (std::size_t i = 0; i < out.source.size(); ++i) {
    out.source[i] = static_cast<std::uint8_t>(i);
    out.sign[i] = 1;
  }
  return out;
}

Wiring Wiring::reversed(int i) noexcept {
  Wiring out = correct();
  out.sign[at(i)] = -1;
  return out;
}

Wiring Wiring::swapped(int i, int j) noexcept {
  Wiring out = correct();
  out.source[at(i)] = static_cast<std::uint8_t>(j);
  out.source[at(j)] = static_cast<std::uint8_t>(i);
  return out;
}

Wiring Wiring::swapped_reversed(int i, int j) noexcept {
  Wiring out = swapped(i, j);
  out.sign[at(i)] = -1;
  out.sign[at(j)] = -1;
  return out;
}

Wiring Wiring::cycled(int i, int j, int k) noexcept {
  Wiring out = correct();
  out.source[at(i)] = static_cast<std::uint8_t>(j);
  out.source[at(j)] = static_cast<std::uint8_t>(k);
  out.source[at(k)] = static_cast<std::uint8_t>(i);
  return out;
}

WiringEffect wiring_effect(const SensorArray& array, const Wiring& wiring) noexcept {
  WiringEffect out;
  array_detail::Rows h;
  for (int i = 0; i < array.size(); ++i) h.add(array.axis(i));
  const Mat3 normal = array_detail::inverse_normal(h);
  if (normal == Mat3{}) return out;
  // x = K g: least squares by the axes as they should be, of readings along the axes as they are wired.
  Mat3 k{};
  array_detail::Rows wired;
  for (int i = 0; i < array.size(); ++i) {
    const Vec3 p = times(normal, array.axis(i));
    wired.add(scaled(array.axis(wiring.source[at(i)]), wiring.sign[at(i)]));
    for (std::size_t r = 0; r < 3; ++r) {
      for (std::size_t c = 0; c < 3; ++c) k[3 * r + c] += p[r] * wired.row[at(i)][c];
    }
  }
  array_detail::Rows residual;
  for (int i = 0; i < array.size(); ++i) {
    const Vec3& a = array.axis(i);
    const Vec3 explained = {a[0] * k[0] + a[1] * k[3] + a[2] * k[6], a[0] * k[1] + a[1] * k[4] + a[2] * k[7],
                            a[0] * k[2] + a[1] * k[5] + a[2] * k[8]};
    residual.add(minus(wired.row[at(i)], explained));
  }
  const Vec3 stretch = array_detail::singular_values(rows_of(k));
  out.parity = array_detail::singular_values(residual)[0];
  out.length = std::fmax(std::fabs(stretch[0] - 1.0), std::fabs(1.0 - stretch[2]));
  out.turn_rad = turn_of(k);
  // The component along z that is found is that of gravity along the third row.
  out.inclination_rad = angle_between_rad(row_of(k, 2), {0.0, 0.0, 1.0});
  return out;
}

}  // namespace PLUMB_ABI
}  // namespace plumb

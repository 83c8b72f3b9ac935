#include "plumb/paper/paper_parameters.hpp"

#include <algorithm>
#include <cmath>

#include "../calibration/fit_internal.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace {

using fit::at;

/// The n sensors that paper and calibration share when the paper's form is unique.
constexpr int kUniqueUpTo = 4;

bool has_cross_terms(const SensorModel& model) noexcept {
  return std::any_of(model.misalignment.begin(), model.misalignment.end(), [](double m) { return m != 0.0; });
}

/// SF/d and d B, every order of temperature: d stretches the row.
SensorCoefficients stretched(const SensorCoefficients& c, double d) noexcept {
  SensorCoefficients out = c;
  for (std::size_t k = 0; k < 4; ++k) {
    out.scale[k] /= d;
    out.bias[k] *= d;
  }
  return out;
}

/// x with x_0 a + x_1 b + x_2 c = v (Cramer).
Vec3 combination(const Vec3& a, const Vec3& b, const Vec3& c, double det, const Vec3& v) noexcept {
  return scaled(Vec3{det3(v, b, c), det3(a, v, c), det3(a, b, v)}, 1.0 / det);
}

/// n = 3: row i of P = H H'^-1 holds h_i in terms of the rows of H'.
Expected<SensorModel> of_three(const SensorArray& nominal, const SensorArray& calibrated, SensorModel out) noexcept {
  const Vec3 a = calibrated.axis(0), b = calibrated.axis(1), c = calibrated.axis(2);
  const double det = det3(a, b, c);
  if (!(std::fabs(det) >= kMinPaperDet)) {
    return fail(Errc::axes_rank_deficient, -1, std::fabs(det), kMinPaperDet);
  }
  std::array<Vec3, 3> p{};
  for (int i = 0; i < 3; ++i) {
    p[at(i)] = combination(a, b, c, det, nominal.axis(i));
    const double d = p[at(i)][at(i)];
    if (!(d >= kMinPaperDet)) return fail(Errc::not_invertible, i, d, kMinPaperDet);
    out.sensor[at(i)] = stretched(out.sensor[at(i)], d);
  }
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      if (i != j) out.misalignment[at(i * kCapacity + j)] = -p[at(i)][at(j)] / p[at(j)][at(j)];
    }
  }
  return out;
}

/// n = 4: each row is a system in the other three axes.
Expected<SensorModel> of_four(const SensorArray& nominal, const SensorArray& calibrated, SensorModel out) noexcept {
  for (int i = 0; i < 4; ++i) {
    const std::array<int, 3> other = {i > 0 ? 0 : 1, i > 1 ? 1 : 2, i > 2 ? 2 : 3};
    const Vec3 &a = calibrated.axis(other[0]), &b = calibrated.axis(other[1]), &c = calibrated.axis(other[2]);
    const double det = det3(a, b, c);
    if (!(std::fabs(det) >= kMinPaperDet)) return fail(Errc::axes_rank_deficient, i, std::fabs(det), kMinPaperDet);
    const Vec3 m = combination(a, b, c, det, minus(calibrated.axis(i), nominal.axis(i)));
    for (std::size_t k = 0; k < 3; ++k) out.misalignment[at(i * kCapacity + other[k])] = m[k];
  }
  return out;
}

}  // namespace

Expected<SensorModel> paper_form(const SensorArray& nominal, const SensorArray& calibrated,
                                 const SensorModel& common) noexcept {
  const int n = nominal.size();
  if (calibrated.size() != n || common.size != n) return fail(Errc::out_of_range, 0, calibrated.size(), n);
  if (has_cross_terms(common)) return fail(Errc::out_of_range, 1);
  if (n > kUniqueUpTo) return fail(Errc::not_unique, -1, n, kUniqueUpTo);
  return n == 3 ? of_three(nominal, calibrated, common) : of_four(nominal, calibrated, common);
}

Expected<CommonFrameForm> common_frame_form(const SensorArray& nominal, const SensorModel& paper) noexcept {
  const int n = nominal.size();
  if (paper.size != n) return fail(Errc::out_of_range, 0, paper.size, n);
  for (int i = 0; i < n; ++i) {
    const double diagonal = paper.misalignment[at(i * kCapacity + i)];
    if (diagonal != 0.0) return fail(Errc::out_of_range, 1, diagonal);
  }
  // Rows (I - M)^-1 H, column by column. Scale 1 and no bias turn `raw_from` into that inverse.
  SensorModel mixing;
  mixing.size = n;
  mixing.misalignment = paper.misalignment;
  std::array<Vec3, kCapacity> row{};
  for (std::size_t p = 0; p < 3; ++p) {
    Readings column{};
    for (int i = 0; i < n; ++i) column[at(i)] = nominal.axis(i)[p];
    const Expected<std::array<double, kCapacity>> inverse = mixing.raw_from(column, 0.0);
    if (!inverse) return tl::unexpected<Error>(inverse.error());
    for (int i = 0; i < n; ++i) row[at(i)][p] = (*inverse)[at(i)];
  }
  CommonFrameForm out;
  out.model = paper;
  out.model.misalignment = {};
  for (int i = 0; i < n; ++i) {
    const double length = norm(row[at(i)]);
    if (!(length >= kMinPaperDet)) return fail(Errc::not_invertible, i, length, kMinPaperDet);
    out.axis[at(i)] = scaled(row[at(i)], 1.0 / length);
    out.model.sensor[at(i)] = stretched(out.model.sensor[at(i)], 1.0 / length);
  }
  return out;
}

}  // namespace PLUMB_ABI
}  // namespace plumb

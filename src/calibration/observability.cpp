#include "plumb/calibration/observability.hpp"

#include <algorithm>
#include <cmath>

#include "fit_internal.hpp"
#include "plumb/core/units.hpp"
#include "plumb/numeric/cholesky.hpp"
#include "plumb/numeric/hypotenuse.hpp"
#include "station_solver.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

using numbers::at;

namespace {

/// The grid: inclinations from 0 to 180 deg, toolfaces all around, the two verticals once each.
constexpr int kInclinationSteps = 12;
constexpr int kToolfaceSteps = 12;
constexpr int kGrid = 2 + (kInclinationSteps - 1) * kToolfaceSteps;
/// Of two attitudes whose gains differ by less (relative) the earlier one of the grid is taken, so that rounding does
/// not choose.
constexpr double kSameGain = 1e-6;

PlannedAttitude grid_point(int k) noexcept {
  PlannedAttitude out;
  if (k == 1) out.inclination_rad = kPi;
  if (k >= 2) {
    const int ring = 1 + (k - 2) / kToolfaceSteps, turn = (k - 2) % kToolfaceSteps;
    out.inclination_rad = kPi / kInclinationSteps * ring;
    out.toolface_rad = 2.0 * kPi / kToolfaceSteps * turn;
  }
  const double s = std::sin(out.inclination_rad);
  out.direction = {-s * std::sin(out.toolface_rad), -s * std::cos(out.toolface_rad), std::cos(out.inclination_rad)};
  return out;
}

/// Rows of a station that the free direction leaves: an orthonormal basis of the whitened readings across the two
/// tangents of the sphere, by Gram-Schmidt over unit vectors.
struct Across {
  int sensors = 0;
  int rows = 0;
  std::array<int, kCapacity> sensor{};
  std::array<double, kCapacity> root_weight{};
  std::array<std::array<double, kCapacity>, kCapacity> row{};
};

double take_out(std::array<double, kCapacity>& v, const std::array<double, kCapacity>& unit, int n) noexcept {
  double shared = 0.0;
  for (int k = 0; k < n; ++k) shared += v[at(k)] * unit[at(k)];
  for (int k = 0; k < n; ++k) v[at(k)] -= shared * unit[at(k)];
  double square = 0.0;
  for (int k = 0; k < n; ++k) square += v[at(k)] * v[at(k)];
  return square;
}

double squared_row_length(const std::array<double, kCapacity>& v, int n) noexcept {
  double square = 0.0;
  for (int k = 0; k < n; ++k) square += v[at(k)] * v[at(k)];
  return square;
}

void normalise(std::array<double, kCapacity>& v, int n, double square) noexcept {
  const double scale = 1.0 / std::sqrt(square);
  for (int k = 0; k < n; ++k) v[at(k)] *= scale;
}

/// Two directions across u.
std::array<Vec3, 2> tangents_of(const Vec3& u) noexcept {
  const Vec3 helper = std::fabs(u[0]) < 0.7 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  Vec3 p = cross(u, helper);
  p = scaled(p, 1.0 / norm(p));
  return {p, cross(u, p)};
}

Across across_of(const Datasheet& datasheet, const SeenAttitude& attitude) noexcept {
  Across out;
  for (int i = 0; i < datasheet.size; ++i) {
    if (!attitude.delivered.has(i)) continue;
    const std::size_t k = at(out.sensors++);
    out.sensor[k] = i;
    out.root_weight[k] = std::sqrt(attitude.samples) / datasheet.sensor[at(i)].row.sigma_mps2;
  }
  const int n = out.sensors;
  // Tangents first, then unit vectors; the tangents' places are dropped at the end.
  std::array<std::array<double, kCapacity>, kCapacity + 2> basis{};
  const std::array<Vec3, 2> tangent = tangents_of(attitude.direction);
  int size = 0;
  for (int c = 0; c < n + 2 && size < n; ++c) {
    std::array<double, kCapacity> v{};
    for (int k = 0; k < n; ++k) {
      const Vec3& h = datasheet.sensor[at(out.sensor[at(k)])].row.axis;
      v[at(k)] = c < 2 ? out.root_weight[at(k)] * dot(h, tangent[at(c)]) : (k == c - 2 ? 1.0 : 0.0);
    }
    const double square = squared_row_length(v, n);
    if (!(square > 1e-18) || !std::isfinite(square)) return Across{};  // samples of no weight, or beyond all numbers
    normalise(v, n, square);
    double left = 1.0;
    for (int pass = 0; pass < 2; ++pass) {
      for (int b = 0; b < size; ++b) left = take_out(v, basis[at(b)], n);
    }
    if (c < 2 ? !(left > 1e-12) : !(left > 1e-8)) {
      if (c < 2) return Across{};  // the sensors see one tangent only: no direction
      continue;
    }
    normalise(v, n, squared_row_length(v, n));
    basis[at(size++)] = v;
  }
  out.rows = size - 2;
  for (int r = 0; r < out.rows; ++r) out.row[at(r)] = basis[at(r + 2)];
  return out;
}

/// One row of the Jacobian in prior units: root-weight times projection, times S (g, 1).
void jacobian_row(const fit::PriorRoots& roots, const Across& across, int r, const Vec3& g,
                  fit::Parameters& out) noexcept {
  out = {};
  for (int k = 0; k < across.sensors; ++k) {
    const int i = across.sensor[at(k)];
    const double weight = across.row[at(r)][at(k)] * across.root_weight[at(k)];
    const Vec3 w = scaled(fit::times(roots[at(i)].axes, g), weight);
    for (int p = 0; p < 3; ++p) out[at(4 * i + p)] = w[at(p)];
    out[at(4 * i + 3)] = weight * roots[at(i)].bias;
  }
}

bool tells(const Datasheet& datasheet, const SeenAttitude& attitude) noexcept {
  const double length = norm(attitude.direction);
  return attitude.samples > 0.0 && std::isfinite(attitude.samples) && std::fabs(length - 1.0) < 1e-6 &&
         fit::independent(datasheet, attitude.delivered & SensorSet::first(datasheet.size));
}

void count_inclinations(const std::array<bool, kInclinationBins>& seen, Coverage& out) noexcept {
  // Bins of 5 deg; the bin after one that was counted is still the same inclination.
  int last = -2;
  for (int k = 0; k < kInclinationBins; ++k) {
    if (!seen[at(k)] || k == last + 1) continue;
    ++out.inclinations;
    last = k;
  }
}

}  // namespace

Coverage coverage_of(const Datasheet& datasheet, const SeenAttitude* attitudes, int count) noexcept {
  Coverage out;
  std::array<bool, kInclinationBins> seen{};
  std::array<bool, kCapacity> sensor_seen{};
  for (int k = 0; k < count && attitudes != nullptr; ++k) {
    const Vec3& u = attitudes[k].direction;
    if (!(std::fabs(norm(u) - 1.0) < 1e-6)) continue;
    const double inclination_rad = std::atan2(hypotenuse(u[0], u[1]), u[2]);
    if (out.attitudes == 0 || inclination_rad < out.inclination_min_rad) out.inclination_min_rad = inclination_rad;
    if (out.attitudes == 0 || inclination_rad > out.inclination_max_rad) out.inclination_max_rad = inclination_rad;
    seen[at(static_cast<int>(std::lround(inclination_rad / kPi * (kInclinationBins - 1))))] = true;
    ++out.attitudes;
    for (int i = 0; i < datasheet.size; ++i) {
      if (!attitudes[k].delivered.has(i)) continue;
      const double part = dot(datasheet.sensor[at(i)].row.axis, u);
      if (!sensor_seen[at(i)] || part < out.lowest[at(i)]) out.lowest[at(i)] = part;
      if (!sensor_seen[at(i)] || part > out.highest[at(i)]) out.highest[at(i)] = part;
      sensor_seen[at(i)] = true;
    }
  }
  count_inclinations(seen, out);
  return out;
}

StationPlanner::StationPlanner(const Datasheet& datasheet, double g_mps2) noexcept
    : datasheet_(&datasheet), g_mps2_(g_mps2), usable_(fit::acceptable(datasheet, g_mps2)) {
  const int n4 = usable_ ? 4 * datasheet.size : 0;
  for (int k = 0; k < n4; ++k) information_[at(k * n4 + k)] = 1.0;
}

bool StationPlanner::add(const SeenAttitude& attitude) noexcept {
  if (!usable_ || !tells(*datasheet_, attitude)) return false;
  const int n4 = 4 * datasheet_->size;
  const fit::PriorRoots roots = fit::prior_roots(*datasheet_);
  const Across across = across_of(*datasheet_, attitude);
  fit::Parameters j;
  for (int r = 0; r < across.rows; ++r) {
    jacobian_row(roots, across, r, scaled(attitude.direction, g_mps2_), j);
    for (int a = 0; a < n4; ++a) {
      for (int b = 0; b <= a; ++b) information_[at(a * n4 + b)] += j[at(a)] * j[at(b)];
    }
  }
  fresh_ = false;
  return across.rows > 0;
}

bool StationPlanner::refresh() noexcept {
  if (fresh_) return true;
  const int n4 = 4 * datasheet_->size;
  covariance_ = information_;
  if (!cholesky_factor(covariance_.data(), n4, n4)) return false;
  cholesky_inverse(covariance_.data(), n4, n4);
  fresh_ = true;
  return true;
}

/// log det(1 + J C J'), by the Cholesky pivots of a matrix of as many rows as the station has.
double StationPlanner::gain_of(const SeenAttitude& attitude) const noexcept {
  const int n4 = 4 * datasheet_->size;
  const fit::PriorRoots roots = fit::prior_roots(*datasheet_);
  const Across across = across_of(*datasheet_, attitude);
  std::array<fit::Parameters, kCapacity> j{};
  std::array<double, std::size_t{kCapacity} * kCapacity> m{};
  for (int r = 0; r < across.rows; ++r) {
    jacobian_row(roots, across, r, scaled(attitude.direction, g_mps2_), j[at(r)]);
    fit::Parameters cj{};
    for (int a = 0; a < n4; ++a) {
      for (int b = 0; b < n4; ++b) cj[at(a)] += covariance_[at(a * n4 + b)] * j[at(r)][at(b)];
    }
    for (int s = 0; s <= r; ++s) {
      double sum = r == s ? 1.0 : 0.0;
      for (int a = 0; a < n4; ++a) sum += j[at(s)][at(a)] * cj[at(a)];
      m[at(r * kCapacity + s)] = sum;
    }
  }
  if (across.rows < 1 || !cholesky_factor(m.data(), across.rows, kCapacity)) return 0.0;
  double gain = 0.0;
  for (int r = 0; r < across.rows; ++r) gain += 2.0 * std::log(m[at(r * kCapacity + r)]);
  return gain;
}

PlannedAttitude StationPlanner::best(double samples) noexcept {
  PlannedAttitude out;
  if (!usable_ || !refresh()) return out;
  for (int k = 0; k < kGrid; ++k) {
    PlannedAttitude point = grid_point(k);
    const SeenAttitude attitude = {point.direction, SensorSet::first(datasheet_->size), samples};
    if (!tells(*datasheet_, attitude)) continue;
    point.gain = gain_of(attitude);
    if (point.gain > out.gain * (1.0 + kSameGain)) out = point;
  }
  return out;
}

int StationPlanner::plan(double samples, int wanted, PlannedAttitude* out) noexcept {
  int written = 0;
  for (; written < wanted && out != nullptr; ++written) {
    out[written] = best(samples);
    if (!(out[written].gain > 0.0)) break;
    add({out[written].direction, SensorSet::first(datasheet_->size), samples});
  }
  return written;
}

}  // namespace PLUMB_ABI
}  // namespace plumb

/// Prior units, and the frame that the prior fixes.
#include <cmath>

#include "fit_internal.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace fit {
namespace {

constexpr int kTurnSteps = 30;
constexpr double kTurnStop = 1e-14;

/// Rotation of v by the vector `turn` (axis times angle), Rodrigues.
Vec3 turned(const Vec3& v, const Vec3& turn) noexcept {
  const double angle = norm(turn);
  if (!(angle > 0.0)) return v;
  const Vec3 axis = scaled(turn, 1.0 / angle);
  const double half = std::sin(0.5 * angle);
  const Vec3 across = cross(axis, v);
  return plus(v, plus(scaled(across, std::sin(angle)), scaled(cross(axis, across), 2.0 * half * half)));
}

}  // namespace

PriorRoots prior_roots(const Datasheet& datasheet) noexcept {
  PriorRoots roots{};
  for (int i = 0; i < datasheet.size; ++i) {
    const DatasheetSensor& s = datasheet.sensor[at(i)];
    PriorRoot& root = roots[at(i)];
    root.axes = {s.prior.axis_rad, 0.0, 0.0, s.prior.axis_rad, 0.0, s.prior.axis_rad};
    add_outer(root.axes, s.row.axis, s.prior.scale - s.prior.axis_rad);
    root.bias = s.prior.bias_mps2;
  }
  return roots;
}

Parameters times_roots(const PriorRoots& roots, int n, const Parameters& v) noexcept {
  Parameters out;
  for (int i = 0; i < n; ++i) {
    const Vec3 axes = times(roots[at(i)].axes, row_of(v, i));
    for (int p = 0; p < 3; ++p) out[at(4 * i + p)] = axes[at(p)];
    out[at(4 * i + 3)] = roots[at(i)].bias * v[at(4 * i + 3)];
  }
  return out;
}

Parameters natural(const Datasheet& datasheet, const PriorRoots& roots, const Parameters& x) noexcept {
  Parameters out = times_roots(roots, datasheet.size, x);
  for (int i = 0; i < datasheet.size; ++i) {
    for (int p = 0; p < 3; ++p) out[at(4 * i + p)] += datasheet.sensor[at(i)].row.axis[at(p)];
  }
  return out;
}

void turn_to_datasheet(const Datasheet& datasheet, Parameters& theta) noexcept {
  const int n = datasheet.size;
  for (int step = 0; step < kTurnSteps; ++step) {
    Symmetric3 inertia{};
    Vec3 torque{};
    for (int i = 0; i < n; ++i) {
      const Vec3 w = row_of(theta, i);
      const Vec3 u = scaled(w, 1.0 / norm(w));
      add_outer(inertia, u, -1.0);
      inertia[0] += 1.0;
      inertia[3] += 1.0;
      inertia[5] += 1.0;
      torque = plus(torque, cross(u, datasheet.sensor[at(i)].row.axis));
    }
    const Vec3 turn = solve(inertia, torque);
    for (int i = 0; i < n; ++i) {
      const Vec3 w = turned(row_of(theta, i), turn);
      for (int p = 0; p < 3; ++p) theta[at(4 * i + p)] = w[at(p)];
    }
    if (!(norm(turn) > kTurnStop)) break;
  }
}

void remove_rotation(const Parameters& theta, int n, Parameters& change) noexcept {
  Symmetric3 inertia{};
  Vec3 moment{};
  for (int i = 0; i < n; ++i) {
    const Vec3 w = row_of(theta, i);
    const double square = dot(w, w);
    add_outer(inertia, w, -1.0);
    inertia[0] += square;
    inertia[3] += square;
    inertia[5] += square;
    moment = plus(moment, cross(row_of(change, i), w));
  }
  const Vec3 turn = solve(inertia, moment);
  for (int i = 0; i < n; ++i) {
    const Vec3 turned_by = cross(row_of(theta, i), turn);
    for (int p = 0; p < 3; ++p) change[at(4 * i + p)] -= turned_by[at(p)];
  }
}

}  // namespace fit
}  // namespace PLUMB_ABI
}  // namespace plumb

/// Prior units, and the frame that the prior fixes.
#include <cmath>

#include "fit_internal.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

using numbers::at;

namespace fit {
namespace {

constexpr int kTurnSteps = 30;
constexpr double kTurnStop = 1e-14;
/// Where the prior is concerned a turn is settled sooner: it weighs nothing against the data.
constexpr double kPriorTurnStop = 1e-9;
constexpr int kHalvings = 20;

void set_row(Parameters& theta, int i, const Vec3& w) noexcept {
  for (int p = 0; p < 3; ++p) theta[at(4 * i + p)] = w[at(p)];
}

/// Adds |v|^2 1 - v v'.
void add_inertia(Symmetric3& inertia, const Vec3& v) noexcept {
  const double square = dot(v, v);
  add_outer(inertia, v, -1.0);
  inertia[0] += square;
  inertia[3] += square;
  inertia[5] += square;
}

/// Angle about `axis` that brings the axes as near to the datasheet's as such a rotation can.
double best_turn_about(const Datasheet& datasheet, const Vec3& axis, const Parameters& theta) noexcept {
  double sine = 0.0, cosine = 0.0;
  for (int i = 0; i < datasheet.size; ++i) {
    const Vec3 w = row_of(theta, i), h = datasheet.sensor[at(i)].row.axis;
    const double share = 1.0 / norm(w);
    sine += share * dot(axis, cross(w, h));
    cosine += share * (dot(w, h) - dot(axis, w) * dot(axis, h));
  }
  return std::atan2(sine, cosine);
}

/// (W - h)'P(W - h), summed: what the prior says of the axes.
double prior_cost(const Datasheet& datasheet, const Parameters& theta) noexcept {
  double sum = 0.0;
  for (int i = 0; i < datasheet.size; ++i) {
    const DatasheetSensor& s = datasheet.sensor[at(i)];
    const Vec3 d = minus(row_of(theta, i), s.row.axis);
    const double along = dot(s.row.axis, d);
    sum += (dot(d, d) - along * along) / (s.prior.axis_rad * s.prior.axis_rad) +
           along * along / (s.prior.scale * s.prior.scale);
  }
  return sum;
}

/// Gauss-Newton step of a common rotation towards the least of `prior_cost`.
Vec3 turn_by_prior(const Datasheet& datasheet, const Parameters& theta) noexcept {
  Symmetric3 curvature{};
  Vec3 slope{};
  for (int i = 0; i < datasheet.size; ++i) {
    const DatasheetSensor& s = datasheet.sensor[at(i)];
    const Vec3 w = row_of(theta, i);
    // A turn by e moves W by e x W, and (e x W)'P(W - h) = e'(W x P(W - h)).
    const double across = 1.0 / (s.prior.axis_rad * s.prior.axis_rad);
    const double along = 1.0 / (s.prior.scale * s.prior.scale) - across;
    const Vec3 d = minus(w, s.row.axis);
    slope = plus(slope, cross(w, plus(scaled(d, across), scaled(s.row.axis, along * dot(s.row.axis, d)))));
    Symmetric3 inertia{};
    add_inertia(inertia, w);
    for (std::size_t k = 0; k < 6; ++k) curvature[k] += across * inertia[k];
    add_outer(curvature, cross(w, s.row.axis), along);
  }
  return scaled(solve(curvature, slope), -1.0);
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
  Parameters out{};
  for (int i = 0; i < n; ++i) {
    const Vec3 axes = times(roots[at(i)].axes, row_of(v, i));
    for (int p = 0; p < 3; ++p) out[at(4 * i + p)] = axes[at(p)];
    out[at(4 * i + 3)] = roots[at(i)].bias * v[at(4 * i + 3)];
  }
  return out;
}

Parameters datasheet_parameters(const Datasheet& datasheet) noexcept {
  Parameters out;
  for (int i = 0; i < datasheet.size; ++i) {
    set_row(out, i, datasheet.sensor[at(i)].row.axis);
    out[at(4 * i + 3)] = 0.0;
  }
  return out;
}

Parameters prior_units(const Datasheet& datasheet, const Parameters& theta) noexcept {
  Parameters out;
  for (int i = 0; i < datasheet.size; ++i) {
    const DatasheetSensor& s = datasheet.sensor[at(i)];
    const Vec3 d = minus(row_of(theta, i), s.row.axis);
    const double along = dot(s.row.axis, d);
    const double across = 1.0 / s.prior.axis_rad;
    set_row(out, i, plus(scaled(d, across), scaled(s.row.axis, along * (1.0 / s.prior.scale - across))));
    out[at(4 * i + 3)] = theta[at(4 * i + 3)] / s.prior.bias_mps2;
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

/// Rodrigues.
void turn_all(const Vec3& turn, int n, Parameters& theta) noexcept {
  const double angle = norm(turn);
  if (!(angle > 0.0)) return;
  const Vec3 axis = scaled(turn, 1.0 / angle);
  const double half = std::sin(0.5 * angle), sine = std::sin(angle);
  for (int i = 0; i < n; ++i) {
    const Vec3 w = row_of(theta, i);
    const Vec3 across = cross(axis, w);
    set_row(theta, i, plus(w, plus(scaled(across, sine), scaled(cross(axis, across), 2.0 * half * half))));
  }
}

void turn_to_datasheet(const Datasheet& datasheet, const Roll& roll, Parameters& theta, int left_out) noexcept {
  const int n = datasheet.size;
  if (roll.used) {
    const Vec3 turn = scaled(roll.axis, best_turn_about(datasheet, roll.axis, theta));
    turn_all(turn, n, theta);
    return;
  }
  for (int step = 0; step < kTurnSteps; ++step) {
    Symmetric3 inertia{};
    Vec3 torque{};
    for (int i = 0; i < n; ++i) {
      if (i == left_out) continue;
      const Vec3 w = row_of(theta, i);
      const Vec3 u = scaled(w, 1.0 / norm(w));
      add_inertia(inertia, u);
      torque = plus(torque, cross(u, datasheet.sensor[at(i)].row.axis));
    }
    const Vec3 turn = solve(inertia, torque);
    turn_all(turn, n, theta);
    if (!(norm(turn) > kTurnStop)) break;
  }
}

void turn_to_prior(const Datasheet& datasheet, int steps, Parameters& theta) noexcept {
  double cost = prior_cost(datasheet, theta);
  for (int step = 0; step < steps; ++step) {
    Vec3 turn = turn_by_prior(datasheet, theta);
    if (!(norm(turn) > kPriorTurnStop)) return;
    Parameters moved;
    double moved_cost = cost;
    for (int half = 0; half < kHalvings; ++half) {
      moved = theta;
      turn_all(turn, datasheet.size, moved);
      moved_cost = prior_cost(datasheet, moved);
      if (moved_cost < cost) break;
      turn = scaled(turn, 0.5);
    }
    if (!(moved_cost < cost)) return;
    cost = moved_cost;
    theta = moved;
  }
}

Vec3 remove_rotation(const Parameters& theta, int n, const Roll& roll, Parameters& change) noexcept {
  Symmetric3 inertia{};
  Vec3 moment{};
  for (int i = 0; i < n; ++i) {
    const Vec3 w = row_of(theta, i);
    add_inertia(inertia, w);
    moment = plus(moment, cross(row_of(change, i), w));
  }
  Vec3 turn = solve(inertia, moment);
  if (roll.used) {
    const double about = dot(roll.axis, times(inertia, roll.axis));
    turn = scaled(roll.axis, about > 0.0 ? dot(roll.axis, moment) / about : 0.0);
  }
  for (int i = 0; i < n; ++i) {
    const Vec3 turned_by = cross(row_of(theta, i), turn);
    for (int p = 0; p < 3; ++p) change[at(4 * i + p)] -= turned_by[at(p)];
  }
  return scaled(turn, -1.0);
}

}  // namespace fit
}  // namespace PLUMB_ABI
}  // namespace plumb

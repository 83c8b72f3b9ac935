/// A start for the fit without iteration (docs/theory.md, section 9.3). With x the vector by the datasheet's own map,
/// any set of sensors of rank 3 that counts linearly puts x on an ellipsoid: x'Qx + 2 l'x = c, nine unknowns with tr Q
/// = 3, linear least squares. Its centre and its root give gravity in the frame that turns x least; readings over that
/// gravity, by linear regression, are W and b. One pass over the stations, for any number of sensors.
#include <cmath>

#include "fit_internal.hpp"
#include "plumb/numeric/cholesky.hpp"
#include "plumb/numeric/symmetric_eigen.hpp"
#include "station_solver.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

using numbers::at;

namespace fit {
namespace {

constexpr int kUnknowns = 9;
/// Least part of a column of the equations that the columns before it must leave: below it the ellipsoid is open in
/// some direction, or only noise closes it.
constexpr double kLeastPivot = 1e-6;
constexpr double kFeigned = 4.0;  ///< noise feigns about its own variance where there is nothing
/// Least over largest axis of the ellipsoid, squared: beyond it the datasheet is not about these sensors.
constexpr double kFlattest = 1e-2;
constexpr int kTurns = 30;  ///< a few are usual

struct EllipsoidMoments {
  int stations = 0;
  double variance = 0.0;  ///< of x, all directions together, sum over the stations
  std::array<double, std::size_t{kUnknowns} * kUnknowns> normal{};
  std::array<double, kUnknowns> rhs{};
  Vec3 x{};
  Symmetric3 xx{};
  std::array<double, kCapacity> y{};
  std::array<Vec3, kCapacity> yx{};
};

/// Readings and vectors in units of gravity.
void add(const StationSolver& s, double g_mps2, EllipsoidMoments& m) noexcept {
  const double share = 1.0 / g_mps2;
  const Vec3 x = scaled(s.estimate, share);
  const std::array<double, kUnknowns> f = {x[0] * x[0] - x[2] * x[2],
                                           x[1] * x[1] - x[2] * x[2],
                                           2.0 * x[0] * x[1],
                                           2.0 * x[0] * x[2],
                                           2.0 * x[1] * x[2],
                                           2.0 * x[0],
                                           2.0 * x[1],
                                           2.0 * x[2],
                                           -1.0};
  const double square = dot(x, x);
  for (int i = 0; i < kUnknowns; ++i) {
    for (int j = 0; j <= i; ++j) m.normal[at(i * kUnknowns + j)] += f[at(i)] * f[at(j)];
    m.rhs[at(i)] -= f[at(i)] * square;
  }
  m.x = plus(m.x, x);
  add_outer(m.xx, x, 1.0);
  for (int k = 0; k < s.rows; ++k) {
    const double y = s.reading[at(k)] * share;
    m.y[at(k)] += y;
    m.yx[at(k)] = plus(m.yx[at(k)], scaled(x, y));
  }
  m.variance += (s.spread[0] + s.spread[3] + s.spread[5]) * share * share;
  ++m.stations;
}

/// x = centre + radius times (unit vector of gravity).
struct Ellipsoid {
  bool valid = false;
  Vec3 centre{};
  Symmetric3 radius{};
};

Ellipsoid ellipsoid_of(EllipsoidMoments& m) noexcept {
  Ellipsoid out;
  std::array<double, kUnknowns> diagonal{};
  for (int k = 0; k < kUnknowns; ++k) diagonal[at(k)] = m.normal[at(k * kUnknowns + k)];
  if (m.stations < kUnknowns || !cholesky_factor(m.normal.data(), kUnknowns, kUnknowns)) return out;
  const double least = std::fmax(kLeastPivot, kFeigned * m.variance / m.stations);
  for (int k = 0; k < kUnknowns; ++k) {
    const double pivot = m.normal[at(k * kUnknowns + k)];
    if (!(pivot * pivot > least * diagonal[at(k)])) return out;
  }
  std::array<double, kUnknowns> u = m.rhs;
  cholesky_solve(m.normal.data(), kUnknowns, kUnknowns, u.data());
  const Symmetric3 q = {1.0 + u[0], u[2], u[3], 1.0 + u[1], u[4], 1.0 - u[0] - u[1]};
  std::array<double, 9> full = {q[0], q[1], q[2], q[1], q[3], q[4], q[2], q[4], q[5]};
  std::array<double, 9> vectors{};
  std::array<double, 3> values{};
  if (!symmetric_eigen(full.data(), 3, 3, values.data(), vectors.data())) return out;
  if (!(values[0] > kFlattest * values[2])) return out;
  const Vec3 l = {u[5], u[6], u[7]};
  out.centre = scaled(solve(q, l), -1.0);
  const double size = u[8] - dot(l, out.centre);
  if (!(size > 0.0)) return out;
  for (std::size_t v = 0; v < 3; ++v) {
    add_outer(out.radius, Vec3{vectors[v], vectors[3 + v], vectors[6 + v]}, std::sqrt(size / values[v]));
  }
  out.valid = true;
  return out;
}

}  // namespace

bool closed_form(const Problem& problem, Parameters& theta) noexcept {
  const Datasheet& datasheet = problem.datasheet;
  const int n = datasheet.size;
  const Parameters nominal = datasheet_parameters(datasheet);
  StationSolver solver(problem, nominal, 0.0);
  EllipsoidMoments m;
  for (int s = 0; s < problem.count; ++s) {
    const Loaded loaded = solver.read(problem.stations[s]);
    if (loaded == Loaded::not_finite) return false;
    // Without some reading x is another function of gravity.
    if (loaded == Loaded::used && solver.rows == n) add(solver, problem.g_mps2, m);
  }
  const Ellipsoid ellipsoid = ellipsoid_of(m);
  if (!ellipsoid.valid) return false;
  const double share = 1.0 / m.stations;
  const Vec3 mean = scaled(m.x, share);
  Symmetric3 scatter = m.xx;
  add_outer(scatter, mean, -static_cast<double>(m.stations));
  for (int i = 0; i < n; ++i) {
    const Vec3 slope = solve(scatter, minus(m.yx[at(i)], scaled(mean, m.y[at(i)])));
    const Vec3 w = times(ellipsoid.radius, slope);
    for (int p = 0; p < 3; ++p) theta[at(4 * i + p)] = w[at(p)];
    theta[at(4 * i + 3)] = problem.g_mps2 * (m.y[at(i)] * share + dot(slope, minus(ellipsoid.centre, mean)));
  }
  turn_to_prior(datasheet, kTurns, theta);
  for (int k = 0; k < 4 * n; ++k) {
    if (!std::isfinite(theta[at(k)])) return false;
  }
  return true;
}

}  // namespace fit
}  // namespace PLUMB_ABI
}  // namespace plumb

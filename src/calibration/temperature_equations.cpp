/// Sums over the stations of a fit over temperature: information about axes, scale factors and biases of all orders,
/// the direction of gravity eliminated.
#include <cmath>

#include "station_solver.hpp"
#include "temperature_model.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

using numbers::at;

namespace fit {
namespace {

using JointColumns = std::array<double, kJointPerSensor>;

/// Minus the derivative of the residual of one sensor by its parameters, in prior units. That of s_j is
/// (W g + b + beta) T_j / s: by the model, not by the noisy reading, which would feign information.
JointColumns columns_of(const Joint& joint, const JointState& state, int i, const Vec3& g, const Cubic& t) noexcept {
  const PriorRoot& root = joint.roots[at(i)];
  const Vec3 axes = times(root.axes, g);
  JointColumns out{axes[0], axes[1], axes[2], root.bias};
  const Cubic &s = state.scale[at(i)], &b = state.bias[at(i)];
  double scale = 0.0, reading = dot(row_of(state.theta, i), g) + state.theta[at(4 * i + 3)];
  for (std::size_t k = 0; k < t.size(); ++k) {
    scale += s[k] * t[k];
    reading += b[k] * t[k];
  }
  for (int j = 1; j <= joint.order; ++j) {
    out[at(2 + 2 * j)] = joint.scale_sigma[at(i)][at(j)] * t[at(j)] * reading / scale;
    out[at(3 + 2 * j)] = joint.bias_sigma[at(i)][at(j)] * t[at(j)];
  }
  return out;
}

/// Adds M (x) z z' and (M e) (x) z, M the projector across the tangents of the sphere.
void add_joint_station(const Joint& joint, const JointState& state, const StationSolver& s, double temperature_degc,
                       double pull, double* information, JointVector& rhs) noexcept {
  const int per = joint.per_sensor(), size = joint.parameters();
  const Cubic t = chebyshev_values(joint.use_degc.scaled(temperature_degc));
  std::array<JointColumns, kCapacity> z{};
  for (int k = 0; k < s.rows; ++k) {
    const int i = s.sensor[at(k)];
    z[at(k)] = columns_of(joint, state, i, s.gravity, t);
    const double projected = pull * s.projected(k);
    for (int p = 0; p < per; ++p) rhs[at(per * i + p)] += projected * z[at(k)][at(p)];
    for (int l = 0; l <= k; ++l) {
      const double m = pull * s.projector(k, l);
      double* block = information + at(per * i) * at(size) + at(per * s.sensor[at(l)]);
      for (int p = 0; p < per; ++p) {
        const double factor = m * z[at(k)][at(p)];
        for (int q = 0; q < per; ++q) block[p * size + q] += factor * z[at(l)][at(q)];
      }
    }
  }
}

}  // namespace

void accumulate(const Joint& joint, const JointState& state, const Problem& reduced, double misfit_variance, Loss loss,
                double* information, JointSums& out, FitTally* tally) noexcept {
  const int size = joint.parameters();
  for (int k = 0; k < size * size; ++k) information[k] = 0.0;
  out = JointSums{};
  StationSolver solver(reduced, state.theta, misfit_variance);
  for (int k = 0; k < reduced.count; ++k) {
    const Station& station = reduced.stations[k];
    const Loaded loaded = solver.solve(station);
    if (loaded == Loaded::skipped) continue;
    if (loaded == Loaded::not_finite) {
      out.sums.finite = false;
      out.sums.bad_station = k;
      return;
    }
    const double pull = pull_of(loss, solver.chi2, solver.freedom());
    add_joint_station(joint, state, solver, station.temperature_degc, pull, information, out.rhs);
    note_station(solver, pull, out.sums);
    if (tally != nullptr) tally->add(solver, reduced.g_mps2);
  }
  out.sums.finite = std::isfinite(out.sums.chi2) && std::isfinite(out.sums.weighted_chi2);
}

}  // namespace fit
}  // namespace PLUMB_ABI
}  // namespace plumb

#include "tools.hpp"

#include <cmath>

namespace plumb_bench {
inline namespace PLUMB_ABI {

using namespace plumb;
using namespace plumb_test;

double worst_error(const LawTool& tool) {
  const TrialTool& t = tool.tool;
  double worst = 0.0;
  TrialNoise noise(1);
  GravityReference exact = t.gravity;
  exact.sigma_mps2 = 0.0;
  BlockEvidence block;
  block.usable = t.array.all();
  block.samples = 1e8;
  for (int k = 0; k < 200; ++k) {
    const Vec3 g = scaled(noise.direction(), kG0_mps2);
    for (int i = 0; i < tool.n(); ++i) block.mean_mps2[slot(i)] = dot(t.row[slot(i)], g) + t.offset_mps2[slot(i)];
    for (int triple = 0; triple < t.array.triple_count(); ++triple) {
      const SetTest test = test_set(t.array, exact, t.limits, block, t.array.triple(triple).set());
      if (test.tested && test.norm_systematic > 0.0)
        worst = std::fmax(worst, std::fabs(test.norm) / test.norm_systematic);
    }
  }
  return worst;
}

namespace {

/// The small turn theta with h + theta x h nearest to w over all rows, by least squares.
Vec3 small_turn(const std::vector<Vec3>& from, const std::vector<Vec3>& to) {
  Vec3 rows[3] = {}, right{};
  for (std::size_t i = 0; i < from.size(); ++i) {
    const Vec3 &h = from[i], &w = to[i];
    right = plus(right, cross(h, minus(w, h)));
    for (std::size_t a = 0; a < 3; ++a) {
      Vec3 unit{};
      unit[a] = 1.0;
      rows[a] = plus(rows[a], minus(scaled(unit, dot(h, h)), scaled(h, h[a])));
    }
  }
  const double det = dot(rows[0], cross(rows[1], rows[2]));
  return scaled(plus(plus(scaled(cross(rows[1], rows[2]), right[0]), scaled(cross(rows[2], rows[0]), right[1])),
                     scaled(cross(rows[0], rows[1]), right[2])),
                1.0 / det);
}

/// `v` turned about `theta` by its length.
Vec3 turned_about(const Vec3& theta, const Vec3& v) {
  const double angle = norm(theta);
  if (angle == 0.0) return v;
  const Vec3 axis = scaled(theta, 1.0 / angle);
  return plus(plus(scaled(v, std::cos(angle)), scaled(cross(axis, v), std::sin(angle))),
              scaled(axis, dot(axis, v) * (1.0 - std::cos(angle))));
}

}  // namespace

AttackTool attack_tool(LawTool tool) {
  AttackTool out{std::move(tool), {1, 0, 0, 0, 1, 0, 0, 0, 1}};
  // The datasheet's axes may lie degrees from the true ones: to the first order alone the frame would be off by the
  // square of that, as much as what is judged in it.
  constexpr int kRounds = 6;
  std::vector<Vec3> from, to;
  for (int i = 0; i < out.law.n(); ++i) {
    from.push_back(out.law.tool.row[slot(i)]);
    to.push_back(out.law.tool.array.axis(i));
  }
  Vec3 column[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (int round = 0; round < kRounds; ++round) {
    const Vec3 theta = small_turn(from, to);
    for (Vec3& row : from) row = turned_about(theta, row);
    for (Vec3& c : column) c = turned_about(theta, c);
  }
  for (std::size_t k = 0; k < 9; ++k) out.turn[k] = column[k % 3][k / 3];
  return out;
}

namespace {

constexpr int kFits = 3;
constexpr int kFitStations = 24;

std::vector<AttackTool> pool_of(int n) {
  std::vector<AttackTool> out;
  TrialNoise noise(static_cast<std::uint64_t>(4000 + n));
  for (int geometry = 0; geometry < 2; ++geometry) {
    const AxisList axes = trial_axes(n, geometry);
    LawTool tool;
    tool.geometry = geometry == 0 ? Geometry::named : Geometry::named_other;
    tool.plane = axes_in_one_plane(axes, n);
    tool.knowledge = Knowledge::exact;
    tool.tool = exact_tool(axes, n, kPoolSigma_mps2);
    out.push_back(attack_tool(tool));
    tool.knowledge = Knowledge::fitted;
    for (int fits = 0; fits < kFits;) {
      tool.tool = fitted_tool(axes, n, kFitStations, noise, kPoolSigma_mps2);
      if (tool.n() != n || worst_error(tool) > 1.0) continue;  // refused, or beyond its own bound
      out.push_back(attack_tool(tool));
      ++fits;
    }
  }
  return out;
}

}  // namespace

const std::vector<AttackTool>& pool(int n) {
  static std::array<std::vector<AttackTool>, 9> pools;
  std::vector<AttackTool>& own = pools[slot(n)];
  if (own.empty()) own = pool_of(n);
  return own;
}

const AttackTool& any_tool(int n, TrialNoise& noise) {
  const std::vector<AttackTool>& all = pool(n);
  return all[slot(noise.below(static_cast<int>(all.size())))];
}

const AttackTool& exact_named_tool(int n) { return pool(n).front(); }

AttackTool misstated_tool(int n, double actual_mps2, double stated_mps2, TrialNoise& noise) {
  LawTool law;
  const AxisList axes = trial_axes(n, noise.below(2));
  law.plane = axes_in_one_plane(axes, n);
  law.knowledge = Knowledge::drawn;
  law.tool = exact_tool(axes, n, kPoolSigma_mps2);
  RowUncertainty known;
  for (int i = 0; i < n; ++i) {
    for (int q = 0; q < 4; ++q) {
      const int k = 4 * i + q;
      const double stated = q == 3 ? stated_mps2 : stated_mps2 / kG0_mps2;
      known.covariance[slot(k * (k + 1) / 2 + k)] = stated * stated;
    }
    for (double& component : law.tool.row[slot(i)]) component += actual_mps2 / kG0_mps2 * noise.normal();
    law.tool.offset_mps2[slot(i)] = actual_mps2 * noise.normal();
  }
  law.tool.array.set_uncertainty(known);
  return attack_tool(std::move(law));
}

AttackTool tool_with_axes(const AxisList& axes, int n) {
  LawTool law;
  law.plane = axes_in_one_plane(axes, n);
  law.tool = exact_tool(axes, n, kPoolSigma_mps2);
  return attack_tool(std::move(law));
}

}  // namespace PLUMB_ABI
}  // namespace plumb_bench

/// Sums over the stations: projected information about (W, b) with the direction of gravity eliminated.
#include <array>
#include <cmath>

#include "fit_internal.hpp"
#include "fit_tally.hpp"
#include "plumb/numeric/detail/add_scaled.hpp"
#include "station_solver.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

using numbers::at;

namespace fit {
namespace {

constexpr int pair_of(int i, int j) noexcept { return i * (i + 1) / 2 + j; }

/// Where entry (p, q) of a 4x4 block stands among the ten moments.
constexpr std::array<int, 16> kMoment = {0, 1, 2, 3, 1, 4, 5, 6, 2, 5, 7, 8, 3, 6, 8, 9};

using Moments = std::array<double, kMomentCount>;

Moments moments_of(const Vec3& g, double weight) noexcept {
  const double x = weight * g[0], y = weight * g[1], z = weight * g[2];
  return {x * g[0], x * g[1], x * g[2], x, y * g[1], y * g[2], y, z * g[2], z, weight};
}

/// Inclination, in its own standard deviations, at which a roll row has lost half of its weight.
constexpr double kStationary = 10.0;

/// The row that a station adds about its inclination: the component of the fitted gravity along the axis.
struct RollRow {
  double weight = 0.0;  ///< 0: none
  double level = 0.0;
  std::array<double, kCapacity> slope{};  ///< minus the derivative by reading, L W t
};

/// Not inlined: who has no roll groups needs no room for it under every station.
[[gnu::noinline]] RollRow roll_row(const Roll& roll, const StationSolver& s, double g_mps2) noexcept {
  RollRow out;
  const Vec3 a = times(s.spread, s.direction), z = times(s.spread, roll.axis);
  const Vec3 t = minus(z, scaled(a, dot(s.direction, z) / s.along));
  out.level = dot(roll.axis, s.gravity);
  const double across = g_mps2 * g_mps2 - out.level * out.level;
  // Along the axis itself the level is stationary, its gradient points wherever noise has it, and a fit that follows it
  // never settles: the row fades out where the inclination is not well above its own uncertainty.
  const double second = kStationary * g_mps2 * s.direction_variance();
  const double variance = dot(roll.axis, t) + roll.wobble_rad * roll.wobble_rad * across + second * second;
  if (!(variance > 0.0)) return out;
  out.weight = 1.0 / variance;
  for (int k = 0; k < s.rows; ++k) out.slope[at(k)] = s.weight[at(k)] * dot(s.row[at(k)], t);
  return out;
}

RollGroup* group_of(RollSums& sums, std::uint32_t tag, double level) noexcept {
  for (int k = 0; k < sums.groups; ++k) {
    if (sums.group[at(k)].tag == tag) return &sums.group[at(k)];
  }
  if (sums.groups == kMaxRollGroups) return nullptr;
  RollGroup& fresh = sums.group[at(sums.groups++)];
  fresh = RollGroup{};
  fresh.tag = tag;
  fresh.origin = level;
  return &fresh;
}

void add_roll(const StationSolver& s, const RollRow& row, double pull, RollGroup& group, Parameters& rhs) noexcept {
  const double weight = pull * row.weight, level = row.level - group.origin;
  ++group.stations;
  group.weight += weight;
  group.level += weight * level;
  group.square += weight * level * level;
  double slopes = 0.0;
  for (int k = 0; k < s.rows; ++k) {
    const int i = s.sensor[at(k)];
    const double slope = weight * row.slope[at(k)];
    slopes += row.slope[at(k)] * row.slope[at(k)];
    for (int p = 0; p < 3; ++p) {
      group.slope[at(4 * i + p)] += slope * s.gravity[at(p)];
      rhs[at(4 * i + p)] += slope * level * s.gravity[at(p)];
    }
    group.slope[at(4 * i + 3)] += slope;
    rhs[at(4 * i + 3)] += slope * level;
  }
  group.growth += weight * slopes;
}

/// Adds M (x) z z' and (M e) (x) z, M the projector across the tangents of the sphere. Not inlined: what it needs would
/// lie under the solution of the next station.
[[gnu::noinline]] void add_station(const StationSolver& s, const RollRow& roll, double pull, double* blocks,
                                   Parameters& rhs) noexcept {
  const Moments moments = moments_of(s.gravity, pull);
  for (int k = 0; k < s.rows; ++k) {
    const int i = s.sensor[at(k)];
    const double projected = pull * s.projected(k);
    for (int p = 0; p < 3; ++p) rhs[at(4 * i + p)] += projected * s.gravity[at(p)];
    rhs[at(4 * i + 3)] += projected;
    const double slope = roll.weight * roll.slope[at(k)];
    for (int l = 0; l <= k; ++l) {
      const double m = s.projector(k, l) + slope * roll.slope[at(l)];
      add_scaled<kMomentCount>(blocks + at(kMomentCount * pair_of(i, s.sensor[at(l)])), moments.data(), m);
    }
  }
}

/// Every group has an inclination of its own: the weighted mean goes out.
void finish_rolls(const RollSums& roll, int n, Sums& sums, Parameters& rhs) noexcept {
  for (int k = 0; k < roll.groups; ++k) {
    const RollGroup& group = roll.group[at(k)];
    if (!(group.weight > 0.0)) continue;
    const double mean = group.level / group.weight;
    for (int p = 0; p < 4 * n; ++p) rhs[at(p)] -= group.slope[at(p)] * mean;
    const double chi2 = std::fmax(group.square - group.level * mean, 0.0);
    sums.chi2 += chi2;
    sums.weighted_chi2 += chi2 * group.growth / static_cast<double>(group.stations);
    sums.rows += group.stations - 1;
  }
}

using Block = std::array<double, 16>;

/// Root times block, or (with the roles of rows and columns exchanged by the caller) block times root.
Block times_root(const PriorRoot& root, const Block& b, bool transpose) noexcept {
  Block out{};
  for (std::size_t q = 0; q < 4; ++q) {
    const std::size_t step = transpose ? 1 : 4, base = transpose ? 4 * q : q;
    const Vec3 column = times(root.axes, Vec3{b[base], b[base + step], b[base + 2 * step]});
    for (std::size_t p = 0; p < 3; ++p) out[base + p * step] = column[p];
    out[base + 3 * step] = root.bias * b[base + 3 * step];
  }
  return out;
}

}  // namespace

void find_roll_groups(const Problem& problem, Roll& roll) noexcept {
  std::array<std::uint32_t, kMaxRollGroups> tag{};
  std::array<int, kMaxRollGroups> members{};
  int groups = 0;
  for (int s = 0; s < problem.count; ++s) {
    const Station& station = problem.stations[s];
    if (station.roll_group == 0 || station.count == 0) continue;
    int k = 0;
    while (k < groups && k < kMaxRollGroups && tag[at(k)] != station.roll_group) ++k;
    if (k == kMaxRollGroups) {
      groups = kMaxRollGroups + 1;
      continue;
    }
    if (k == groups) {
      ++groups;
      tag[at(k)] = station.roll_group;
    }
    ++members[at(k)];
  }
  roll.groups = groups;
  for (int k = 0; k < groups && k < kMaxRollGroups; ++k) {
    if (members[at(k)] > 1) roll.used = true;
    if (members[at(k)] == 1) ++roll.lone;
  }
}

Sums accumulate(const Problem& problem, const Parameters& theta, double misfit_variance, Loss loss, double* blocks,
                Parameters& rhs, const Room& room, FitTally* tally) noexcept {
  RollSums* const roll = room.roll;
  const int n = problem.datasheet.size;
  for (int k = 0; k < kMomentCount * n * (n + 1) / 2; ++k) blocks[k] = 0.0;
  for (int k = 0; k < 4 * n; ++k) rhs[at(k)] = 0.0;
  if (roll != nullptr) roll->groups = 0;
  Sums sums;
  StationSolver solver(problem, theta, misfit_variance);
  RollRow row;
  for (int s = 0; s < problem.count; ++s) {
    const Station& station = problem.stations[s];
    const Loaded loaded = solver.solve(station);
    if (loaded == Loaded::skipped || (room.screening != nullptr && room.screening->out(station))) continue;
    if (loaded == Loaded::not_finite) {
      sums.finite = false;
      sums.bad_station = s;
      return sums;
    }
    const double pull = pull_of(loss, solver.chi2, solver.freedom());
    row.weight = 0.0;
    if (roll != nullptr && problem.roll.used && station.roll_group != 0) {
      row = roll_row(problem.roll, solver, problem.g_mps2);
      RollGroup* group = row.weight > 0.0 ? group_of(*roll, station.roll_group, row.level) : nullptr;
      if (group != nullptr) {
        add_roll(solver, row, pull, *group, rhs);
      } else {
        row.weight = 0.0;
      }
    }
    add_station(solver, row, pull, blocks, rhs);
    note_station(solver, pull, sums);
    if (tally != nullptr) tally->add(solver, problem.g_mps2);
  }
  if (roll != nullptr) finish_rolls(*roll, n, sums, rhs);
  sums.finite = std::isfinite(sums.chi2) && std::isfinite(sums.weighted_chi2);
  return sums;
}

template <class Matrix>
void expand(const double* blocks, const RollSums* roll, const PriorRoots& roots, int n,
            const Matrix& information) noexcept {
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j <= i; ++j) {
      const double* moments = blocks + at(kMomentCount * pair_of(i, j));
      Block block{};
      for (std::size_t k = 0; k < 16; ++k) block[k] = moments[kMoment[k]];
      block = times_root(roots[at(i)], block, false);
      block = times_root(roots[at(j)], block, true);
      for (int p = 0; p < 4; ++p) {
        for (int q = 0; q < 4; ++q) {
          if (Matrix::keeps(4 * i + p, 4 * j + q)) information(4 * i + p, 4 * j + q) = block[at(4 * p + q)];
        }
      }
    }
  }
  for (int k = 0; roll != nullptr && k < roll->groups; ++k) {
    const RollGroup& group = roll->group[at(k)];
    if (!(group.weight > 0.0)) continue;
    const Parameters slope = times_roots(roots, n, group.slope);
    for (int p = 0; p < 4 * n; ++p) {
      const double share = slope[at(p)] / group.weight;
      for (int q = 0; q <= p; ++q) information(p, q) -= share * slope[at(q)];
    }
  }
}

template void expand(const double*, const RollSums*, const PriorRoots&, int, const Square&) noexcept;
template void expand(const double*, const RollSums*, const PriorRoots&, int, const Packed&) noexcept;

}  // namespace fit
}  // namespace PLUMB_ABI
}  // namespace plumb

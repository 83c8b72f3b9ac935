/// Sums over the stations: projected information about (W, b) with the direction of gravity eliminated.
#include <cmath>

#include "fit_internal.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace fit {
namespace {

constexpr int pair_of(int i, int j) noexcept { return i * (i + 1) / 2 + j; }

/// Where entry (p, q) of a 4x4 block stands among the ten moments.
constexpr std::array<int, 16> kMoment = {0, 1, 2, 3, 1, 4, 5, 6, 2, 5, 7, 8, 3, 6, 8, 9};

std::array<double, kMomentCount> moments_of(const Vec3& g) noexcept {
  return {g[0] * g[0], g[0] * g[1], g[0] * g[2], g[0], g[1] * g[1], g[1] * g[2], g[1], g[2] * g[2], g[2], 1.0};
}

/// Adds M (x) z z' and (M e) (x) z, M the whitened projector across the two tangents of the sphere.
void add_station(const StationRows& rows, const StationFit& station, double* blocks, Parameters& rhs) noexcept {
  const std::array<double, kMomentCount> moments = moments_of(station.gravity);
  double along1 = 0.0, along2 = 0.0;
  for (int k = 0; k < rows.rows; ++k) {
    along1 += station.tangent1[at(k)] * station.residual[at(k)];
    along2 += station.tangent2[at(k)] * station.residual[at(k)];
  }
  for (int k = 0; k < rows.rows; ++k) {
    const int i = rows.sensor[at(k)];
    const double t1 = station.tangent1[at(k)], t2 = station.tangent2[at(k)];
    const double projected = rows.weight[at(k)] * station.residual[at(k)] - t1 * along1 - t2 * along2;
    for (int p = 0; p < 3; ++p) rhs[at(4 * i + p)] += projected * station.gravity[at(p)];
    rhs[at(4 * i + 3)] += projected;
    for (int l = 0; l <= k; ++l) {
      double m = -t1 * station.tangent1[at(l)] - t2 * station.tangent2[at(l)];
      if (l == k) m += rows.weight[at(k)];
      double* block = blocks + at(kMomentCount * pair_of(i, rows.sensor[at(l)]));
      for (int q = 0; q < kMomentCount; ++q) block[q] += m * moments[at(q)];
    }
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

Sums accumulate(const Problem& problem, const Parameters& theta, double misfit_variance, double* blocks,
                Parameters& rhs) noexcept {
  const int n = problem.datasheet.size;
  for (int k = 0; k < kMomentCount * n * (n + 1) / 2; ++k) blocks[k] = 0.0;
  for (int k = 0; k < 4 * n; ++k) rhs[at(k)] = 0.0;
  Sums sums;
  StationRows rows;
  StationFit station;
  for (int s = 0; s < problem.count; ++s) {
    const Loaded loaded = load_rows(problem.datasheet, problem.stations[s], misfit_variance, rows);
    if (loaded == Loaded::skipped) continue;
    if (loaded == Loaded::used) fit_station(rows, theta, problem.g_mps2, station);
    if (loaded == Loaded::not_finite || !station.finite) {
      sums.finite = false;
      return sums;
    }
    add_station(rows, station, blocks, rhs);
    ++sums.stations;
    sums.rows += rows.rows;
    sums.chi2 += station.chi2;
    for (int k = 0; k < rows.rows; ++k) {
      const double scaled_residual = rows.weight[at(k)] * station.residual[at(k)];
      sums.weighted_chi2 += scaled_residual * scaled_residual;
    }
  }
  sums.finite = std::isfinite(sums.chi2) && std::isfinite(sums.weighted_chi2);
  return sums;
}

void expand(const double* blocks, const PriorRoots& roots, int n, double* information) noexcept {
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j <= i; ++j) {
      const double* moments = blocks + at(kMomentCount * pair_of(i, j));
      Block block{};
      for (std::size_t k = 0; k < 16; ++k) block[k] = moments[kMoment[k]];
      block = times_root(roots[at(i)], block, false);
      block = times_root(roots[at(j)], block, true);
      for (int p = 0; p < 4; ++p) {
        for (int q = 0; q < 4; ++q) information[(4 * i + p) * 4 * n + 4 * j + q] = block[at(4 * p + q)];
      }
    }
  }
}

}  // namespace fit
}  // namespace PLUMB_ABI
}  // namespace plumb

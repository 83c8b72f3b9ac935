/// The tools that the laws are put to: every geometry, calibrated perfectly, with known errors, or by a fit. Grades are
/// counted here from the axes alone, so that a monitor which counts wrongly is found out.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "plumb/health/health_monitor.hpp"
#include "support/isolation_trials.hpp"

namespace plumb_test {
inline namespace PLUMB_ABI {

enum class Geometry : std::uint8_t { named, named_other, random, coplanar, triads };
enum class Knowledge : std::uint8_t { exact, drawn, fitted };

/// A pool entry: the tool, and monitors that are about to watch it.
struct LawTool {
  TrialTool tool;
  Geometry geometry = Geometry::named;
  Knowledge knowledge = Knowledge::exact;
  int plane = 2;  ///< c(H): axes in one plane, at most
  int n() const { return tool.array.size(); }
  int strict() const { return n() - 1 - plane; }
  int parity() const { return n() - 2 - plane; }
};

/// The most axes that lie in the plane of any two, counted one by one; parallel axes span no plane of their own.
inline int axes_in_one_plane(const plumb::AxisList& axes, int n) {
  int most = 2;
  for (int i = 0; i < n; ++i) {
    for (int j = i + 1; j < n; ++j) {
      const plumb::Vec3 across = plumb::cross(axes[slot(i)], axes[slot(j)]);
      const double sine = plumb::norm(across);
      if (sine < 1e-6) continue;
      int count = 0;
      for (int k = 0; k < n; ++k) count += std::abs(plumb::dot(axes[slot(k)], across)) < 0.05 * sine ? 1 : 0;
      most = std::max(most, count);
    }
  }
  return most;
}

inline double least_determinant(const plumb::AxisList& axes, int n) {
  double least = 1.0;
  for (int i = 0; i < n; ++i) {
    for (int j = i + 1; j < n; ++j) {
      for (int k = j + 1; k < n; ++k) {
        const double det = plumb::dot(axes[slot(i)], plumb::cross(axes[slot(j)], axes[slot(k)]));
        least = std::min(least, std::abs(det));
      }
    }
  }
  return least;
}

/// Axes anywhere, every three of them with a determinant of at least 0.15 (n = 4, 5) to 0.06 (n = 8).
inline plumb::AxisList random_axes(int n, TrialNoise& noise) {
  const double floor = n <= 5 ? 0.15 : n == 6 ? 0.1 : 0.06;
  plumb::AxisList axes{};
  do {
    for (int i = 0; i < n; ++i) axes[slot(i)] = noise.direction();
  } while (least_determinant(axes, n) < floor);
  return axes;
}

/// `plane` axes in one plane, the others out of it.
inline plumb::AxisList coplanar_axes(int n, int plane, TrialNoise& noise) {
  plumb::AxisList axes{};
  do {
    const plumb::Vec3 u = noise.direction();
    plumb::Vec3 v = plumb::cross(u, noise.direction());
    v = plumb::scaled(v, 1.0 / plumb::norm(v));
    for (int i = 0; i < n; ++i) {
      const double angle = (i + 0.3 * noise.uniform()) * plumb::kPi / plane;
      axes[slot(i)] = i < plane ? plumb::plus(plumb::scaled(u, std::cos(angle)), plumb::scaled(v, std::sin(angle)))
                                : noise.direction();
    }
  } while (axes_in_one_plane(axes, n) != plane);
  return axes;
}

/// Triads at right angles, all turned alike but for a polarity or two; what is left of n repeats the first axes.
inline plumb::AxisList triad_axes(int n, TrialNoise& noise) {
  plumb::AxisList axes{};
  const plumb::Vec3 a = noise.direction();
  plumb::Vec3 b = plumb::cross(a, noise.direction());
  b = plumb::scaled(b, 1.0 / plumb::norm(b));
  const plumb::Vec3 frame[3] = {a, b, plumb::cross(a, b)};
  for (int i = 0; i < n; ++i) axes[slot(i)] = plumb::scaled(frame[i % 3], noise.sign());
  return axes;
}

/// Errors drawn within two sigmas from a covariance that the monitor knows: 0.03 mg0 in every row and offset.
inline TrialTool drawn_tool(const plumb::AxisList& axes, int n, TrialNoise& noise) {
  TrialTool tool = exact_tool(axes, n);
  constexpr double kLeft = 3e-5;
  plumb::RowUncertainty known;
  const auto draw = [&noise] {
    double z = noise.normal();
    while (std::abs(z) > 2.0) z = noise.normal();
    return kLeft * z;
  };
  for (int i = 0; i < n; ++i) {
    for (int q = 0; q < 4; ++q) {
      const int k = 4 * i + q;
      const double sigma = q == 3 ? kLeft * plumb::kG0_mps2 : kLeft;
      known.covariance[slot(k * (k + 1) / 2 + k)] = sigma * sigma;
    }
    for (double& component : tool.row[slot(i)]) component += draw();
    tool.offset_mps2[slot(i)] = draw() * plumb::kG0_mps2;
  }
  tool.array.set_uncertainty(known);
  return tool;
}

inline LawTool law_tool(const plumb::AxisList& axes, int n, Geometry geometry, Knowledge knowledge, TrialNoise& noise) {
  LawTool out;
  out.geometry = geometry;
  out.knowledge = knowledge;
  out.plane = axes_in_one_plane(axes, n);
  do {
    out.tool = knowledge == Knowledge::exact   ? exact_tool(axes, n)
               : knowledge == Knowledge::drawn ? drawn_tool(axes, n, noise)
                                               : fitted_tool(axes, n, 60, noise);
  } while (out.n() != n);  // a fit may be refused: another draw
  return out;
}

/// Every geometry of n sensors that can name anybody, with every kind of calibration. The same at every call.
inline std::vector<LawTool> law_tools(int n) {
  std::vector<LawTool> out;
  TrialNoise noise(static_cast<std::uint64_t>(7000 + n));
  const auto add = [&](const plumb::AxisList& axes, Geometry geometry) {
    if (n - 1 - axes_in_one_plane(axes, n) < 1) return;
    const bool alone = geometry == Geometry::triads || geometry == Geometry::named_other;
    for (const Knowledge knowledge : {Knowledge::exact, Knowledge::drawn, Knowledge::fitted}) {
      if (alone && knowledge == Knowledge::drawn) continue;
      out.push_back(law_tool(axes, n, geometry, knowledge, noise));
    }
  };
  add(trial_axes(n, 0), Geometry::named);
  add(trial_axes(n, 1), Geometry::named_other);
  add(random_axes(n, noise), Geometry::random);
  add(random_axes(n, noise), Geometry::random);
  if (n >= 5) add(coplanar_axes(n, 3, noise), Geometry::coplanar);
  if (n >= 6) add(coplanar_axes(n, 4, noise), Geometry::coplanar);
  if (n >= 6) add(triad_axes(n, noise), Geometry::triads);
  return out;
}

}  // namespace PLUMB_ABI
}  // namespace plumb_test

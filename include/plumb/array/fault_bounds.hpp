/// How large a fault must be so that no error of the healthy sensors can hide it, at any attitude and whatever the
/// other faulty sensors read (theorem T7). Needs no gravity.
#pragma once

#include <array>

#include "plumb/array/geometry.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

/// Row k: k units (sensors, where no chips are stated) may read anything, the sensors of the other u - k keep |h_j.d|
/// within their slack, d being the difference between the truth and another explanation. Infinite where u - k units may
/// lie in one plane (u - k <= c) and for k = 0.
struct FaultBounds {
  /// [k][i]: a larger fault of sensor i, its unit one of the k, has no such explanation. In the unit of the slack.
  std::array<Readings, kCapacity + 1> fault{};
  /// [k]: how far the vector of another explanation can lie from the truth. In the unit of the slack.
  std::array<double, kCapacity + 1> vector_error{};
  int sensors = 0;

  /// The largest of a row: enough for every sensor. Infinite where k is out of range.
  double worst_fault(int k) const noexcept;
};

/// Bounds for a slack per sensor, > 0 [any one unit]. A consistent set and the truth may both miss a reading by e, so a
/// slack of 2 gives the constants in units of e: fault[m] detects m faults, fault[2m] tells m faulty units from every
/// other m, fault[m+1] tells one faulty unit where explanations with m faults are admitted.
///
/// The extremes are vertices of {d: |h_j.d| <= slack_j, j trusted}, each cut out by three sensors; a vertex counts for
/// k when at most k units object to it, none of its own among them. That is linear programming duality: the largest
/// |h_i.d| over the polytope equals the cheapest way to predict sensor i from three trusted ones. O(n^4), no
/// allocation.
FaultBounds fault_bounds(const SensorArray& array, const Readings& slack) noexcept;

/// The same slack for every sensor.
FaultBounds fault_bounds(const SensorArray& array, double slack = 2.0) noexcept;

}  // namespace PLUMB_ABI
}  // namespace plumb

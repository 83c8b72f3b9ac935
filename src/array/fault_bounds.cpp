#include "plumb/array/fault_bounds.hpp"

#include <cmath>
#include <cstddef>
#include <limits>

#include "plumb/core/detail/numbers.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

using numbers::at;
using numbers::kInfinity;

namespace {

/// A reading this much beyond its slack, relative, still touches it: corners where more than three sensors meet.
constexpr double kTouches = 1e-9;

void raise(double& entry, double to) noexcept {
  if (to > entry) entry = to;
}

/// One vertex: what it does to the vector, and to every sensor that is not to be trusted. The units of its corner are
/// trusted with all of their sensors, and units are what is counted.
void count_vertex(const SensorArray& array, const Readings& slack, SensorSet corner, const Vec3& d,
                  FaultBounds& out) noexcept {
  const SensorUnits& units = array.units();
  const SensorSet trusted = units.whole(corner);
  Readings off{};
  SensorSet objects;
  for (int i = 0; i < array.size(); ++i) {
    off[at(i)] = std::fabs(dot(array.axis(i), d));
    if (!corner.has(i) && off[at(i)] > slack[at(i)] * (1.0 + kTouches)) objects = objects.with(i);
  }
  if (!(objects & trusted).empty()) return;  // no vertex of what these units allow
  const int against = units.count(objects);
  raise(out.vector_error[at(against)], norm(d));
  for (int i = 0; i < array.size(); ++i) {
    if (trusted.has(i)) continue;
    const int k = units.count(objects.with(i));
    raise(out.fault[at(k)][at(i)], slack[at(i)] + off[at(i)]);
  }
}

/// All eight sign patterns of a triple, less those that only turn d round.
void count_triple(const SensorArray& array, const Readings& slack, int triple, FaultBounds& out) noexcept {
  const Triple& t = array.triple(triple);
  if (std::isinf(t.condition)) return;
  const Mat3 map = triple_map(array, triple);
  const double a = slack[t.sensors[0]];
  const double b = slack[t.sensors[1]];
  const double c = slack[t.sensors[2]];
  for (const double sb : {1.0, -1.0}) {
    for (const double sc : {1.0, -1.0}) count_vertex(array, slack, t.set(), times(map, {a, sb * b, sc * c}), out);
  }
}

}  // namespace

double FaultBounds::worst_fault(int k) const noexcept {
  if (k < 1 || k > sensors) return kInfinity;
  double worst = 0.0;
  for (int i = 0; i < sensors; ++i) raise(worst, fault[at(k)][at(i)]);
  return worst;
}

FaultBounds fault_bounds(const SensorArray& array, const Readings& slack) noexcept {
  FaultBounds out;
  const int n = array.size();
  out.sensors = n;
  for (int t = 0; t < array.triple_count(); ++t) count_triple(array, slack, t, out);
  const int last = array.units().size() - 1 - coplanarity(array, array.all());
  for (int k = 1; k <= n; ++k) {
    // Whoever may distrust k units may distrust fewer.
    raise(out.vector_error[at(k)], out.vector_error[at(k - 1)]);
    if (k > last) {
      out.fault[at(k)].fill(kInfinity);
      out.vector_error[at(k)] = kInfinity;
      continue;
    }
    for (int i = 0; i < n; ++i) raise(out.fault[at(k)][at(i)], out.fault[at(k - 1)][at(i)]);
  }
  if (last < 0) out.vector_error[0] = kInfinity;
  out.fault[0].fill(kInfinity);
  return out;
}

FaultBounds fault_bounds(const SensorArray& array, double slack) noexcept {
  Readings all{};
  all.fill(slack);
  return fault_bounds(array, all);
}

}  // namespace PLUMB_ABI
}  // namespace plumb

#include "plumb/health/detail/window.hpp"

#include <cmath>

namespace plumb {
inline namespace PLUMB_ABI {

RowPlace Window::place_of_others(SensorSet now, SensorSet before) noexcept {
  return now.contains(before) ? RowPlace::begins_block : RowPlace::left_out;
}

SensorSet Window::delivered() const noexcept { return block.complete(); }

void Window::power_on(int triples, int window) noexcept {
  begin_block();
  mae.configure(triples, window);
  forget_near();
  latest_mps2 = Vec3{};
  clipped = not_finite = SensorSet{};
}

void Window::begin_block() noexcept {
  block.clear();
  raw.clear();
}

#if PLUMB_SINGLE
void Window::add(const InForce& in_force, const LeastSquares& map, const Mat3& frame, SensorSet in_service,
                 const Readings& y, SensorSet usable, double count) noexcept {
  const double g_mps2 = in_force.gravity.g_mps2;
  Differences d;
  block.add(y, usable, count, d);
  if (block.size() == 1 || !near.is_of(block)) near.take(in_force.array, map, frame, block, g_mps2);
  NearLengths::Estimate latest;
  if (map.valid && usable.contains(in_service)) {
    if (NearLengths::near(d, usable).contains(in_service)) latest = near.estimate(d, in_service);
    if (latest.units < 0) {
      const Vec3 x = map.estimate(y);
      latest = {times(frame, x), to_mae_units(norm(x) - g_mps2)};
    }
    latest_mps2 = latest.framed_mps2;
  }
  mae.add(in_force.array, y, usable, near, d, latest.units, g_mps2);
}
#else
void Window::add(const InForce& in_force, const LeastSquares& map, const Mat3& frame, SensorSet in_service,
                 const Readings& y, SensorSet usable, double count) noexcept {
  const bool determined = map.valid && usable.contains(in_service);
  const Vec3 latest = determined ? map.estimate(y) : Vec3{};
  mae.add(in_force.array, y, usable, determined ? &latest : nullptr, in_force.gravity.g_mps2);
  if (determined) latest_mps2 = times(frame, latest);
  block.add(y, usable, count);
}
#endif

}  // namespace PLUMB_ABI
}  // namespace plumb

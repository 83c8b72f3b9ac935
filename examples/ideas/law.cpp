// A law on your array: over random faults within its grade, no healthy sensor is ever excluded.
#include <cstdio>

#include "plumb/array/named.hpp"
#include "plumb/testing/laws.hpp"

int main() {
  plumb::testing::Case c;
  plumb::AxisList axes{};
  plumb::SensorRow rows[5];
  plumb::cone(axes, 5);
  const char* const ids[] = {"a1", "a2", "a3", "a4", "a5"};
  for (std::size_t i = 0; i < 5; ++i) rows[i] = {plumb::make_id(ids[i]), axes[i], 0.002};
  c.array = *plumb::SensorArray::make(rows, 5);
  int held = 0;
  for (c.seed = 1; c.seed <= 40; ++c.seed) {  // 40 runs, a bias of another size on another sensor in each
    plumb::scenario::Fault fault{plumb::scenario::FaultKind::bias_step, static_cast<int>(c.seed % 5)};
    fault.clock = plumb::scenario::Clock::station;
    fault.onset = 2;
    fault.magnitude = 0.02 * static_cast<double>(c.seed);
    c.faults = {fault};
    held += plumb::testing::never_excludes_a_healthy_sensor(c).holds;
  }
  std::printf("%d of 40\n", held);
}

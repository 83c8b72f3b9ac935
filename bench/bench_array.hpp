/// The arrays of the benchmarks: the paper's four sensors, or so many on a cone.
#pragma once

#include <array>
#include <string>

#include "plumb/array/named.hpp"
#include "plumb/array/sensor_array.hpp"
#include "plumb/core/units.hpp"

namespace plumb_bench {
inline namespace PLUMB_ABI {

inline plumb::SensorArray array_of(int n) {
  plumb::AxisList axes{};
  if (n == 4) {
    plumb::paper_tetrahedron(axes);
  } else {
    plumb::cone(axes, n);
  }
  std::array<plumb::SensorRow, plumb::kCapacity> rows{};
  for (int i = 0; i < n; ++i) {
    auto& row = rows[static_cast<std::size_t>(i)];
    row.id = plumb::make_id(("a" + std::to_string(i + 1)).c_str());
    row.axis = axes[static_cast<std::size_t>(i)];
    row.sigma_mps2 = 2e-4 * plumb::kG0_mps2;
  }
  return *plumb::SensorArray::make(rows.data(), n);
}

}  // namespace PLUMB_ABI
}  // namespace plumb_bench

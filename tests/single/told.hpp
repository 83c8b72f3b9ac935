/// Knows nothing of plumb's types, which are others in every build.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace single_test {

/// What one step said: what decides, and figures.
struct Told {
  std::array<std::uint64_t, 18> words{};
  std::array<double, 3> gravity_mps2{}, latest_mps2{};
  double protection_rad = 0.0;
  std::array<double, 2> mae_mps2{};
};

std::vector<Told> double_run(double sigma_mps2, std::uint32_t seed, bool rough);

}  // namespace single_test

// The run by the monitor in double: the only file of these tests that is compiled for it.
#include "recorded_run.hpp"

namespace single_test {

std::vector<Told> double_run(double sigma_mps2, std::uint32_t seed, bool rough) {
  return recorded_run(sigma_mps2, seed, rough);
}

}  // namespace single_test

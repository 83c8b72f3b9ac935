// The steppers that this program has, one per capacity.
#include <algorithm>

#include "builds.hpp"
#include "plumb/session/stepper.hpp"

#define PLUMB_DECLARE_STEPPER(ABI, CAPACITY, WINDOW)                               \
  namespace plumb {                                                                \
  namespace ABI {                                                                  \
  namespace stepping_detail {                                                      \
  std::unique_ptr<stepping::Stepper> make(const std::vector<std::uint8_t>& setup); \
  }                                                                                \
  }                                                                                \
  }
PLUMB_FOR_EACH_BUILD(PLUMB_DECLARE_STEPPER)
#undef PLUMB_DECLARE_STEPPER

namespace plumb {
namespace stepping {
namespace {

using Make = std::unique_ptr<Stepper> (*)(const std::vector<std::uint8_t>& setup);

const std::vector<Build<Make>>& builds() {
#define PLUMB_STEPPER(ABI, CAPACITY, WINDOW) {CAPACITY, WINDOW, ABI::stepping_detail::make},
  static const std::vector<Build<Make>> all = {PLUMB_FOR_EACH_BUILD(PLUMB_STEPPER)};
#undef PLUMB_STEPPER
  return all;
}

}  // namespace

const std::vector<int>& stepper_capacities() {
  static const std::vector<int> all = capacities_of(builds());
  return all;
}

std::unique_ptr<Stepper> make_stepper(const std::vector<std::uint8_t>& setup, int sensors, int window,
                                      int least_capacity) {
  for (const Build<Make>& build : builds()) {
    if (build.holds(std::max(sensors, least_capacity), window)) return build.make(setup);
  }
  return nullptr;
}

}  // namespace stepping
}  // namespace plumb

// The steppers that this program has, one per capacity.
#include "kernel/stepper.hpp"

#define PLUMB_DECLARE_STEPPER(ABI)                                                 \
  namespace plumb {                                                                \
  namespace ABI {                                                                  \
  namespace stepping_detail {                                                      \
  std::unique_ptr<stepping::Stepper> make(const std::vector<std::uint8_t>& setup); \
  }                                                                                \
  }                                                                                \
  }
PLUMB_DECLARE_STEPPER(cap4)
PLUMB_DECLARE_STEPPER(cap8)
PLUMB_DECLARE_STEPPER(cap24)
#undef PLUMB_DECLARE_STEPPER

namespace plumb {
namespace stepping {
namespace {

using Make = std::unique_ptr<Stepper> (*)(const std::vector<std::uint8_t>& setup);
struct Build {
  int capacity;
  int window;  ///< longest window of the monitor (plumb/core/config.hpp)
  Make make;
};

const std::vector<Build>& builds() {
  static const std::vector<Build> all = {
#ifdef PLUMB_STEPPER_4
      {4, 32, cap4::stepping_detail::make},
#endif
#ifdef PLUMB_STEPPER_8
      {8, 32, cap8::stepping_detail::make},
#endif
#ifdef PLUMB_STEPPER_24
      {24, 256, cap24::stepping_detail::make},
#endif
  };
  return all;
}

}  // namespace

const std::vector<int>& stepper_capacities() {
  static const std::vector<int> all = [] {
    std::vector<int> out;
    for (const Build& build : builds()) out.push_back(build.capacity);
    return out;
  }();
  return all;
}

std::unique_ptr<Stepper> make_stepper(const std::vector<std::uint8_t>& setup, int sensors, int window,
                                      int least_capacity) {
  for (const Build& build : builds()) {
    if (build.capacity < least_capacity || build.capacity < sensors || build.window < window) continue;
    return build.make(setup);
  }
  return nullptr;
}

}  // namespace stepping
}  // namespace plumb

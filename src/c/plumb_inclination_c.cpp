// Inclination in motion behind the C header: copies in, one call, copies out. Nothing is decided here.
#include <algorithm>
#include <new>
#include <type_traits>

#include "motion_c.hpp"
#include "plumb/motion/continuous_inclination.hpp"

/// What stands in the storage of the caller.
struct plumb_inclination {
  std::uint64_t alive = 0;
  plumb::ContinuousInclination inclination;
};

namespace {

using namespace plumb;
using namespace plumb::c_api;

constexpr std::uint64_t kInclinationAlive = 0x706c756d622d6931ULL;

static_assert(std::is_trivially_destructible<plumb_inclination>::value, "storage may simply be dropped");
static_assert(static_cast<int>(InclinationStatus::contradicts_gravity) == PLUMB_INCLINATION_CONTRADICTS_GRAVITY,
              "the header names them all");

InclinationSetup inclination_setup_of(const plumb_inclination_config& config) noexcept {
  InclinationSetup out;
  std::copy(config.axis, config.axis + 3, out.axis.begin());
  out.axis_bound_rad = config.axis_bound_rad;
  out.velocity_bound_mps = config.velocity_bound_mps;
  out.window_s = config.window_s;
  out.gravity_mps2 = config.gravity_mps2;
  out.gravity_bound_mps2 = config.gravity_bound_mps2;
  return out;
}

plumb_inclination_interval interval_of(const InclinationInterval& from, bool is_new) noexcept {
  plumb_inclination_interval out{};
  out.struct_size = sizeof out;
  out.status = static_cast<std::int32_t>(from.status);
  out.is_new = is_new ? 1 : 0;
  out.widest = static_cast<std::int32_t>(from.widest);
  out.gyro_assumed = from.gyro_assumed ? 1 : 0;
  out.time_s = from.time_s;
  out.span_s = from.span_s;
  out.inclination_rad = from.inclination_rad;
  out.low_rad = from.low_rad;
  out.high_rad = from.high_rad;
  return out;
}

}  // namespace

extern "C" {

plumb_error plumb_inclination_config_defaults(plumb_inclination_config* config) noexcept {
  if (config == nullptr) return missing(0);
  const InclinationSetup d;
  *config = plumb_inclination_config{};
  config->struct_size = sizeof(plumb_inclination_config);
  std::copy(d.axis.begin(), d.axis.end(), config->axis);
  config->axis_bound_rad = d.axis_bound_rad;
  config->velocity_bound_mps = d.velocity_bound_mps;
  config->window_s = d.window_s;
  config->gravity_mps2 = d.gravity_mps2;
  config->gravity_bound_mps2 = d.gravity_bound_mps2;
  return answer(PLUMB_OK);
}

plumb_error plumb_inclination_interval_defaults(plumb_inclination_interval* interval) noexcept {
  if (interval == nullptr) return missing(0);
  *interval = interval_of(InclinationInterval{}, false);
  return answer(PLUMB_OK);
}

const char* plumb_inclination_status_text(std::int32_t status) noexcept {
  return to_string(static_cast<InclinationStatus>(number_of(status)));
}
const char* plumb_inclination_term_text(std::int32_t term) noexcept {
  return to_string(static_cast<InclinationTerm>(number_of(term)));
}

size_t plumb_inclination_size(void) noexcept { return sizeof(plumb_inclination); }
size_t plumb_inclination_align(void) noexcept { return alignof(plumb_inclination); }

plumb_error plumb_inclination_init(void* storage, size_t storage_size, const plumb_motion_config* motion,
                                   const plumb_inclination_config* config, plumb_inclination** inclination) noexcept {
  if (inclination == nullptr) return missing(4);
  *inclination = nullptr;
  plumb_error e = room_for<plumb_inclination>(storage, storage_size, 0);
  MotionProblem problem;
  if (e.code == PLUMB_OK) e = prepare(motion, 2, problem);
  if (e.code == PLUMB_OK) e = check_struct(config, 3);
  if (e.code != PLUMB_OK) return e;
  auto* made = new (storage) plumb_inclination;
  e = answer(made->inclination.configure(problem.array, problem.setup, inclination_setup_of(*config)));
  if (e.code != PLUMB_OK) return e;
  made->alive = kInclinationAlive;
  *inclination = made;
  return e;
}

plumb_error plumb_inclination_step(plumb_inclination* inclination, const plumb_motion_sample* sample,
                                   const plumb_motion* motion, plumb_inclination_interval* interval) noexcept {
  plumb_error e = check_alive(inclination, kInclinationAlive, 0);
  if (e.code == PLUMB_OK) e = check_struct(sample, 1);
  if (e.code == PLUMB_OK) e = check_alive(motion, kMotionAlive, 2);
  const plumb_error writable = check_struct(interval, 3);
  if (e.code == PLUMB_OK) e = writable;
  if (e.code != PLUMB_OK) {  // what stood there before is not the answer to this call
    if (writable.code == PLUMB_OK) *interval = interval_of(InclinationInterval{}, false);
    return e;
  }
  const bool is_new = inclination->inclination.step(sample_of(*sample), motion->monitor.verdict());
  *interval = interval_of(inclination->inclination.interval(), is_new);
  return e;
}

}  // extern "C"

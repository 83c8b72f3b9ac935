// Chips with clocks of their own behind the C header: copies in, one call, copies out. Nothing is decided here.
#include <new>
#include <type_traits>

#include "motion_c.hpp"
#include "plumb/motion/motion_clocks.hpp"

/// What stands in the storage of the caller.
struct plumb_clocks {
  plumb_motion motion;  ///< alive where the clocks are
  plumb::MotionClocks clocks;
};

namespace {

using namespace plumb;
using namespace plumb::c_api;

static_assert(std::is_trivially_destructible<plumb_clocks>::value, "storage may simply be dropped");

/// Errors: wrong struct of a clock, more clocks than there is room for.
plumb_error read(const plumb_chip_clock* clock, std::int32_t clocks, ClockSetup& out) noexcept {
  if (clock == nullptr) return missing(3);
  if (clocks < 1 || clocks > kMotionClocks)
    return answer({Errc::out_of_range, 199, static_cast<double>(clocks), static_cast<double>(kMotionClocks)});
  out.clocks = clocks;
  for (size_t c = 0; c < static_cast<size_t>(clocks); ++c) {
    const plumb_chip_clock& from = clock[c];
    const plumb_error e = check_struct(&from, static_cast<int>(c));
    if (e.code != PLUMB_OK) return e;
    MotionClock& to = out.clock[c];
    to.sensors = SensorSet(from.sensors);
    for (size_t g = 0; g < static_cast<size_t>(kGyros); ++g) to.gyro[g] = (from.gyros >> g & 1U) != 0;
    to.sample_period_s = from.sample_period_s;
    to.offset_s = from.offset_s;
    to.rate = from.rate;
    to.since_s = from.since_s;
    to.valid_s = from.valid_s;
    to.offset_bound_s = from.offset_bound_s;
    to.rate_bound = from.rate_bound;
  }
  return answer(PLUMB_OK);
}

plumb_error check_clocks(const plumb_clocks* c) noexcept {
  return check_alive(c == nullptr ? nullptr : &c->motion, kMotionAlive, 0);
}

}  // namespace

extern "C" {

plumb_error plumb_chip_clock_defaults(plumb_chip_clock* clock) noexcept {
  if (clock == nullptr) return missing(0);
  const MotionClock d;
  *clock = plumb_chip_clock{};
  clock->struct_size = sizeof(plumb_chip_clock);
  clock->sample_period_s = d.sample_period_s;
  clock->valid_s = d.valid_s;
  return answer(PLUMB_OK);
}

const char* plumb_clock_push_text(std::int32_t push) noexcept {
  return to_string(static_cast<ClockPush>(number_of(push)));
}

std::int32_t plumb_clocks_capacity(void) noexcept { return kMotionClocks; }
size_t plumb_clocks_size(void) noexcept { return sizeof(plumb_clocks); }
size_t plumb_clocks_align(void) noexcept { return alignof(plumb_clocks); }

plumb_error plumb_clocks_init(void* storage, size_t storage_size, const plumb_motion_config* config,
                              const plumb_chip_clock* clock, std::int32_t clocks, double wait_s,
                              plumb_clocks** made) noexcept {
  if (made == nullptr) return missing(6);
  *made = nullptr;
  plumb_error e = room_for<plumb_clocks>(storage, storage_size, 0);
  MotionProblem problem;
  ClockSetup stated;
  if (e.code == PLUMB_OK) e = prepare(config, 2, problem);
  if (e.code == PLUMB_OK) e = read(clock, clocks, stated);
  if (e.code != PLUMB_OK) return e;
  stated.wait_s = wait_s;
  auto* out = new (storage) plumb_clocks;
  e = answer(out->clocks.configure(problem.array, problem.setup, stated));
  if (e.code == PLUMB_OK) e = answer(with_clocks(stated, problem.array, problem.setup));
  if (e.code == PLUMB_OK) e = answer(out->motion.monitor.configure(problem.array, problem.setup));
  if (e.code != PLUMB_OK) return e;
  out->motion.alive = kMotionAlive;
  *made = out;
  return e;
}

plumb_error plumb_clocks_push(plumb_clocks* clocks, std::int32_t clock, const plumb_motion_sample* sample,
                              std::int32_t* push) noexcept {
  plumb_error e = check_clocks(clocks);
  if (e.code == PLUMB_OK) e = check_struct(sample, 2);
  ClockPush became = ClockPush::not_configured;
  if (e.code == PLUMB_OK) became = clocks->clocks.push(clock, sample_of(*sample));
  if (push != nullptr) *push = static_cast<std::int32_t>(became);
  return e;
}

plumb_error plumb_clocks_set(plumb_clocks* clocks, std::int32_t clock, double offset_s, double rate,
                             double since_s) noexcept {
  const plumb_error e = check_clocks(clocks);
  return e.code == PLUMB_OK ? answer(clocks->clocks.set_clock(clock, offset_s, rate, since_s)) : e;
}

plumb_error plumb_clocks_next(plumb_clocks* clocks, double now_s, plumb_motion_verdict* verdict,
                              std::int32_t* drawn) noexcept {
  if (drawn != nullptr) *drawn = 0;
  plumb_error e = check_clocks(clocks);
  if (e.code == PLUMB_OK && drawn == nullptr) e = missing(3);
  if (e.code == PLUMB_OK && verdict != nullptr) e = check_struct(verdict, 2);
  if (e.code != PLUMB_OK) return without_verdict(e, verdict);
  MotionSample common;
  if (!clocks->clocks.next(now_s, common)) return e;
  *drawn = 1;
  const MotionVerdict& found = clocks->motion.monitor.step(common);
  if (verdict != nullptr) *verdict = verdict_of(found);
  return e;
}

plumb_motion* plumb_clocks_motion(plumb_clocks* clocks) noexcept {
  return check_clocks(clocks).code == PLUMB_OK ? &clocks->motion : nullptr;
}

}  // extern "C"

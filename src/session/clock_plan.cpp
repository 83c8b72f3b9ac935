#include "clock_plan.hpp"

#include <cmath>
#include <string>

namespace plumb {
inline namespace PLUMB_ABI {
namespace session {
namespace {

/// As `plumb::check` numbers what it refuses of clocks.
constexpr int kWait = 198, kFirstClock = 200, kFields = 10;
constexpr const char* kField[] = {"sample_period_s", "offset_s",       "rate",       "since_s",
                                  "valid_s",         "offset_bound_s", "rate_bound", "offset_bound_s"};

std::string field_of(const io::ArrayFile& array, int index) {
  if (index == kWait) return "motion.clock_wait_s";
  const int clock = (index - kFirstClock) / kFields, field = (index - kFirstClock) % kFields;
  const bool stated = index >= kFirstClock && clock < static_cast<int>(array.motion.clocks.size());
  if (!stated || field >= static_cast<int>(std::size(kField))) return "clock";
  return "clock[" + std::to_string(clock + 1) + "]." + kField[field];
}

}  // namespace

ClockPlan clock_plan_of(const io::ArrayFile& array, const MotionSetup& setup) {
  ClockPlan out;
  out.setup.wait_s = array.motion.clock_wait_s.value_or(out.setup.wait_s);
  MotionClock left;
  left.sensors = array.array.all();
  left.sample_period_s = setup.sample_period_s;
  left.valid_s = kMostTime_s;
  for (std::size_t g = 0; g < left.gyro.size(); ++g) left.gyro[g] = static_cast<int>(g) < setup.gyros;
  const auto add = [&out](const MotionClock& clock, const std::string& name) {
    out.setup.clock[static_cast<std::size_t>(out.setup.clocks++)] = clock;  // the file has room for all
    out.name.push_back(name);
  };
  for (const io::ClockSpec& one : array.motion.clocks) {
    MotionClock clock = one.clock;
    clock.sample_period_s = one.sample_period_s.value_or(setup.sample_period_s);
    left.sensors = left.sensors - clock.sensors;
    for (std::size_t g = 0; g < left.gyro.size(); ++g) left.gyro[g] = left.gyro[g] && !clock.gyro[g];
    add(clock, one.name);
  }
  out.stated = array.motion.clocks.size();
  if (!left.sensors.empty() || left.gyro[0] || left.gyro[1]) add(left, "what has no [[clock]]");
  return out;
}

std::optional<io::FileError> apply_clocks(const io::ArrayFile& array, MotionPlan& plan) {
  const Expected<void> applied = with_clocks(plan.clocks->setup, plan.array, plan.setup);
  if (applied) return std::nullopt;
  return io::FileError{array.path,
                       0,
                       field_of(array, applied.error().index),
                       "is beyond what motion can be judged with: motion is not judged",
                       "state smaller bounds of the clock and of lags, or a clock nearer to the common one",
                       io::ExitCode::invalid_input};
}

/// Clocks that share a column deliver together, and those without one once every common period.
double rows_per_sample(const io::ArrayFile& array, int sensor) noexcept {
  const double common_s =
      array.motion.sample_period_s.value_or(array.input.rate_hz > 0.0 ? 1.0 / array.input.rate_hz : 1e-3);
  const std::vector<io::ClockSpec>& clocks = array.motion.clocks;
  const auto period_s = [common_s](const io::ClockSpec& one) { return one.sample_period_s.value_or(common_s); };
  SensorSet left = array.array.all();
  double rows_per_s = 0.0, own_s = 0.0;
  for (std::size_t c = 0; c < clocks.size(); ++c) {
    left = left - clocks[c].clock.sensors;
    if (clocks[c].clock.sensors.has(sensor)) own_s = period_s(clocks[c]);
    bool shared = false;
    for (std::size_t b = 0; b < c; ++b) shared = shared || clocks[b].column == clocks[c].column;
    rows_per_s += shared ? 0.0 : 1.0 / period_s(clocks[c]);
  }
  if (own_s == 0.0) return 1.0;
  if (!left.empty()) rows_per_s += 1.0 / common_s;
  return std::fmax(1.0, own_s * rows_per_s);
}

double stamp_of(const MotionClock& clock, double common_s) noexcept {
  return (common_s + clock.offset_s - clock.rate * clock.since_s) / (1.0 - clock.rate);
}

double common_time_of(const MotionClock& clock, double stamp_s) noexcept {
  return stamp_s - clock.offset_s - clock.rate * (stamp_s - clock.since_s);
}

io::ClockTimes shown_by_clocks(const io::ArrayFile& array, double common_s) noexcept {
  io::ClockTimes out = io::kNoClockTimes;
  for (std::size_t c = 0; c < array.motion.clocks.size(); ++c)
    out[c] = stamp_of(array.motion.clocks[c].clock, common_s);
  return out;
}

}  // namespace session
}  // namespace PLUMB_ABI
}  // namespace plumb

#include "plumb/session/motion_feed.hpp"

#include <cmath>

#include "clock_plan.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace session {
namespace {

/// Beyond it a step says nothing of the sample period: the longest that `plumb::check` takes.
constexpr double kLongestPeriod_s = 1.0;

void note(std::uint64_t& count, double& first_s, double time_s) noexcept {
  if (count++ == 0) first_s = time_s;
}

}  // namespace

MotionFeed::MotionFeed(const MotionPlan& plan)
    : plan_(plan),
      rates_{MotionInputsWatch(plan.setup.sample_period_s), MotionInputsWatch(plan.setup.sample_period_s)} {
  if (!plan.clocks) return;
  clocks_ = std::make_unique<MotionClocks>();
  (void)clocks_->configure(plan.array, plan.setup, plan.clocks->setup);  // the plan has asked `check` already
  for (std::size_t c = 0; c < plan.clocks->name.size(); ++c) {
    ClockRun& run = runs_.emplace_back();
    run.name = plan.clocks->name[c];
    run.clock = plan.clocks->setup.clock[c];
    run.wait_s = plan.clocks->setup.wait_s;
    run.of_the_log = c >= plan.clocks->stated;
  }
  last_s_.assign(runs_.size(), std::nan(""));
}

bool MotionFeed::delivered(const MotionClock& clock, const MotionSample& row) const noexcept {
  bool any = !(clock.sensors & row.delivered).empty();
  for (std::size_t g = 0; g < clock.gyro.size(); ++g) any = any || (clock.gyro[g] && row.rate_given[g]);
  return any;
}

void MotionFeed::take(const MotionSample& row, const double* clock_s) noexcept {
  row_ = row;
  pending_ = true;
  for (std::size_t c = 0; c < runs_.size(); ++c) {
    const double time_s = runs_[c].of_the_log ? row.time_s : clock_s[c];
    if (!std::isfinite(time_s) || time_s == last_s_[c] || !delivered(runs_[c].clock, row)) continue;
    push(c, time_s, row);
    last_s_[c] = time_s;
  }
}

void MotionFeed::push(std::size_t clock, double time_s, const MotionSample& row) noexcept {
  ClockRun& run = runs_[clock];
  MotionSample sample = row;
  sample.time_s = time_s;
  const ClockPush became = clocks_->push(static_cast<int>(clock), sample);
  ++run.samples;
  run.late_sum_s += row.time_s - common_time_of(run.clock, time_s);
  const double step_s = time_s - last_s_[clock];
  if (step_s > 0.0 && step_s <= kLongestPeriod_s) {
    ++run.steps;
    run.step_sum_s += step_s;
  }
  if (became == ClockPush::began_anew) note(run.anew, run.first_anew_s, row.time_s);
  if (became == ClockPush::out_of_order) note(run.early, run.first_early_s, row.time_s);
  if (became == ClockPush::not_valid || became == ClockPush::not_finite)
    note(run.not_valid, run.first_not_valid_s, row.time_s);
  for (std::size_t g = 0; g < run.clock.gyro.size(); ++g) {
    if (!run.clock.gyro[g]) continue;
    rates_[g].add(row.time_s);
    rates_[g].add_rate(g, row.rate_given[g], row.rate_radps[g]);
  }
}

bool MotionFeed::next(MotionSample& out) noexcept {
  if (clocks_ == nullptr) {
    const bool has = pending_;
    pending_ = false;
    if (has) out = row_;
    return has;
  }
  if (!pending_) return false;
  if (!clocks_->next(row_.time_s, out)) {
    pending_ = false;
    return false;
  }
  for (ClockRun& run : runs_) {
    ++run.instants;
    run.absent += delivered(run.clock, out) ? 0U : 1U;
  }
  return true;
}

}  // namespace session
}  // namespace PLUMB_ABI
}  // namespace plumb

#include "plumb/session/rate_run.hpp"

#include <cmath>
#include <limits>
#include <utility>

#include "plumb/io/json_fields.hpp"
#include "plumb/session/detail/step_rows.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace session {
namespace {

/// From so much of full scale on a reading counts as clipped, as in the monitor at rest.
constexpr double kClipped = 0.995;

constexpr double kNever_s = std::numeric_limits<double>::infinity();

/// More than a block holds. Accelerometers that deliver no rows for so long say nothing of rest.
constexpr std::size_t kMostWaiting = 4 * kWindowCapacity;

SensorSet clipped_of(const io::ArrayFile& array, const Sample& sample) {
  SensorSet out;
  for (int i = 0; i < array.datasheet.size; ++i) {
    const auto a = static_cast<std::size_t>(i);
    const double full = array.datasheet.sensor[a].full_scale_raw;
    if (full > 0.0 && std::fabs(sample.raw[a]) >= kClipped * full) out = out.with(i);
  }
  return out;
}

}  // namespace

RateSample rate_sample(const io::ArrayFile& array, const SensorModel& model, const Sample& sample) {
  RateSample out;
  out.time_s = sample.time_s;
  out.delivered = sample.delivered;
  out.clipped = clipped_of(array, sample) & sample.delivered;
  out.rate_radps = model.apply(sample.raw, sample.temperature_degc, sample.delivered);
  return out;
}

RateWatch::RateWatch(const io::ArrayFile& array, RateGroup group, bool waits_for_rest)
    : array_(array), group_(std::move(group)), waits_(waits_for_rest) {
  newest_.time_s = std::numeric_limits<double>::quiet_NaN();
  run_.calibrated = group_.calibrated;
  run_.common = group_.common;
}

io::FileExpected<std::unique_ptr<RateWatch>> RateWatch::make(const io::ArrayFile& array, bool waits_for_rest,
                                                             const io::GyroCalibration* calibration) {
  io::FileExpected<RateGroup> group = rate_group(array, calibration);
  if (!group) return tl::unexpected<io::FileError>(group.error());
  std::unique_ptr<RateWatch> out(new RateWatch(array, *std::move(group), waits_for_rest));
  const Expected<void> made = out->monitor_.configure(out->group_.array, out->group_.setup);
  if (made) return out;
  io::FileError error = io::from_error(made.error());
  error.file = array.path;
  error.field = "rate";
  return tl::unexpected<io::FileError>(error);
}

io::FileExpected<void> RateWatch::take(const stepping::Rows& rows) {
  Sample sample;
  io::FileExpected<void> done;
  for (std::size_t k = 0; k < rows.row.size() && done; ++k) {
    stepping_detail::take_row(rows, k, sample);
    newest_ = rate_sample(array_, group_.model, sample);
    waiting_.push_back(newest_);
    if (!waits_ || waiting_.size() > kMostWaiting) done = step_until(waiting_.front().time_s, kNever_s);
  }
  return done;
}

io::FileExpected<void> RateWatch::rested(const TrackPoint& block) { return step_until(block.end_s, block.begin_s); }
io::FileExpected<void> RateWatch::moved(double until_s) { return step_until(until_s, kNever_s); }

io::FileExpected<void> RateWatch::step_until(double until_s, double rest_from_s) {
  io::FileExpected<void> done;
  while (done && !waiting_.empty() && waiting_.front().time_s <= until_s) {
    RateSample& next = waiting_.front();
    next.at_rest = next.time_s >= rest_from_s;
    done = step(next);
    waiting_.pop_front();
  }
  return done;
}

io::FileExpected<void> RateWatch::step(const RateSample& sample) {
  for (int i = 0; i < array_.array.size(); ++i) {
    const auto a = static_cast<std::size_t>(i);
    const bool heard = sample.delivered.has(i) && std::isfinite(sample.rate_radps[a]);
    if (run_.samples == 0 || heard) heard_s_[a] = sample.time_s;
  }
  ++run_.samples;
  run_.samples_at_rest += sample.at_rest ? 1 : 0;
  const RateVerdict before = run_.last;
  const RateVerdict& now = monitor_.step(sample);
  if (now.turned_at_rest && !before.turned_at_rest && run_.turned_at_rest++ == 0) run_.turned_at_rest_s = sample.time_s;
  if (now.alarm && !before.alarm && run_.alarms++ == 0) run_.first_alarm_s = sample.time_s;
  count(now);
  const bool changed = now.alarm != before.alarm || now.suspects != before.suspects ||
                       now.excluded != before.excluded || now.off_at_rest != before.off_at_rest ||
                       now.turned_at_rest != before.turned_at_rest;
  if (!changed) return {};
  const RateEvent event{sample.time_s,      now.suspects, now.excluded, now.off_at_rest,
                        now.turned_at_rest, now.alarm,    now.cause};
  io::FileExpected<void> done;
  for (const Sink& sink : sinks_) {
    if (done) done = sink(event);
  }
  return done;
}

void RateWatch::count(const RateVerdict& now) {
  run_.ever_excluded = run_.ever_excluded | now.excluded;
  run_.ever_off_at_rest = run_.ever_off_at_rest | now.off_at_rest;
  if (now.block_ended) {
    ++run_.blocks;
    const double bound_radps = with_common_part(group_, norm(now.block.rate_radps), now.block.bound_radps);
    if (now.block.validity != ForceValidity::none && std::isfinite(bound_radps)) {
      ++run_.bounded_blocks;
      run_.bound_sum_radps += bound_radps;
      run_.worst_bound_radps = std::fmax(run_.worst_bound_radps, bound_radps);
    }
  }
  run_.last = now;
}

io::FileExpected<RateRun> RateWatch::end(LogEnd end) {
  const io::FileExpected<void> done = step_until(std::numeric_limits<double>::infinity(), kNever_s);
  if (!done) return tl::unexpected<io::FileError>(done.error());
  static_cast<LogEnd&>(run_) = std::move(end);
  for (int i = 0; i < array_.array.size(); ++i) {
    const double quiet_s = run_.log.last_time_s - heard_s_[static_cast<std::size_t>(i)];
    if (!(quiet_s > kSilent_s)) continue;
    run_.silent_s = run_.silent.empty() ? quiet_s : std::fmin(run_.silent_s, quiet_s);
    run_.silent = run_.silent.with(i);
  }
  return run_;
}

std::string rate_event_json(const RateEvent& event, const SensorArray& array) {
  return io::object({{"t_s", event.time_s},
                     {"cause", to_string(event.cause)},
                     {"suspects", io::ids_of(event.suspects, array)},
                     {"excluded", io::ids_of(event.excluded, array)},
                     {"off_at_rest", io::ids_of(event.off_at_rest, array)},
                     {"turned_at_rest", event.turned_at_rest},
                     {"alarm", event.alarm}})
      .dump();
}

}  // namespace session
}  // namespace PLUMB_ABI
}  // namespace plumb

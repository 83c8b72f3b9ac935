#include "plumb/session/rate_run.hpp"

#include <cmath>

#include "plumb/io/json_fields.hpp"
#include "plumb/session/interrupt.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace session {
namespace {

/// From so much of full scale on a reading counts as clipped, as in the monitor at rest.
constexpr double kClipped = 0.995;

SensorSet clipped_of(const io::ArrayFile& array, const Sample& sample) {
  SensorSet out;
  for (int i = 0; i < array.datasheet.size; ++i) {
    const auto a = static_cast<std::size_t>(i);
    const double full = array.datasheet.sensor[a].full_scale_raw;
    if (full > 0.0 && std::fabs(sample.raw[a]) >= kClipped * full) out = out.with(i);
  }
  return out;
}

/// What a run adds up from verdict to verdict.
void take(const RateVerdict& now, double time_s, const RateGroup& group, RateRun& run) {
  RateEvent event{time_s, now.suspects, now.excluded, now.off_at_rest, now.turned_at_rest, now.cause};
  const RateVerdict& before = run.last;
  const bool changed = now.suspects != before.suspects || now.excluded != before.excluded ||
                       now.off_at_rest != before.off_at_rest || now.turned_at_rest != before.turned_at_rest;
  if (changed) run.events.push_back(event);
  if (now.turned_at_rest && !before.turned_at_rest && run.turned_at_rest++ == 0) run.turned_at_rest_s = time_s;
  run.ever_excluded = run.ever_excluded | now.excluded;
  run.ever_off_at_rest = run.ever_off_at_rest | now.off_at_rest;
  if (now.block_ended) {
    ++run.blocks;
    const double bound_radps = with_common_part(group, norm(now.block.rate_radps), now.block.bound_radps);
    if (now.block.validity != ForceValidity::none && std::isfinite(bound_radps)) {
      ++run.bounded_blocks;
      run.bound_sum_radps += bound_radps;
      run.worst_bound_radps = std::fmax(run.worst_bound_radps, bound_radps);
    }
  }
  run.last = now;
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

io::FileExpected<RateRun> run_rates(const io::ArrayFile& array, const LogSpec& log, RestTimes* rest,
                                    const io::GyroCalibration* calibration) {
  const io::FileExpected<RateGroup> group = rate_group(array, calibration);
  if (!group) return tl::unexpected<io::FileError>(group.error());
  auto monitor = std::make_unique<RateMonitor>();
  if (const Expected<void> made = monitor->configure(group->array, group->setup); !made) {
    io::FileError error = io::from_error(made.error());
    error.file = array.path;
    error.field = "rate";
    return tl::unexpected<io::FileError>(error);
  }
  io::FileExpected<io::LogReader> reader = io::LogReader::open(log.path, array, log.on_bad_row);
  if (!reader) return tl::unexpected<io::FileError>(reader.error());
  reader->stop_when(interrupt_flag());
  RateRun run;
  run.calibrated = group->calibrated;
  run.common = group->common;
  Readings heard_s{};
  Sample sample;
  io::LogReader::Next next = io::LogReader::Next::row;
  while ((next = reader->next(sample)) == io::LogReader::Next::row) {
    RateSample one = rate_sample(array, group->model, sample);
    one.at_rest = rest != nullptr && rest->at_rest(sample.time_s);
    run.samples_at_rest += one.at_rest ? 1 : 0;
    for (int i = 0; i < array.array.size(); ++i) {
      const auto a = static_cast<std::size_t>(i);
      const bool heard = one.delivered.has(i) && std::isfinite(one.rate_radps[a]);
      if (run.samples == 0 || heard) heard_s[a] = sample.time_s;
    }
    ++run.samples;
    take(monitor->step(one), sample.time_s, *group, run);
  }
  run.log = reader->statistics();
  for (int i = 0; i < array.array.size(); ++i) {
    const double quiet_s = run.log.last_time_s - heard_s[static_cast<std::size_t>(i)];
    if (!(quiet_s > kSilent_s)) continue;
    run.silent_s = run.silent.empty() ? quiet_s : std::fmin(run.silent_s, quiet_s);
    run.silent = run.silent.with(i);
  }
  run.interrupted = interrupted();
  run.stopped = next == io::LogReader::Next::error;
  if (run.stopped) run.stop = reader->error();
  return run;
}

std::string rate_event_json(const RateEvent& event, const SensorArray& array) {
  return io::object({{"t_s", event.time_s},
                     {"cause", to_string(event.cause)},
                     {"suspects", io::ids_of(event.suspects, array)},
                     {"excluded", io::ids_of(event.excluded, array)},
                     {"off_at_rest", io::ids_of(event.off_at_rest, array)},
                     {"turned_at_rest", event.turned_at_rest}})
      .dump();
}

}  // namespace session
}  // namespace PLUMB_ABI
}  // namespace plumb

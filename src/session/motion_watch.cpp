#include "plumb/session/motion_watch.hpp"

#include <cmath>

#include "plumb/health/motion_link.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace session {
namespace {

static_assert(static_cast<std::size_t>(MotionCause::irregular_time) + 1 == kMotionCauses);

bool judged(MotionCause cause) noexcept {
  return cause != MotionCause::rotation_unknown && cause != MotionCause::no_redundancy &&
         cause != MotionCause::irregular_time;
}

void note_first(SensorSet now, SensorSet& ever, std::array<double, kCapacity>& at_s, double time_s) {
  const SensorSet news = now - ever;
  for (std::size_t i = 0; i < at_s.size(); ++i) {
    if (news.has(static_cast<int>(i))) at_s[i] = time_s;
  }
  ever = ever | now;
}

/// A table that is written as the run goes on, with its header.
io::FileExpected<io::OutputFile> begun(const std::string& path, const std::string& header) {
  io::FileExpected<io::OutputFile> file = io::OutputFile::create(path, io::OutputFile::Mode::stream);
  if (!file) return file;
  const io::FileExpected<void> written = file->write(header);
  if (!written) return tl::unexpected<io::FileError>(written.error());
  return file;
}

io::FileExpected<void> put(io::OutputFile& file, const std::string& line, bool live) {
  io::FileExpected<void> done = file.write(line);
  if (done && live) done = file.flush();
  return done;
}

}  // namespace

MotionWatch::MotionWatch(const MotionPlan& plan)
    : plan_(plan),
      monitor_(std::make_unique<MotionMonitor>()),
      sampler_(plan_),
      feed_(plan_),
      inputs_(plan.setup.sample_period_s),
      clock_s_(feed_.stated(), std::nan("")) {
  (void)monitor_->configure(plan_.array, plan_.setup);  // the plan has asked `check` already
  run_.rates_of_group = plan_.rates.has_value();
  if (plan.inclination) (void)inclination_.emplace().configure(plan_.array, plan_.setup, *plan.inclination);
}

void MotionWatch::at_turn(const stepping::Turn& turn) { turn_[0] = turn; }
void MotionWatch::at_second_turn(const stepping::Turn& turn) { turn_[1] = turn; }

MotionSample MotionWatch::row_of(const Sample& sample) {
  MotionSample out = sampler_.sample(sample);
  if (!feed_.has_clocks()) inputs_.add(sample.time_s);
  for (std::size_t g = 0; g < static_cast<std::size_t>(plan_.setup.gyros); ++g) {
    if (!turn_[g]) continue;
    if (!feed_.has_clocks()) inputs_.add_rate(g, turn_[g]->rate_known, turn_[g]->rate_radps);
    out.rate_given[g] = turn_[g]->rate_known;
    out.rate_radps[g] = turn_[g]->rate_radps;
  }
  if (plan_.rates && gyros_ != nullptr) add_group_rate(out);
  return out;
}

/// Gyros that did not deliver in this row give no rate.
void MotionWatch::add_group_rate(MotionSample& row) {
  const RateSample& gyros = gyros_->newest();
  ToolRate rate;
  if (gyros.time_s == row.time_s) rate = plan_.rates->step(gyros, gyros_->failed());
  constexpr std::uint64_t kFirstRows = 2;  // of which no slope can be known
  if (!rate.begins || inputs_.found().rows > kFirstRows) inputs_.add_rate(0, rate.given, rate.rate_radps);
  if (!rate.given) return;
  row.rate_given[0] = true;
  row.rate_radps[0] = rate.rate_radps;
  row.interpolation_radps[0] = rate.bound_radps;
}

void MotionWatch::note_events(const MotionVerdict& before, const MotionVerdict& now, double time_s) {
  using io::MotionEventKind;
  const auto add = [this, &now, time_s](MotionEventKind kind, SensorSet sensors, MotionCause cause) {
    events_.push_back({kind, time_s, sensors, cause, now.least_faults});
  };
  const bool named = !now.isolated.empty() || !(now.excluded - before.excluded).empty();
  if (now.alarm && !before.alarm) add(MotionEventKind::alarm, now.suspects, named ? MotionCause::none : now.cause);
  if (const SensorSet news = now.isolated - before.isolated; !news.empty())
    add(MotionEventKind::isolated, news, MotionCause::none);
  if (const SensorSet news = now.excluded - before.excluded; !news.empty())
    add(MotionEventKind::excluded, news, MotionCause::none);
  if (now.gyros_disagree && !before.gyros_disagree) add(MotionEventKind::gyros_disagree, {}, MotionCause::none);
  if (before.alarm && !now.alarm) add(MotionEventKind::alarm_over, {}, MotionCause::none);
}

void MotionWatch::count(const MotionVerdict& verdict, double time_s) {
  MotionRun& run = run_;
  ++run.samples;
  run.judged += judged(verdict.cause) ? 1U : 0U;
  ++run.why[static_cast<std::size_t>(verdict.cause)];
  run.in_alarm += verdict.alarm ? 1U : 0U;
  if (verdict.alarm && !run.last.alarm && run.alarms++ == 0) run.first_alarm_s = time_s;
  if (verdict.gyros_disagree && !run.last.gyros_disagree && run.gyro_disagreements++ == 0)
    run.gyros_disagree_s = time_s;
  run.suspects = run.suspects | verdict.suspects;
  note_first(verdict.isolated | verdict.excluded, run.isolated, run.isolated_at_s, time_s);
  note_first(verdict.excluded, run.excluded, run.excluded_at_s, time_s);
  if (verdict.block_ended && std::isfinite(verdict.block.bound_mps2)) {
    ++run.blocks;
    run.blocks_unchecked += verdict.block.validity == ForceValidity::unchecked ? 1U : 0U;
    run.blocks_by_one_gyro += verdict.block.gyro_assumed ? 1U : 0U;
    run.bound_sum_mps2 += verdict.block.bound_mps2;
    ++run.dominant[static_cast<std::size_t>(verdict.block.dominant)];
    if (verdict.block.bound_mps2 > run.worst_bound_mps2) {
      run.worst_bound_mps2 = verdict.block.bound_mps2;
      run.worst_bound_at_s = verdict.block.time_s;
    }
  }
  run.inputs = inputs_.found();
  if (feed_.has_clocks()) {
    for (std::size_t g = 0; g < run.inputs.gyro.size(); ++g) run.inputs.gyro[g] = feed_.rates(g);
  }
  run.last = verdict;
}

io::FileExpected<void> MotionWatch::take(const Sample& sample, const Verdict& verdict) {
  if (settles_motion(verdict)) {
    const SensorSet excluded = monitor_->verdict().excluded;
    if (!excluded.empty())
      events_.push_back({io::MotionEventKind::forgotten, sample.time_s, excluded, MotionCause::none, 0});
    monitor_->forget();
  }
  monitor_->set_in_service(verdict.in_service);
  feed_.take(row_of(sample), clock_s_.data());
  turn_ = {};
  io::FileExpected<void> done;
  MotionSample moved;
  while (done && feed_.next(moved)) done = judge(moved);
  if (feed_.has_clocks()) run_.clocks = feed_.clocks();
  return done;
}

io::FileExpected<void> MotionWatch::judge(const MotionSample& sample) {
  if (feed_.has_clocks()) inputs_.add(sample.time_s);
  const MotionVerdict before = monitor_->verdict();
  const MotionVerdict& now = monitor_->step(sample);
  note_events(before, now, sample.time_s);
  count(now, sample.time_s);
  found_ = {now.alarm, now.excluded.bits};
  for (MotionSink* sink : sinks_) {
    const io::FileExpected<void> taken = sink->take(sample.time_s, now, events_);
    if (!taken) return taken;
  }
  events_.clear();
  return follow_inclination(sample, now);
}

io::FileExpected<void> MotionWatch::follow_inclination(const MotionSample& sample, const MotionVerdict& verdict) {
  if (!inclination_ || !inclination_->step(sample, verdict)) return {};
  const InclinationInterval& found = inclination_->interval();
  const bool known = found.status == InclinationStatus::known;
  ++(known ? run_.inclinations : run_.inclination_breaks);
  (known ? run_.inclination : run_.no_inclination) = found;
  for (MotionSink* sink : sinks_) {
    const io::FileExpected<void> taken = sink->take_inclination(found);
    if (!taken) return taken;
  }
  return {};
}

io::FileExpected<std::unique_ptr<InclinationFile>> InclinationFile::create(const std::string& path, bool live) {
  io::FileExpected<io::OutputFile> file = begun(path, io::inclination_csv_header());
  if (!file) return tl::unexpected<io::FileError>(file.error());
  return std::unique_ptr<InclinationFile>(new InclinationFile(*std::move(file), live));
}

io::FileExpected<void> InclinationFile::take_inclination(const InclinationInterval& interval) {
  line_.clear();
  io::append_inclination_row(line_, interval);
  return put(file_, line_, live_);
}

io::FileExpected<std::unique_ptr<MotionFile>> MotionFile::create(const std::string& path, const SensorArray& array,
                                                                 const Mat3& frame, bool live) {
  io::FileExpected<io::OutputFile> file = begun(path, io::motion_csv_header());
  if (!file) return tl::unexpected<io::FileError>(file.error());
  return std::unique_ptr<MotionFile>(new MotionFile(*std::move(file), array, frame, live));
}

io::FileExpected<void> MotionFile::take(double time_s, const MotionVerdict& verdict,
                                        const std::vector<io::MotionEvent>&) {
  line_.clear();
  io::append_motion_row(line_, time_s, verdict, array_, frame_);
  return put(file_, line_, live_);
}

io::FileExpected<void> MotionEvents::take(double, const MotionVerdict&, const std::vector<io::MotionEvent>& events) {
  for (const io::MotionEvent& event : events) {
    line_.clear();
    io::append_motion_event_json(line_, event, array_);
    const io::FileExpected<void> done = file_.put(line_);
    if (!done) return done;
  }
  return {};
}

}  // namespace session
}  // namespace PLUMB_ABI
}  // namespace plumb

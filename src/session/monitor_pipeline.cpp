#include "plumb/session/monitor_pipeline.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "clock_plan.hpp"
#include "plumb/io/field_json.hpp"
#include "plumb/io/records.hpp"
#include "plumb/scenario/count_text.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace session {
namespace {

io::FileExpected<void> put_line(io::OutputFile& file, std::string& line, bool live) {
  line += '\n';
  io::FileExpected<void> done = file.write(line);
  if (done && live) done = file.flush();
  return done;
}

/// Relative; beyond the rounding of scales and lengths, far below what a person would write.
constexpr double kSameNoise = 1e-6;

/// Noise of one sample of sensor i by the array file; that of the calibration where both say the same.
double noise_mps2(const io::ArrayFile& array, const Calibration& calibration, int i) {
  const DatasheetSensor& sheet = array.datasheet.sensor[static_cast<std::size_t>(i)];
  const double scale = calibration.model.sensor[static_cast<std::size_t>(i)].scale[0];
  const double then = calibration.array.sigma_mps2(i);
  const double now = sheet.row.sigma_mps2 * std::fabs(sheet.coefficients.scale[0] / scale);
  return !std::isfinite(now) || std::fabs(now - then) <= kSameNoise * then ? then : now;
}

std::unique_ptr<MonitorSetup> setup_of(const io::ArrayFile& array) {
  auto setup = std::make_unique<MonitorSetup>();
  setup->gravity = array.gravity;
  setup->config = array.monitor;
  // The frame stays the tool's here: it is applied where results are written (io/records.hpp), once.
  for (int i = 0; i < array.datasheet.size; ++i) {
    const auto a = static_cast<std::size_t>(i);
    setup->full_scale_raw[a] = array.datasheet.sensor[a].full_scale_raw;
    setup->resolution_raw[a] = array.datasheet.sensor[a].resolution_raw;
    setup->stability[a] = array.stability[a];
    if (!array.lever_arm_m.empty()) setup->lever_arm_m[a] = array.lever_arm_m[a];
  }
  setup->lever_arms_known = !array.lever_arm_m.empty();
  return setup;
}

std::unique_ptr<MonitorSetup> setup_of(const io::ArrayFile& array, const Calibration& calibration, double days) {
  auto setup = setup_of(array);
  setup->days_since_calibration = days;
  setup->model = calibration.model;
  setup->array = calibrated_array(array, calibration);
  // The calibrated span, where the array file does not claim another.
  const MonitorConfig unset;
  MonitorConfig& config = setup->config;
  if (config.temperature_min_degc == unset.temperature_min_degc)
    config.temperature_min_degc = calibration.report.temperature_min_degc;
  if (config.temperature_max_degc == unset.temperature_max_degc)
    config.temperature_max_degc = calibration.report.temperature_max_degc;
  return setup;
}

/// At rest a sample that stands in r rows counts r times: a mean then scatters as one of noise that is the root of r
/// larger does, and is judged as that.
Expected<void> allow_for_repeats(const io::ArrayFile& array, SensorArray& monitored) {
  if (array.motion.clocks.empty()) return {};
  std::array<SensorRow, kCapacity> rows{};
  for (int i = 0; i < monitored.size(); ++i) {
    rows[static_cast<std::size_t>(i)] = monitored.row(i);
    rows[static_cast<std::size_t>(i)].sigma_mps2 *= std::sqrt(rows_per_sample(array, i));
  }
  return monitored.set_rows(rows.data());
}

/// null: the monitor is to calibrate itself.
Expected<std::unique_ptr<MonitorSetup>> setup_of(const io::ArrayFile& array, const Calibration* calibration,
                                                 double days) {
  auto setup = calibration != nullptr ? setup_of(array, *calibration, days) : setup_of(array);
  Expected<void> known;
  if (calibration == nullptr) known = set_datasheet(array.datasheet, *setup);
  if (known) known = allow_for_repeats(array, setup->array);
  if (!known) return tl::unexpected<Error>(known.error());
  return setup;
}

tl::unexpected<io::FileError> refused_setup(const Error& reason, const io::ArrayFile& array) {
  io::FileError error = io::from_error(reason);
  error.file = array.path;
  if (reason.code == Errc::range_too_small && reason.index >= 0)
    error.field = "sensor[" + std::to_string(reason.index + 1) + "].full_scale";
  if (reason.code == Errc::out_of_range && reason.index < 0) {
    error.field = "days_since_calibration";
    error.remedy = "give the days from the calibration to the run, 0 or more";
  }
  if (reason.code == Errc::implausible && reason.index >= 0) {
    error.field = "sensor[" + std::to_string(reason.index + 1) + "].prior";
    error.what =
        "is too wide for the monitor to calibrate itself: at most 0.1 m/s^2 per m/s^2 of scale, 0.1 rad of axis and "
        "0.1 g0 of bias";
    error.remedy = "calibrate with plumb calibrate, or give the tolerances of the datasheet, 1 sigma";
  }
  return tl::unexpected<io::FileError>(error);
}

/// What the clocks of the chips say at row k.
void take_clocks(const stepping::Rows& rows, std::size_t k, std::vector<double>& out) {
  const auto clocks = static_cast<std::size_t>(rows.clocks);
  out.assign(rows.clock_s.data() + k * clocks, rows.clock_s.data() + (k + 1) * clocks);
}

/// Every sink every row whose verdict somebody wanted: it chooses itself.
io::FileExpected<void> tell(const stepping::Rows& rows, const stepping::Said& said,
                            const std::vector<VerdictSink*>& sinks) {
  stepping_detail::Unpacker unpacker(said.bytes.data());
  Sample sample;
  Verdict verdict;
  std::vector<double> clock_s;
  for (const std::size_t k : said.row) {
    if (rows.clocks > 0) take_clocks(rows, k, clock_s);
    stepping_detail::take_row(rows, k, sample);
    unpacker(verdict);
    for (VerdictSink* sink : sinks) {
      if (!rows.depth_m.empty()) sink->at_depth(rows.depth_m[k]);
      if (!rows.turn.empty()) sink->at_turn(rows.turn[k]);
      if (!rows.second_turn.empty()) sink->at_second_turn(rows.second_turn[k]);
      if (rows.clocks > 0) sink->at_clocks(clock_s);
      const io::FileExpected<void> taken = sink->take(sample, verdict);
      if (!taken) return taken;
    }
  }
  return {};
}

/// Row k alone, with what was found in motion by the row before it.
void take_one(const stepping::Rows& rows, std::size_t k, const stepping::Found& found, stepping::Rows& one) {
  const auto sensors = static_cast<std::size_t>(rows.sensors);
  one.sensors = rows.sensors;
  one.clocks = rows.clocks;
  if (rows.clocks > 0) take_clocks(rows, k, one.clock_s);
  one.row.assign(1, rows.row[k]);
  one.raw.assign(rows.raw_of(k), rows.raw_of(k) + sensors);
  if (!rows.turn.empty()) one.turn.assign(1, rows.turn[k]);
  if (!rows.second_turn.empty()) one.second_turn.assign(1, rows.second_turn[k]);
  if (!rows.depth_m.empty()) one.depth_m.assign(1, rows.depth_m[k]);
  one.found.assign(1, found);
}

}  // namespace

SensorSet noise_changed(const io::ArrayFile& array, const Calibration& calibration) {
  SensorSet out;
  for (int i = 0; i < calibration.array.size(); ++i) {
    if (noise_mps2(array, calibration, i) != calibration.array.sigma_mps2(i)) out = out.with(i);
  }
  return out;
}

SensorArray calibrated_array(const io::ArrayFile& array, const Calibration& calibration) {
  SensorArray out = calibration.array;
  std::array<SensorRow, kCapacity> rows{};
  for (int i = 0; i < out.size(); ++i) {
    rows[static_cast<std::size_t>(i)] = out.row(i);
    rows[static_cast<std::size_t>(i)].sigma_mps2 = noise_mps2(array, calibration, i);
  }
  if (!noise_changed(array, calibration).empty()) (void)out.set_rows(rows.data());  // the same axes and ids as before
  return out;
}

SensorArray array_to_certify(const io::ArrayFile& array, const Calibration& calibration) {
  SensorArray out = calibrated_array(array, calibration);
  std::array<SensorRow, kCapacity> rows{};
  for (int i = 0; i < out.size(); ++i) {
    rows[static_cast<std::size_t>(i)] = out.row(i);
    rows[static_cast<std::size_t>(i)].sigma_mps2 = std::fmax(out.sigma_mps2(i), calibration.array.sigma_mps2(i));
  }
  if (!noise_changed(array, calibration).empty()) (void)out.set_rows(rows.data());  // the same axes and ids as before
  return out;
}

io::FileExpected<void> EventsFile::take(const Sample&, const Verdict& verdict) {
  if (verdict.transition.sequence == 0) return {};
  line_.clear();
  io::append_event_json(line_, verdict.transition, array_);
  return put(line_);
}

io::FileExpected<void> EventsFile::put(std::string& line) {
  if (!group_.empty()) line.insert(1, "\"group\":\"" + group_ + "\",");  // names of groups need no escapes
  return put_line(file_, line, consistent_);
}

io::FileExpected<void> VerdictsFile::take(const Sample&, const Verdict& verdict) {
  if (!verdict.tick && !every_sample_) return {};
  line_.clear();
  io::append_verdict_json(line_, verdict, array_, frame_);
  if (field_ != io::FieldKind::gravity) line_ = io::in_field_units(line_, field_);
  for (const VerdictNote* note : notes_) note->append(verdict, line_);
  return put_line(file_, line_, consistent_);
}

io::FileExpected<std::unique_ptr<MonitorSetup>> monitor_setup(const io::ArrayFile& array,
                                                              const Calibration* calibration, double days) {
  Expected<std::unique_ptr<MonitorSetup>> setup = setup_of(array, calibration, days);
  if (!setup) return refused_setup(setup.error(), array);
  return *std::move(setup);
}

io::FileExpected<std::unique_ptr<HealthMonitor>> make_monitor(const io::ArrayFile& array,
                                                              const Calibration* calibration, double days) {
  const io::FileExpected<std::unique_ptr<MonitorSetup>> setup = monitor_setup(array, calibration, days);
  if (!setup) return tl::unexpected<io::FileError>(setup.error());
  auto monitor = std::make_unique<HealthMonitor>();
  const Expected<void> configured = monitor->configure(**setup);
  if (configured) return monitor;
  return refused_setup(configured.error(), array);
}

io::FileExpected<std::unique_ptr<HealthMonitor>> restore_monitor(const io::ArrayFile& array,
                                                                 const Calibration* calibration,
                                                                 const std::string& snapshot_path, double days) {
  const io::FileExpected<std::string> bytes = io::read_file(snapshot_path);
  if (!bytes) return tl::unexpected<io::FileError>(bytes.error());
  auto monitor = restore_monitor(array, calibration, *bytes, snapshot_path, days);
  if (!monitor && monitor.error().file == snapshot_path) monitor.error().remedy += " (leave out --snapshot-in)";
  return monitor;
}

io::FileExpected<std::unique_ptr<HealthMonitor>> restore_monitor(const io::ArrayFile& array,
                                                                 const Calibration* calibration,
                                                                 const std::string& bytes, const std::string& name,
                                                                 double days) {
  const Expected<std::unique_ptr<MonitorSetup>> setup = setup_of(array, calibration, days);
  if (!setup) return refused_setup(setup.error(), array);
  auto monitor = std::make_unique<HealthMonitor>();
  const Expected<void> restored =
      monitor->restore(**setup, reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
  if (restored && bytes.size() > monitor->snapshot_size()) {
    return tl::unexpected<io::FileError>(io::FileError{
        name, 0, "",
        "holds " + count_text(bytes.size() - monitor->snapshot_size(), "byte") + " behind the end of the snapshot",
        "give the file as --snapshot-out wrote it"});
  }
  if (restored) return monitor;
  if (monitor->verdict().snapshot_refusal == Errc::ok) return refused_setup(restored.error(), array);
  io::FileError error = io::from_error(restored.error());
  error.file = name;
  return tl::unexpected<io::FileError>(std::move(error));
}

io::FileExpected<void> save_snapshot(const std::string& path, const HealthMonitor& monitor) {
  std::string bytes(monitor.snapshot_size(), '\0');
  const Expected<std::size_t> written = monitor.snapshot(reinterpret_cast<std::uint8_t*>(bytes.data()), bytes.size());
  if (!written) return tl::unexpected<io::FileError>(io::from_error(written.error()));
  return io::write_file(path, bytes);
}

io::FileExpected<std::unique_ptr<PaperMonitor>> make_paper_monitor(const io::ArrayFile& array,
                                                                   const io::CalibrationFile& calibration,
                                                                   const std::string& path) {
  if (!calibration.paper) {
    return tl::unexpected<io::FileError>(io::FileError{
        path, 0, "paper", "is missing: " + array.path + " asks for mode = \"paper\", which needs the paper's own fits",
        "run plumb calibrate again with this array file (--paper is implied), or set mode = \"plumb\""});
  }
  auto setup = std::make_unique<PaperSetup>();
  setup->base = *setup_of(array, calibration.calibration, 0.0);
  setup->datasheet = array.datasheet;
  setup->paper = *calibration.paper;
  auto monitor = std::make_unique<PaperMonitor>();
  const Expected<void> configured = monitor->configure(*setup);
  if (configured) return monitor;
  return refused_setup(configured.error(), array);
}

std::unique_ptr<stepping::Stepper> make_stepper(const io::ArrayFile& array, const Calibration* calibration,
                                                int least_capacity, double days) {
  const Expected<std::unique_ptr<MonitorSetup>> setup = setup_of(array, calibration, days);
  if (!setup) return nullptr;
  const int sensors = (*setup)->array.size();
  std::array<SensorRow, kCapacity> rows{};
  for (int i = 0; i < sensors; ++i) rows[static_cast<std::size_t>(i)] = (*setup)->array.row(i);
  std::vector<std::uint8_t> bytes(2 * sizeof(MonitorSetup));
  stepping_detail::Packer packer(bytes.data());
  stepping_detail::lead(packer, std::as_const(**setup), rows, (*setup)->array.uncertainty());
  return stepping::make_stepper(bytes, sensors, array.monitor.window, least_capacity);
}

StepperRun::StepperRun(stepping::Stepper& stepper, const std::vector<VerdictSink*>& sinks)
    : stepper_(stepper), sinks_(sinks) {
  for (const VerdictSink* sink : sinks) {
    wanted_ = std::max(wanted_, sink->wanted());
    if (sink->found_in_motion() != nullptr) in_motion_ = sink;
  }
}

io::FileExpected<void> StepperRun::take(const stepping::Rows& rows) {
  if (in_motion_ == nullptr) return step(rows);
  for (std::size_t k = 0; k < rows.row.size(); ++k) {
    take_one(rows, k, *in_motion_->found_in_motion(), one_);
    const io::FileExpected<void> taken = step(one_);
    if (!taken) return taken;
  }
  return {};
}

io::FileExpected<void> StepperRun::step(const stepping::Rows& rows) {
  stepper_.step(rows, run_.samples == 0, wanted_, said_);
  run_.samples += rows.row.size();
  run_.blocks += said_.blocks;
  run_.transitions += said_.changes;
  run_.last_time_s = rows.row.back().time_s;
  return tell(rows, said_, sinks_);
}

MonitorRun StepperRun::end(LogEnd end) {
  static_cast<LogEnd&>(run_) = std::move(end);
  run_.counts = said_.counts;
  std::vector<std::uint8_t> now;
  stepper_.now(now);
  stepping_detail::Unpacker unpacker(now.data());
  unpacker(run_.last);
  return run_;
}

io::FileExpected<MonitorRun> run_stepper(stepping::Stepper& stepper, const io::ArrayFile& array, const LogSpec& log,
                                         const std::vector<VerdictSink*>& sinks) {
  StepperRun run(stepper, sinks);
  std::vector<LogShare> shares(1);
  shares.front() = {&array, &run, {}};
  const io::FileExpected<void> done = run_log(log, shares);
  if (!done) return tl::unexpected<io::FileError>(done.error());
  return run.end(std::move(shares.front().end));
}

}  // namespace session
}  // namespace PLUMB_ABI
}  // namespace plumb

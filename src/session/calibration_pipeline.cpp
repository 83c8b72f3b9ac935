#include "plumb/session/calibration_pipeline.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "plumb/detection/stationarity.hpp"
#include "plumb/findings/dead_channel.hpp"
#include "plumb/findings/followed_direction.hpp"
#include "plumb/findings/frame_turn.hpp"
#include "plumb/findings/log_diagnosis.hpp"
#include "plumb/findings/temperature_gaps.hpp"
#include "plumb/findings/turned_triad.hpp"
#include "plumb/findings/unit_guess.hpp"
#include "plumb/io/records.hpp"
#include "plumb/session/interrupt.hpp"
#include "plumb/session/progress.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace session {
namespace {

SensorSet finite_channels(const Sample& sample, int n) {
  SensorSet usable = sample.delivered & SensorSet::first(n);
  for (int i = 0; i < n; ++i) {
    if (!std::isfinite(sample.raw[static_cast<std::size_t>(i)])) usable = usable.without(i);
  }
  return usable;
}

/// A row of a survey log is a station already.
Station station_of_row(const Sample& sample, SensorSet usable) {
  Station station;
  for (int i = 0; i < kCapacity; ++i) {
    if (usable.has(i)) station.mean[static_cast<std::size_t>(i)] = sample.raw[static_cast<std::size_t>(i)];
  }
  station.delivered = usable;
  station.temperature_degc = sample.temperature_degc;
  station.count = sample.count;
  station.tag = sample.station;
  station.roll_group = sample.roll_group;
  station.begin_s = station.end_s = sample.time_s;
  return station;
}

/// Turns samples into stations, either way.
class StationCollector {
 public:
  explicit StationCollector(const io::ArrayFile& array)
      : rows_(array.input.rows), model_(array.datasheet.model()), size_(array.datasheet.size), diagnosis_(array) {
    StationFinder::Settings settings;
    settings.station_angle_rad = array.monitor.station_angle_rad;
    settings.max_gap_s = array.monitor.max_gap_s;
    if (rows_ == io::RowKind::samples)
      finder_ = std::make_unique<StationFinder>(array.array, array.gravity.g_mps2, settings);
  }

  /// `held`: the temperature is that of a row before.
  void add(const Sample& sample, bool held) {
    gaps_.add(sample.time_s, sample.temperature_degc, held);
    const SensorSet usable = finite_channels(sample, size_);
    if (!finder_) {
      stations_.push_back(station_of_row(sample, usable));
      return;
    }
    const Readings y = model_.apply(sample.raw, sample.temperature_degc, usable);
    diagnosis_.add(sample, y, usable);
    Station finished;
    if (finder_->add(sample, y, usable, finished)) stations_.push_back(finished);
  }

  void finish(CalibrationRun& run) {
    Station finished;
    if (finder_ && finder_->finish(finished)) stations_.push_back(finished);
    if (finder_ && stations_.empty()) run.log_findings = diagnosis_.findings();
    gaps_.finish();
    const auto guessed = [this](const Station& station) { return gaps_.cover(station); };
    const auto kept = std::remove_if(stations_.begin(), stations_.end(), guessed);
    run.without_temperature = static_cast<int>(stations_.end() - kept);
    stations_.erase(kept, stations_.end());
    run.stations = std::move(stations_);
  }

 private:
  io::RowKind rows_;
  SensorModel model_;
  int size_;
  findings::LogDiagnosis diagnosis_;
  findings::TemperatureGaps gaps_;
  std::unique_ptr<StationFinder> finder_;
  std::vector<Station> stations_;
};

/// What refuses the fit: gravity before all, then what the fit itself says, unless the study has a better name for it.
void settle(CalibrationRun& run, const Expected<Calibration>& fit) {
  const Judgement& judged = run.study.judgement;
  const bool named = judged.error.code != Errc::ok;
  if (!fit) {
    run.refusal = fit.error();
    // Stations that determine too little say nothing of values; that one sensor contradicts itself they do say.
    const bool too_little = fit.error().code == Errc::too_few_stations || fit.error().code == Errc::unobservable ||
                            fit.error().code == Errc::too_few_levels;
    const bool stands = judged.concern == Concern::gravity || judged.concern == Concern::inconsistent_sensor;
    // One number that is none spoils a whole sensor; the station that holds it is the better name.
    const bool one_row = fit.error().code == Errc::diverged && fit.error().index >= 0;
    if (!named || (too_little && !stands) || (one_row && judged.concern == Concern::inconsistent_sensor)) return;
  } else if (!named) {
    run.accepted = std::make_unique<Calibration>(*fit);
    return;
  }
  run.refusal = judged.error;
  run.concern = judged.concern;
}

/// Whether the values do not fit together, and no stuck channel, other unit, single row or temperature is why. Of what
/// was refused by a name, only the roll axis may have a better one: which axis it was, or the group that spoils it.
bool worth_a_second_look(const CalibrationRun& run, const io::ArrayFile& array) {
  const Errc code = run.refusal.code;
  const bool of_values = code == Errc::diverged || code == Errc::implausible || code == Errc::poor_fit;
  const bool of_one_row = code == Errc::diverged && run.refusal.index >= 0;
  const bool open = run.concern == Concern::none || run.concern == Concern::roll_axis;
  if (!of_values || of_one_row || !open) return false;
  // Triads that are mirrored against each other cancel: the vector is short as if in another unit.
  const bool may_cancel = findings::triads_of(array.array, array.package).size() > 1;
  if (!may_cancel && findings::of_another_unit(array, run.stations)) return false;
  if (findings::followed_direction(run.temperature.order, run.stations, run.study.attitudes).axis != 0) return false;
  for (int i = 0; i < array.array.size(); ++i) {
    if (findings::dead_channel(run.log, i)) return false;
  }
  return true;
}

/// Without the columns that no fit reads: a log of a bench need not have them.
io::ArrayFile with_what_a_fit_reads(io::ArrayFile array) {
  array.input.depth_column.clear();
  array.input.rotation_columns.clear();
  array.input.clock_columns.clear();
  return array;
}

/// The stations as they would have been at one temperature, by the calibration.
std::vector<Station> at_one_temperature(std::vector<Station> stations, const Calibration& calibration) {
  const double degc = calibration.model.sensor[0].reference_degc;
  for (Station& s : stations) {
    const Readings y = calibration.model.apply(s.mean, s.temperature_degc, s.delivered);
    if (const auto raw = calibration.model.raw_from(y, degc)) s.mean = *raw;
    s.temperature_degc = degc;
  }
  return stations;
}

/// The paper's fits beside the accepted one, to the same stations. They know no temperature: what plumb's fit found of
/// it is taken out of the stations and put into the model. Of
/// no use where that of all sensors is not sound.
void fit_by_paper(const io::ArrayFile& array, CalibrationRun& run) {
  std::vector<Station> stations = findings::chosen(run.stations, run.study.kept);
  auto paper = std::make_unique<PaperCalibration>();
  Datasheet datasheet = array.datasheet;
  if (run.temperature.order > 0) {
    datasheet = with_temperature_of(datasheet, *run.accepted);
    stations = at_one_temperature(std::move(stations), *run.accepted);
  }
  const Expected<void> done = paper_calibrate_all(datasheet, array.gravity, stations.data(),
                                                  static_cast<int>(stations.size()), PaperOptions{}, *paper);
  if (!done) {
    run.paper_refusal = done.error();
    return;
  }
  if (!paper->all.converged) {
    run.paper_refusal = Error{Errc::diverged, -1, paper->all.cost, 0.0};
  } else if (!paper->all.sound()) {
    run.paper_refusal = Error{Errc::unobservable, -1, static_cast<double>(paper->all.rank), kPaperRank};
  }
  run.paper = std::move(paper);
}

/// Where the fit shows down, by station.
std::vector<Vec3> shown_down(const CalibrationRun& run) {
  std::vector<Vec3> out;
  for (const SeenAttitude& one : run.study.attitudes) out.push_back(one.direction);
  return out;
}

/// Turns the axes of the fit into the housing, as far as known attitudes say how it lies to them.
void turn_into_housing(const io::ArrayFile& array, std::vector<findings::MeasuredAttitude>& measured,
                       CalibrationRun& run) {
  const Mat3 turn = findings::turn_into_housing(array, run.study.shown->report, measured);
  if (turn == io::kIdentity3) return;
  findings::apply_turn(turn, *run.study.shown);
  if (run.accepted) findings::apply_turn(turn, *run.accepted);
  run.study.paper = paper_form(array.array, run.study.shown->array, run.study.shown->model);
  for (SeenAttitude& one : run.study.attitudes) one.direction = times(turn, one.direction);
  for (findings::MeasuredAttitude& one : measured) one.down = times(turn, one.down);
}

/// Compares the fit with what is known of its stations; one that stands otherwise is of a tool that is wired otherwise.
void judge_wiring(const io::ArrayFile& array, CalibrationRun& run) {
  const std::vector<Vec3> down = shown_down(run);
  std::vector<findings::MeasuredAttitude> measured;
  for (const io::KnownAttitude& one : array.input.known_attitudes) {
    if (const auto found = findings::measured_attitudes({one}, down)) measured.push_back(found->front());
  }
  turn_into_housing(array, measured, run);
  run.wiring = findings::check_wiring(array, run.accepted ? &run.accepted->array : nullptr, std::move(measured));
  if (run.wiring.status == findings::WiringStatus::contradicted) run.accepted.reset();
}

/// A known attitude of a station that the fit does not show: a wrong number, or a station that was set aside.
std::optional<io::FileError> station_not_shown(const io::ArrayFile& array, const CalibrationRun& run) {
  if (!run.accepted) return std::nullopt;
  const auto found = findings::measured_attitudes(array.input.known_attitudes, shown_down(run));
  return found ? std::nullopt : std::optional<io::FileError>(unknown_station(found.error(), run.stations.size()));
}

/// Fits the stations of `run` and judges the fit.
void fit_stations(const io::ArrayFile& array, const CalibrationChoice& choice, CalibrationRun& run) {
  run.options = choice.fit;
  const Vec3 counted_from = {array.output_frame[6], array.output_frame[7], array.output_frame[8]};
  const Vec3 axis = choice.roll_axis.value_or(counted_from);
  run.options.roll_axis = scaled(axis, 1.0 / norm(axis));
  TemperatureOptions over = choice.temperature;
  over.fit = run.options;
  const auto work = std::make_unique<TemperatureWork>();
  std::vector<Station> scratch(run.stations.size());
  const Expected<Calibration> fit = calibrate_over_temperature(array.datasheet, array.gravity, run.stations.data(),
                                                               static_cast<int>(run.stations.size()), over,
                                                               scratch.data(), *work, &run.temperature, &run.report);
  over.order = run.temperature.order;
  run.study = findings::study_fit(array, run.stations, fit, run.report, over, choice.hold_out);
  settle(run, fit);
  TemperatureOptions again = choice.temperature;
  again.fit = run.options;
  if (worth_a_second_look(run, array)) {
    const SensorArray* const came_to = run.study.shown ? &run.study.shown->array : nullptr;
    run.second_look = findings::second_look(array, run.stations, again, came_to);
  }
  // That without roll groups the axis does not matter is no change.
  if (run.concern == Concern::roll_axis && run.second_look.without_groups) run.second_look = findings::SecondLook{};
  if (run.study.shown) judge_wiring(array, run);
  if (run.accepted && choice.paper_fits) fit_by_paper(array, run);
}

io::FileExpected<void> read_stations(const io::ArrayFile& array, const LogSpec& log, CalibrationRun& run) {
  const io::ArrayFile asked = with_what_a_fit_reads(array);
  io::FileExpected<io::LogReader> reader = io::LogReader::open(log.path, asked, log.on_bad_row);
  if (!reader) return tl::unexpected<io::FileError>(reader.error());
  reader->hash_bytes();
  reader->stop_when(interrupt_flag());
  StationCollector collector(array);
  {
    Progress progress("reading " + log.path);
    Sample sample;
    io::LogReader::Next status = reader->next(sample);
    std::uint64_t held = 0;
    for (; status == io::LogReader::Next::row; status = reader->next(sample)) {
      collector.add(sample, reader->statistics().temperature_held != held);
      held = reader->statistics().temperature_held;
      progress.at(reader->statistics().rows, sample.time_s);
    }
    if (status == io::LogReader::Next::error) return tl::unexpected<io::FileError>(reader->error());
  }
  run.interrupted = interrupted();
  collector.finish(run);
  run.log = reader->statistics();
  return {};
}

}  // namespace

io::FileExpected<CalibrationRun> run_calibration(const io::ArrayFile& array, const LogSpec& log,
                                                 const CalibrationChoice& choice) {
  if (choice.paper_fits && array.array.size() > kPaperCapacity) {
    const std::string sensors = std::to_string(array.array.size());
    return tl::unexpected<io::FileError>(io::FileError{
        array.path, 0, "",
        "the paper's fit supports at most " + std::to_string(kPaperCapacity) + " sensors, but this array has " +
            sensors + " (their misalignments grow as the square of the number)",
        "leave out --paper and mode = \"paper\", or describe a part of the sensors in another file"});
  }
  CalibrationRun run;
  if (const io::FileExpected<void> read = read_stations(array, log, run); !read)
    return tl::unexpected<io::FileError>(read.error());
  fit_stations(array, choice, run);
  if (const std::optional<io::FileError> wrong = station_not_shown(array, run))
    return tl::unexpected<io::FileError>(*wrong);
  return run;
}

io::FileExpected<std::vector<Station>> find_stations(const io::ArrayFile& array, const LogSpec& log) {
  CalibrationRun run;
  if (const io::FileExpected<void> read = read_stations(array, log, run); !read)
    return tl::unexpected<io::FileError>(read.error());
  return std::move(run.stations);
}

io::FileError unknown_station(const io::KnownAttitude& known, std::size_t stations) {
  return io::FileError{"--known-attitude",
                       0,
                       "",
                       "station " + std::to_string(known.station) + " has no direction in the calibration, which has " +
                           std::to_string(stations) + " stations",
                       "give the number under which plumb calibrate --verbose lists a station that it uses",
                       io::ExitCode::usage};
}

void note_attitudes(const CalibrationRun& run, io::CalibrationContext& context) {
  context.down = shown_down(run);
  for (const findings::MeasuredAttitude& one : run.wiring.measured) context.known_attitudes.push_back(one.stated);
}

CalibrationRun run_calibration(const io::ArrayFile& array, const std::vector<Sample>& samples,
                               const CalibrationChoice& choice) {
  StationCollector collector(array);
  for (const Sample& sample : samples) collector.add(sample, false);
  CalibrationRun run;
  collector.finish(run);
  run.log = findings::statistics_of(samples, array.datasheet.size);
  fit_stations(array, choice, run);
  return run;
}

io::FileExpected<void> save_calibration(const std::string& path, const CalibrationRun& run, const io::ArrayFile& array,
                                        const std::string& log_path, const CalibrationTag& tag) {
  io::CalibrationContext context;
  context.date = tag.date;
  context.serial = tag.serial;
  context.log_file = log_path;
  context.log_bytes = run.log.bytes;
  context.log_hash = run.log.hash;
  context.stations = run.report.stations;
  context.plumb_version = PLUMB_VERSION;
  context.gravity = array.gravity;
  note_attitudes(run, context);
  return io::write_calibration(path, *run.accepted, array, context, run.paper.get(),
                               tag.alignment ? &*tag.alignment : nullptr);
}

}  // namespace session
}  // namespace PLUMB_ABI
}  // namespace plumb

// plumb simulate: plays a scenario file into a log, the truth beside it.
#include <fmt/format.h>

#include <memory>
#include <optional>

#include "demo_files.hpp"
#include "plumb/core/units.hpp"
#include "plumb/io/log_writer.hpp"
#include "plumb/io/records.hpp"
#include "plumb/io/scenario_file.hpp"
#include "plumb/navigation/tilt.hpp"
#include "station_mean.hpp"
#include "tool.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {
namespace {

struct SimulateOptions {
  std::string scenario;
  std::string out = "-";
  std::string truth;
  std::string array_out;
  std::optional<std::uint64_t> seed;
};

constexpr const char* kSimulateAbout =
    "Play a scenario into a log: a tool whose sensors are really like this, held so, shaken so, breaking then.\n"
    "The log looks as the scenario's array file says, so `plumb calibrate` and `plumb monitor` read it like a\n"
    "recorded one. The scenario is a TOML file; docs/scenario-file.md lists its keys.";
constexpr const char* kSimulateNotes =
    "Examples (a stand to calibrate on, then a drilling run with a fault, watched through a pipe):\n"
    "  plumb simulate examples/stand.toml --out stand.csv\n"
    "  plumb calibrate --array examples/paper_tool.toml --log stand.csv --out cal.json\n"
    "  plumb simulate examples/drilling.toml |\n"
    "    plumb monitor --array examples/paper_tool.toml --calibration cal.json --log -\n\n"
    "The shortest scenario:\n"
    "  tool = \"paper\"             # or array = \"my_tool.toml\", relative to the scenario file\n"
    "  [attitude]\n"
    "  law = \"drilling-path\"      # or fixed, list, random, roll-test\n\n"
    "Units: of the log, as [input] of the array file says; of --truth, s, m/s^2 and deg, in the frame in which\n"
    "plumb answers (the one in which the nominal axes fit the true ones best; gravity cannot tell another).\n"
    "The same scenario and seed give the same bytes. --seed changes noise, random attitudes and random faults;\n"
    "the sensors are drawn from [truth] seed and stay the same, so that a calibration stays theirs.\n"
    "Where the log goes to standard output, nothing else is written there.\n\n";

io::FileError usage_error(const char* option, std::string what, std::string remedy) {
  return io::FileError{option, 0, "", std::move(what), std::move(remedy), io::ExitCode::usage};
}

/// The files must not run into one another, and an array file that exists already is not written again.
std::optional<io::FileError> conflict(const SimulateOptions& options, const io::ScenarioFile& file) {
  const std::string& truth = options.truth;
  if (!truth.empty() && (truth == options.out || truth == options.array_out)) {
    return usage_error("--truth", "goes to the same place as another output", "give it a file of its own");
  }
  if (options.array_out.empty()) return std::nullopt;
  if (options.array_out == options.out) {
    return usage_error("--array-out", "goes to the same place as the log", "give it a file of its own");
  }
  if (file.array_path.empty()) return std::nullopt;
  return usage_error("--array-out", "the scenario names an array file already, " + file.array.path,
                     "use that file; --array-out is for scenarios with tool = \"paper\"");
}

/// The truth as a table. Where the log has one row per station, so has this one.
class TruthFile {
 public:
  TruthFile(io::OutputFile file, const io::ScenarioFile& scenario) : file_(std::move(file)), array_(scenario.array) {
    // The turn is found once, by its effect on the three axes.
    std::vector<scenario::Truth> axes(3);
    for (std::size_t k = 0; k < 3; ++k) axes[k].gravity_mps2[k] = 1.0;
    into_frame_of_nominal_axes(scenario.scenario.tool, axes);
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t r = 0; r < 3; ++r) turn_[3 * r + k] = axes[k].gravity_mps2[r];
    }
  }

  io::FileExpected<void> head() {
    return file_.write("t_s,station,moving,gx_mps2,gy_mps2,gz_mps2,inclination_deg,toolface_deg,faulty\n");
  }

  io::FileExpected<void> write(double time_s, const scenario::Truth& truth) {
    const Vec3 g = io::in_frame(array_.output_frame, times(turn_, truth.gravity_mps2));
    const Tilt tilt = tilt_of(g, Mat3{});
    std::string faulty;
    for (int i = 0; i < array_.array.size(); ++i) {
      if (truth.faulty.has(i)) faulty += (faulty.empty() ? "" : " ") + std::string(array_.array.row(i).id.data());
    }
    const auto angle = [](bool valid, double rad) { return valid ? io::shortest(deg_from_rad(rad)) : std::string(); };
    return file_.write(fmt::format("{},{},{},{},{},{},{},{},{}\n", io::shortest(time_s), truth.station,
                                   truth.moving ? 1 : 0, io::shortest(g[0]), io::shortest(g[1]), io::shortest(g[2]),
                                   angle(tilt.inclination_valid, tilt.inclination_rad),
                                   angle(tilt.toolface_valid, tilt.toolface_rad), faulty));
  }
  io::FileExpected<void> commit() { return file_.commit(); }

 private:
  io::OutputFile file_;
  const io::ArrayFile& array_;
  Mat3 turn_{};
};

/// Plays one scenario from its first sample to its last.
class Play {
 public:
  Play(const SimulateOptions& options, const io::ScenarioFile& file, scenario::Simulator simulator)
      : options_(options), file_(file), simulator_(std::move(simulator)), shown_(file.scenario.faults.size()) {}

  io::FileExpected<void> run() {
    if (!options_.truth.empty()) {
      io::FileExpected<io::OutputFile> out = io::OutputFile::create(options_.truth, io::OutputFile::Mode::stream);
      if (!out) return tl::unexpected<io::FileError>(out.error());
      truth_.emplace(*std::move(out), file_);
      io::FileExpected<void> done = truth_->head();
      if (!done) return done;
    }
    io::FileExpected<io::LogWriter> log = io::LogWriter::create(options_.out, file_.array);
    if (!log) return tl::unexpected<io::FileError>(log.error());
    io::FileExpected<void> done = play(*log);
    if (done) done = log->commit();
    if (done && truth_) done = truth_->commit();
    return done;
  }

  std::uint64_t rows() const noexcept { return rows_; }
  double last_time_s() const noexcept { return last_time_s_; }
  std::size_t stations() const noexcept { return simulator_.directions().size(); }
  /// Faults that lie outside the run.
  std::vector<std::size_t> without_effect() const {
    std::vector<std::size_t> out;
    for (std::size_t k = 0; k < shown_.size(); ++k) {
      if (!shown_[k]) out.push_back(k);
    }
    return out;
  }

 private:
  io::FileExpected<void> play(io::LogWriter& log) {
    const bool means = file_.array.input.rows == io::RowKind::stations;
    StationMean station(file_.array.array.size());
    Progress progress("simulating " + file_.name);
    Sample sample;
    scenario::Moment now;
    while (!interrupted() && simulator_.next(sample)) {
      now.row = simulator_.row();
      const scenario::Truth& truth = simulator_.truth();
      now.time_s = last_time_s_ = sample.time_s;
      now.station = truth.station;
      note_faults(now);
      progress.at(now.row, sample.time_s);
      if (means && truth.moving) continue;
      if (means && !station.empty() && station.truth().station != truth.station) {
        io::FileExpected<void> done = put(log, station.mean(), station.truth());
        if (!done) return done;
        station = StationMean(file_.array.array.size());
      }
      if (means) {
        station.add(sample, truth);
        continue;
      }
      io::FileExpected<void> done = put(log, sample, truth);
      if (!done) return done;
    }
    return means && !station.empty() ? put(log, station.mean(), station.truth()) : io::FileExpected<void>();
  }

  io::FileExpected<void> put(io::LogWriter& log, const Sample& sample, const scenario::Truth& truth) {
    ++rows_;
    io::FileExpected<void> done = log.write(sample);
    return done && truth_ ? truth_->write(sample.time_s, truth) : done;
  }

  void note_faults(const scenario::Moment& now) {
    for (std::size_t k = 0; k < shown_.size(); ++k) {
      if (!shown_[k]) shown_[k] = scenario::in_effect(file_.scenario.faults[k], now);
    }
  }

  const SimulateOptions& options_;
  const io::ScenarioFile& file_;
  scenario::Simulator simulator_;
  std::optional<TruthFile> truth_;
  std::vector<bool> shown_;
  std::uint64_t rows_ = 0;
  double last_time_s_ = 0.0;
};

/// What was played, where it does not stand in the way of the log.
void tell(const SimulateOptions& options, const io::ScenarioFile& file, const Play& play) {
  const scenario::FaultContext context = io::fault_context(file.array);
  const bool to_pipe = options.out == "-" || options.truth == "-" || options.array_out == "-";
  if (!to_pipe) {
    for (const scenario::Fault& fault : file.scenario.faults) print(scenario::describe(fault, context) + "\n");
    print(fmt::format("written: {} ({} rows, {} stations, t = {:.3f} to {:.3f} s)\n", options.out, play.rows(),
                      play.stations(), file.scenario.start_s, play.last_time_s()));
    for (const std::string& other : {options.truth, options.array_out}) {
      if (!other.empty()) print(fmt::format("written: {}\n", other));
    }
  }
  if (interrupted()) return;
  for (const std::size_t k : play.without_effect()) {
    print_error(
        fmt::format("plumb: {}: fault[{}].spec: {} changed nothing: the run (t = {:.3f} to {:.3f} s, {} "
                    "stations) has no such time, row or station.\n",
                    file.path, k + 1, scenario::to_text(file.scenario.faults[k], context), file.scenario.start_s,
                    play.last_time_s(), play.stations()));
  }
}

io::ExitCode run_simulate(const SimulateOptions& options) {
  io::FileExpected<io::ScenarioFile> file = io::read_scenario(options.scenario);
  if (!file) return report(file.error());
  if (options.seed) file->scenario.seed = *options.seed;
  if (const std::optional<io::FileError> error = conflict(options, *file)) return report(*error);
  const std::vector<NamedFile> to_write = {
      {"--out", options.out}, {"--truth", options.truth}, {"--array-out", options.array_out}};
  const std::vector<NamedFile> to_read = {{"SCENARIO", options.scenario}};
  if (const std::optional<io::FileError> clash = overwritten(to_write, to_read)) return report(*clash);
  tl::expected<scenario::Simulator, std::string> simulator = scenario::Simulator::make(file->scenario);
  if (!simulator) return report(io::FileError{options.scenario, 0, "", simulator.error(), ""});
  if (!options.array_out.empty()) {
    const io::FileExpected<void> written = io::write_file(options.array_out, file->array.text);
    if (!written) return report(written.error());
  }
  watch_interrupts();
  Play play(options, *file, *std::move(simulator));
  const io::FileExpected<void> done = play.run();
  if (!done) return report(done.error());
  tell(options, *file, play);
  if (!interrupted()) return io::ExitCode::done;
  print_error(fmt::format("plumb: interrupted; the rows up to t = {:.3f} s are written.\n", play.last_time_s()));
  return io::ExitCode::other;
}

}  // namespace

Command add_simulate(const Options& tool) {
  auto options = std::make_shared<SimulateOptions>();
  const Options command =
      tool.add_command("simulate", "play a scenario into a log: sensors, attitudes, noise and faults");
  command.add_option("scenario", options->scenario, "the scenario file: what happens to which tool")
      .required()
      .type_name("SCENARIO.toml");
  command.add_option("--seed", options->seed, "of noise, attitudes and faults, in the place of the scenario's own")
      .check(seed_refusal)
      .type_name("N");
  command.add_option("--out", options->out, "the log to write; `-` = standard output, the default")
      .type_name("LOG.csv|-");
  command.add_option("--truth", options->truth, "what was really the case at every row: gravity, tilt, faulty sensors")
      .type_name("TRUTH.csv");
  command.add_option("--array-out", options->array_out, "the array file of a scenario with tool = \"paper\"")
      .type_name("ARRAY.toml");
  command.footer(kSimulateNotes + exit_codes_help());
  return {command, kSimulateAbout, [options] { return run_simulate(*options); }};
}

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb

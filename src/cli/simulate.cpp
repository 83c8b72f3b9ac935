// plumb simulate: plays a scenario file into a log, the truth beside it.
#include <fmt/format.h>

#include <memory>
#include <optional>

#include "plumb/geomagnetic/field_reference.hpp"
#include "plumb/io/output_file.hpp"
#include "plumb/io/scenario_file.hpp"
#include "plumb/scenario/count_text.hpp"
#include "plumb/session/scenario_play.hpp"
#include "simulate_flight.hpp"
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
  FlightOptions flight;
};

constexpr const char* kSimulateAbout =
    "Simulate a log from a scenario: true sensor parameters, attitudes, vibration, noise and faults.\n"
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
    "An array file with [[group]]s: the log has the columns of all of them, which plumb monitor --group reads;\n"
    "array = \"my_tool.toml#mag\" simulates one group alone.\n\n"
    "--flight simulates motion instead, of the array of an ARRAY file with lever arms: specific force, rotation, "
    "vibration,\n"
    "shocks, and a gyro where [input] names rotation_radps. Errors are drawn within the bounds that the file states "
    "for\n"
    "motion. --truth has the specific force at the reference point and the rate.\n"
    "  plumb simulate --flight drone examples/motion/drone.toml --fault imu2:stuck=0g0@3s --out flight.csv\n\n"
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
    return usage_error("--truth", "names the same file as another output", "give it a file of its own");
  }
  if (options.array_out.empty()) return std::nullopt;
  if (options.array_out == options.out) {
    return usage_error("--array-out", "names the same file as the log", "give it a file of its own");
  }
  if (file.array_path.empty()) return std::nullopt;
  return usage_error("--array-out", "the scenario names an array file already, " + file.array.path,
                     "use that file; --array-out is for scenarios with tool = \"paper\"");
}

/// What was played, where it does not stand in the way of the log.
void tell(const SimulateOptions& options, const io::ScenarioFile& file, const session::ScenarioPlay& play) {
  const bool to_pipe = options.out == "-" || options.truth == "-" || options.array_out == "-";
  if (!to_pipe) {
    for (const session::ScenarioPlay::PlayedFault& one : play.faults())
      print(scenario::describe(one.fault, io::fault_context(*one.array)) + "\n");
    print(fmt::format("written: {} ({}, {}, t = {:.3f} to {:.3f} s)\n", options.out, count_text(play.rows(), "row"),
                      count_text(play.stations(), "station"), file.scenario.start_s, play.last_time_s()));
    for (const std::string& other : {options.truth, options.array_out}) {
      if (!other.empty()) print(fmt::format("written: {}\n", other));
    }
  }
  if (interrupted()) return;
  for (const session::ScenarioPlay::PlayedFault& one : play.faults()) {
    if (one.shown) continue;
    print_error(
        fmt::format("plumb: {}: fault[{}].spec: {} changed nothing: the run (t = {:.3f} to {:.3f} s, {}) "
                    "has no such time, row or station.\n",
                    file.path, one.table, scenario::to_text(one.fault, io::fault_context(*one.array)),
                    file.scenario.start_s, play.last_time_s(), count_text(play.stations(), "station")));
  }
}

io::ExitCode run_simulate(const SimulateOptions& options) {
  if (const std::optional<io::FileError> misuse = flight_misuse(options.flight)) return report(*misuse);
  if (!options.flight.kind.empty()) {
    if (!options.array_out.empty())
      return report(usage_error("--array-out", "a flight is of an array file already", "leave it out"));
    return run_flight(options.flight, {options.scenario, options.out, options.truth, options.seed});
  }
  io::FileExpected<io::ScenarioFile> file = io::read_scenario(options.scenario, geomagnetic::lookup);
  if (!file) return report(file.error());
  if (options.seed) {
    file->scenario.seed = *options.seed;
    for (io::ScenarioFile::Group& group : file->groups) group.scenario.seed = *options.seed;
  }
  if (const std::optional<io::FileError> error = conflict(options, *file)) return report(*error);
  const std::vector<NamedFile> to_write = {
      {"--out", options.out}, {"--truth", options.truth}, {"--array-out", options.array_out}};
  const std::vector<NamedFile> to_read = {{"SCENARIO", options.scenario}};
  if (const std::optional<io::FileError> clash = overwritten(to_write, to_read)) return report(*clash);
  const tl::expected<std::unique_ptr<session::ScenarioPlay>, std::string> made = session::ScenarioPlay::make(*file);
  if (!made) return report(io::FileError{options.scenario, 0, "", made.error(), ""});
  session::ScenarioPlay& play = **made;
  if (!options.array_out.empty()) {
    const io::FileExpected<void> written = io::write_file(options.array_out, file->array.text);
    if (!written) return report(written.error());
  }
  watch_interrupts();
  const io::FileExpected<void> done = play.run(options.out, options.truth);
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
      tool.add_command("simulate", "simulate a log from a scenario: sensors, attitudes, noise and faults");
  command
      .add_option("scenario", options->scenario,
                  "the scenario file: the tool and what happens to it; an array file with --flight")
      .required()
      .type_name("SCENARIO.toml");
  command.add_option("--seed", options->seed, "seed of noise, attitudes and faults, in place of the scenario's own")
      .check(seed_refusal)
      .type_name("N");
  command.add_option("--out", options->out, "the log to write; `-` = standard output, the default")
      .type_name("LOG.csv|-");
  command.add_option("--truth", options->truth, "the true values of every row: gravity, tilt, faulty sensors")
      .type_name("TRUTH.csv");
  command.add_option("--array-out", options->array_out, "the array file of a scenario with tool = \"paper\"")
      .type_name("ARRAY.toml");
  add_flight_options(command, options->flight);
  command.footer(kSimulateNotes + exit_codes_help());
  return {command, kSimulateAbout, [options] { return run_simulate(*options); }};
}

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb

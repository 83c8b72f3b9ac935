#include "simulate_flight.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>

#include "fault_options.hpp"
#include "plumb/io/calibration_file.hpp"
#include "plumb/io/scenario_file.hpp"
#include "plumb/scenario/count_text.hpp"
#include "plumb/scenario/fault_text.hpp"
#include "plumb/session/flight_play.hpp"
#include "read_array.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {
namespace {

constexpr double kLongestFlight_s = 86400.0;

scenario::FlightKind kind_of(const std::string& word) {
  for (int k = 0; k < scenario::kFlightKinds; ++k) {
    if (word == to_string(static_cast<scenario::FlightKind>(k))) return static_cast<scenario::FlightKind>(k);
  }
  return scenario::FlightKind::drone;
}

std::string kind_refusal(const std::string& word) {
  std::string known;
  for (int k = 0; k < scenario::kFlightKinds; ++k) {
    const std::string one = to_string(static_cast<scenario::FlightKind>(k));
    if (word == one) return "";
    known += (known.empty() ? "" : ", ") + one;
  }
  return "\"" + word + "\" is no flight; use one of: " + known;
}

void tell_unseen(const io::ArrayFile& array, const std::vector<scenario::Fault>& faults, const std::vector<int>& unseen,
                 double last_time_s) {
  for (const int k : unseen) {
    print_error(fmt::format(
        "plumb: --fault \"{}\" changed nothing: the flight (t = 0.000 to {:.3f} s) has no such time or station.\n",
        scenario::to_text(faults[static_cast<std::size_t>(k)], io::fault_context(array)), last_time_s));
  }
}

void tell(const FlightFiles& files, const io::ArrayFile& array, const ToolFaults& faults,
          const session::FlightPlay& play) {
  const auto describe = [](const io::ArrayFile& of, const std::vector<scenario::Fault>& all) {
    for (const scenario::Fault& fault : all) print(scenario::describe(fault, io::fault_context(of)) + "\n");
  };
  if (files.out != "-" && files.truth != "-") {
    describe(array, faults.own);
    for (std::size_t k = 0; k < faults.group.size(); ++k) describe(array.groups[k], faults.group[k]);
    print(fmt::format("written: {} ({}, t = 0.000 to {:.3f} s)\n", files.out, count_text(play.rows(), "row"),
                      play.last_time_s()));
    if (!files.truth.empty()) print(fmt::format("written: {}\n", files.truth));
  }
  tell_unseen(array, faults.own, play.without_effect(), play.last_time_s());
  for (std::size_t k = 0; k < faults.group.size(); ++k)
    tell_unseen(array.groups[k], faults.group[k], play.without_effect(k), play.last_time_s());
}

}  // namespace

void add_flight_options(const Options& command, FlightOptions& options) {
  command
      .add_option("--flight", options.kind,
                  "simulate motion of the array of this array file instead: drone, drilling, car or launch")
      .check(kind_refusal)
      .type_name("KIND");
  command
      .add_option(
          "--duration",
          [&options](const std::string& text) -> std::string {
            char* end = nullptr;
            options.duration_s = std::strtod(text.c_str(), &end);
            options.duration_given = true;
            const bool sound = end != text.c_str() && *end == '\0' && options.duration_s > 0.0 &&
                               options.duration_s <= kLongestFlight_s;
            return sound ? "" : "\"" + text + "\" is no duration; give seconds above 0, at most 86400";
          },
          "of the flight in s, 10 by default")
      .type_name("S");
  command
      .add_option("--calibration", options.calibration,
                  "in a flight the sensors are as this calibration has them; the nominal ones by default")
      .type_name("CAL.json");
  command
      .add_option("--fault", options.faults,
                  "a fault in the flight, as plumb inject takes it; may be given several times")
      .type_name("FAULT");
}

std::optional<io::FileError> flight_misuse(const FlightOptions& options) {
  if (!options.kind.empty()) return std::nullopt;
  const char* option = !options.faults.empty()        ? "--fault"
                       : !options.calibration.empty() ? "--calibration"
                                                      : "--duration";
  if (options.faults.empty() && options.calibration.empty() && !options.duration_given) return std::nullopt;
  return io::FileError{option,
                       0,
                       "",
                       "belongs to --flight; a scenario has its own in its file",
                       "add --flight drone and name an array file, or write it into the scenario",
                       io::ExitCode::usage};
}

io::ExitCode run_flight(const FlightOptions& options, const FlightFiles& files) {
  const std::vector<NamedFile> to_write = {{"--out", files.out}, {"--truth", files.truth}};
  if (const std::optional<io::FileError> clash = overwritten(to_write, {{"ARRAY", files.array}})) return report(*clash);
  const io::FileExpected<io::ArrayFile> array =
      read_accelerometers(files.array, "plumb simulate --flight",
                          "write a scenario with array = \"{}\", which turns the tool from station to station");
  if (!array) return report(array.error());
  const io::FileExpected<ToolFaults> faults = tool_faults_of(options.faults, *array);
  if (!faults) return report(faults.error());
  std::optional<io::CalibrationFile> calibration;
  if (!options.calibration.empty()) {
    io::FileExpected<io::CalibrationFile> read = io::read_calibration(options.calibration, *array);
    if (!read) return report(read.error());
    calibration = *std::move(read);
  }
  session::FlightRequest request;
  if (calibration) request.calibration = &calibration->calibration;
  request.kind = kind_of(options.kind);
  request.duration_s = options.duration_s;
  request.seed = files.seed.value_or(request.seed);
  request.faults = faults->own;
  request.group_faults = faults->group;
  const io::FileExpected<std::unique_ptr<session::FlightPlay>> play = session::FlightPlay::make(*array, request);
  if (!play) return report(play.error());
  watch_interrupts();
  const io::FileExpected<void> done = (*play)->run(files.out, files.truth);
  if (!done) return report(done.error());
  tell(files, *array, *faults, **play);
  if (!interrupted()) return io::ExitCode::done;
  print_error(fmt::format("plumb: interrupted; the rows up to t = {:.3f} s are written.\n", (*play)->last_time_s()));
  return io::ExitCode::other;
}

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb

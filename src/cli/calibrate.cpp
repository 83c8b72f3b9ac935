// plumb calibrate: a log of attitudes at rest in, a calibration file out.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <memory>
#include <sstream>

#include "calibrate_aligned.hpp"
#include "calibrate_gyros.hpp"
#include "calibrate_known.hpp"
#include "calibrate_motion.hpp"
#include "fit_pictures.hpp"
#include "known_attitude_option.hpp"
#include "plumb/core/units.hpp"
#include "plumb/render/fit_report.hpp"
#include "plumb/render/words.hpp"
#include "plumb/scenario/count_text.hpp"
#include "plumb/session/calibration_pipeline.hpp"
#include "plumb/session/choice_texts.hpp"
#include "plumb/session/days_since.hpp"
#include "read_array.hpp"
#include "tool.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {
namespace {

struct CalibrateOptions {
  std::string array;
  session::LogSpec log;
  std::string calibration;  ///< to which `motion` adds
  std::string motion;       ///< empty: a calibration at rest
  KnownCoefficientOptions known;
  GyroOptions gyros;
  std::string out;
  session::CalibrationChoice choice;
  std::string plots;
  session::CalibrationTag tag;
  std::vector<std::string> known_attitudes;  ///< as written
  std::string align_by;                      ///< calibration of the accelerometers; empty: none
  bool suggest = false;
  bool json = false;
  bool verbose = false;
  bool rolls = false;              ///< something was said about the roll groups
  const char* of_a_fit = nullptr;  ///< an option of the fit of a log at rest that was given
};

constexpr const char* kCalibrateAbout =
    "Estimate bias, scale and direction of every sensor from a log in which the tool is held\n"
    "still at many attitudes. Gravity is the only reference. plumb finds the still stretches by itself, or\n"
    "takes every row as one where the array file says rows = \"stations\". The calibration file is written\n"
    "only if the fit is accepted: converged, every parameter determined, residuals small, values plausible, and\n"
    "stations that were held out predicted as well as the fit claims.";
constexpr const char* kCalibrateNotes =
    "Example:\n"
    "  plumb calibrate --array tool.toml --log calibration.csv --out calibration.json\n\n"
    "Units: mg0 = 0.001 x 9.80665 m/s^2; angles in deg; scales in the unit of the log per g0. Attitudes are named by\n"
    "inclination (0 = tool axis z points down), toolface (turn about z) and the direction of down in the tool frame.\n"
    "Record at least 12 attitudes spread over all directions, 10 s each; 24 to 48 are better.\n"
    "--paper makes the paper's own fits too, of all sensors and of every three of them, for `plumb monitor` in\n"
    "mode = \"paper\"; up to 8 sensors. An array file with that mode implies it.\n"
    "With --motion the tool turns and accelerates about all axes, for half a minute or longer, and everything else "
    "stays\n"
    "as it was calibrated (docs/motion.md, Commissioning):\n"
    "  plumb calibrate --array tool.toml --calibration calibration.json --motion flight.csv --out in-motion.json\n\n"
    "Gyros of a [[group]] are calibrated in motion too, after some seconds at rest (docs/motion.md, Redundant gyros):\n"
    "  plumb calibrate --array tool.toml#gyros --motion turning.csv --out gyros.json\n\n"
    "Known coefficients need no log (docs/calibration.md, Known coefficients). Their uncertainty has to be stated, "
    "and\n"
    "nothing has tested them: a monitor trusts them after its own validation.\n"
    "  plumb calibrate --array drone.toml --from vehicle.params --uncertainty \"bias=5 mg, scale=1000 ppm, axis=0.5 "
    "deg\" \\\n"
    "    --out calibration.json\n"
    "  plumb calibrate --array drone.toml --calibration calibration.json --export px4 --out calibrated.params\n\n"
    "Ctrl-C ends the reading; the fit then uses the stations found so far, and says so.\n\n";

/// The number that the text is, or what is wrong with it.
std::string read_number(const std::string& text, double& value) {
  const char* const end = text.data() + text.size();
  const auto read = std::from_chars(text.data(), end, value);
  return read.ec == std::errc{} && read.ptr == end && std::isfinite(value) ? "" : "\"" + text + "\" is not a number";
}

std::string read_roll_axis(const std::string& text, std::optional<Vec3>& out) {
  Vec3 axis{};
  std::istringstream in(text + ",");
  std::string part;
  std::size_t parts = 0;
  for (; std::getline(in, part, ','); ++parts) {
    const std::string wrong = parts < 3 ? read_number(part, axis[parts]) : "";
    if (!wrong.empty()) return wrong + "; give three numbers, the direction in the tool frame: 0,0,1";
  }
  if (parts != 3) return "give three numbers, the direction in the tool frame: 0,0,1";
  const double length = norm(axis);
  if (!(length > 0.0) || !std::isfinite(length))
    return "the three numbers must not all be zero; the tool axis z is 0,0,1";
  out = scaled(axis, 1.0 / length);
  return "";
}

std::string read_wobble(const std::string& text, double& wobble_rad) {
  constexpr double kMost_deg = 45.0;
  double value = 0.0;
  const std::string wrong = read_number(text, value);
  if (!wrong.empty()) return wrong + "; give 0 to 45 deg";
  if (!(value >= 0.0) || value > kMost_deg) return "\"" + text + "\" deg is out of range: give 0 to 45 deg";
  wobble_rad = rad_from_deg(value);
  return "";
}

std::string serial_refusal(const std::string& text) {
  constexpr std::size_t kMost = 64;
  const bool printable = std::all_of(text.begin(), text.end(), [](char c) { return c >= ' ' && c <= '~'; });
  if (text.empty() || text.size() > kMost || !printable) return "give 1 to 64 printable ASCII characters";
  return "";
}

/// The pictures, where asked for. Without gnuplot the rest is done all the same.
io::FileExpected<void> draw_fit(const CalibrateOptions& options, const session::CalibrationRun& fit,
                                const io::ArrayFile& array) {
  if (options.plots.empty()) return {};
  std::string missing;
  const io::FileExpected<std::vector<std::string>> names = cli::draw_fit(options.plots, fit, array, missing);
  if (!names) return tl::unexpected<io::FileError>(names.error());
  if (!missing.empty()) print_error("plumb: " + missing + "\n");
  if (!options.json) print("written to " + options.plots + ": " + render::listed(*names) + "\n");
  return {};
}

/// What belongs to the fit of a log at rest, as far as it is given.
const char* option_of_a_fit(const CalibrateOptions& options) {
  const std::pair<bool, const char*> at_rest[] = {{!options.log.path.empty(), "--log"},
                                                  {!options.known_attitudes.empty(), "--known-attitude"},
                                                  {!options.align_by.empty(), "--align-by"},
                                                  {options.choice.paper_fits, "--paper"},
                                                  {!options.plots.empty(), "--plots"},
                                                  {options.rolls, "--roll-axis"},
                                                  {options.suggest, "--suggest"},
                                                  {options.verbose, "--verbose"}};
  for (const auto& [given, option] : at_rest) {
    if (given) return option;
  }
  return options.of_a_fit;
}

io::FileError wrong_use(const char* option, const std::string& what, const std::string& remedy) {
  return io::FileError{option, 0, "", what, remedy, io::ExitCode::usage};
}

/// The gyros of a group are calibrated in motion alone.
bool of_a_group(const CalibrateOptions& options) {
  return !options.motion.empty() && array_file_of(options.array) != options.array;
}

/// A calibration is made at rest, in motion or of known coefficients: which options belong together.
std::optional<io::FileError> misuse(const CalibrateOptions& options) {
  if (std::optional<io::FileError> wrong = misuse_of(options.known, options.calibration)) return wrong;
  const char* const of_a_fit = option_of_a_fit(options);
  if (options.gyros.given() != nullptr && !of_a_group(options))
    return wrong_use(options.gyros.given(), "belongs to a calibration of gyros",
                     "name their group, and a log in motion: --array TOOL.toml#GROUP --motion LOG.csv");
  if (options.known.given()) {
    const char* const mode = options.known.from.empty() ? "--export" : "--from";
    if (of_a_fit != nullptr)
      return wrong_use(of_a_fit, std::string("belongs to a calibration from a log, not to ") + mode, "leave it out");
    const bool tagged = !options.tag.date.empty() || !options.tag.serial.empty();
    if (tagged && options.known.from.empty())
      return wrong_use(options.tag.date.empty() ? "--serial" : "--date", "belongs to a calibration that is made",
                       "leave it out: the forms of others hold none");
    if (!options.motion.empty())
      return wrong_use("--motion", std::string("does not go with ") + mode, "add it to the calibration afterwards");
    return std::nullopt;
  }
  if (options.motion.empty()) {
    if (options.log.path.empty())
      return wrong_use(
          "--log", "is required",
          "give the log of still attitudes, --from with known coefficients, or --calibration and --motion");
    if (!options.calibration.empty())
      return wrong_use("--calibration", "belongs to --motion; a calibration at rest begins anew", "leave it out");
    return std::nullopt;
  }
  if (of_a_fit != nullptr)
    return wrong_use(of_a_fit, "belongs to a calibration at rest, not to --motion", "leave it out");
  if (of_a_group(options)) return std::nullopt;
  if (options.calibration.empty())
    return wrong_use("--motion", "adds to a calibration made at rest, and none is given",
                     "calibrate with --log first, then give --calibration CAL.json");
  if (!options.tag.serial.empty())
    return wrong_use("--serial", "belongs to a calibration at rest, not to --motion", "leave it out");
  return std::nullopt;
}

io::ExitCode run_known(const CalibrateOptions& options) {
  const ChebyshevSpan& use = options.choice.temperature.use_degc;
  KnownCoefficientFiles files = {options.array,      options.calibration, options.out, options.tag.date,
                                 options.tag.serial, std::nullopt,        options.json};
  if (use.lowest < use.highest) files.span = coefficients::TemperatureSpan{use.lowest, use.highest};
  return options.known.from.empty() ? run_calibrate_export(options.known, files)
                                    : run_calibrate_from(options.known, files);
}

io::ExitCode run_calibrate(const CalibrateOptions& options) {
  if (const std::optional<io::FileError> wrong = misuse(options)) return report(*wrong);
  if (options.known.given()) return run_known(options);
  const session::LogSpec motion{options.motion, options.log.on_bad_row};
  if (of_a_group(options))
    return run_calibrate_gyros(options.gyros, {options.array, options.calibration, motion, options.out,
                                               options.tag.date, options.tag.serial, options.json});
  if (!options.motion.empty())
    return run_calibrate_motion(
        {options.array, options.calibration, motion, options.out, options.tag.date, options.json});
  const std::vector<NamedFile> to_write = {{"--out", options.out}};
  const std::vector<NamedFile> to_read = {
      {"--array", array_file_of(options.array)}, {"--log", options.log.path}, {"--align-by", options.align_by}};
  if (const std::optional<io::FileError> clash = overwritten(to_write, to_read)) return report(*clash);
  io::FileExpected<io::ArrayFile> array = read_array(options.array, "plumb calibrate", Serves::lengths);
  if (!array) return report(array.error());
  if (const auto wrong = misuse_of_alignment(*array, options.align_by, !options.known_attitudes.empty()))
    return report(*wrong);
  take_known_attitudes(options.known_attitudes, *array);
  if (options.rolls && array->input.roll_group_column.empty()) {
    return report(
        io::FileError{options.array, 0, "input.roll_group",
                      "is missing: --roll-axis and --roll-axis-deviation-deg need groups of stations that share an "
                      "inclination, and the array file names no column for them",
                      "name the log column that holds the number of the roll group: roll_group = "
                      "\"group\", or remove the options",
                      io::ExitCode::usage});
  }
  watch_interrupts();
  session::CalibrationChoice choice = options.choice;
  choice.paper_fits = choice.paper_fits || array->monitor.mode == MonitorMode::paper;
  io::FileExpected<session::CalibrationRun> fit = session::run_calibration(*array, options.log, choice);
  if (!fit) return report(fit.error());
  print(options.json ? render::fit_json(*fit, *array)
                     : render::fit_text(*fit, *array, {options.verbose, options.suggest}));
  const io::FileExpected<void> drawn = draw_fit(options, *fit, *array);
  if (!drawn) return report(drawn.error());
  if (!fit->accepted) {
    const render::Refusal refusal = render::refusal_of(*fit, *array);
    print_error("plumb: the calibration was not accepted: " + refusal.reason + ". " + options.out +
                " was not written. Remedy: " + refusal.next + ".\n");
    return fit->interrupted ? io::ExitCode::other : io::ExitCode::not_accepted;
  }
  if (fit->paper_refusal.code != Errc::ok) {
    const render::Refusal refusal = render::paper_refusal_of(*fit, *array);
    print_error("plumb: the fit by the paper's method was not accepted: " + refusal.reason + ". " + options.out +
                " was not written. Remedy: " + refusal.next + ".\n");
    return fit->interrupted ? io::ExitCode::other : io::ExitCode::not_accepted;
  }
  session::CalibrationTag tag = options.tag;
  if (!options.align_by.empty()) {
    std::string text;
    const io::FileExpected<io::FrameAlignment> aligned =
        align_group(options.array, options.align_by, options.log, *array, *fit, text);
    if (!aligned) return report(aligned.error());
    tag.alignment = *aligned;
    if (!options.json) print(text);
  }
  const io::FileExpected<void> saved = session::save_calibration(options.out, *fit, *array, options.log.path, tag);
  if (!saved) return report(saved.error());
  if (!options.json && options.out != "-") print("written: " + options.out + "\n");
  if (!fit->interrupted) return io::ExitCode::done;
  print_error("plumb: interrupted; the calibration uses the " + count_text(fit->stations.size(), "station") +
              " found before the interruption.\n");
  return io::ExitCode::other;
}

}  // namespace

Command add_calibrate(const Options& tool) {
  auto options = std::make_shared<CalibrateOptions>();
  const Options command = tool.add_command(
      "calibrate", "find bias, scale and direction of every sensor from a log of attitudes held still");
  command.add_option("--array", options->array, "the array file: what the sensors are, how the log looks")
      .required()
      .type_name("ARRAY.toml");
  command
      .add_option("--log", options->log.path,
                  "the log of still attitudes, CSV with a header row or a ULog that plumb wrote; `-` reads standard "
                  "input. Required without "
                  "--motion, --from and --export")
      .type_name("LOG.csv");
  command
      .add_option("--motion", options->motion,
                  "a log in motion instead, with the rates of a gyro: fits lever arms, lags and rectification and adds "
                  "them to --calibration")
      .type_name("FLIGHT.csv");
  command
      .add_option("--calibration", options->calibration,
                  "with --motion: the calibration at rest that it adds to; with --export: the one to write")
      .type_name("CAL.json");
  add_known_coefficient_options(command, options->known);
  add_gyro_options(command, options->gyros);
  command.add_option("--out", options->out, "the calibration file to write; with --export that of the others")
      .required()
      .type_name("CAL.json");
  command
      .add_option("--date", options->tag.date,
                  "when the log was recorded; kept in the calibration file: drift per day (stability_per_day) counts "
                  "from this date")
      .check(session::date_refusal)
      .type_name("YYYY-MM-DD");
  command.add_option("--serial", options->tag.serial, "the serial number of the tool; kept in the calibration file")
      .check(serial_refusal)
      .type_name("TEXT");
  add_bad_row_option(command, options->log.on_bad_row);
  add_known_attitude_option(command, options->known_attitudes);
  command
      .add_option("--align-by", options->align_by,
                  "of a magnetic group: the calibration of the accelerometers, into whose frame the axes are turned by "
                  "the dip at the stations that both held still in")
      .type_name("ACC.json");
  command.add_flag("--paper", options->choice.paper_fits, "the paper's own fits too, kept in the calibration file");
  command
      .add_option(
          "--hold-out",
          [options](const std::string& text) {
            options->of_a_fit = "--hold-out";
            return session::read_hold_out(text, options->choice.hold_out);
          },
          "check the fit by predicting stations that were held out of it: a number of folds, a fraction (once), "
          "`one` at a time, or `none`; by default 4 folds, below 16 stations one at a time")
      .type_name("K|FRACTION|one|none");
  command
      .add_option(
          "--temperature-order",
          [options](const std::string& text) {
            options->of_a_fit = "--temperature-order";
            return session::read_temperature_order(text, options->choice.temperature.order);
          },
          "polynomials of scale and bias over the temperature: their order, or `auto`, the highest that the stations "
          "support (the default); 0 takes the coefficients of the array file")
      .type_name("auto|0|1|2|3");
  command
      .add_option(
          "--use-range-degc",
          [options](const std::string& text) {
            return session::read_use_range(text, options->choice.temperature.use_degc);
          },
          "temperatures at which the calibration will be used, for the errors to expect there; by default those of the "
          "stations. With --from: over which the coefficients hold within their uncertainty. A negative one needs the "
          "form --use-range-degc=-20,60")
      .type_name("LO,HI");
  command.add_flag(
      "--keep-outliers",
      [options] {
        options->of_a_fit = "--keep-outliers";
        options->choice.fit.reject_outliers = false;
      },
      "plain least squares: keep stations whose residuals exceed the noise");
  command
      .add_option(
          "--roll-axis",
          [options](const std::string& text) {
            options->rolls = true;
            return read_roll_axis(text, options->choice.roll_axis);
          },
          "the axis about which stations of one roll group ([input] roll_group) were rolled, in the tool frame; by "
          "default the one from which inclination is counted")
      .type_name("X,Y,Z");
  command
      .add_option(
          "--roll-axis-deviation-deg",
          [options](const std::string& text) {
            options->rolls = true;
            return read_wobble(text, options->choice.fit.roll_axis_deviation_rad);
          },
          "spread of the inclination from roll to roll within a group, 1 sigma, deg; 0 by default")
      .type_name("D");
  command
      .add_option("--plots", options->plots,
                  "draw residuals, parameters, convergence and attitudes into this directory (needs gnuplot)")
      .type_name("DIR");
  command.add_flag("--suggest", options->suggest, "list the attitudes to record next, even if the fit was accepted");
  command.add_flag("--json", options->json, "the report as JSON, for machines");
  command.add_flag("--verbose", options->verbose, "list the stations that were found, with their times and errors");
  command.footer(kCalibrateNotes + exit_codes_help());
  return {command, kCalibrateAbout, [options] { return run_calibrate(*options); }};
}

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb

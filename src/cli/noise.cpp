// plumb noise: what a log at rest tells of the noise of its sensors, and what to declare.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "plot_files.hpp"
#include "plumb/io/array_file.hpp"
#include "plumb/io/output_file.hpp"
#include "plumb/io/units.hpp"
#include "plumb/logs/flight_log.hpp"
#include "plumb/noise/axis_study.hpp"
#include "plumb/noise/load_log.hpp"
#include "plumb/render/noise_report.hpp"
#include "read_array.hpp"
#include "tool.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {
namespace {

struct NoiseOptions {
  std::string log;
  std::string array;
  std::string time_column;
  std::string rate;
  std::string unit;
  std::vector<std::string> columns;
  int block = 0;  ///< 0: `window` of the array file, or 32
  int per_octave = 4;
  std::string page;
  std::string plots;
  bool json = false;
  io::BadRowPolicy on_bad_row = io::BadRowPolicy::stop;
};

constexpr int kUsualBlock = 32;

constexpr const char* kNoiseAbout =
    "Measure the noise of sensors from a log of the tool at rest: Allan deviation, the terms of noise with their\n"
    "intervals, lines in the spectrum, and whether the noise is white over a block. Prints the `noise` to declare.";
constexpr const char* kNoiseNotes =
    "Examples:\n"
    "  plumb noise still.csv --array tool.toml\n"
    "  plumb noise still.csv --unit count --rate \"100 Hz\" --html noise.html\n"
    "  plumb noise still.csv --columns ax_mps2 --columns ay_mps2 --json\n\n"
    "With an array file the log is read as it says, and results are accelerations, of a group\n"
    "(tool.toml#NAME) in the units of its field: nT, of gyros deg/sqrt(h) and deg/h. Without one every column of "
    "numbers\n"
    "is studied but the time, which is the column t, time or timestamp (time_us: in microseconds).\n"
    "The longest stretch at rest without a gap is used. A term that the log does not show has a bound, and how much\n"
    "longer a log must be to show one of half that size. docs/noise.md has the method and what its intervals hold.\n\n";

io::FileError refused_option(const char* option, std::string what, std::string remedy) {
  return io::FileError{option, 0, "", std::move(what), std::move(remedy), io::ExitCode::usage};
}

std::optional<io::FileError> misused(const NoiseOptions& options) {
  if (options.array.empty()) return std::nullopt;
  const std::pair<const char*, const std::string&> described[] = {
      {"--time", options.time_column}, {"--rate", options.rate}, {"--unit", options.unit}};
  for (const auto& [option, value] : described) {
    if (!value.empty())
      return refused_option(option, "the array file says it: [input]", "leave it out, or correct the array file");
  }
  return std::nullopt;
}

io::FileExpected<noise::LoadOptions> load_options(const NoiseOptions& options, const io::ArrayFile* array) {
  noise::LoadOptions out;
  out.array = array;
  out.time_column = options.time_column;
  out.unit = options.unit;
  out.columns = options.columns;
  out.on_bad_row = options.on_bad_row;
  out.stop = interrupt_flag();
  if (options.rate.empty()) return out;
  const io::FileExpected<double> rate = io::parse_quantity(io::Quantity::rate, options.rate);
  if (!rate) return tl::unexpected<io::FileError>(refused_option("--rate", rate.error().what, rate.error().remedy));
  if (!(*rate > 0.0))
    return tl::unexpected<io::FileError>(refused_option("--rate", "is not above 0", "give it as in \"100 Hz\""));
  out.rate_hz = *rate;
  return out;
}

/// A log of an autopilot is named for what it is, and so is any other file that is no table.
io::FileExpected<void> check_is_table(const NoiseOptions& options) {
  std::error_code error;
  if (!options.array.empty() || !std::filesystem::is_regular_file(options.log, error)) return {};
  const io::FileExpected<logs::LogFormat> format = logs::log_format(options.log);
  if (!format) return tl::unexpected<io::FileError>(format.error());
  if (*format == logs::LogFormat::csv) return {};
  return tl::unexpected<io::FileError>(
      io::FileError{options.log, 0, "", std::string("is a log in the form ") + to_string(*format) + ", not a CSV",
                    "turn it into a CSV and an array file with plumb import, and give both"});
}

render::NoiseReport study(const NoiseOptions& options, const io::ArrayFile* array, const noise::LoadedLog& loaded) {
  render::NoiseReport out;
  out.log = options.log == "-" ? "standard input" : options.log;
  out.array = options.array;
  const bool rate = array != nullptr && array->field == io::FieldKind::rate;
  const int window = array != nullptr && !rate ? array->monitor.window : kUsualBlock;
  out.block = static_cast<std::size_t>(options.block > 0 ? options.block : window);
  out.time_column = loaded.time_column;
  out.left_out = loaded.left_out;
  out.rows_bad = loaded.rows_bad;
  out.complete = loaded.complete;
  const noise::StudyOptions how{out.block, options.per_octave};
  for (std::size_t c = 0; c < loaded.log.columns.size() && !interrupted(); ++c) {
    render::NoiseAxis axis{noise::study_axis(loaded.log, c, how), loaded.units[c], std::nullopt};
    if (!loaded.declared.empty()) axis.declared = loaded.declared[c];
    out.axes.push_back(std::move(axis));
  }
  return out;
}

io::FileExpected<void> draw_noise(const NoiseOptions& options, const render::NoiseReport& found) {
  const std::vector<render::PlotFile> files = render::noise_plot_files(found);
  const std::vector<std::string> pictures = render::noise_picture_names(found);
  if (!options.plots.empty()) {
    std::string missing;
    const io::FileExpected<std::vector<std::string>> names =
        draw_files(options.plots, files, render::kNoiseScript, pictures, missing);
    if (!names) return tl::unexpected<io::FileError>(names.error());
    if (!missing.empty()) print_error("plumb: " + missing + "\n");
    if (!options.json) print(fmt::format("\nwritten to {}: {}\n", options.plots, fmt::join(*names, ", ")));
  }
  if (options.page.empty()) return {};
  io::FileExpected<void> written =
      io::write_file(options.page, render::noise_html(found, draw_for_page(files, render::kNoiseScript, pictures)));
  if (written && !options.json) print("\nPage: " + options.page + "\n");
  return written;
}

io::ExitCode run_noise(const NoiseOptions& options) {
  if (const std::optional<io::FileError> wrong = misused(options)) return report(*wrong);
  if (const std::optional<io::FileError> clash =
          overwritten({{"--html", options.page}}, {{"--array", array_file_of(options.array)}, {"LOG", options.log}}))
    return report(*clash);
  std::optional<io::ArrayFile> array;
  if (!options.array.empty()) {
    io::FileExpected<io::ArrayFile> file = read_array(options.array, "plumb noise", Serves::all);
    if (!file) return report(file.error());
    array = *std::move(file);
  }
  if (const io::FileExpected<void> table = check_is_table(options); !table) return report(table.error());
  watch_interrupts();
  const io::ArrayFile* const described = array ? &*array : nullptr;
  const io::FileExpected<noise::LoadOptions> how = load_options(options, described);
  if (!how) return report(how.error());
  const io::FileExpected<noise::LoadedLog> loaded = noise::load_still_log(options.log, *how);
  if (!loaded) return report(loaded.error());
  const render::NoiseReport found = study(options, described, *loaded);
  print(options.json ? render::noise_json(found).dump(2) + "\n" : render::noise_text(found));
  const io::FileExpected<void> drawn = draw_noise(options, found);
  if (!drawn) return report(drawn.error());
  if (interrupted()) {
    print_error("plumb: interrupted; what was read until then is told.\n");
    return io::ExitCode::other;
  }
  if (!render::noise_picture_names(found).empty()) return io::ExitCode::done;
  return report({options.log, 0, "", "no column could be judged; each is told with its reason",
                 "record the tool at rest for some minutes, with channels that are connected",
                 io::ExitCode::nothing_judged});
}

}  // namespace

Command add_noise(const Options& tool) {
  auto options = std::make_shared<NoiseOptions>();
  const Options command = tool.add_command("noise", "measure the noise of sensors from a log at rest: what to declare");
  command.add_option("LOG", options->log, "the log of the tool at rest, CSV with a header row; `-` = standard input")
      .required()
      .type_name("STILL.csv|-");
  command.add_option("--array", options->array, "the array file: how the log looks, what noise is declared")
      .type_name("ARRAY.toml");
  command.add_option("--columns", options->columns, "study this column only (sensor id with --array); several times")
      .type_name("NAME");
  command.add_option("--time", options->time_column, "without --array: name of the time column").type_name("NAME");
  command.add_option("--rate", options->rate, "without --array: the sampling rate, instead of a time column")
      .type_name("\"100 Hz\"");
  command
      .add_option("--unit", options->unit,
                  "without --array: unit of the columns, as [input] unit; by default by the end of their names")
      .type_name("UNIT");
  command
      .add_option("--block", options->block,
                  "samples that the monitor averages; by default `window` of the array file, else 32")
      .told_range(1, 256)
      .type_name("N");
  command.add_option("--per-octave", options->per_octave, "averaging times for each factor of two; 4 by default")
      .told_range(1, 16)
      .type_name("N");
  command.add_option("--html", options->page, "write a page with everything that was found, and the plots (gnuplot)")
      .type_name("FILE.html");
  command
      .add_option("--plots", options->plots,
                  "draw the Allan deviation with the fitted slopes, and the spectrum, into this directory (gnuplot)")
      .type_name("DIR");
  command.add_flag("--json", options->json, "JSON instead of text, for machines");
  add_bad_row_option(command, options->on_bad_row);
  command.footer(kNoiseNotes + exit_codes_help());
  return {command, kNoiseAbout, [options] { return run_noise(*options); }};
}

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb

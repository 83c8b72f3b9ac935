// plumb geometry: what a set of axes can and cannot determine, before anything is built.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <memory>
#include <optional>

#include "../io/text_tools.hpp"
#include "plot_files.hpp"
#include "plumb/array/named.hpp"
#include "plumb/core/units.hpp"
#include "plumb/io/array_file.hpp"
#include "plumb/io/calibration_file.hpp"
#include "plumb/render/calibration_notes.hpp"
#include "plumb/render/geometry_plot.hpp"
#include "plumb/render/geometry_report.hpp"
#include "plumb/render/rate_geometry.hpp"
#include "plumb/session/monitor_pipeline.hpp"
#include "read_array.hpp"
#include "tool.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {
namespace {

using findings::GeometryStudy;
using findings::GeometrySubject;

struct GeometryOptions {
  std::string array;
  std::string name;
  std::string calibration;
  std::string noise = "200 ug0";
  std::string plots;
  int samples = 0;  ///< 0: the window of the file, or 32
  bool check = false;
  bool json = false;
};

constexpr const char* kGeometryAbout =
    "Judge a geometry: the array as it was read, how well its axes determine a vector, how many faulty sensors it\n"
    "bears, the least faults that are found, the tilt error that can go undetected, and what no test can see.";
constexpr const char* kGeometryNotes =
    "Built-in geometries for --name:\n"
    "  paper-tetrahedron   the paper's four axes (three on a cone about z, the fourth along z)\n"
    "  triad               orthogonal x, y, z\n"
    "  cone:5              five axes on a cone about z (any number from 3 up)\n"
    "  cone-axis:8         seven on a cone and one along z\n"
    "  platonic:6          one axis per pair of faces: 3 cube, 4 octahedron, 6 dodecahedron, 10 icosahedron\n\n"
    "Examples:\n"
    "  plumb geometry tool.toml\n"
    "  plumb geometry tool.toml --calibration cal.json --plots pictures\n"
    "  plumb geometry tool.toml#mag         a group of the tool, in the units of its field\n"
    "  plumb geometry --name cone:5 --noise \"1 mg0\" --json\n\n"
    "Words: det = determinant of three unit axes (1 = orthogonal, 0 = in one plane); near singular = |det| below\n"
    "0.05, such a triple raises no alarm. Coplanarity c = most axes in one plane. Confirmed grade = faults that can\n"
    "be excluded; provisional grade = faults that can be excluded provisionally, without knowing gravity.\n"
    "Minimum detectable bias: missed in at most 0.1 % of blocks. Guaranteed: whatever the noise does within its "
    "bound.\n"
    "The four sizes have these names in every command and report; docs/sizes.md has them for five arrays.\n"
    "Angles in deg.\n"
    "docs/guide.md explains every line. --check ends with 6 where there is a warning.\n\n";

const std::vector<std::string> kNames = {"paper-tetrahedron", "triad", "cone", "cone-axis", "platonic"};

io::FileError usage(std::string what, std::string remedy) {
  return io::FileError{"--name", 0, "", std::move(what), std::move(remedy), io::ExitCode::usage};
}

io::FileExpected<SensorArray> array_of(const AxisList& axes, int n, const std::string& name, double sigma_mps2) {
  if (n == 0) {
    return tl::unexpected<io::FileError>(
        usage("\"" + name + "\" is not a built-in geometry",
              fmt::format("choose a number of sensors that this geometry has, from 3 to {}: paper-tetrahedron, triad, "
                          "cone:5, cone-axis:8, platonic:6",
                          kCapacity)));
  }
  std::array<SensorRow, kCapacity> rows{};
  for (std::size_t i = 0; i < static_cast<std::size_t>(n); ++i) {
    rows[i].id = make_id(fmt::format("a{}", i + 1).c_str());
    rows[i].axis = axes[i];
    rows[i].sigma_mps2 = sigma_mps2;
  }
  const Expected<SensorArray> array = SensorArray::make(rows.data(), n);
  if (array) return *array;
  return tl::unexpected<io::FileError>(io::from_error(array.error()));
}

io::FileExpected<SensorArray> named_array(const std::string& name, double sigma_mps2) {
  const std::size_t colon = name.find(':');
  const std::string kind = name.substr(0, colon);
  int n = 0;
  if (colon != std::string::npos) {
    const char* end = name.data() + name.size();
    const auto [stop, error] = std::from_chars(name.data() + colon + 1, end, n);
    if (error != std::errc() || stop != end) n = 0;
  }
  AxisList axes{};
  if (name == "paper-tetrahedron") return array_of(axes, paper_tetrahedron(axes), name, sigma_mps2);
  if (name == "triad") return array_of(axes, orthogonal_triad(axes), name, sigma_mps2);
  const bool fits = n >= 3 && n <= kCapacity;
  if (kind == "cone") return array_of(axes, fits ? cone(axes, n) : 0, name, sigma_mps2);
  if (kind == "cone-axis") return array_of(axes, fits ? cone_with_axis(axes, n) : 0, name, sigma_mps2);
  if (kind == "platonic") return array_of(axes, fits ? platonic(axes, n) : 0, name, sigma_mps2);
  return tl::unexpected<io::FileError>(usage(
      "\"" + name + "\" is not a geometry",
      io::did_you_mean(kind, kNames) + "choose one of paper-tetrahedron, triad, cone:5, cone-axis:8, platonic:6"));
}

io::FileError refused(const char* option, std::string what, std::string remedy) {
  return io::FileError{option, 0, "", std::move(what), std::move(remedy), io::ExitCode::usage};
}

io::FileExpected<void> name_subject(const GeometryOptions& options, GeometrySubject& subject) {
  io::FileExpected<double> sigma = io::parse_quantity(io::Quantity::acceleration, options.noise);
  if (!sigma) {
    sigma.error().code = io::ExitCode::usage;
    sigma.error().file = "--noise";
    return tl::unexpected<io::FileError>(sigma.error());
  }
  const io::FileExpected<SensorArray> array = named_array(options.name, *sigma);
  if (!array) return tl::unexpected<io::FileError>(array.error());
  subject.name = options.name;
  subject.array = *array;
  return {};
}

io::FileExpected<void> read_subject(const GeometryOptions& options, GeometrySubject& subject) {
  io::FileExpected<io::ArrayFile> file = read_array(options.array, "plumb geometry", Serves::all);
  if (!file) return tl::unexpected<io::FileError>(file.error());
  subject.name = file->name;
  subject.array = file->array;
  subject.model = file->datasheet.model();
  subject.gravity = file->gravity;
  subject.settings = findings::settings_of(*file);
  if (file->field == io::FieldKind::rate) {
    if (!options.calibration.empty() || !options.plots.empty() || options.samples > 0)
      return tl::unexpected<io::FileError>(refused(
          !options.calibration.empty() ? "--calibration"
          : options.samples > 0        ? "--samples"
                                       : "--plots",
          "belongs to a vector whose length is known; gyros are judged by parity, with [group.rate]", "leave it out"));
  } else if (!options.calibration.empty()) {
    const io::FileExpected<io::CalibrationFile> found = io::read_calibration(options.calibration, *file);
    if (!found) return tl::unexpected<io::FileError>(found.error());
    print_error(render::exact_note(*found, options.calibration));
    subject.array = session::array_to_certify(*file, found->calibration);
    subject.model = found->calibration.model;
    subject.calibrated = true;
    subject.visited = found->context.down;
  }
  subject.file = std::make_unique<const io::ArrayFile>(*std::move(file));
  return {};
}

std::optional<io::FileError> misused(const GeometryOptions& options) {
  if (options.array.empty() && options.name.empty())
    return refused("geometry", "no array is given", "give an array file, or --name paper-tetrahedron");
  if (!options.array.empty() && !options.name.empty())
    return refused("geometry", "both a file and --name are given", "give an array file, or --name paper-tetrahedron");
  if (!options.calibration.empty() && options.array.empty())
    return refused("--calibration", "belongs to an array file, and none is given",
                   "give the array file that was calibrated");
  return std::nullopt;
}

io::FileExpected<void> draw_geometry(const GeometryOptions& options, const GeometrySubject& subject,
                                     const GeometryStudy& study) {
  if (options.plots.empty()) return {};
  const render::GeometryPictures pictures = render::geometry_pictures(subject, study);
  if (pictures.map.empty() && pictures.levels.empty()) {
    print_error("plumb: --plots: no picture was drawn: this array cannot isolate a fault at any attitude\n");
    return {};
  }
  std::string missing;
  const io::FileExpected<std::vector<std::string>> names =
      draw_files(options.plots, render::geometry_plot_files(pictures), render::kGeometryScript,
                 render::geometry_picture_names(pictures), missing);
  if (!names) return tl::unexpected<io::FileError>(names.error());
  if (!missing.empty()) print_error("plumb: " + missing + "\n");
  if (!options.json) print(fmt::format("\nwritten to {}: {}\n", options.plots, fmt::join(*names, ", ")));
  return {};
}

/// Gyros have no length to be held against: what parity alone gives.
io::ExitCode judge_rates(const GeometryOptions& options, const io::ArrayFile& group) {
  const findings::RateGeometry found = findings::study_rates(group.array, group.rate);
  print(options.json ? render::rate_geometry_json(group, found) : render::rate_geometry_text(group, found));
  if (!options.check || found.isolated_units > 0) return io::ExitCode::done;
  print_error(fmt::format("plumb: {}: no_isolation: {}\n", group.name, render::kNoRateIsolation));
  return io::ExitCode::verification_failed;
}

io::ExitCode run_geometry(const GeometryOptions& options) {
  if (const std::optional<io::FileError> wrong = misused(options)) return report(*wrong);
  GeometrySubject subject;
  const io::FileExpected<void> ready =
      options.array.empty() ? name_subject(options, subject) : read_subject(options, subject);
  if (!ready) return report(ready.error());
  if (subject.field() == io::FieldKind::rate) return judge_rates(options, *subject.file);
  if (options.samples > 0) subject.settings.samples = options.samples;
  const GeometryStudy study = findings::study_geometry(subject);
  print(options.json ? render::geometry_json(subject, study) : render::geometry_text(subject, study));
  const io::FileExpected<void> drawn = draw_geometry(options, subject, study);
  if (!drawn) return report(drawn.error());
  if (!options.check || study.warnings.empty()) return io::ExitCode::done;
  for (const findings::Finding& f : study.warnings) {
    print_error(
        fmt::format("plumb: {}: {}: {}\n", subject.name, to_string(f.code), render::geometry_words(f, subject, study)));
  }
  return io::ExitCode::verification_failed;
}

}  // namespace

Command add_geometry(const Options& tool) {
  auto options = std::make_shared<GeometryOptions>();
  const Options command =
      tool.add_command("geometry", "judge a set of axes: what it determines, and how many faults it can isolate");
  command.add_option("array", options->array, "the array file to judge").type_name("ARRAY.toml");
  command.add_option("--name", options->name, "a built-in geometry instead of a file, see below").type_name("NAME");
  command
      .add_option("--calibration", options->calibration,
                  "what `plumb calibrate` wrote for this array: its axes, and the errors that it leaves")
      .type_name("CAL.json");
  command.add_option("--samples", options->samples, "samples of a block; by default `window` of the file, else 32")
      .told_range(1, 1000000)
      .type_name("N");
  command.add_option("--noise", options->noise, "with --name: noise of one sample, 1 sigma (default \"200 ug0\")")
      .type_name("NOISE");
  command
      .add_option(
          "--plots", options->plots,
          "draw single-attitude isolation over all attitudes, and the protection level against the noise, into this "
          "directory (needs gnuplot)")
      .type_name("DIR");
  command.add_flag("--check", options->check, "exit with code 6 if there is a warning");
  command.add_flag("--json", options->json, "JSON instead of text, for machines");
  command.footer(kGeometryNotes + exit_codes_help());
  return {command, kGeometryAbout, [options] { return run_geometry(*options); }};
}

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb

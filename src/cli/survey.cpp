// plumb survey: stations of accelerometers and magnetometers, judged, and the path of the hole.
#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <tuple>

#include "plumb/io/output_file.hpp"
#include "plumb/io/printable.hpp"
#include "plumb/render/survey_report.hpp"
#include "plumb/survey/station_file.hpp"
#include "plumb/survey/survey_csv.hpp"
#include "read_array.hpp"
#include "survey_page.hpp"
#include "survey_reference.hpp"
#include "tool.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {
namespace {

struct SurveyOptions {
  std::string stations;
  ReferenceOptions reference;
  std::string convergence;
  std::optional<survey::North> north;
  std::string noise_gravity = "0.1 mg", noise_field = "20 nT";
  survey::LimitKind limits = survey::LimitKind::from_uncertainty;
  double false_alarm = 0.0027;
  double risk = 1e-4;
  bool axial = false;
  bool align = false;
  std::string alignment_sigma;  // empty: kUsualAlignment
  std::string sag_sigma, depth_sigma, depth_scale_sigma;
  std::string csv, page;
  bool json = false;
  io::BadRowPolicy on_bad_row = io::BadRowPolicy::stop;
};

constexpr const char* kUsualAlignment = "0.5 deg";
constexpr double kMostStated_rad = rad_from_deg(30.0);  // beyond, Gauss and Newton may end elsewhere

constexpr const char* kSurveyAbout =
    "Inclination, toolface and azimuth of survey stations from accelerometers and magnetometers, each with its\n"
    "protection level; checks of gravity, field and dip; the path of the hole by minimum curvature.";
constexpr const char* kSurveyNotes =
    "Examples:\n"
    "  plumb survey run4.csv --place \"60.40, 2.10\" --date 2026-03-31\n"
    "  plumb survey run4.csv --place \"60.40, 2.10\" --date 2026-03-31 --convergence \"-1.2 deg\" --axial --csv "
    "out.csv\n"
    "  plumb survey run4.csv --gravity \"9.819 m/s^2\" --field \"50812 nT\" --dip \"72.4 deg\" --declination \"-0.6 "
    "deg\"\n\n"
    "Columns of STATIONS.csv: md_m, then gx_mps2 gy_mps2 gz_mps2 (or _g, _mg; ax_ for specific force) and bx_nT by_nT\n"
    "bz_nT (or _uT, _mG, _G). z points down the hole, toolface counts from y. docs/survey.md has formulas, sources "
    "and\n"
    "limits, and what is refused.\n\n";

io::FileExpected<double> alignment_within(const SurveyOptions& options) {
  const auto refused = [](const char* option, const char* what, const char* remedy) {
    return tl::unexpected<io::FileError>(io::FileError{option, 0, "", what, remedy, io::ExitCode::usage});
  };
  if (options.axial)
    return refused("--align-magnetometers", "it cannot be asked for together with --axial: both explain the same dips",
                   "leave one out; the alignment takes axial interference of 220 nT (1 sigma) into account");
  const std::string stated = options.alignment_sigma.empty() ? kUsualAlignment : options.alignment_sigma;
  const io::FileExpected<double> sigma = quantity_option(io::Quantity::angle, "--alignment-sigma", stated);
  if (sigma && !(*sigma > 0.0 && *sigma <= kMostStated_rad))
    return refused("--alignment-sigma", "it must be above 0 and at most 30 deg", "state it as in \"0.5 deg\"");
  return sigma;
}

io::FileExpected<survey::PathSigmas> path_sigmas(const SurveyOptions& options) {
  survey::PathSigmas out;
  struct Sigma {
    const char* option;
    const std::string& text;
    io::Quantity quantity;
    double most;
    const char* form;
    double& value;
  };
  for (const Sigma& one : {Sigma{"--sag-sigma", options.sag_sigma, io::Quantity::angle, rad_from_deg(5.0),
                                 "above 0 and at most 5 deg, as in \"0.2 deg\"", out.sag_rad},
                           Sigma{"--depth-sigma", options.depth_sigma, io::Quantity::length, 1000.0,
                                 "above 0 and at most 1000 m, as in \"0.35 m\"", out.depth_m},
                           Sigma{"--depth-scale-sigma", options.depth_scale_sigma, io::Quantity::ratio, 0.1,
                                 "above 0 and at most 0.1 of the depth, as in \"5.6e-4\"", out.depth_scale}}) {
    if (one.text.empty()) continue;
    const io::FileExpected<double> found = quantity_option(one.quantity, one.option, one.text);
    if (!found) return tl::unexpected<io::FileError>(found.error());
    if (!(*found > 0.0 && *found <= one.most))
      return tl::unexpected<io::FileError>(
          io::FileError{one.option, 0, "", "is out of range", std::string("state ") + one.form, io::ExitCode::usage});
    one.value = *found;
  }
  return out;
}

io::FileExpected<survey::SurveySettings> survey_settings(const SurveyOptions& options) {
  survey::SurveySettings out;
  out.station.checks.limits = options.limits;
  out.station.checks.false_alarm = options.false_alarm;
  out.integrity_risk = options.risk;
  out.north = options.north;
  out.correct_axial = options.axial;
  if (options.align) {
    const io::FileExpected<double> within = alignment_within(options);
    if (!within) return tl::unexpected<io::FileError>(within.error());
    out.align_within_rad = *within;
  } else if (!options.alignment_sigma.empty()) {
    return tl::unexpected<io::FileError>(io::FileError{"--alignment-sigma", 0, "", "no alignment is asked for",
                                                       "add --align-magnetometers", io::ExitCode::usage});
  }
  const io::FileExpected<survey::PathSigmas> path = path_sigmas(options);
  if (!path) return tl::unexpected<io::FileError>(path.error());
  out.path = *path;
  if (!options.convergence.empty()) {
    const io::FileExpected<double> angle = quantity_option(io::Quantity::angle, "--convergence", options.convergence);
    if (!angle) return tl::unexpected<io::FileError>(angle.error());
    out.station.convergence = {true, *angle};
  }
  return out;
}

/// What is asked for, and what is missing for it.
std::optional<io::FileError> missing_for_north(const SurveyOptions& options, const survey::Reference& reference) {
  if (!options.north || *options.north == survey::North::magnetic) return std::nullopt;
  if (!reference.field.declination_known)
    return io::FileError{"--north",
                         0,
                         "",
                         "there is no declination to turn magnetic azimuths by" +
                             (reference.field.declination_note.empty() ? "" : ": " + reference.field.declination_note),
                         "state --field, --dip and --declination, or --place and --date",
                         io::ExitCode::usage};
  if (*options.north == survey::North::grid && options.convergence.empty())
    return io::FileError{
        "--north",          0, "", "there is no convergence to turn true azimuths by", "state --convergence",
        io::ExitCode::usage};
  return std::nullopt;
}

/// The command that makes the page again.
std::string command_of(const SurveyOptions& o) {
  const SurveyOptions usual;
  const ReferenceOptions& r = o.reference;
  const std::tuple<const char*, const std::string&, const std::string&> texts[] = {
      {"--array", r.array, usual.reference.array},
      {"--place", r.place, usual.reference.place},
      {"--height", r.height, usual.reference.height},
      {"--date", r.date, usual.reference.date},
      {"--coefficients", r.coefficients, usual.reference.coefficients},
      {"--gravity", r.gravity, usual.reference.gravity},
      {"--gravity-sigma", r.gravity_sigma, usual.reference.gravity_sigma},
      {"--field", r.field, usual.reference.field},
      {"--field-sigma", r.field_sigma, usual.reference.field_sigma},
      {"--dip", r.dip, usual.reference.dip},
      {"--dip-sigma", r.dip_sigma, usual.reference.dip_sigma},
      {"--declination", r.declination, usual.reference.declination},
      {"--declination-sigma", r.declination_sigma, usual.reference.declination_sigma},
      {"--convergence", o.convergence, usual.convergence},
      {"--noise-gravity", o.noise_gravity, usual.noise_gravity},
      {"--noise-field", o.noise_field, usual.noise_field},
      {"--alignment-sigma", o.alignment_sigma, usual.alignment_sigma},
      {"--sag-sigma", o.sag_sigma, usual.sag_sigma},
      {"--depth-sigma", o.depth_sigma, usual.depth_sigma},
      {"--depth-scale-sigma", o.depth_scale_sigma, usual.depth_scale_sigma},
      {"--csv", o.csv, usual.csv},
      {"--report", o.page, usual.page}};
  std::string out = "plumb survey " + io::shell_word(o.stations);
  for (const auto& [option, text, left_out] : texts) {
    if (text != left_out) out += fmt::format(" {} {}", option, io::shell_word(text));
  }
  if (r.errors == ReferenceErrors::wmm) out += " --reference-errors wmm";
  if (o.north) out += fmt::format(" --north {}", to_string(*o.north));
  if (o.limits == survey::LimitKind::fixed) out += " --limits fixed";
  if (o.false_alarm != usual.false_alarm) out += fmt::format(" --false-alarm {}", o.false_alarm);
  if (o.risk != usual.risk) out += fmt::format(" --risk {}", o.risk);
  if (o.axial) out += " --axial";
  if (o.align) out += " --align-magnetometers";
  if (o.on_bad_row == io::BadRowPolicy::skip) out += " --on-bad-row skip";
  return out;
}

/// What is said where a result was written, yet is not all that was asked for.
io::ExitCode verdict(const SurveyOptions& options, const survey::Survey& found) {
  if (found.axial && !*found.axial)
    return report({options.stations, 0, "",
                   "the axial interference could not be estimated: " + found.axial->error().text(),
                   "leave --axial out, or add stations at other attitudes", io::ExitCode::not_accepted});
  if (found.alignment && !*found.alignment)
    return report({options.stations, 0, "",
                   "the alignment of the magnetometers could not be estimated: " + found.alignment->error().text(),
                   "leave --align-magnetometers out, or add stations at other attitudes", io::ExitCode::not_accepted});
  for (const survey::SurveyStation& s : found.stations) {
    if (s.status != survey::StationStatus::rejected) return io::ExitCode::done;
  }
  return report({options.stations, 0, "", "no station passed the check of gravity",
                 "check units and signs of the columns, the noise that is stated, and the reference of gravity",
                 io::ExitCode::nothing_judged});
}

io::ExitCode run_survey_command(const SurveyOptions& options) {
  if (const auto clash = overwritten({{"--csv", options.csv}, {"--report", options.page}},
                                     {{"STATIONS", options.stations},
                                      {"--coefficients", options.reference.coefficients},
                                      {"--array", array_file_of(options.reference.array)}}))
    return report(*clash);
  io::FileExpected<survey::SurveySettings> settings = survey_settings(options);
  if (!settings) return report(settings.error());
  const auto noise_gravity = quantity_option(io::Quantity::acceleration, "--noise-gravity", options.noise_gravity);
  if (!noise_gravity) return report(noise_gravity.error());
  const auto noise_field = field_option("--noise-field", options.noise_field);
  if (!noise_field) return report(noise_field.error());
  io::FileExpected<survey::StationFile> file = survey::read_stations(options.stations, options.on_bad_row);
  if (!file) return report(file.error());
  for (survey::Measurement& m : file->stations) m.random = survey::independent_covariance(*noise_gravity, *noise_field);
  std::string notes;
  const io::FileExpected<ReferenceOptions> reference = with_array(options.reference, notes);
  if (!reference) return report(reference.error());
  print_error(notes);
  const auto stations = referenced(file->stations, *reference);
  if (!stations) return report(stations.error());
  if (const auto missing = missing_for_north(options, stations->front().reference)) return report(*missing);

  const render::SurveyReport found{options.stations,
                                   file->gravity_unit,
                                   file->field_unit,
                                   file->rows_left_out,
                                   options.reference.array,
                                   *settings,
                                   stations->front().reference,
                                   stations->back().reference,
                                   *noise_gravity,
                                   *noise_field,
                                   survey::run_survey(*stations, *settings)};
  if (found.survey.wiring.swapped)
    return report({options.stations, 0, "header", found.survey.wiring.text(),
                   "rename the columns of that triad; the dip does not say which of the two it is",
                   io::ExitCode::invalid_input});
  if (!options.csv.empty()) {
    if (const auto written = io::write_file(options.csv, survey::survey_csv(found.survey)); !written)
      return report(written.error());
  }
  if (!options.page.empty()) {
    const std::vector<std::pair<const char*, std::string>> inputs{{"stations", options.stations},
                                                                  {"coefficients", options.reference.coefficients},
                                                                  {"array", array_file_of(options.reference.array)}};
    if (const auto written = write_survey_page(options.page, found, inputs, command_of(options)); !written)
      return report(written.error());
  }
  print(options.json ? render::survey_json(found).dump(2) + "\n" : render::survey_text(found));
  return verdict(options, found.survey);
}

void add_checks(const Options& command, SurveyOptions& options) {
  command
      .add_option("--noise-gravity", options.noise_gravity,
                  "noise of a station's accelerometer means, 1 sigma (default \"0.1 mg\")")
      .type_name("\"0.1 mg\"");
  command
      .add_option("--noise-field", options.noise_field,
                  "noise of a station's magnetometer means, 1 sigma (default \"20 nT\")")
      .type_name("\"20 nT\"");
  command
      .add_option("--limits", options.limits,
                  {{"uncertainty", survey::LimitKind::from_uncertainty}, {"fixed", survey::LimitKind::fixed}},
                  "uncertainty: sigmas of tool and reference (default); fixed: 2.5 mg, 300 nT, 0.25 deg")
      .type_name("uncertainty|fixed");
  command.add_option("--false-alarm", options.false_alarm, "chance that a good station fails a check (default 0.0027)")
      .range(1e-9, 0.5)
      .type_name("P");
  command.add_option("--risk", options.risk, "chance that an angle is beyond its protection level (default 1e-4)")
      .range(1e-12, 0.5)
      .type_name("P");
}

}  // namespace

Command add_survey(const Options& tool) {
  auto options = std::make_shared<SurveyOptions>();
  const Options command =
      tool.add_command("survey", "azimuth and path of a hole, from accelerometers and magnetometers");
  command.add_option("STATIONS", options->stations, "one row a station, CSV with a header row; `-` = standard input")
      .required()
      .type_name("STATIONS.csv|-");
  add_reference_options(command, options->reference);
  command.add_option("--convergence", options->convergence, "meridian convergence, true to grid north, east positive")
      .type_name("\"1.2 deg\"");
  const auto north = [options](const std::string& text) {
    for (const survey::North one : {survey::North::magnetic, survey::North::true_north, survey::North::grid}) {
      if (text == to_string(one)) {
        options->north = one;
        return std::string();
      }
    }
    return std::string("must be magnetic, true or grid");
  };
  command
      .add_option("--north", north, "north of the path; by default grid with --convergence, else true, else magnetic")
      .type_name("magnetic|true|grid");
  add_checks(command, *options);
  command.add_flag("--axial", options->axial,
                   "estimate the axial interference of the drill string from all stations, and take it off");
  command.add_flag("--align-magnetometers", options->align,
                   "turn the field into the frame of the accelerometers, by a rotation estimated from the dips");
  command
      .add_option("--alignment-sigma", options->alignment_sigma,
                  "how far they may be turned, 1 sigma; an estimate has to be better (default \"0.5 deg\")")
      .type_name("\"0.5 deg\"");
  command
      .add_option("--sag-sigma", options->sag_sigma,
                  "sag of the tool in a horizontal hole, 1 sigma of its inclination, for positions (none)")
      .type_name("\"0.2 deg\"");
  command.add_option("--depth-sigma", options->depth_sigma, "measured depth, alike at all stations, 1 sigma (none)")
      .type_name("\"0.35 m\"");
  command
      .add_option("--depth-scale-sigma", options->depth_scale_sigma,
                  "measured depth, in proportion to it, 1 sigma (none)")
      .type_name("5.6e-4");
  command.add_option("--csv", options->csv, "write the survey as a table").type_name("OUT.csv");
  command.add_option("--report", options->page, "write a page with every check, plots (gnuplot) and references")
      .type_name("FILE.html");
  command.add_flag("--json", options->json, "JSON instead of text, for machines");
  add_bad_row_option(command, options->on_bad_row);
  command.footer(kSurveyNotes + exit_codes_help());
  return {command, kSurveyAbout, [options] { return run_survey_command(*options); }};
}

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb

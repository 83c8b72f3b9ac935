#include "calibrate_known.hpp"
#include "read_array.hpp"

#include "plumb/coefficients/calibration_export.hpp"
#include "plumb/io/output_file.hpp"
#include "plumb/render/coefficients_report.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {
namespace {

std::string wrong_form(const std::string& word) {
  return coefficients::form_of(word) ? "" : "give px4, ardupilot, imu_tk, csv or json";
}

std::string wrong_instance(const std::string& text) {
  const auto read = coefficients::parse_instance(text);
  return read ? "" : read.error().what + ": " + read.error().remedy;
}

std::vector<coefficients::InstanceChoice> choices_of(const KnownCoefficientOptions& options) {
  std::vector<coefficients::InstanceChoice> out;
  for (const std::string& text : options.instances) {
    if (const auto read = coefficients::parse_instance(text)) out.push_back(*read);
  }
  return out;
}

io::FileExpected<std::vector<coefficients::CoefficientFile>> files_of(const KnownCoefficientOptions& options,
                                                                      const io::ArrayFile& array) {
  std::vector<coefficients::CoefficientFile> out;
  const auto form = coefficients::form_of(options.form);
  int of_imu_tk = 0;
  for (const std::string& path : options.from) {
    auto file = coefficients::read_coefficients(path, array, form, of_imu_tk + 1);
    if (!file) return tl::unexpected<io::FileError>(file.error());
    if (file->form == coefficients::Form::imu_tk) ++of_imu_tk;
    out.push_back(*std::move(file));
  }
  return out;
}

}  // namespace

void add_known_coefficient_options(const Options& command, KnownCoefficientOptions& options) {
  command
      .add_option(
          "--from", options.from,
          "known coefficients instead of a log: parameters of PX4 (CAL_ACC*) or ArduPilot (INS_ACC*), a file of "
          "imu_tk, or a table (csv, json); may be given several times")
      .type_name("FILE");
  command.add_option("--form", options.form, "with --from: the form of its files; by default it is found out")
      .check(wrong_form)
      .type_name("FORM");
  command
      .add_option(
          "--uncertainty",
          [&options](const std::string& text) {
            const auto read = coefficients::parse_uncertainty(text);
            if (!read) return read.error().what + ": " + read.error().remedy;
            options.uncertainty = *read;
            options.states_uncertainty = true;
            return std::string();
          },
          "with --from: 1 sigma of the coefficients of which the files state none: \"bias=5 mg, scale=1000 ppm, "
          "axis=0.5 deg\"")
      .type_name("TEXT");
  command
      .add_option("--instance", options.instances,
                  "with --from and --export: a chip by its number in the form, and the package or the three sensors "
                  "(x,y,z; \"-\" before one that reads the other way round) that it is; may be given several times")
      .check(wrong_instance)
      .type_name("N=PACKAGE|IDS");
  command
      .add_option("--export", options.to,
                  "write --calibration in the form of others: px4, ardupilot, imu_tk, csv or json; what that cannot "
                  "hold is listed")
      .check(wrong_form)
      .type_name("FORM");
}

std::optional<io::FileError> misuse_of(const KnownCoefficientOptions& options, const std::string& calibration) {
  const auto wrong = [](const char* option, const std::string& what, const std::string& remedy) {
    return io::FileError{option, 0, "", what, remedy, io::ExitCode::usage};
  };
  const bool from = !options.from.empty(), to = !options.to.empty();
  if (from && to) return wrong("--export", "does not go with --from", "make the calibration first, then export it");
  if (!from && !options.form.empty()) return wrong("--form", "belongs to --from", "leave it out");
  if (!from && options.states_uncertainty) return wrong("--uncertainty", "belongs to --from", "leave it out");
  if (!from && !to && !options.instances.empty())
    return wrong("--instance", "belongs to --from and --export", "leave it out");
  if (to && calibration.empty())
    return wrong("--export", "needs the calibration to write", "give --calibration CAL.json");
  if (from && !calibration.empty())
    return wrong("--calibration", "does not go with --from, which begins anew", "leave it out");
  return std::nullopt;
}

io::ExitCode run_calibrate_from(const KnownCoefficientOptions& options, const KnownCoefficientFiles& files) {
  std::vector<NamedFile> to_read = {{"--array", files.array}};
  for (const std::string& path : options.from) to_read.push_back({"--from", path});
  if (const std::optional<io::FileError> clash = overwritten({{"--out", files.out}}, to_read)) return report(*clash);
  const io::FileExpected<io::ArrayFile> array = read_array(files.array, "plumb calibrate --from", Serves::gravity);
  if (!array) return report(array.error());
  const auto read = files_of(options, *array);
  if (!read) return report(read.error());
  const auto adoption = coefficients::adopt(*array, *read, {choices_of(options), options.uncertainty, files.span});
  if (!adoption) return report(adoption.error());
  const auto saved = coefficients::save_adoption(files.out, *adoption, *array, files.date, files.serial);
  if (!saved) return report(saved.error());
  if (files.out == "-") return io::ExitCode::done;
  print(files.json ? render::adoption_json(*adoption, *array).dump(1) + "\n"
                   : render::adoption_text(*adoption, *array) + "written: " + files.out + "\n");
  return io::ExitCode::done;
}

io::ExitCode run_calibrate_export(const KnownCoefficientOptions& options, const KnownCoefficientFiles& files) {
  const std::vector<NamedFile> to_read = {{"--array", files.array}, {"--calibration", files.calibration}};
  if (const std::optional<io::FileError> clash = overwritten({{"--out", files.out}}, to_read)) return report(*clash);
  const io::FileExpected<io::ArrayFile> array = read_array(files.array, "plumb calibrate --from", Serves::gravity);
  if (!array) return report(array.error());
  const io::FileExpected<io::CalibrationFile> calibration = io::read_calibration(files.calibration, *array);
  if (!calibration) return report(calibration.error());
  const auto made =
      coefficients::export_calibration(*array, *calibration, *coefficients::form_of(options.to), choices_of(options));
  if (!made) return report(made.error());
  const io::FileExpected<void> saved = io::write_file(files.out, made->text);
  if (!saved) return report(saved.error());
  const std::string text = render::export_text(*made, *array);
  if (files.out == "-") {
    print_error(text);
    return io::ExitCode::done;
  }
  print(files.json ? render::export_json(*made, *array).dump(1) + "\n" : text + "written: " + files.out + "\n");
  return io::ExitCode::done;
}

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb

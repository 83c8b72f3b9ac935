// plumb import: a log of another program becomes an array file and a log of plumb.
#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>

#include "plumb/io/array_file.hpp"
#include "plumb/io/log_writer.hpp"
#include "plumb/io/output_file.hpp"
#include "plumb/io/printable.hpp"
#include "plumb/io/units.hpp"
#include "plumb/logs/log_aligner.hpp"
#include "plumb/review/log_import.hpp"
#include "plumb/scenario/count_text.hpp"
#include "table_options.hpp"
#include "tool.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {
namespace {

namespace fs = std::filesystem;

struct ImportOptions {
  std::string log;
  std::string out;
  std::string gravity;
  review::ImportSettings settings;
  logs::Alignment alignment = logs::Alignment::linear;
  io::LogWriter::Form form = io::LogWriter::Form::csv;
  logs::CsvHints table;
};

std::string log_path_of(const ImportOptions& options) {
  return (fs::path(options.out) / (options.form == io::LogWriter::Form::ulog ? "log.ulg" : "log.csv")).string();
}

constexpr const char* kImportAbout =
    "Turn a log of a flight controller or robot into files of plumb: array.toml with three sensors for each chip, and\n"
    "log.csv (or log.ulg) with one row for each instant, the readings of all chips aligned in time.";
constexpr const char* kImportNotes =
    "Rows have the instants of the slowest chip; the others are interpolated to them, and cells across a gap stay\n"
    "empty. The autopilot's calibration, as far as the log holds readings before it, goes to coefficients.csv, for\n"
    "plumb calibrate --from; readings after it are marked so in array.toml (corrected = true), and are not corrected\n"
    "again. array.toml accepts errors of direction up to 8 deg, which such a calibration can meet: state your own.\n"
    "The last lines say what to run next.\n\n"
    "Examples:\n"
    "  plumb import flight.ulg --out flight\n"
    "  plumb import flight.ulg --message sensor_accel --align nearest --out raw\n\n";

io::FileError failed(const std::string& file, std::string what, std::string remedy, io::ExitCode code) {
  return {file, 0, "", std::move(what), std::move(remedy), code};
}

/// The rows of the log as they are written.
class Rows {
 public:
  Rows(const review::ImportPlan& plan, io::LogWriter& writer) : plan_(plan), writer_(writer) {}

  bool operator()(const logs::AlignedRow& row) {
    Sample sample;
    sample.time_s = row.time_s;
    double degrees = 0.0;
    int warm = 0;
    for (std::size_t chip = 0; chip < row.readings.size(); ++chip) {
      const logs::ImuRecord& reading = row.readings[chip];
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double value = reading.specific_force_mps2[axis];
        if (!std::isfinite(value)) continue;
        sample.raw[3 * chip + axis] = value;
        sample.delivered = sample.delivered.with(static_cast<int>(3 * chip + axis));
      }
      if (!std::isfinite(reading.temperature_degc)) continue;
      degrees += reading.temperature_degc;
      ++warm;
    }
    io::LogWriter::Notes notes;
    if (warm > 0) sample.temperature_degc = degrees / warm;
    notes.temperature_held = warm == 0;
    if (plan_.rates_from != review::kNoChip) {
      const logs::Axes& rate = row.readings[plan_.rates_from].rate_radps;
      notes.rotation.rate_known = std::isfinite(rate[0]);
      notes.rotation.turning = notes.rotation.rate_known;
      notes.rotation.rate_radps = {rate[0], rate[1], rate[2]};
    }
    const io::FileExpected<void> written = writer_.write(sample, notes);
    if (!written) error_ = written.error();
    return written.has_value() && !interrupted();
  }
  const std::optional<io::FileError>& error() const noexcept { return error_; }

 private:
  const review::ImportPlan& plan_;
  io::LogWriter& writer_;
  std::optional<io::FileError> error_;
};

std::string aligned_words(const review::LogDigest& digest, const review::ImportPlan& plan,
                          const logs::LogAligner& aligner) {
  std::string out = fmt::format("{}, at the instants of {}", count_text(aligner.rows(), "row"),
                                io::printable_line(digest.sources[plan.sources[plan.reference]].source.name));
  for (std::size_t k = 0; k < plan.sources.size(); ++k) {
    if (k == plan.reference) continue;
    out += fmt::format("; {} is {:.2f} ms away on average",
                       io::printable_line(digest.sources[plan.sources[k]].source.name),
                       1000.0 * aligner.mean_distance_s(k));
  }
  if (aligner.left_out() > 0)
    out += fmt::format("; {} left out that went back in time", count_text(aligner.left_out(), "record"));
  return out + ".\n";
}

io::FileExpected<std::string> write_log(const ImportOptions& options, const review::LogDigest& digest,
                                        const review::ImportPlan& plan, const std::string& array_path) {
  const io::FileExpected<io::ArrayFile> array = io::read_array_file(array_path);
  if (!array) return tl::unexpected<io::FileError>(array.error());
  const std::string path = log_path_of(options);
  io::FileExpected<io::LogWriter> writer = io::LogWriter::create(path, *array, io::LogWriter::Columns::all);
  if (!writer) return tl::unexpected<io::FileError>(writer.error());
  Rows rows(plan, *writer);
  std::vector<logs::AlignedSource> sources;
  for (std::size_t k = 0; k < plan.sources.size(); ++k) sources.push_back({plan.sources[k], plan.longest_gap_s[k]});
  logs::LogAligner aligner(sources, plan.reference, options.alignment, std::ref(rows));
  const io::FileExpected<logs::LogExtent> extent = logs::read_log(options.log, options.table, aligner);
  if (!extent) return tl::unexpected<io::FileError>(extent.error());
  aligner.finish();
  if (rows.error()) return tl::unexpected<io::FileError>(*rows.error());
  const io::FileExpected<void> kept = writer->commit();
  if (!kept) return tl::unexpected<io::FileError>(kept.error());
  return fmt::format("{}: {}", io::printable_line(path), aligned_words(digest, plan, aligner));
}

io::FileExpected<void> make_place(const std::string& path) {
  std::error_code error;
  fs::create_directories(path, error);
  if (!error) return {};
  return tl::unexpected<io::FileError>(
      failed(path, "cannot be made: " + error.message(), "name a directory that can be written", io::ExitCode::other));
}

io::FileExpected<void> read_gravity(ImportOptions& options) {
  if (options.gravity.empty()) return {};
  io::FileExpected<double> gravity = io::parse_quantity(io::Quantity::acceleration, options.gravity);
  if (!gravity) {
    gravity.error().file = "--gravity";
    gravity.error().code = io::ExitCode::usage;
    return tl::unexpected<io::FileError>(gravity.error());
  }
  if (!(*gravity >= 9.5 && *gravity <= 10.2)) {
    return tl::unexpected<io::FileError>(failed("--gravity",
                                                "\"" + options.gravity + "\" is not from 9.5 to 10.2 m/s^2",
                                                "give the gravity where the log was taken", io::ExitCode::usage));
  }
  options.settings.gravity_mps2 = *gravity;
  return {};
}

/// The file beside the log with what is known of its calibration.
std::string coefficients_path(const ImportOptions& options) {
  return (fs::path(options.out) / "coefficients.csv").string();
}

/// What the array file accepts, and what the number of chips allows.
std::string about_the_monitor(const review::ImportPlan& plan) {
  if (plan.sources.size() == 1) {
    return "One chip has no redundancy: the monitor compares the length of gravity alone, and no direction is valid.\n";
  }
  return fmt::format(
      "The array file accepts errors of direction up to {:.0f} deg (alert_limit), which an autopilot's calibration "
      "allows.\n",
      review::kImportAlertLimit_deg);
}

std::string next_words(const ImportOptions& options, const review::ImportPlan& plan) {
  const std::string array = io::shell_word((fs::path(options.out) / "array.toml").string());
  const std::string log = io::shell_word(log_path_of(options));
  if (plan.coefficients_text.empty()) {
    return fmt::format(
        "\n{}The log has no calibration that can be taken over: the monitor finds one, where the log has some 20 still "
        "attitudes.\nNext:\n  plumb monitor --array {} --calibrate-first --log {}\n",
        about_the_monitor(plan), array, log);
  }
  const std::string calibration = io::shell_word((fs::path(options.out) / "calibration.json").string());
  return fmt::format(
      "\n{}Next:\n  plumb calibrate --array {} --from {} --out {}\n  plumb monitor --array {} --calibration {} --log "
      "{}\n",
      about_the_monitor(plan), array, io::shell_word(coefficients_path(options)), calibration, array, calibration, log);
}

io::ExitCode run_import(ImportOptions& options) {
  if (const io::FileExpected<void> gravity = read_gravity(options); !gravity) return report(gravity.error());
  const std::string array_path = (fs::path(options.out) / "array.toml").string();
  const std::string table_path = coefficients_path(options);
  const std::string log_path = log_path_of(options);
  if (const std::optional<io::FileError> clash =
          overwritten({{"--out", array_path}, {"--out", table_path}, {"--out", log_path}}, {{"LOG", options.log}}))
    return report(*clash);
  const io::FileExpected<review::LogDigest> digest = review::digest_log(options.log, options.table);
  if (!digest) return report(digest.error());
  io::FileExpected<review::ImportPlan> plan =
      review::plan_import(*digest, review::review_log(*digest), options.settings);
  if (!plan) {
    plan.error().file = options.log;
    return report(plan.error());
  }
  if (const io::FileExpected<void> made = make_place(options.out); !made) return report(made.error());
  if (const io::FileExpected<void> kept = io::write_file(array_path, plan->array_text); !kept)
    return report(kept.error());
  print(fmt::format("{}: {}\n", io::printable_line(array_path), count_text(plan->sources.size(), "chip")));
  if (plan->left_out > 0)
    print_error(
        fmt::format("plumb: {} left out: an array has 24 sensors at most.\n", count_text(plan->left_out, "chip")));
  if (!plan->coefficients_text.empty()) {
    const std::string path = coefficients_path(options);
    if (const io::FileExpected<void> kept = io::write_file(path, plan->coefficients_text); !kept)
      return report(kept.error());
    print(io::printable_line(path) +
          (plan->uncalibrated ? ": the autopilot's calibration of what the log holds, with what it may be "
                                "off by\n"
                              : ": scale 1 and bias 0, since the autopilot has corrected the readings, with "
                                "what they may be off by\n"));
  }
  const io::FileExpected<std::string> written = write_log(options, *digest, *plan, array_path);
  if (!written) return report(written.error());
  print(*written);
  if (!digest->understood.empty())
    print_error(fmt::format("plumb: {}: read as {}.\n", io::printable_line(options.log),
                            io::printable_line(digest->understood)));
  for (const review::Note& note : digest->notes)
    print_error(fmt::format("plumb: {}: byte {}: {}.\n", io::printable_line(options.log), note.offset,
                            io::printable_line(note.what)));
  if (interrupted()) {
    print_error("plumb: interrupted; the rows up to here are written.\n");
    return io::ExitCode::other;
  }
  print(next_words(options, *plan));
  return io::ExitCode::done;
}

}  // namespace

Command add_import(const Options& tool) {
  auto options = std::make_shared<ImportOptions>();
  const Options command =
      tool.add_command("import", "turn a log of an autopilot or robot into an array file and a CSV");
  command.add_option("LOG", options->log, "The log: ULog, DataFlash, ROS 2 bag or CSV").required().type_name("FILE");
  command.add_option("--out", options->out, "Directory for array.toml and the log; made where it is missing")
      .required()
      .type_name("DIR");
  command
      .add_option("--message", options->settings.message,
                  "Take the readings of this message (default: the one with most records)")
      .type_name("NAME");
  command.add_option("--align", options->alignment,
                     {{"linear", logs::Alignment::linear}, {"nearest", logs::Alignment::nearest}},
                     "How the other chips are brought to the instants of the slowest: linear (default) or nearest");
  command
      .add_option<io::LogWriter::Form>("--to", options->form,
                                       {{"csv", io::LogWriter::Form::csv}, {"ulog", io::LogWriter::Form::ulog}},
                                       "What to write the log as (default: csv)")
      .type_name("csv|ulog");
  command.add_flag("--rates", options->settings.rates, "With the rates of the first gyro, for a tool that turns");
  command.add_option("--gravity", options->gravity, "Gravity where the log was taken (default: anywhere on the ground)")
      .type_name("\"9.81 m/s^2\"");
  add_table_options(command, options->table);
  command.footer(kImportNotes + exit_codes_help());
  return {command, kImportAbout, [options] { return run_import(*options); }};
}

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb

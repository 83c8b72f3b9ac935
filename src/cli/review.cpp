// plumb review: logs of other programs, judged without an array file and without a calibration of plumb.
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <thread>

#include "plumb/io/output_file.hpp"
#include "plumb/io/units.hpp"
#include "plumb/render/review_report.hpp"
#include "plumb/review/time_skew.hpp"
#include "table_options.hpp"
#include "tool.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {
namespace {

namespace fs = std::filesystem;

struct ReviewOptions {
  std::vector<std::string> logs;
  std::string page;
  std::string gravity;
  bool json = false;
  bool notes = false;
  int jobs = 0;  ///< 0: as many as the machine runs at a time
  logs::CsvHints table;
};

constexpr const char* kReviewAbout =
    "Review logs of flight controllers and robots: which accelerometers they hold, what each reads at rest, whether\n"
    "they agree at rest and in motion, and which one does not. Needs no array file and no calibration.\n"
    "Reads PX4 ULog (.ulg), ArduPilot DataFlash (.bin), ROS 2 bags (.mcap, .db3) and CSV.";
constexpr const char* kReviewNotes =
    "Examples:\n"
    "  plumb review flight.ulg\n"
    "  plumb review logs/*.bin --html fleet.html\n"
    "  plumb review flight.ulg --gravity 9.8123 --json\n\n"
    "GREEN: nothing was found in what could be judged; what could not is listed. ORANGE: see to it before the next\n"
    "flight. RED: an autopilot would refuse to arm, or a sensor has failed. The exit code is that of the worst log:\n"
    "0 green, 8 orange, 9 red, 7 nothing judged, 3 a log that cannot be read. docs/review.md has every limit.\n\n";

/// A log as it came out, in the place where it was named.
struct Outcome {
  std::optional<review::LogReview> review;
  std::optional<io::FileError> error;
};

std::vector<Outcome> review_all(const ReviewOptions& options, const review::ReviewSettings& settings) {
  std::vector<Outcome> out(options.logs.size());
  std::atomic<std::size_t> next{0};
  const auto work = [&] {
    for (std::size_t k = next++; k < out.size() && !interrupted(); k = next++) {
      const io::FileExpected<review::LogReview> found = review::review_file(options.logs[k], settings);
      if (found)
        out[k].review = *found;
      else
        out[k].error = found.error();
    }
  };
  const unsigned machine = std::max(1U, std::thread::hardware_concurrency());
  const std::size_t wanted = options.jobs > 0 ? static_cast<std::size_t>(options.jobs) : machine;
  std::vector<std::thread> threads;
  for (std::size_t k = 1; k < std::min(wanted, out.size()); ++k) threads.emplace_back(work);
  work();
  for (std::thread& thread : threads) thread.join();
  return out;
}

/// The worst: red before orange before what could not be read before what was not judged.
io::ExitCode exit_code_of(const std::vector<review::LogReview>& logs, bool unread) {
  const auto any = [&](review::Grade grade) {
    return std::any_of(logs.begin(), logs.end(), [&](const auto& log) { return log.grade == grade; });
  };
  if (any(review::Grade::red)) return io::ExitCode::review_red;
  if (any(review::Grade::orange)) return io::ExitCode::review_orange;
  if (unread) return io::ExitCode::invalid_input;
  const bool all = std::all_of(logs.begin(), logs.end(), [](const auto& log) { return log.judged; });
  return all ? io::ExitCode::done : io::ExitCode::nothing_judged;
}

io::FileExpected<review::ReviewSettings> settings_of(const ReviewOptions& options) {
  review::ReviewSettings out;
  out.table = options.table;
  if (options.gravity.empty()) return out;
  io::FileExpected<double> gravity = io::parse_quantity(io::Quantity::acceleration, options.gravity);
  if (gravity && *gravity >= 1.0 && *gravity <= 30.0) {
    out.gravity_mps2 = *gravity;
    return out;
  }
  if (!gravity) {
    gravity.error().code = io::ExitCode::usage;
    gravity.error().file = "--gravity";
    return tl::unexpected<io::FileError>(gravity.error());
  }
  return tl::unexpected<io::FileError>(
      io::FileError{"--gravity", 0, "", "\"" + options.gravity + "\" is not from 1 to 30 m/s^2",
                    "give the local gravity, for example \"9.81 m/s^2\"", io::ExitCode::usage});
}

std::string text_of(const std::vector<review::LogReview>& logs, const std::vector<render::UnreadLog>& unread,
                    bool notes) {
  if (logs.size() + unread.size() > 1) {
    std::string out = render::fleet_text(logs, unread);
    for (const review::LogReview& log : logs) {
      if (log.grade != review::Grade::green) out += "\n" + render::review_text(log, notes);
    }
    return out;
  }
  return logs.empty() ? "" : render::review_text(logs.front(), notes);
}

io::ExitCode run_review(const ReviewOptions& options) {
  std::vector<NamedFile> inputs;
  for (const std::string& log : options.logs) inputs.push_back({"LOG", log});
  if (const std::optional<io::FileError> clash = overwritten({{"--html", options.page}}, inputs)) return report(*clash);
  const io::FileExpected<review::ReviewSettings> settings = settings_of(options);
  if (!settings) return report(settings.error());
  std::vector<review::LogReview> logs;
  std::vector<render::UnreadLog> unread;
  for (const Outcome& outcome : review_all(options, *settings)) {
    if (outcome.review) logs.push_back(*outcome.review);
    if (!outcome.error) continue;
    report(*outcome.error);
    unread.push_back({outcome.error->file, outcome.error->what});
  }
  if (interrupted()) {
    print_error("plumb: interrupted; the logs that were not finished are left out.\n");
    if (logs.empty()) return io::ExitCode::other;
  }
  print(options.json ? render::review_json(logs, unread).dump(2) + "\n" : text_of(logs, unread, options.notes));
  if (!options.page.empty()) {
    const io::FileExpected<void> written = io::write_file(options.page, render::review_html(logs, unread));
    if (!written) return report(written.error());
    if (!options.json) print("\nPage: " + options.page + "\n");
  }
  return exit_code_of(logs, !unread.empty());
}

}  // namespace

Command add_review(const Options& tool) {
  auto options = std::make_shared<ReviewOptions>();
  const Options command =
      tool.add_command("review", "review logs of autopilots and robots: which accelerometer disagrees; no array file");
  command.add_option("LOG", options->logs, "Logs: ULog, DataFlash, ROS 2 bag or CSV")
      .several()
      .required()
      .type_name("FILE...");
  command.add_option("--html", options->page, "Write a page with everything that was found").type_name("FILE.html");
  command
      .add_option("--gravity", options->gravity,
                  "Gravity where the log was taken (default: anywhere on the ground, 9.765 to 9.832 m/s^2)")
      .type_name("\"9.81 m/s^2\"");
  command.add_option("--jobs", options->jobs, "Logs read at a time (default: one for each processor)").range(1, 256);
  command.add_flag("--notes", options->notes, "Show every note that the reader left, with its byte");
  command.add_flag("--json", options->json, "Print everything as JSON");
  add_table_options(command, options->table);
  command.footer(kReviewNotes + exit_codes_help());
  return {command, kReviewAbout, [options] { return run_review(*options); }};
}

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb

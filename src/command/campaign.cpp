#include "campaign.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <filesystem>

#include "output.hpp"
#include "plumb/campaign/campaign_file.hpp"
#include "plumb/campaign/replay.hpp"
#include "plumb/campaign/result_file.hpp"
#include "plumb/core/units.hpp"
#include "plumb/geomagnetic/field_reference.hpp"
#include "plumb/io/output_file.hpp"
#include "plumb/io/printable.hpp"
#include "plumb/io/scenario_file.hpp"
#include "plumb/render/timeline.hpp"
#include "plumb/scenario/count_text.hpp"
#include "plumb/session/interrupt.hpp"
#include "usual_options.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace command {
namespace {

using campaign::CampaignFile;
using campaign::Count;
using Counted = campaign::Progress;  // `Progress` is the line on standard error
using campaign::Spec;
using Clock = std::chrono::steady_clock;

constexpr const char* kNotes =
    "Examples:\n"
    "  plumb campaign examples/guaranteed.toml --scenarios 10000\n"
    "  plumb campaign examples/guaranteed.toml --threads 2 --out result.json      # Ctrl-C, and go on with:\n"
    "  plumb campaign examples/guaranteed.toml --threads 2 --out result.json --resume\n"
    "  plumb campaign examples/guaranteed.toml --replay 4711\n\n"
    "Scenario number k is a function of the file, the seed and k alone. The result does not depend on threads,\n"
    "ranks or interruptions: the same bytes. --out is written whole every half minute and at the end, holds all that\n"
    "is known so far, and is what --resume goes on from.\n"
    "A scenario in which a healthy sensor is excluded, or in which the output misleads, is simplified as far as\n"
    "possible, saved as a scenario file beside the result (the first three of each kind), and printed with the "
    "command\n"
    "that runs it again (of magnetometers: printed as it was drawn, with its number). Ctrl-C ends the current batch "
    "and writes the result so far, exit code 1. Where the file's\n"
    "[expect] is not met, exit code 6. docs/campaign.md lists the keys of the file.\n\n";

constexpr int kCasesShown = 3;
constexpr std::uint64_t kBatchPerThread = 1U << 13U;

io::FileError usage_error(const std::string& option, const std::string& what, const std::string& remedy) {
  return io::FileError{option, 0, "", what, remedy, io::ExitCode::usage};
}

/// "2 h 05 min", "43 s".
std::string duration(double seconds) {
  const auto whole = static_cast<std::uint64_t>(std::max(seconds, 0.0));
  if (whole >= 3600) return fmt::format("{} h {:02} min", whole / 3600, whole % 3600 / 60);
  if (whole >= 60) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
  return fmt::format("{} s", whole);
}

/// Progress on standard error, and the result written every so often.
class Watch {
 public:
  Watch(const CampaignOptions& options, const CampaignFile& file, std::uint64_t before)
      : options_(options), file_(file), before_(before), on_terminal_(::isatty(STDERR_FILENO) != 0) {}
  ~Watch() {
    if (shown_) print_status("\r\033[K");
  }
  Watch(const Watch&) = delete;
  Watch& operator=(const Watch&) = delete;

  std::string see(const Counted& progress) {
    const Clock::time_point now = Clock::now();
    if (on_terminal_) show(progress, std::chrono::duration<double>(now - start_).count());
    const bool due = std::chrono::duration<double>(now - written_).count() >= options_.every_s;
    if (!due || options_.out.empty()) return "";
    written_ = now;
    const io::FileExpected<void> done = io::write_file(options_.out, campaign::result_text(file_, progress));
    return done ? "" : done.error().text();
  }

 private:
  void show(const Counted& progress, double elapsed_s) {
    const double rate = static_cast<double>(progress.done - before_) / std::max(elapsed_s, 1e-3);
    const double left_s = static_cast<double>(file_.plan.scenarios - progress.done) / std::max(rate, 1e-9);
    shown_ = true;
    print_status(fmt::format("\r{}: {} of {}, {:.0f}/s, {} left; wrong exclusions {}\033[K",
                             io::printable_line(file_.plan.name), progress.done,
                             count_text(file_.plan.scenarios, "scenario"), rate, duration(left_s),
                             progress.tally.total(Count::wrong_exclusion)));
  }

  const CampaignOptions& options_;
  const CampaignFile& file_;
  std::uint64_t before_;
  bool on_terminal_;
  bool shown_ = false;
  Clock::time_point start_ = Clock::now(), written_ = Clock::now();
};

/// The name of a case beside the result, or in the working directory.
std::string case_path(const CampaignOptions& options, std::uint64_t number) {
  const std::filesystem::path of(options.out.empty() ? std::filesystem::path(options.file).filename()
                                                     : std::filesystem::path(options.out));
  return (of.parent_path() / (of.stem().string() + "-case-" + std::to_string(number) + ".toml")).string();
}

/// Makes the first failing scenarios small, saves them and says how to play them again.
io::FileExpected<std::string> save_cases(const CampaignOptions& options, const CampaignFile& file, Count what,
                                         const campaign::FirstNumbers& numbers) {
  std::string told;
  if (numbers.front() == campaign::kNoNumber) return told;
  auto kernel = campaign::make_kernel(file.plan);
  if (!kernel) return tl::unexpected<io::FileError>(io::FileError{options.file, 0, "", kernel.error(), ""});
  for (int k = 0; k < kCasesShown; ++k) {
    const std::uint64_t number = numbers[static_cast<std::size_t>(k)];
    if (number == campaign::kNoNumber) break;
    if (file.plan.magnetic) {  // a scenario file has no way to say where the field points in the tool
      told += fmt::format("{} in scenario {}: {}\n  plumb campaign {} --replay {}\n", to_string(what), number,
                          campaign::sentence_of(file.plan, campaign::spec_of(file.plan, number)), options.file, number);
      continue;
    }
    const Spec small = campaign::shrunk(file.plan, **kernel, campaign::spec_of(file.plan, number), what);
    const std::string path = case_path(options, number);
    const io::FileExpected<void> written = io::write_file(path, campaign::case_text(file.plan, small));
    if (!written) return tl::unexpected<io::FileError>(written.error());
    told += fmt::format("{} in scenario {}: {}\n  plumb campaign {} --replay {}\n", to_string(what), number,
                        campaign::sentence_of(file.plan, small), options.file, path);
  }
  return told;
}

/// What became of one scenario, in a line.
std::string outcome_text(const CampaignFile& file, const campaign::Outcome& outcome) {
  const auto names = [](std::uint32_t bits) {
    std::string out;
    for (int i = 0; i < campaign::kMostSensors; ++i) {
      if ((bits >> i & 1U) != 0) out += (out.empty() ? "a" : " a") + std::to_string(i + 1);
    }
    return out.empty() ? std::string("none") : out;
  };
  std::string out = fmt::format("faulty: {}; excluded: {}; provisionally excluded: {}\n", names(outcome.faulty),
                                names(outcome.ever_excluded), names(outcome.ever_provisionally_excluded));
  for (const Count what :
       {Count::wrong_exclusion, Count::wrong_provisional_exclusion, Count::misleading, Count::beyond_protection}) {
    if (campaign::fails(file.plan, what, outcome)) out += fmt::format("{}: {}\n", to_string(what), words_of(what));
  }
  return out;
}

/// The scenario that a number or a scenario file names, and the tool that it is played with.
struct ToReplay {
  scenario::Scenario scenario;
  int tool = 0;
};
io::FileExpected<ToReplay> find_case(const CampaignOptions& options, const CampaignFile& file) {
  std::uint64_t number = 0;
  const char* end = options.replay.data() + options.replay.size();
  const auto [stopped, error] = std::from_chars(options.replay.data(), end, number);
  if (error == std::errc() && stopped == end) {
    const Spec spec = campaign::spec_of(file.plan, number);
    print(campaign::sentence_of(file.plan, spec) + "\n");
    return ToReplay{campaign::scenario_of(file.plan, spec), spec.tool};
  }
  const io::FileExpected<io::ScenarioFile> read = io::read_scenario(options.replay);
  if (!read) return tl::unexpected<io::FileError>(read.error());
  for (std::size_t tool = 0; tool < file.plan.tools.size(); ++tool) {
    if (file.plan.tools[tool].name == read->array.name) return ToReplay{read->scenario, static_cast<int>(tool)};
  }
  return tl::unexpected<io::FileError>(io::FileError{
      options.replay, 0, "array.name", "is \"" + read->array.name + "\", which is not a tool of this campaign",
      "give the campaign file that saved the case"});
}

io::ExitCode run_replay(const CampaignOptions& options, const CampaignFile& file) {
  const io::FileExpected<ToReplay> found = find_case(options, file);
  if (!found) return report(found.error());
  const Expected<SensorArray> array = found->scenario.tool.datasheet.array();
  if (!array) return report(io::from_error(array.error()));
  print(render::table_header());
  const auto outcome = campaign::replay(file.plan, found->tool, found->scenario, [&](const Verdict& verdict) {
    if (verdict.transition.sequence != 0) print(render::table_line(render::row_of(verdict, *array, io::kIdentity3)));
  });
  if (!outcome) return report(io::FileError{options.replay, 0, "", outcome.error(), ""});
  print(outcome_text(file, *outcome));
  return io::ExitCode::done;
}

Counted fresh(const CampaignFile& file) {
  Counted progress;
  progress.tally = campaign::Tally(file.plan);
  return progress;
}

/// Checks the place of the result, and reads what is there already.
io::FileExpected<Counted> starting_point(const CampaignOptions& options, const CampaignFile& file) {
  Counted progress = fresh(file);
  if (options.out == "-") {
    return tl::unexpected<io::FileError>(
        usage_error("--out", "is standard output, which cannot be rewritten as the campaign goes on",
                    "name a file, or use --json"));
  }
  std::error_code ignored;
  const bool exists = !options.out.empty() && std::filesystem::exists(options.out, ignored);
  if (options.resume && options.out.empty()) {
    return tl::unexpected<io::FileError>(
        usage_error("--resume", "needs the result file to continue", "add --out RESULT.json"));
  }
  if (options.resume && exists) return campaign::read_result(options.out, file);
  if (!exists) {
    if (options.out.empty()) return progress;
    // Whether it can be written shows now, and not after hours.
    const io::FileExpected<void> written = io::write_file(options.out, campaign::result_text(file, progress));
    if (!written) return tl::unexpected<io::FileError>(written.error());
    return progress;
  }
  return tl::unexpected<io::FileError>(usage_error("--out", "the result file exists already: " + options.out,
                                                   "continue it with --resume, or give another name"));
}

io::ExitCode finish(const CampaignOptions& options, const CampaignFile& file, const Counted& progress) {
  if (!options.out.empty()) {
    const io::FileExpected<void> written = io::write_file(options.out, campaign::result_text(file, progress));
    if (!written) return report(written.error());
  }
  print(options.json ? campaign::result_text(file, progress) : campaign::summary_text(file, progress));
  if (progress.done < file.plan.scenarios) {
    const std::string more = options.out.empty() ? "nothing is saved without --out" : "continue with --resume";
    print_error(fmt::format("plumb: interrupted after {} of {}; {}.\n", progress.done,
                            count_text(file.plan.scenarios, "scenario"), more));
    return io::ExitCode::other;
  }
  const campaign::Tally& tally = progress.tally;
  for (const Count what : {Count::wrong_exclusion, Count::misleading}) {
    const auto cases =
        save_cases(options, file, what, what == Count::misleading ? tally.first_misleading() : tally.first_wrong());
    if (!cases) return report(cases.error());
    if (options.json) {
      print_error(*cases);
    } else {
      print(*cases);
    }
  }
  const std::string broken = campaign::broken_expectations(file, progress);
  if (broken.empty()) return io::ExitCode::done;
  print_error("plumb: " + options.file + ": [expect] is not met: " + broken);
  return io::ExitCode::verification_failed;
}

}  // namespace

void add_campaign_options(const Options& command, CampaignOptions& options) {
  command.add_option("campaign", options.file, "the campaign file: which tools, which faults, how many scenarios")
      .required()
      .type_name("CAMPAIGN.toml");
  command.add_option("--out", options.out, "the result (JSON), updated while the campaign runs")
      .type_name("RESULT.json");
  command.add_flag("--resume", options.resume,
                   "continue from the result that --out names; start anew if there is none");
  command.add_option("--threads", options.threads, "number of threads; the result does not depend on it")
      .range(1, 1024)
      .type_name("N");
  command.add_option("--seed", options.seed, "use this seed instead of the seed in the campaign file")
      .check(seed_refusal)
      .type_name("N");
  command
      .add_option("--scenarios", options.scenarios,
                  "play this number of scenarios instead of the number in the campaign file")
      .check(seed_refusal)
      .type_name("N");
  command.add_option("--every", options.every_s, "seconds between two writes of the result; 30 by default")
      .range(0.0, 1e6)
      .type_name("S");
  command
      .add_option("--replay", options.replay, "run one scenario again, by its number or from a saved case, and show it")
      .type_name("NUMBER|CASE.toml");
  command.add_flag("--json", options.json, "print the result as JSON instead of a table");
  command.footer(kNotes + exit_codes_help());
}

io::ExitCode run_campaign(const CampaignOptions& options, campaign::Ranks& ranks) {
  const bool first = ranks.rank() == 0;
  const auto refuse = [first](const io::FileError& error) { return first ? command::report(error) : error.code; };
  io::FileExpected<CampaignFile> file = campaign::read_campaign(options.file, geomagnetic::lookup);
  if (!file) return refuse(file.error());
  if (options.seed) file->plan.seed = *options.seed;
  if (options.scenarios) file->plan.scenarios = *options.scenarios;
  if (file->plan.scenarios == 0) return refuse(usage_error("--scenarios", "is 0", "give at least 1"));
  if (!options.replay.empty()) return first ? run_replay(options, *file) : io::ExitCode::done;
  const std::vector<NamedFile> to_write = {{"--out", options.out}}, to_read = {{"CAMPAIGN", options.file}};
  if (const auto clash = overwritten(to_write, to_read)) return refuse(*clash);
  io::FileExpected<Counted> start = first ? starting_point(options, *file) : fresh(*file);
  if (ranks.any(!start)) return start ? io::ExitCode::other : refuse(start.error());
  // By now the first rank has seen to it that there is a result to go on from.
  if (!first && options.resume) start = campaign::read_result(options.out, *file);
  if (ranks.any(!start)) return start ? io::ExitCode::other : command::report(start.error());
  session::watch_interrupts();
  campaign::RunOptions how;
  how.threads = options.threads;
  how.batch = kBatchPerThread * static_cast<std::uint64_t>(options.threads) * static_cast<std::uint64_t>(ranks.size());
  {
    Watch watch(options, *file, start->done);
    const auto done = campaign::run(
        file->plan, how, ranks, *start, [] { return session::interrupted(); },
        [&watch](const Counted& progress) { return watch.see(progress); });
    if (!done) return refuse(io::FileError{options.file, 0, "", done.error(), "", io::ExitCode::other});
  }
  return first ? finish(options, *file, *start) : io::ExitCode::done;
}

}  // namespace command
}  // namespace PLUMB_ABI
}  // namespace plumb

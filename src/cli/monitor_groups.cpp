#include "monitor_groups.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <utility>

#include "monitor_wanted.hpp"
#include "monitor_watch.hpp"
#include "plumb/render/group_report.hpp"
#include "plumb/render/timeline.hpp"
#include "plumb/session/group_dip.hpp"
#include "plumb/session/rate_run.hpp"
#include "read_array.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {
namespace {

MonitorOptions options_of(const MonitorOptions& tool, const WantedGroup& group) {
  MonitorOptions out = tool;
  out.groups.clear();
  out.array = tool.array + "#" + group.name;
  out.calibration = group.calibration;
  out.calibrate_first = false;
  out.events = name_for_group(tool.events, group.name);
  out.verdicts = name_for_group(tool.verdicts, group.name);
  out.report = name_for_group(tool.report, group.name);
  out.incidents.directory = name_for_group(tool.incidents.directory, group.name);
  out.motion.clear();
  out.inclination.clear();
  out.host.clear();
  return out;
}

/// The worse of two ways to end.
io::ExitCode worse(io::ExitCode a, io::ExitCode b) {
  if (a == io::ExitCode::done) return b;
  if (b == io::ExitCode::monitor_failed) return b;
  return a;
}

/// One group beside the accelerometers: magnetometers with a monitor like theirs, or gyros.
struct Group {
  explicit Group(const WantedGroup& one) : wanted(one) {}
  const io::ArrayFile& array() const noexcept { return *wanted.array; }

  WantedGroup wanted;
  std::string label;
  std::unique_ptr<ArrayWatch> watch;
  session::GroupTrack track;
  std::unique_ptr<session::GroupDip> dip;  ///< of magnetometers whose dip is known
  std::unique_ptr<session::RateWatch> rate;
  std::optional<session::EventsFile> events, json;  ///< of gyros
  std::pair<SensorSet, int> shown;                  ///< what the table says of them: out of service, and what else
  session::RateRun run;
};

/// All groups of one tool over one pass of its log.
class ToolWatch {
 public:
  ToolWatch(const MonitorOptions& options, const io::ArrayFile& tool, const std::vector<WantedGroup>& groups);
  /// How the command ends, where it ends before the run.
  std::optional<io::ExitCode> begin();
  io::FileExpected<void> run();
  io::ExitCode say();

 private:
  io::FileExpected<void> make_rate(Group& group);
  io::FileExpected<void> open_rate(Group& group);
  io::FileExpected<void> open_dip(Group& group);
  io::FileExpected<void> put(const session::DipEvent& event, const Group& group);
  io::FileExpected<void> put(const session::RateEvent& event, Group& group);
  io::FileExpected<void> keep(std::vector<session::LogShare>& shares);
  io::Json summary() const;

  const MonitorOptions& options_;
  const std::string& rates_of_;  ///< the group that gives the accelerometers' rate in motion; empty: none
  std::size_t widest_;
  std::vector<std::unique_ptr<Group>> groups_;
  std::unique_ptr<ArrayWatch> gravity_;
  session::GroupTrack track_;
};

std::string column(const std::string& name, std::size_t widest) { return fmt::format("{:<{}}", name, widest + 2); }

ToolWatch::ToolWatch(const MonitorOptions& options, const io::ArrayFile& tool, const std::vector<WantedGroup>& groups)
    : options_(options),
      rates_of_(tool.motion.gyro.group),
      widest_(std::string(to_string(io::FieldKind::gravity)).size()) {
  for (const WantedGroup& one : groups) {
    groups_.push_back(std::make_unique<Group>(one));
    widest_ = std::max(widest_, one.name.size());
  }
}

std::optional<io::ExitCode> ToolWatch::begin() {
  MonitorOptions own = options_;
  own.label = column(to_string(io::FieldKind::gravity), widest_);
  const session::RateWatch* rates = nullptr;
  for (const std::unique_ptr<Group>& group : groups_) {
    group->label = column(group->wanted.name, widest_);
    if (group->array().field != io::FieldKind::rate) continue;
    if (io::FileExpected<void> made = make_rate(*group); !made) return report(made.error());
    if (group->wanted.name == rates_of_) rates = group->rate.get();
  }
  auto gravity = ArrayWatch::begin(own, rates != nullptr ? &rates->group() : nullptr);
  if (!gravity) return gravity.error();
  gravity_ = *std::move(gravity);
  gravity_->add_first(track_);
  if (rates != nullptr) gravity_->take_rates_of(*rates);
  for (const std::unique_ptr<Group>& group : groups_) {
    io::FileExpected<void> opened;
    if (group->rate) {
      opened = open_rate(*group);
    } else {
      MonitorOptions options = options_of(own, group->wanted);
      options.label = group->label;
      auto watch = ArrayWatch::begin(options);
      if (!watch) return watch.error();
      group->watch = *std::move(watch);
      if (group->array().magnetic.dip_known) opened = open_dip(*group);
    }
    if (!opened) return report(opened.error());
    if (options_.json) print_now(render::group_heading_json(group->array()));
  }
  if (gravity_->outputs().table) {
    const std::string header = render::table_header(), indent = column("", widest_);
    const std::size_t second = header.find('\n') + 1;
    print_now(column("group", widest_) + header.substr(0, second) + indent + header.substr(second));
  }
  return std::nullopt;
}

io::FileExpected<void> ToolWatch::make_rate(Group& group) {
  io::FileExpected<std::unique_ptr<session::RateWatch>> made =
      session::RateWatch::make(group.array(), true, group.wanted.gyros ? &*group.wanted.gyros : nullptr);
  if (!made) return tl::unexpected<io::FileError>(made.error());
  group.rate = *std::move(made);
  print_error(render::rate_bounds_note(group.array(), group.rate->group().calibrated));
  return {};
}

io::FileExpected<void> ToolWatch::open_rate(Group& group) {
  track_.tell(*group.rate);
  group.rate->tell([this, &group](const session::RateEvent& event) { return put(event, group); });
  const bool live = options_.log.path == "-" || options_.log.follow;
  const std::pair<std::optional<session::EventsFile>*, std::string> files[] = {
      {&group.events, name_for_group(options_.events, group.wanted.name)}, {&group.json, options_.json ? "-" : ""}};
  for (const auto& [out, path] : files) {
    if (path.empty()) continue;
    io::FileExpected<io::OutputFile> file = io::OutputFile::create(path, io::OutputFile::Mode::stream);
    if (!file) return tl::unexpected<io::FileError>(file.error());
    out->emplace(*std::move(file), group.array().array, live || path == "-", path == "-" ? group.wanted.name : "");
  }
  return {};
}

/// The dip of a tool whose accelerometers follow the paper's algorithm is compared, and is no reference of three.
io::FileExpected<void> ToolWatch::open_dip(Group& group) {
  group.dip = std::make_unique<session::GroupDip>(gravity_->array(), group.array());
  if (gravity_->monitor() != nullptr) {
    io::FileExpected<std::unique_ptr<MonitorSetup>> setup = gravity_->setup();
    if (!setup) return tl::unexpected<io::FileError>(setup.error());
    group.dip->judge(*gravity_->monitor(), *std::move(setup));
  }
  group.watch->add_first(group.track);
  group.track.tell(group.dip->field());
  track_.tell(group.dip->gravity());
  group.dip->tell([this, &group](const session::DipEvent& event) { return put(event, group); });
  if (gravity_->outputs().verdicts) gravity_->outputs().verdicts->add(*group.dip);
  return {};
}

io::FileExpected<void> ToolWatch::put(const session::DipEvent& event, const Group& group) {
  Outputs& out = gravity_->outputs();
  io::FileExpected<void> done;
  for (std::optional<session::EventsFile>* const file : {&out.events, &out.json}) {
    std::string line = session::dip_event_json(event, group.array(), gravity_->sensors());
    if (*file && done) done = (*file)->put(line);
  }
  if (out.table) print_now(group.label + render::dip_line(event, group.array(), gravity_->sensors()));
  return done;
}

io::FileExpected<void> ToolWatch::put(const session::RateEvent& event, Group& group) {
  io::FileExpected<void> done;
  for (std::optional<session::EventsFile>* const file : {&group.events, &group.json}) {
    std::string line = session::rate_event_json(event, group.array().array);
    if (*file && done) done = (*file)->put(line);
  }
  const std::pair<SensorSet, int> now(event.excluded | event.off_at_rest,
                                      (event.turned_at_rest ? 1 : 0) + (event.alarm ? 2 : 0));
  if (gravity_->outputs().table && std::exchange(group.shown, now) != now)
    print_now(group.label + render::rate_line(event, group.array().array));
  return done;
}

io::FileExpected<void> ToolWatch::run() {
  // Within a row the accelerometers come last: the field of the block that ends there is known then, and the gyros
  // wait for what they say of rest. The rates that correct the accelerometers in motion are known there too.
  std::vector<session::LogShare> shares;
  for (const std::unique_ptr<Group>& group : groups_)
    shares.push_back(group->rate ? session::LogShare{&group->array(), group->rate.get(), {}} : group->watch->share());
  shares.push_back(gravity_->share());
  const io::FileExpected<void> done = session::run_log(gravity_->log(), shares);
  return done ? keep(shares) : done;
}

/// The report of the tool last: it begins with what the others say.
io::FileExpected<void> ToolWatch::keep(std::vector<session::LogShare>& shares) {
  std::string doubts;
  io::FileExpected<void> kept;
  for (std::size_t k = 0; k < groups_.size() && kept; ++k) {
    Group& group = *groups_[k];
    if (group.rate) {
      io::FileExpected<session::RateRun> ended = group.rate->end(std::move(shares[k].end));
      if (!ended) return tl::unexpected<io::FileError>(ended.error());
      group.run = *std::move(ended);
      if (group.events) kept = group.events->commit();
      continue;
    }
    const std::string doubt = group.dip ? group.dip->doubt() : "";
    if (!doubt.empty()) doubts += (doubts.empty() ? "" : "; ") + doubt;
    if (group.watch->outputs().report && group.dip && group.dip->check().disagreeing > 0)
      group.watch->outputs().report->doubt(doubt);
    kept = group.watch->keep(std::move(shares[k].end));
  }
  if (HealthReport* const report = gravity_->outputs().report.get(); report != nullptr) {
    report->doubt(doubts);
    report->begin_with(summary());
  }
  return kept ? gravity_->keep(std::move(shares.back().end)) : kept;
}

/// One object a group, for the report of the tool; the accelerometers are its own.
io::Json ToolWatch::summary() const {
  io::Json out = io::Json::array();
  for (const std::unique_ptr<Group>& group : groups_) {
    const io::ArrayFile& array = group->array();
    io::Json one = io::object({{"name", array.group},
                               {"field", to_string(array.field)},
                               {"sensors", io::ids_of(array.array.all(), array.array)}});
    if (group->rate) {
      one["trusted"] = render::rate_is_trusted(group->run);
      one["use"] = render::rate_sentence(group->run, array);
      one["excluded"] = io::ids_of(group->run.last.excluded | group->run.last.off_at_rest, array.array);
      one["page"] = io::Json();
      one["dip"] = io::Json();
    } else {
      const verification::ToolHealth& health = group->watch->outputs().report->health();
      one["trusted"] = health.use() == verification::SurveyUse::yes;
      one["use"] = health.sentence();
      one["excluded"] = io::ids_of(health.last().excluded, group->watch->sensors());
      one["page"] = std::filesystem::path(name_for_group(options_.report, array.group)).filename().string();
      one["dip"] = render::dip_sentence(group->dip.get(), gravity_->sensors());
    }
    out.push_back(std::move(one));
  }
  return out;
}

io::ExitCode ToolWatch::say() {
  io::ExitCode worst = gravity_->say();
  const bool table = gravity_->outputs().table.has_value();
  for (const std::unique_ptr<Group>& group : groups_) {
    const io::ArrayFile& array = group->array();
    if (table) print_now(render::group_heading(array));
    if (group->rate) {
      if (table || options_.json)
        print_now(options_.json ? render::rate_run_json(group->run, array) : render::rate_run_text(group->run, array));
      if (group->run.stopped) print_error("plumb: the log ended in an error; what came before counts.\n");
      worst = worse(worst, group->run.stopped       ? report(group->run.stop)
                           : group->run.interrupted ? io::ExitCode::other
                                                    : io::ExitCode::done);
      continue;
    }
    worst = worse(worst, group->watch->say());
    const io::Json dip = io::object({{"dip", render::dip_json(group->dip.get(), array, gravity_->sensors())}});
    print_now(options_.json ? dip.dump() + "\n" : render::dip_text(group->dip.get(), gravity_->sensors()));
    if (group->dip && !group->dip->doubt().empty()) worst = worse(worst, io::ExitCode::verification_failed);
  }
  return worst;
}

}  // namespace

std::string name_for_group(const std::string& path, const std::string& group) {
  if (path.empty() || path == "-") return path;
  const std::filesystem::path whole(path);
  const std::string name = whole.stem().string() + "-" + group + whole.extension().string();
  return (whole.parent_path() / name).string();
}

io::ExitCode monitor_tool(const MonitorOptions& options) {
  const io::FileExpected<io::ArrayFile> tool = read_array(options.array, "plumb monitor", Serves::lengths);
  if (!tool) return report(tool.error());
  if (const std::optional<io::FileError> wrong = groups_misuse(options)) return report(*wrong);
  const io::FileExpected<std::vector<WantedGroup>> groups = wanted_groups(options, *tool);
  if (!groups) return report(groups.error());
  if (const std::optional<io::FileError> clash = groups_clash(options, *groups)) return report(*clash);
  ToolWatch watch(options, *tool, *groups);
  if (const std::optional<io::ExitCode> ended = watch.begin()) return *ended;
  const io::FileExpected<void> done = watch.run();
  return done ? watch.say() : report(done.error());
}

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb

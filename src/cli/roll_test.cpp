#include "roll_test.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "plumb/core/units.hpp"
#include "plumb/io/records.hpp"
#include "plumb/report/words.hpp"
#include "tool.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {
namespace {

/// Counts the attitudes at which the tool was at rest.
class Attitudes : public VerdictSink {
 public:
  explicit Attitudes(double apart_rad) : apart_rad_(apart_rad) {}
  io::FileExpected<void> take(const Sample&, const Verdict& verdict) override {
    const bool at_rest = verdict.tick && (verdict.usable & Usable::stationary) != 0;
    if (at_rest && is_new(verdict.gravity_mps2)) seen_.push_back(verdict.gravity_mps2);
    return {};
  }
  stepping::Wanted wanted() const override { return stepping::Wanted::blocks; }
  int count() const { return static_cast<int>(seen_.size()); }

 private:
  bool is_new(const Vec3& direction) const {
    return norm(direction) > 0.0 && std::none_of(seen_.begin(), seen_.end(), [&](const Vec3& before) {
             return angle_between_rad(before, direction) < apart_rad_;
           });
  }

  std::vector<Vec3> seen_;
  double apart_rad_;
};

bool is_validated(const Verdict& v) { return (v.qualifiers & Qualifier::unproven) == 0; }
bool in_doubt(const Verdict& v) { return v.state == HealthState::suspect && (is_validated(v) || !v.suspects.empty()); }

/// The sensor along whose axis gravity has to change; -1 where the turn is about no single sensor.
int sensor_along(const Vec3& along, const SensorArray& array) {
  constexpr double kRounding = 1e-9;
  for (int i = 0; i < array.size(); ++i) {
    if (norm(minus(array.axis(i), along)) < kRounding) return i;
  }
  return -1;
}

/// The monitor's own request, in words.
std::string turn_text(const RotationRequest& turn, const SensorArray& array, const Mat3& frame) {
  if (!(turn.change_mps2 > 0.0)) return fmt::format("a turn by {:.0f} deg or more", deg_from_rad(turn.angle_rad));
  const Vec3 along = io::in_frame(frame, turn.along);
  const int sensor = sensor_along(turn.along, array);
  const std::string whose = sensor < 0 ? "" : fmt::format(", the axis of {}", array.row(sensor).id.data());
  return fmt::format("a turn that changes gravity by {:.2f} m/s^2 along ({:.3f}, {:.3f}, {:.3f}){}", turn.change_mps2,
                     along[0], along[1], along[2], whose);
}

std::string missing_text(const RollTest& test, const HealthMonitor& monitor, const Mat3& frame) {
  const Verdict& v = test.run.last;
  const MonitorConfig& config = monitor.config();
  if (test.run.blocks == 0)
    return fmt::format("no block was at rest: hold the tool still for {} rows or more at a time", config.window);
  if (v.wants_rotation && v.rotation.change_mps2 > 0.0)
    return "still missing is " + turn_text(v.rotation, monitor.array(), frame);
  return fmt::format("still missing are {} blocks at rest in a row in which all sensors agree", config.clean_blocks);
}

/// "a3 excluded, a5 absent": whoever does not serve in the run.
std::string out_of_service_text(const Verdict& v, const SensorArray& array) {
  const std::pair<SensorSet, const char*> sets[] = {
      {v.excluded, "excluded"}, {v.set_aside, "provisionally excluded"}, {v.absent, "absent"}};
  std::string out;
  for (const auto& [set, word] : sets) {
    if (!set.empty()) out += fmt::format("{} {}; ", report::sensor_names(set, array), word);
  }
  return out;
}

std::string doubt_text(const Verdict& v, const SensorArray& array, const Mat3& frame) {
  std::string out = fmt::format("ended in doubt ({}: {})", to_string(v.cause), report::explain(v.cause));
  if (!v.suspects.empty()) out += fmt::format(", suspected are {}", report::sensor_names(v.suspects, array));
  if (v.wants_rotation && v.rotation.wanted) out += "; what would help is " + turn_text(v.rotation, array, frame);
  return out;
}

}  // namespace

std::optional<io::FileError> roll_test_misuse(const MonitorOptions& options, const io::ArrayFile& array) {
  if (options.roll_test.empty()) return std::nullopt;
  const auto refused = [](const std::string& what, const std::string& remedy) {
    return io::FileError{"--roll-test", 0, "", what, remedy, io::ExitCode::usage};
  };
  if (options.roll_test == "-") return refused("is read to its end before the log: a file, not a pipe", "name a file");
  if (!options.snapshot_in.empty())
    return refused("and --snapshot-in are two pasts of one run", "leave one of them out");
  if (options.calibrate_first)
    return refused("validates a tool that is calibrated, and --calibrate-first says that this one is not",
                   "name a calibration with --calibration, or leave --roll-test out");
  if (options.limits) return refused("has no use with --limits, which reads no log", "leave one of them out");
  if (array.monitor.mode == MonitorMode::paper)
    return refused("validates plumb's monitor, and the paper's algorithm has no validation",
                   "leave the option out, or set mode = \"plumb\" in " + array.path);
  return std::nullopt;
}

io::FileExpected<RollTest> play_roll_test(HealthMonitor& monitor, const io::ArrayFile& array,
                                          const MonitorOptions& options) {
  watch_interrupts();
  Attitudes attitudes(monitor.config().excitation_angle_rad);
  scenario::Host nobody;
  const LogSpec log{options.roll_test, options.log.on_bad_row};
  io::FileExpected<MonitorRun> run = run_monitor(monitor, array, log, {&attitudes}, nobody);
  if (!run) return tl::unexpected<io::FileError>(run.error());
  if (run->stopped) {
    io::FileError error = run->stop;
    error.remedy += " (the roll test of --roll-test; the log was not read)";
    return tl::unexpected<io::FileError>(std::move(error));
  }
  monitor.begin_time_base();
  return RollTest{*std::move(run), attitudes.count()};
}

std::string roll_test_text(const RollTest& test, const std::string& path, const HealthMonitor& monitor,
                           const Mat3& frame) {
  const Verdict& v = test.run.last;
  const SensorArray& array = monitor.array();
  std::string out =
      fmt::format("plumb: roll test {}: {} samples, {} attitudes at rest", path, test.run.samples, test.attitudes);
  if (test.run.log.rows_bad > 0) out += fmt::format(", {} bad rows skipped", test.run.log.rows_bad);
  out += "; ";
  if (v.state == HealthState::failed) {
    const bool timed_out = (v.qualifiers & Qualifier::exhausted) != 0;
    const std::string why = timed_out ? report::explain(Cause::patience) : "too few sensors are left";
    return out +
           fmt::format("ended in failed, because {}: no output of the run is valid until a reset (--host)\n", why);
  }
  out += out_of_service_text(v, array);
  if (in_doubt(v)) out += doubt_text(v, array, frame) + "; ";
  out += is_validated(v) ? fmt::format("validated: {}", report::sensor_names(v.in_service, array))
                         : "not validated: " + missing_text(test, monitor, frame);
  return out + fmt::format("; the run begins in {}\n", to_string(v.state));
}

io::Json roll_test_json(const RollTest& test, const HealthMonitor& monitor, const Mat3& frame) {
  return io::object({{"samples", test.run.samples},
                     {"rows_bad", test.run.log.rows_bad},
                     {"blocks", test.run.blocks},
                     {"attitudes", test.attitudes},
                     {"validated", is_validated(test.run.last)},
                     {"last_verdict", io::parsed(io::verdict_json(test.run.last, monitor.array(), frame))}});
}

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb

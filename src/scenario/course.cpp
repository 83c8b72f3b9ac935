#include "plumb/scenario/course.hpp"

#include <algorithm>
#include <memory>
#include <utility>

namespace plumb {
inline namespace PLUMB_ABI {
namespace scenario {
namespace {

tl::unexpected<std::string> refuse(std::string why) { return tl::unexpected<std::string>(std::move(why)); }

/// The monitor takes levels in acceleration as the datasheet has them.
FaultContext context_of(const Datasheet& datasheet) {
  FaultContext context;
  context.datasheet = datasheet;
  return context;
}

std::string names(const Datasheet& datasheet, SensorSet set) {
  std::string text;
  for (int i = 0; i < datasheet.size; ++i) {
    if (set.has(i)) text += (text.empty() ? "" : ",") + std::to_string(i + 1);
  }
  return text.empty() ? "none" : text;
}

/// Sensors that the scenario ever makes faulty; those that merely fall silent are not lost to validation.
SensorSet liars(const Scenario& scenario) {
  SensorSet set;
  for (const Fault& fault : scenario.faults) {
    if (fault.sensor == kWholeLog) continue;
    set = set.with(fault.sensor);
    if (fault.kind == FaultKind::exchange) set = set.with(static_cast<int>(fault.magnitude));
  }
  return set;
}

}  // namespace

tl::expected<Course, std::string> make_course(const Datasheet& datasheet, std::uint64_t seed,
                                              const MonitorConfig& config) {
  Course course;
  const Expected<SensorArray> array = datasheet.array();
  if (!array) return refuse(std::string("the array is refused: ") + describe(array.error().code));
  MonitorSetup& setup = course.setup;
  setup.array = *array;
  setup.model = datasheet.model();
  setup.gravity = {kG0_mps2, 1e-4 * kG0_mps2, GravityModel::value};
  setup.config = config;
  for (std::size_t i = 0; i < static_cast<std::size_t>(datasheet.size); ++i) {
    setup.full_scale_raw[i] = datasheet.sensor[i].full_scale_raw;
  }
  Scenario& scenario = course.scenario;
  scenario.tool = perfect_tool(datasheet);
  scenario.attitudes = RandomStations{kCourseStations};
  scenario.rate_hz = kCourseRate_hz;
  scenario.dwell_s = kCourseBlocks * config.window / kCourseRate_hz;
  scenario.move_s = 1.0;
  scenario.record_motion = false;
  scenario.seed = seed;
  return course;
}

tl::expected<Course, std::string> make_course(const CatalogueEntry& entry, int sensor, const Datasheet& datasheet,
                                              std::uint64_t seed) {
  MonitorConfig config;
  config.temperature_min_degc = 0.0;
  config.temperature_max_degc = 50.0;
  auto course = make_course(datasheet, seed, config);
  if (!course) return course;
  CatalogueOptions options;
  options.sensor = sensor;
  options.clock = Clock::station;
  options.onset = entry.from_power_on ? 1 : kCourseOnset;
  auto faults = faults_of(entry, options, context_of(datasheet));
  if (!faults) return refuse(faults.error());
  course->scenario.faults = std::move(*faults);
  return course;
}

tl::expected<CourseResult, std::string> run(const Course& course) {
  auto simulator = Simulator::make(course.scenario);
  if (!simulator) return refuse(simulator.error());
  const auto monitor = std::make_unique<HealthMonitor>();
  const Expected<void> configured = monitor->configure(course.setup);
  if (!configured) return refuse(std::string("the monitor refuses the set-up: ") + describe(configured.error().code));
  CourseResult result;
  result.faulty = liars(course.scenario);
  Sample sample;
  std::uint64_t since_onset = 0;
  while (simulator->next(sample)) {
    const Verdict& verdict = monitor->step(sample);
    const Truth& truth = simulator->truth();
    const bool valid = verdict.validity == Validity::valid || verdict.validity == Validity::degraded;
    if (truth.station < static_cast<std::uint32_t>(kCourseOnset)) {
      result.trusted = verdict.validity == Validity::valid || verdict.validity == Validity::degraded;
    } else {
      // The vector of a station that the tool has left is held until the first block of the new one: that is no doubt.
      const bool between = verdict.validity == Validity::held && (verdict.qualifiers & Qualifier::moving) == 0;
      const bool whole = verdict.in_service == verdict.configured && verdict.state != HealthState::suspect;
      const bool plain = (verdict.validity == Validity::valid || between) && whole;
      if (!plain && result.first_doubt_block < 0) {
        result.first_doubt_block =
            static_cast<int>(since_onset / static_cast<std::uint64_t>(course.setup.config.window));
      }
      ++since_onset;
    }
    if (verdict.tick && valid) {
      const double error = angle_between_rad(verdict.gravity_mps2, truth.gravity_mps2);
      result.worst_tilt_rad = std::max(result.worst_tilt_rad, error);
    }
    for (int i = 0; i < course.setup.array.size(); ++i) {
      const Cause cause = verdict.sensor_cause[static_cast<std::size_t>(i)];
      const bool lost = cause == Cause::channel_lost || cause == Cause::channel_back;
      if ((verdict.excluded | verdict.provisionally_excluded).has(i) && !lost) result.out = result.out.with(i);
    }
    result.excluded = verdict.excluded | verdict.provisionally_excluded;
    result.state = verdict.state;
  }
  result.refused = monitor->counters().time_refused;
  return result;
}

std::string judge(const CourseResult& result, const Outcome& outcome) {
  Datasheet all;
  all.size = kCapacity;
  const auto said = [&](const std::string& what) { return what + "; "; };
  std::string wrong;
  const int first = result.first_doubt_block;
  if (first >= 0 && first < outcome.earliest_block)
    wrong += said("detected too early, in block " + std::to_string(first));
  if (outcome.latest_block > 0 && (first < 0 || first > outcome.latest_block)) {
    wrong += said(first < 0 ? std::string("not detected") : "detected in block " + std::to_string(first) + " only");
  }
  if ((outcome.states & state_bit(result.state)) == 0) wrong += said(std::string("ends ") + to_string(result.state));
  const SensorSet allowed = outcome.mask == AllowedMask::nobody ? SensorSet() : result.faulty;
  if (!allowed.contains(result.out))
    wrong += said("excluded or provisionally excluded " + names(all, result.out) + ", allowed " + names(all, allowed));
  if (outcome.mask == AllowedMask::the_faulty && result.excluded != result.faulty) {
    wrong += said("excluded at the end " + names(all, result.excluded) + ", faulty " + names(all, result.faulty));
  }
  if (!(result.worst_tilt_rad <= outcome.tilt_bound_rad)) {
    wrong += said("tilt wrong by " + std::to_string(deg_from_rad(result.worst_tilt_rad)) + " deg while valid");
  }
  return wrong;
}

}  // namespace scenario
}  // namespace PLUMB_ABI
}  // namespace plumb

/// The course: one standard run over which faults are judged. A tool whose calibration is exact stands at station after
/// station, is validated by the monitor, and then something happens.
#pragma once

#include <cstdint>
#include <string>
#include <tl/expected.hpp>

#include "plumb/core/config.hpp"
#include "plumb/health/health_monitor.hpp"
#include "plumb/scenario/catalogue.hpp"
#include "plumb/scenario/scenario.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace scenario {

inline constexpr int kCourseStations = 28;
inline constexpr int kCourseOnset = 8;   ///< station at which the fault begins
inline constexpr int kCourseBlocks = 4;  ///< blocks per station
inline constexpr double kCourseRate_hz = 100.0;

struct Course {
  Scenario scenario;
  MonitorSetup setup;
};

/// Random attitudes with motion that is not recorded; the monitor knows the datasheet's axes, scales and biases exactly
/// and gravity within 0.1 mg0. Error: an array that the monitor refuses.
tl::expected<Course, std::string> make_course(const Datasheet& datasheet, std::uint64_t seed,
                                              const MonitorConfig& config = {});

/// The course with an entry's faults, the named sensor being number `sensor`.
tl::expected<Course, std::string> make_course(const CatalogueEntry& entry, int sensor, const Datasheet& datasheet,
                                              std::uint64_t seed);

struct CourseResult {
  bool trusted = false;  ///< nominal, or degraded with three sensors, before the onset
  int first_doubt_block =
      -1;  ///< blocks of samples from the onset until the output was no longer plainly valid; -1 never
  HealthState state = HealthState::suspect;  ///< at the end
  SensorSet out;                             ///< ever excluded for cause, or provisionally excluded
  SensorSet excluded;                        ///< at the end, for cause or lost
  SensorSet faulty;                          ///< ever in fault
  double worst_tilt_rad = 0.0;               ///< error of the vector while published as valid or degraded
  std::uint32_t refused = 0;                 ///< samples with a time that did not increase
};

/// Errors: those of `Simulator::make` and `HealthMonitor::configure`.
tl::expected<CourseResult, std::string> run(const Course& course);

/// Empty where the result is what the entry expects, else what is not.
std::string judge(const CourseResult& result, const Outcome& outcome);

}  // namespace scenario
}  // namespace PLUMB_ABI
}  // namespace plumb

/// What a monitored run looked like: rows (one per change), points (one per block at rest), phases (stretches in which
/// nothing that a lane of the picture shows has changed).
#pragma once

#include <string>
#include <vector>

#include "plumb/core/vec3.hpp"
#include "plumb/health/verdict.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {

/// One change of state or of the sets of sensors, ready to be shown.
struct TimelineRow {
  double time_s = 0.0;
  HealthState from = HealthState::suspect;
  HealthState state = HealthState::suspect;
  HealthEvent event = HealthEvent::none;
  Grade grade = Grade::none;  ///< of an exclusion
  Validity validity = Validity::invalid;
  Cause cause = Cause::none;
  SensorSet named;          ///< sensors that the event names
  std::string sensors;      ///< their ids that the event names, or "-"
  std::string explanation;  ///< plain words
  double statistic = 0.0;   ///< of the block that decided; limit 0 = no test took part
  double limit = 0.0;
  bool has_inclination = false;
  double inclination_deg = 0.0;
  double inclination_sigma_deg = 0.0;  ///< of noise and calibration; 0 = not known
};

/// The row of power-on, before the first sample has been judged.
TimelineRow power_on_row(double time_s, HealthState state);
/// The row with which a monitor begins that goes on from `past` ("the snapshot"); `verdict` is what it says before its
/// next sample.
TimelineRow restored_row(double time_s, const Verdict& verdict, const Mat3& frame, const std::string& past);
/// The row of a verdict that carries a transition.
TimelineRow row_of(const Verdict& verdict, const SensorArray& array, const Mat3& frame);

/// Inclination of a vector in the output frame; false where there is none.
bool inclination_of(const Vec3& gravity_mps2, const Mat3& frame, double& inclination_deg);

/// Its standard deviation in deg by the covariance of the vector; 0 where there is none.
double inclination_sigma_of(const Verdict& verdict, const Mat3& frame);

/// Text table for terminals: the header, then one line a row.
std::string table_header();
std::string table_line(const TimelineRow& row);

/// One block at rest. NaN = not known.
struct TimelinePoint {
  double time_s = 0.0;
  HealthState state = HealthState::suspect;
  Validity validity = Validity::invalid;
  Cause cause = Cause::none;
  SensorSet in_service, provisionally_excluded, excluded, absent;
  double statistic = 0.0;
  double limit = 0.0;
  double inclination_true_deg = 0.0;
  double inclination_plumb_deg = 0.0;
  double inclination_plain_deg = 0.0;  ///< least squares over all sensors, without a monitor
  double norm_error_plumb_mps2 = 0.0;  ///< |g| - G
  double norm_error_plain_mps2 = 0.0;
  double protection_level_deg = 0.0;
};

/// From its time up to that of the next one.
struct TimelinePhase {
  double from_s = 0.0;
  HealthState state = HealthState::suspect;
  Validity validity = Validity::invalid;
  Cause cause = Cause::none;
  bool moving = false;
  SensorSet in_service, provisionally_excluded, excluded, absent;
  SensorSet faulty;  ///< what is really in fault, which the monitor does not know
};

/// Something that the run is known to hold, to be marked in the plot ("a2 stuck").
struct TimelineMark {
  double time_s = 0.0;
  std::string text;
};

struct Timeline {
  std::vector<std::string> sensors;  ///< ids
  std::vector<TimelineRow> rows;
  std::vector<TimelinePhase> phases;
  std::vector<TimelineMark> marks;  ///< in order of time
  std::vector<TimelinePoint> points;
  double begin_s = 0.0;
  double end_s = 0.0;
};

/// The points as CSV, the header row included.
std::string timeline_csv(const Timeline& timeline);

/// Where the points stand in that CSV, for programs that draw it: the first column is 1.
int timeline_column(const char* name);

/// Largest inclination errors over the points of one validity.
struct ErrorSummary {
  int points = 0;
  double worst_plumb_deg = 0.0;
  double worst_plain_deg = 0.0;
};
ErrorSummary errors_where(const Timeline& timeline, Validity validity);

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb

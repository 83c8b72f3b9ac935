/// What a monitored run looked like: rows (one per change) and points (one per quiet block).
#pragma once

#include <string>
#include <vector>

#include "plumb/core/vec3.hpp"
#include "plumb/health/verdict.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace report {

/// One change of state or of the sets of sensors, ready to be shown.
struct TimelineRow {
  double time_s = 0.0;
  HealthState state = HealthState::suspect;
  Validity validity = Validity::invalid;
  Cause cause = Cause::none;
  std::string sensors;      ///< ids that the event names, or "-"
  std::string explanation;  ///< plain words
  double statistic = 0.0;   ///< of the block that decided; limit 0 = no test took part
  double limit = 0.0;
  bool has_inclination = false;
  double inclination_deg = 0.0;
};

/// The row of power-on, before the first sample has been judged.
TimelineRow power_on_row(double time_s, HealthState state);
/// The row of a verdict that carries a transition.
TimelineRow row_of(const Verdict& verdict, const SensorArray& array, const Mat3& frame);

/// Inclination of a vector in the output frame; false where there is none.
bool inclination_of(const Vec3& gravity_mps2, const Mat3& frame, double& inclination_deg);

/// Text table for terminals: the header, then one line a row.
std::string table_header();
std::string table_line(const TimelineRow& row);

/// One quiet block. Angles in deg; NaN = not known.
struct TimelinePoint {
  double time_s = 0.0;
  HealthState state = HealthState::suspect;
  Validity validity = Validity::invalid;
  Cause cause = Cause::none;
  int sensors_in_service = 0;
  double statistic = 0.0;
  double limit = 0.0;
  double inclination_true_deg = 0.0;
  double inclination_plumb_deg = 0.0;
  double inclination_plain_deg = 0.0;  ///< least squares over all sensors, nobody watched
  double protection_level_deg = 0.0;
};

/// Something that the run is known to hold, to be marked in the plot ("a2 dies").
struct TimelineMark {
  double time_s = 0.0;
  std::string text;
};

struct Timeline {
  std::vector<TimelineRow> rows;
  std::vector<TimelineMark> marks;
  std::vector<TimelinePoint> points;
  double begin_s = 0.0;
  double end_s = 0.0;
};

/// The points as CSV, the header row included.
std::string timeline_csv(const Timeline& timeline);

/// Largest inclination errors over the points of one validity.
struct ErrorSummary {
  int points = 0;
  double worst_plumb_deg = 0.0;
  double worst_plain_deg = 0.0;
};
ErrorSummary errors_where(const Timeline& timeline, Validity validity);

}  // namespace report
}  // namespace PLUMB_ABI
}  // namespace plumb

#include "plumb/render/timeline.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "plumb/core/units.hpp"
#include "plumb/io/records.hpp"
#include "plumb/io/units.hpp"
#include "plumb/navigation/tilt.hpp"
#include "plumb/render/measured_words.hpp"
#include "plumb/render/words.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {
namespace {

std::string figure_or_dash(double value, bool known) { return known ? fmt::format("{:.4g}", value) : "-"; }

/// A cell that is empty where the value is not known: CSV readers and gnuplot take it as missing.
void add_cell(std::string& out, double value) {
  out += ',';
  if (std::isfinite(value)) io::append_shortest(out, value);
}

constexpr double kMilliG0_mps2 = 1e-3 * kG0_mps2;

constexpr std::array kColumns = {"t_s",
                                 "state",
                                 "output",
                                 "cause",
                                 "in_service",
                                 "provisionally_excluded",
                                 "excluded",
                                 "absent",
                                 "statistic",
                                 "limit",
                                 "statistic_over_limit",
                                 "inclination_true_deg",
                                 "inclination_plumb_deg",
                                 "inclination_plain_deg",
                                 "error_plumb_deg",
                                 "error_plain_deg",
                                 "g_error_plumb_mg0",
                                 "g_error_plain_mg0",
                                 "protection_level_deg"};

/// "a1 a3": no comma, so that it is one cell.
std::string ids(SensorSet set, const Timeline& timeline) {
  std::string out;
  for (std::size_t i = 0; i < timeline.sensors.size(); ++i) {
    if (set.has(static_cast<int>(i))) out += (out.empty() ? "" : " ") + timeline.sensors[i];
  }
  return out;
}

}  // namespace

bool inclination_of(const Vec3& gravity_mps2, const Mat3& frame, double& inclination_deg) {
  const Tilt tilt = tilt_of(io::in_frame(frame, gravity_mps2), Mat3{});
  if (tilt.inclination_valid) inclination_deg = deg_from_rad(tilt.inclination_rad);
  return tilt.inclination_valid;
}

double inclination_sigma_of(const Verdict& verdict, const Mat3& frame) {
  const Tilt tilt =
      tilt_of(io::in_frame(frame, verdict.gravity_mps2), io::covariance_in_frame(frame, verdict.covariance));
  return tilt.inclination_valid ? deg_from_rad(tilt.inclination_sigma_rad) : 0.0;
}

TimelineRow power_on_row(double time_s, HealthState state) {
  TimelineRow row;
  row.time_s = time_s;
  row.state = state;
  row.cause = Cause::power_on;
  row.sensors = "-";
  row.explanation = explain(Cause::power_on);
  return row;
}

TimelineRow restored_row(double time_s, const Verdict& verdict, const Mat3& frame, const std::string& past) {
  TimelineRow row;
  row.time_s = time_s;
  row.from = row.state = verdict.state;
  row.validity = verdict.validity;
  row.cause = verdict.cause;
  row.sensors = "-";
  row.explanation = "goes on from " + past;
  row.statistic = verdict.statistic;
  row.limit = verdict.limit;
  row.has_inclination = inclination_of(verdict.gravity_mps2, frame, row.inclination_deg);
  row.inclination_sigma_deg = inclination_sigma_of(verdict, frame);
  return row;
}

TimelineRow row_of(const Verdict& verdict, const SensorArray& array, const Mat3& frame) {
  TimelineRow row;
  const TransitionRecord& record = verdict.transition;
  row.time_s = record.time_s;
  row.from = record.from;
  row.state = record.to;
  row.event = record.event;
  row.grade = record.grade;
  row.validity = verdict.validity;
  row.cause = record.cause;
  row.named = record.sensors;
  row.sensors = sensor_names(record.sensors, array);
  row.explanation = explain(verification::named_event(verdict), array);
  row.statistic = record.statistic;
  row.limit = record.limit;
  row.has_inclination = inclination_of(verdict.gravity_mps2, frame, row.inclination_deg);
  row.inclination_sigma_deg = inclination_sigma_of(verdict, frame);
  return row;
}

std::string table_header() {
  return fmt::format(
      "{:>10}  {:<13}  {:<17}  {:<10}  {:>9} {:>9}  {:>11}  {:<11}  {}\n{:>10}  {:<13}  {:<17}  {:<10}  {:>9} "
      "{:>9}  {:>11}\n",
      "time", "state", "cause", "sensor", "statistic", "limit", "inclination", "output", "in words", "s", "", "", "",
      "", "", "deg");
}

std::string table_line(const TimelineRow& row) {
  const bool tested = row.limit > 0.0;
  return fmt::format("{:>10.3f}  {:<13}  {:<17}  {:<10}  {:>9} {:>9}  {:>11}  {:<11}  {}\n", row.time_s,
                     to_string(row.state), to_string(row.cause), row.sensors, figure_or_dash(row.statistic, tested),
                     figure_or_dash(row.limit, tested),
                     row.has_inclination ? angle_words(row.inclination_deg, row.inclination_sigma_deg) : "-",
                     to_string(row.validity), row.explanation);
}

int timeline_column(const char* name) {
  const auto* const found =
      std::find_if(kColumns.begin(), kColumns.end(), [name](const char* column) { return !std::strcmp(column, name); });
  return static_cast<int>(found - kColumns.begin()) + 1;
}

std::string timeline_csv(const Timeline& timeline) {
  std::string out;
  for (const char* column : kColumns) out += (out.empty() ? "" : ",") + std::string(column);
  out += '\n';
  for (const TimelinePoint& p : timeline.points) {
    io::append_shortest(out, p.time_s);
    out += fmt::format(",{},{},{}", to_string(p.state), to_string(p.validity), to_string(p.cause));
    for (const SensorSet set : {p.in_service, p.provisionally_excluded, p.excluded, p.absent})
      out += "," + ids(set, timeline);
    for (const double value :
         {p.statistic, p.limit, p.limit > 0.0 ? p.statistic / p.limit : std::nan(""), p.inclination_true_deg,
          p.inclination_plumb_deg, p.inclination_plain_deg, p.inclination_plumb_deg - p.inclination_true_deg,
          p.inclination_plain_deg - p.inclination_true_deg, p.norm_error_plumb_mps2 / kMilliG0_mps2,
          p.norm_error_plain_mps2 / kMilliG0_mps2, p.protection_level_deg}) {
      add_cell(out, value);
    }
    out += '\n';
  }
  return out;
}

ErrorSummary errors_where(const Timeline& timeline, Validity validity) {
  ErrorSummary out;
  for (const TimelinePoint& p : timeline.points) {
    if (p.validity != validity) continue;
    ++out.points;
    const double plumb_deg = std::fabs(p.inclination_plumb_deg - p.inclination_true_deg);
    const double plain_deg = std::fabs(p.inclination_plain_deg - p.inclination_true_deg);
    if (plumb_deg > out.worst_plumb_deg) out.worst_plumb_deg = plumb_deg;
    if (plain_deg > out.worst_plain_deg) out.worst_plain_deg = plain_deg;
  }
  return out;
}

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb

#include "demo_story.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "plumb/core/units.hpp"
#include "plumb/io/json_fields.hpp"
#include "plumb/io/scenario_file.hpp"
#include "plumb/render/measured_words.hpp"
#include "plumb/render/words.hpp"
#include "plumb/scenario/count_text.hpp"
#include "plumb/scenario/fault_text.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {
namespace {

using render::Timeline;
using render::TimelinePhase;
using render::TimelineRow;

std::string degrees(double deg) { return fmt::format("{:.2g}°", deg); }

std::string at_time(double time_s) { return fmt::format("At {:.2f} s", time_s); }

SensorSet faulty_at(const Timeline& timeline, double time_s) {
  SensorSet faulty;
  for (const TimelinePhase& phase : timeline.phases) {
    if (phase.from_s <= time_s) faulty = phase.faulty;
  }
  return faulty;
}

std::string state_and_output(const TimelineRow& row) {
  const bool stays = row.event != HealthEvent::none && row.from == row.state;
  return fmt::format("The state {} {}, the output {}.", stays ? "stays" : "is", to_string(row.state),
                     to_string(row.validity));
}

/// ", 0.35 s after the fault": after the last one that began on one of these sensors; on any, where none is named.
std::string after_fault(const DrillRecord& record, const TimelineRow& row) {
  double begin_s = -1.0;
  for (const FaultRecord& fault : record.faults) {
    const bool concerned = row.named.empty() || row.named.has(fault.fault.sensor);
    if (concerned && fault.begin_s <= row.time_s) begin_s = std::max(begin_s, fault.begin_s);
  }
  return begin_s < 0.0 ? "" : fmt::format(", {:.2f} s after the fault", row.time_s - begin_s);
}

std::string is_it_right(const DrillRecord& record, const TimelineRow& row) {
  const SensorSet wronged = row.named - faulty_at(record.timeline, row.time_s);
  if (wronged.empty())
    return row.named.size() == 1 ? "This is correct: it is faulty. " : "This is correct: they are faulty. ";
  return fmt::format("This is wrong: {} is healthy. ", render::sensor_names(wronged, record.array.array));
}

std::string exclusion_sentence(const DrillRecord& record, const TimelineRow& row) {
  std::string why = "only one hypothesis is left";
  if (row.grade == Grade::confirmed) {
    why += fmt::format(", confirmed at {} in different directions",
                       count_text(record.array.monitor.isolation_stations, "station"));
  }
  return fmt::format("{}{}, {}: {} is excluded. {}{}", at_time(row.time_s), after_fault(record, row), why, row.sensors,
                     is_it_right(record, row), state_and_output(row));
}

std::string trust_sentence(const TimelineRow& row) {
  return fmt::format(
      "{} validated: the consistency check passed on consecutive blocks, at attitudes that changed the reading of "
      "every sensor in service. {}",
      at_time(row.time_s), state_and_output(row));
}

std::string change_sentence(const DrillRecord& record, const TimelineRow& row) {
  const std::string when = at_time(row.time_s);
  switch (row.event) {
    case HealthEvent::none:
      return "At power-on no sensor is validated: every sensor must first follow the motion of the tool. " +
             state_and_output(row);
    case HealthEvent::passed_block: return trust_sentence(row);
    case HealthEvent::alarm:
      return fmt::format("{}{}, the alarm: {} (statistic {:.4g}, limit {:.4g}). No sensor is isolated yet. {}", when,
                         after_fault(record, row), row.explanation, row.statistic, row.limit, state_and_output(row));
    case HealthEvent::provisional_exclusion:
      return fmt::format(
          "{}{}, {} is provisionally excluded: the other sensors agree without it, for any value of gravity. The "
          "exclusion can still be reversed. {}{}",
          when, after_fault(record, row), row.sensors, is_it_right(record, row), state_and_output(row));
    case HealthEvent::exclusion: return exclusion_sentence(record, row);
    case HealthEvent::isolation_timeout:
      return fmt::format(
          "{} the isolation timeout has expired: after {} in different directions the fault is not "
          "isolated, and the error has no bound. {} Only a reset by the host ends this state.",
          when, count_text(record.array.monitor.isolation_timeout, "station"), state_and_output(row));
    case HealthEvent::reset:
      return fmt::format("{} the monitor starts again with {} back in service; it validates every sensor anew. {}",
                         when, row.sensors, state_and_output(row));
    case HealthEvent::recalibrate:
      return fmt::format(
          "{} recalibration begins: stations are collected, while the coefficients in force stay in use. {}", when,
          state_and_output(row));
    case HealthEvent::fit_accepted:
      return fmt::format("{} the new coefficients are accepted; the sensors must be validated with them. {}", when,
                         state_and_output(row));
    case HealthEvent::fit_rejected:
      return fmt::format("{} the new coefficients are refused; the old ones stay. {}", when, state_and_output(row));
    case HealthEvent::probation_passed:
      return fmt::format("{} {} has agreed with the others at {} in different directions and is back in service. {}",
                         when, row.sensors, count_text(record.array.monitor.probation_stations, "station"),
                         state_and_output(row));
    default: break;
  }
  return fmt::format("{}: {}{}. {}", when, row.explanation, row.named.empty() ? "" : " (" + row.sensors + ")",
                     state_and_output(row));
}

std::string answer_sentence(const DrillRecord& record, const scenario::Host::Answer& answer) {
  const std::string asked = fmt::format("{} the host asks for {}", at_time(answer.time_s),
                                        scenario::describe(answer.request, record.array.array));
  if (answer.refusal == Errc::ok) return asked + ". The request is granted.";
  return fmt::format("{}. The request is refused: {}. Nothing changes.", asked, describe(answer.refusal));
}

/// What motion did, and that it did nothing else.
std::string motion_sentence(const DrillRecord& record) {
  int stretches = 0, changes = 0;
  bool before = false;
  for (const TimelinePhase& phase : record.timeline.phases) {
    if (phase.moving && !before) ++stretches;
    before = phase.moving;
  }
  for (const TimelineRow& row : record.timeline.rows) {
    for (std::size_t k = 0; k < record.timeline.phases.size(); ++k) {
      const TimelinePhase& phase = record.timeline.phases[k];
      if (phase.moving && phase.from_s == row.time_s && row.event != HealthEvent::none) ++changes;
    }
  }
  return fmt::format(
      "The tool moves {}, with {:.2g} g0 rms of vibration. plumb does not test blocks in motion: it holds the "
      "last output, and the state {}.",
      count_text(stretches, "time"), record.scenario.vibration_mps2 / kG0_mps2,
      changes == 0 ? "never changed during motion"
                   : fmt::format("changed {} during motion", count_text(changes, "time")));
}

std::string sum_sentence(const Timeline& timeline) {
  const DrillFigures f = figures_of(timeline);
  return fmt::format(
      "Over the whole run: in the {} of {} blocks at rest that plumb published as valid, the inclination was within "
      "{} of the truth; in unconfirmed blocks the error was up to {}. Without plumb the error was up to {}, without "
      "any warning. The error was within the protection level in {} of {} blocks that had one.",
      f.published, f.blocks, degrees(f.published_deg), degrees(f.unconfirmed_deg), degrees(f.plain_deg), f.kept,
      f.bounded);
}

const TimelineRow* first_row(const Timeline& timeline, HealthEvent event, double from_s) {
  const auto found = std::find_if(timeline.rows.begin(), timeline.rows.end(), [event, from_s](const TimelineRow& row) {
    return row.event == event && row.time_s >= from_s;
  });
  return found == timeline.rows.end() ? nullptr : &*found;
}

/// Figures that are not known are null, not a word that a program would have to know.
nlohmann::ordered_json number(double value) {
  return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json();
}

nlohmann::ordered_json change_json(const TimelineRow& row) {
  nlohmann::ordered_json out;
  out["time_s"] = row.time_s;
  out["from"] = to_string(row.from);
  out["to"] = to_string(row.state);
  out["event"] = to_string(row.event);
  out["cause"] = to_string(row.cause);
  out["grade"] = to_string(row.grade);
  out["sensors"] = row.sensors;
  out["output"] = to_string(row.validity);
  out["statistic"] = row.statistic;
  out["limit"] = row.limit;
  return out;
}

}  // namespace

std::vector<FaultRecord> fault_records(const std::vector<scenario::Fault>& faults, const Timeline& timeline) {
  std::vector<FaultRecord> out;
  for (const scenario::Fault& fault : faults) {
    FaultRecord record{fault, std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
    for (const TimelinePhase& phase : timeline.phases) {
      const bool now = phase.faulty.has(fault.sensor);
      if (now && !std::isfinite(record.begin_s)) record.begin_s = phase.from_s;
      if (!now && std::isfinite(record.begin_s) && !std::isfinite(record.end_s)) record.end_s = phase.from_s;
    }
    if (std::isfinite(record.begin_s)) out.push_back(record);
  }
  return out;
}

std::vector<render::TimelineMark> marks_of(const DrillRecord& record) {
  const scenario::FaultContext context = io::fault_context(record.array);
  std::vector<render::TimelineMark> out;
  for (const FaultRecord& fault : record.faults) {
    out.push_back({fault.begin_s, scenario::describe_effect(fault.fault, context)});
    const std::string id = render::sensor_names(SensorSet::of(fault.fault.sensor), record.array.array);
    if (std::isfinite(fault.end_s)) out.push_back({fault.end_s, id + " is healthy again"});
  }
  for (const scenario::Host::Answer& answer : record.answers) {
    out.push_back(
        {answer.time_s, std::string(to_string(answer.request.kind)) + (answer.refusal == Errc::ok ? "" : " refused")});
  }
  std::stable_sort(out.begin(), out.end(),
                   [](const render::TimelineMark& a, const render::TimelineMark& b) { return a.time_s < b.time_s; });
  return out;
}

DrillFigures figures_of(const Timeline& timeline) {
  DrillFigures f;
  for (const render::TimelinePoint& p : timeline.points) {
    const double plumb_deg = std::fabs(p.inclination_plumb_deg - p.inclination_true_deg);
    ++f.blocks;
    f.plain_deg = std::max(f.plain_deg, std::fabs(p.inclination_plain_deg - p.inclination_true_deg));
    if (p.validity == Validity::valid || p.validity == Validity::degraded) {
      ++f.published;
      f.published_deg = std::max(f.published_deg, plumb_deg);
    }
    if (p.validity == Validity::unconfirmed) f.unconfirmed_deg = std::max(f.unconfirmed_deg, plumb_deg);
    if (!std::isfinite(p.protection_level_deg)) continue;
    ++f.bounded;
    if (plumb_deg <= p.protection_level_deg) ++f.kept;
  }
  return f;
}

std::vector<render::Figure> key_figures(const DrillRecord& record) {
  std::vector<render::Figure> out;
  const DrillFigures f = figures_of(record.timeline);
  if (!record.faults.empty()) {
    const double fault_s = record.faults.front().begin_s;
    const TimelineRow* alarm = first_row(record.timeline, HealthEvent::alarm, fault_s);
    const TimelineRow* aside = first_row(record.timeline, HealthEvent::provisional_exclusion, fault_s);
    if (alarm == nullptr || (aside != nullptr && aside->time_s < alarm->time_s)) alarm = aside;
    const TimelineRow* excluded = first_row(record.timeline, HealthEvent::exclusion, fault_s);
    const auto after = [fault_s](const TimelineRow* row) {
      return row == nullptr ? std::string("never") : fmt::format("{:.2f} s", row->time_s - fault_s);
    };
    out.push_back({after(alarm), "from the first fault to the alarm"});
    out.push_back({after(excluded), "from the first fault to the exclusion of " +
                                        (excluded == nullptr ? std::string("a sensor") : excluded->sensors)});
  }
  out.push_back({degrees(f.plain_deg), "worst inclination error without plumb", "bad"});
  out.push_back({degrees(f.published_deg), "worst error of an output published as valid", "good"});
  return out;
}

std::vector<std::string> story_of(const DrillRecord& record) {
  std::vector<std::pair<double, std::string>> items;
  const scenario::FaultContext context = io::fault_context(record.array);
  for (const FaultRecord& fault : record.faults) {
    items.emplace_back(fault.begin_s,
                       fmt::format("{} a sensor fails: {}. plumb gets no notice of it.", at_time(fault.begin_s),
                                   scenario::describe_effect(fault.fault, context)));
    const std::string id = render::sensor_names(SensorSet::of(fault.fault.sensor), record.array.array);
    if (std::isfinite(fault.end_s))
      items.emplace_back(
          fault.end_s, fmt::format("{} {} is healthy again. plumb is not told that either.", at_time(fault.end_s), id));
  }
  for (const scenario::Host::Answer& answer : record.answers) {
    items.emplace_back(answer.time_s, answer_sentence(record, answer));
  }
  for (const TimelineRow& row : record.timeline.rows) items.emplace_back(row.time_s, change_sentence(record, row));
  std::stable_sort(items.begin(), items.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<std::string> out;
  for (const auto& [time_s, sentence] : items) {
    out.push_back(sentence);
    if (out.size() == 1) out.push_back(motion_sentence(record));
  }
  out.push_back(sum_sentence(record.timeline));
  return out;
}

render::Table changes_table(const Timeline& timeline) {
  render::Table table;
  table.title = "Every change";
  table.head = {"time, s", "state", "cause", "sensor", "statistic", "limit", "inclination, deg", "output", "in words"};
  table.state_column = 1;
  for (const TimelineRow& row : timeline.rows) {
    const bool tested = row.limit > 0.0;
    table.rows.push_back(
        {fmt::format("{:.2f}", row.time_s), to_string(row.state), to_string(row.cause), row.sensors,
         tested ? fmt::format("{:.4g}", row.statistic) : "–", tested ? fmt::format("{:.4g}", row.limit) : "–",
         row.has_inclination ? render::angle_words(row.inclination_deg, row.inclination_sigma_deg) : "–",
         to_string(row.validity), row.explanation});
  }
  table.note =
      "An alarm is a statistic above its limit; both are in standard deviations of the noise (for cause mae: in "
      "m/s²). The limit includes the noise and the uncertainty of calibration and gravity.";
  return table;
}

render::Table states_table() {
  render::Table table;
  table.title = "What the states mean";
  table.head = {"state", "meaning"};
  table.state_column = 0;
  for (int k = 0; k < kStateCount; ++k) {
    const auto state = static_cast<HealthState>(k);
    table.rows.push_back({to_string(state), render::meaning(state)});
  }
  return table;
}

nlohmann::ordered_json facts_of(const DrillRecord& record) {
  nlohmann::ordered_json out;
  const DrillFigures f = figures_of(record.timeline);
  out["sensors"] = record.timeline.sensors;
  out["duration_s"] = record.timeline.end_s - record.timeline.begin_s;
  out["blocks"] = f.blocks;
  out["blocks_valid_or_degraded"] = f.published;
  out["worst_inclination_error_valid_or_degraded_deg"] = f.published_deg;
  out["worst_inclination_error_unconfirmed_deg"] = f.unconfirmed_deg;
  out["worst_inclination_error_without_plumb_deg"] = f.plain_deg;
  out["blocks_bounded"] = f.bounded;
  out["blocks_within_bound"] = f.kept;
  const scenario::FaultContext context = io::fault_context(record.array);
  out["faults"] = nlohmann::ordered_json::array();
  for (const FaultRecord& fault : record.faults) {
    out["faults"].push_back(io::object({{"fault", scenario::to_text(fault.fault, context)},
                                        {"begin_s", fault.begin_s},
                                        {"end_s", number(fault.end_s)}}));
  }
  out["host"] = nlohmann::ordered_json::array();
  for (const scenario::Host::Answer& answer : record.answers) {
    const bool granted = answer.refusal == Errc::ok;
    out["host"].push_back(io::object({{"time_s", answer.time_s},
                                      {"request", scenario::to_text(answer.request, record.array.array)},
                                      {"refused", granted ? nlohmann::ordered_json() : describe(answer.refusal)}}));
  }
  out["changes"] = nlohmann::ordered_json::array();
  for (const TimelineRow& row : record.timeline.rows) out["changes"].push_back(change_json(row));
  return out;
}

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb

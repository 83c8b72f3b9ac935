#include "plumb/render/motion_words.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "plumb/core/units.hpp"
#include "plumb/render/figures.hpp"
#include "plumb/render/words.hpp"
#include "plumb/scenario/count_text.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {
namespace {

using session::MotionRun;

constexpr const char* kGyrosDisagree = "the two gyros read more apart than their bounds allow: one of them is faulty";

/// "a4, a5, a6 (imu2)": with the chip where all of one chip are meant.
std::string names_with_chips(SensorSet set, const io::ArrayFile& array) {
  std::string chip;
  bool one = !set.empty();
  for (int i = 0; i < array.array.size(); ++i) {
    if (!set.has(i)) continue;
    const std::string here = io::package_of(array, i);
    one = one && !here.empty() && (chip.empty() || chip == here);
    chip = here;
  }
  return sensor_names(set, array.array) + (one ? " (" + chip + ")" : "");
}

/// "a4, a5, a6 (imu2) at 3.002 s; a1 at 4.100 s": those of one instant together, in order of time.
std::string names_with_times(SensorSet set, const std::array<double, kCapacity>& at_s, const io::ArrayFile& array) {
  std::string out;
  while (!set.empty()) {
    double first_s = 0.0;
    SensorSet together;
    for (int i = 0; i < array.array.size(); ++i) {
      if (!set.has(i)) continue;
      const double t_s = at_s[static_cast<std::size_t>(i)];
      if (together.empty() || t_s < first_s) {
        first_s = t_s;
        together = SensorSet::of(i);
      } else if (t_s == first_s) {
        together = together.with(i);
      }
    }
    out += fmt::format("{}{} at {:.3f} s", out.empty() ? "" : "; ", names_with_chips(together, array), first_s);
    set = set - together;
  }
  return out.empty() ? "-" : out;
}

/// Of the most samples in which nobody was isolated, or nothing judged.
MotionCause main_cause(const MotionRun& run) {
  const auto most = std::max_element(run.why.begin() + 1, run.why.end());
  return *most == 0 ? MotionCause::none : static_cast<MotionCause>(most - run.why.begin());
}

/// Nobody was isolated in an alarm: why.
MotionCause open_cause(const MotionRun& run) {
  if (run.alarms == 0 || !run.isolated.empty()) return MotionCause::none;
  MotionCause out = MotionCause::none;
  for (const MotionCause cause : {MotionCause::parity, MotionCause::gyro_inconsistent, MotionCause::too_many_faults}) {
    if (run.samples_with(cause) > 0 && (out == MotionCause::none || run.samples_with(cause) > run.samples_with(out)))
      out = cause;
  }
  return out;
}

ForceTerm main_term(const MotionRun& run) {
  return static_cast<ForceTerm>(std::max_element(run.dominant.begin(), run.dominant.end()) - run.dominant.begin());
}

std::string force_words(const MotionRun& run) {
  if (run.blocks == 0) return "none of the blocks has a bounded specific force";
  std::string out = fmt::format(
      "of {}: bound of the error {:.3g} mg0 on average, {:.3g} mg0 at most (t = {:.3f} s); largest part: {}",
      count_text(run.blocks, "block"), kMg0 * run.bound_sum_mps2 / static_cast<double>(run.blocks),
      kMg0 * run.worst_bound_mps2, run.worst_bound_at_s, to_string(main_term(run)));
  if (run.blocks_unchecked > 0)
    out += fmt::format("; in {} it holds only while no further sensor fails", run.blocks_unchecked);
  if (run.blocks_by_one_gyro > 0)
    out += fmt::format("; in {} it holds only while the gyro is healthy", run.blocks_by_one_gyro);
  return out;
}

const char* why_none(InclinationStatus status) {
  switch (status) {
    case InclinationStatus::no_force: return "a block had no bounded force";
    case InclinationStatus::rate_unknown: return "no gyro delivered a rate";
    case InclinationStatus::irregular_time: return "rows do not follow each other by sample_period_s";
    case InclinationStatus::contradicts_gravity:
      return "the force is larger than gravity and the bounds allow: check velocity_bound_mps, gravity and calibration";
    case InclinationStatus::filling:
    case InclinationStatus::known: break;
  }
  return "no window is full";
}

std::string inclination_words(const MotionRun& run) {
  const InclinationInterval& last = run.inclination;
  std::string out;
  if (run.inclinations > 0)
    out =
        fmt::format("{:.2f} deg, between {:.2f} and {:.2f}, in the {:.1f} s around t = {:.3f} s{}; {}; widest part: {}",
                    deg_from_rad(last.inclination_rad), deg_from_rad(last.low_rad), deg_from_rad(last.high_rad),
                    last.span_s, last.time_s, last.gyro_assumed ? " while the gyro is healthy" : "",
                    count_text(run.inclinations, "window"), to_string(last.widest));
  if (run.inclination_breaks == 0) return out.empty() ? "not known: no window is full" : out;
  return fmt::format("{}{} without: {}", out.empty() ? "not known; " : out + "; ",
                     count_text(run.inclination_breaks, "time"), why_none(run.no_inclination.status));
}

io::Json inclination_json(const MotionTold& told) {
  if (!told.inclination) return io::Json();
  const MotionRun& run = *told.run;
  const InclinationInterval& last = run.inclination;
  io::Json out = io::object({{"windows", run.inclinations}, {"breaks", run.inclination_breaks}});
  out["last"] = run.inclinations == 0 ? io::Json()
                                      : io::object({{"t_s", last.time_s},
                                                    {"span_s", last.span_s},
                                                    {"inclination_deg", deg_from_rad(last.inclination_rad)},
                                                    {"low_deg", deg_from_rad(last.low_rad)},
                                                    {"high_deg", deg_from_rad(last.high_rad)},
                                                    {"widest", to_string(last.widest)},
                                                    {"gyro_assumed", last.gyro_assumed}});
  out["last_break"] = run.inclination_breaks == 0 ? io::Json() : io::Json(to_string(run.no_inclination.status));
  return out;
}

std::string judged_words(const MotionRun& run) {
  std::string out = fmt::format("{} of {} judged", run.judged, count_text(run.samples, "sample"));
  if (2 * run.judged < run.samples) out += fmt::format(" ({})", explain(main_cause(run)));
  if (run.alarms > 0)
    out += fmt::format(", {}, the first at {:.3f} s", count_text(run.alarms, "alarm"), run.first_alarm_s);
  else if (run.judged > 0)
    out += ", no alarm";
  return out;
}

io::Json sensors_json(SensorSet set, const std::array<double, kCapacity>& at_s, const io::ArrayFile& array) {
  io::Json out = io::Json::array();
  for (int i = 0; i < array.array.size(); ++i) {
    if (set.has(i))
      out.push_back(io::object({{"id", array.array.row(i).id.data()}, {"t_s", at_s[static_cast<std::size_t>(i)]}}));
  }
  return out;
}

io::Json ids_json(SensorSet set, const io::ArrayFile& array) {
  io::Json out = io::Json::array();
  for (int i = 0; i < array.array.size(); ++i) {
    if (set.has(i)) out.push_back(array.array.row(i).id.data());
  }
  return out;
}

}  // namespace

const char* explain(MotionCause cause) noexcept {
  switch (cause) {
    case MotionCause::none: return "nothing contradicts, or a sensor is isolated";
    case MotionCause::parity: return "readings contradict each other, and several explanations are left";
    case MotionCause::gyro_inconsistent: return "a faulty gyro would explain it as well, and nothing corroborates it";
    case MotionCause::too_many_faults: return "more units are faulty at once than can be isolated";
    case MotionCause::rotation_unknown: return "neither a rate nor a bound of the rate is known";
    case MotionCause::no_redundancy: return "the sensors left do not check each other";
    case MotionCause::irregular_time: return "rows do not follow each other by sample_period_s";
  }
  return "?";
}

std::string event_words(const io::MotionEvent& event) {
  switch (event.kind) {
    case io::MotionEventKind::alarm:
      return event.cause == MotionCause::none ? "readings contradict each other" : explain(event.cause);
    case io::MotionEventKind::isolated: return "faulty in every explanation";
    case io::MotionEventKind::excluded: return "provisionally excluded from the specific force";
    case io::MotionEventKind::alarm_over: return "nothing that contradicts is on record";
    case io::MotionEventKind::forgotten: return "the monitor at rest has judged: taken back";
    case io::MotionEventKind::gyros_disagree: return kGyrosDisagree;
  }
  return "?";
}

std::string motion_line(const io::MotionEvent& event, const SensorArray& array) {
  return fmt::format("{:>10.3f}  {:<13}  {:<17}  {:<10}  {:>9} {:>9}  {:>11}  {:<11}  {}\n", event.time_s,
                     "(in motion)", to_string(event.kind), sensor_names(event.sensors, array), "-", "-", "-", "-",
                     event_words(event));
}

std::string motion_text(const MotionTold& told, const io::ArrayFile& array) {
  if (told.refusal != nullptr)
    return fmt::format("in motion   not judged: {} {}\n", told.refusal->field, told.refusal->what);
  if (told.run == nullptr) return "";
  const MotionRun& run = *told.run;
  std::string out = "in motion   " + judged_words(run) + "\n";
  if (run.alarms > 0) {
    out += "  suspected " + names_with_chips(run.suspects, array) + "\n";
    out += "  isolated  " + names_with_times(run.isolated, run.isolated_at_s, array) + "\n";
    out += "  excluded  " + names_with_times(run.excluded, run.excluded_at_s, array) +
           (run.excluded.empty() ? "\n" : ", provisionally\n");
  }
  if (const MotionCause cause = open_cause(run); cause != MotionCause::none)
    out += fmt::format("  cause     nobody is isolated: {}\n", explain(cause));
  if (run.gyro_disagreements > 0)
    out += fmt::format("  gyros     {}; first at {:.3f} s\n", kGyrosDisagree, run.gyros_disagree_s);
  if (run.rates_of_group) out += "  rate      the median of the group of gyros\n";
  out += "  force     " + force_words(run) + "\n";
  if (told.inclination) out += "  inclined  " + inclination_words(run) + "\n";
  for (const MotionNote& note : motion_notes(run, *told.setup))
    out += fmt::format("  note      {}. Remedy: {}.\n", note.what, note.remedy);
  return out;
}

std::vector<std::string> motion_actions(const MotionTold& told, const io::ArrayFile& array) {
  std::vector<std::string> out;
  if (told.run == nullptr) return out;
  const MotionRun& run = *told.run;
  if (!run.isolated.empty())
    out.push_back(
        fmt::format("In motion {} contradicted the others: check what was isolated, whatever the stations say.",
                    names_with_times(run.isolated, run.isolated_at_s, array)));
  else if (run.alarms > 0)
    out.push_back(
        fmt::format("In motion the readings contradicted each other from t = {:.3f} s on, and nobody was isolated: {}.",
                    run.first_alarm_s, explain(open_cause(run))));
  if (run.gyro_disagreements > 0)
    out.push_back(fmt::format("Check both gyros: from t = {:.3f} s on {}.", run.gyros_disagree_s, kGyrosDisagree));
  return out;
}

io::Json motion_json(const MotionTold& told, const io::ArrayFile& array) {
  if (told.run == nullptr)
    return io::object({{"judged", false},
                       {"field", told.refusal->field},
                       {"why", told.refusal->what},
                       {"remedy", told.refusal->remedy}});
  const MotionRun& run = *told.run;
  const bool blocks = run.blocks > 0;
  const auto known = [](bool is, const io::Json& value) { return is ? value : io::Json(); };
  io::Json out = io::object({{"judged", true},
                             {"samples", run.samples},
                             {"samples_judged", run.judged},
                             {"alarms", run.alarms},
                             {"samples_in_alarm", run.in_alarm},
                             {"first_alarm_s", known(run.alarms > 0, run.first_alarm_s)},
                             {"suspects", ids_json(run.suspects, array)},
                             {"isolated", sensors_json(run.isolated, run.isolated_at_s, array)},
                             {"excluded", sensors_json(run.excluded, run.excluded_at_s, array)},
                             {"cause", to_string(open_cause(run))},
                             {"gyros_disagree_s", known(run.gyro_disagreements > 0, run.gyros_disagree_s)},
                             {"blocks", run.blocks},
                             {"blocks_unchecked", run.blocks_unchecked},
                             {"blocks_by_one_gyro", run.blocks_by_one_gyro}});
  out["bound_mean_mps2"] = known(blocks, blocks ? run.bound_sum_mps2 / static_cast<double>(run.blocks) : 0.0);
  out["bound_worst_mps2"] = known(blocks, run.worst_bound_mps2);
  out["dominant"] = known(blocks, to_string(main_term(run)));
  out["inclination"] = inclination_json(told);
  out["notes"] = io::Json::array();
  for (const MotionNote& note : motion_notes(run, *told.setup))
    out["notes"].push_back(io::object({{"code", note.code}, {"what", note.what}, {"remedy", note.remedy}}));
  return out;
}

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb

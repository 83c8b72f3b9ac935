#include "plumb/render/group_report.hpp"

#include <fmt/format.h>

#include <cmath>

#include "plumb/core/units.hpp"
#include "plumb/io/json_fields.hpp"
#include "plumb/render/words.hpp"
#include "plumb/scenario/count_text.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {
namespace {

/// What the names of lines take of a summary.
constexpr std::size_t kLabel = 12;

double mean_bound(const session::RateRun& run) {
  return run.bounded_blocks > 0 ? run.bound_sum_radps / static_cast<double>(run.bounded_blocks) : 0.0;
}

std::string answer_words(const DipAnswer& answer, const SensorArray& array) {
  switch (answer.verdict) {
    case DipVerdict::not_judged: return "it cannot be judged";
    case DipVerdict::consistent: return "no fault is needed to explain both references";
    case DipVerdict::unseen:
      return "no fault is needed, yet one of " + sensor_names(answer.mirrors, array) + " could pass both references";
    case DipVerdict::fault:
      return answer.named >= 0 ? sensor_names(SensorSet::of(answer.named), array) + " is faulty"
                               : "one of " + sensor_names(answer.suspects, array) + " is faulty";
    case DipVerdict::unexplained: break;
  }
  return "no single faulty accelerometer explains them: several are, or the field is disturbed beyond its bound";
}

/// A line of what is not a state of the monitor, in the columns of `table_line`.
std::string beside_line(double time_s, const char* what, const std::string& sensors, const std::string& words) {
  return fmt::format("{:>10.3f}  {:<13}  {:<17}  {:<10}  {:>9} {:>9}  {:>11}  {:<11}  {}\n", time_s, "", what, sensors,
                     "-", "-", "-", "-", words);
}

std::string dip_of_three_text(const session::DipOfThree& three, const SensorArray& array) {
  if (three.judged == 0) return "";
  std::string out = fmt::format("dip         three accelerometers left: {}", answer_words(three.last.answer, array));
  if (three.faulty > 0)
    out += fmt::format("; a fault in {} of {} from t = {:.3f} s on", three.faulty,
                       count_text(static_cast<std::size_t>(three.judged), "block"), three.first_fault_s);
  out += three.last.protected_by_dip
             ? fmt::format("; by the dip the direction is within {:.3f} deg in the calibrated axes\n",
                           deg_from_rad(three.last.protection_level_calibrated_axes_rad))
             : std::string("; the bound is the monitor's\n");
  return out;
}

}  // namespace

std::string group_heading(const io::ArrayFile& group) {
  return fmt::format("\n== {}: {}\n", group.group,
                     count_text(static_cast<std::size_t>(group.array.size()), io::units_of(group.field).sensor));
}

std::string group_heading_json(const io::ArrayFile& group) {
  return io::object({{"group", io::object({{"name", group.group},
                                           {"field", to_string(group.field)},
                                           {"sensors", io::ids_of(group.array.all(), group.array)}})}})
             .dump() +
         "\n";
}

std::string rate_bounds_note(const io::ArrayFile& group, bool calibrated) {
  if (calibrated) return "";
  bool scale = true, axis = true, bias = true;
  for (int i = 0; i < group.array.size(); ++i) {
    const RateErrors& e = group.rate.errors[static_cast<std::size_t>(i)];
    scale = scale && e.scale > 0.0;
    axis = axis && e.axis_rad > 0.0;
    bias = bias && e.bias_radps > 0.0;
  }
  std::string missing = scale ? "" : "scale_bound";
  if (!axis) missing += (missing.empty() ? "" : ", ") + std::string("axis_bound_rad");
  if (!bias) missing += (missing.empty() ? "" : ", ") + std::string("bias_bound_radps");
  if (missing.empty()) return "";
  return fmt::format(
      "plumb: {}: group {} does not state {} for every gyro: what is not stated counts as 0, so healthy gyros may be "
      "excluded, and bounds of the rate hold for perfect gyros only. Remedy: state them in [group.rate], or calibrate "
      "the gyros and give --group {}=CAL.json.\n",
      group.path, group.group, missing, group.group);
}

std::string rate_run_text(const session::RateRun& run, const io::ArrayFile& group) {
  const SensorArray& array = group.array;
  const SensorSet out_of_service = run.last.excluded | run.last.off_at_rest | run.silent;
  std::string out =
      fmt::format("log         {}, {} of them at rest, {}, {} skipped\n", count_text(run.samples, "sample"),
                  run.samples_at_rest, count_text(run.blocks, "block"), count_text(run.log.rows_bad, "bad row"));
  if (run.calibrated)
    out += run.common > 0.0 ? fmt::format("calibrated  against each other{}\n",
                                          std::isfinite(run.common)
                                              ? fmt::format("; the bound has {:.2g} % of the rate for what they share",
                                                            100.0 * run.common)
                                              : ", and nothing bounds what they share: no rate has a bound")
                            : std::string("calibrated  scales, axes and biases\n");
  out += fmt::format("in service  {}\n", sensor_names(array.all() - out_of_service, array));
  out += fmt::format("excluded    {}\n", sensor_names(run.last.excluded, array));
  if (!run.silent.empty())
    out += fmt::format("silent      {}: no number in the last {:.3g} s of the log\n", sensor_names(run.silent, array),
                       run.silent_s);
  if (!run.last.off_at_rest.empty())
    out += fmt::format("off at rest {}: out of service until a block at rest in which {} near zero again\n",
                       sensor_names(run.last.off_at_rest, array),
                       run.last.off_at_rest.size() == 1 ? "it reads" : "they read");
  const SensorSet earlier = (run.ever_excluded | run.ever_off_at_rest) - out_of_service;
  if (!earlier.empty()) out += fmt::format("earlier     {} out of service for a time\n", sensor_names(earlier, array));
  if (run.alarms > 0)
    out += fmt::format("contradict  {} (first t = {:.3f} s) readings contradicted each other{}{}\n",
                       count_text(static_cast<std::size_t>(run.alarms), "time"), run.first_alarm_s,
                       run.ever_excluded.empty() && run.ever_off_at_rest.empty() ? ", and nobody could be named" : "",
                       run.last.alarm ? "; they do at the end of the log" : "");
  if (run.turned_at_rest > 0)
    out += fmt::format(
        "at rest     {} (first t = {:.3f} s), gyros read a rate that parity blames on none of them: the tool turned "
        "while it was said to "
        "stand still, or a fault is too small for parity\n",
        count_text(static_cast<std::size_t>(run.turned_at_rest), "time"), run.turned_at_rest_s);
  out +=
      run.bounded_blocks > 0
          ? fmt::format("rate        bound of the error {:.3g} deg/s on average, {:.3g} deg/s at most, in {} of {}\n",
                        deg_from_rad(mean_bound(run)), deg_from_rad(run.worst_bound_radps), run.bounded_blocks,
                        count_text(run.blocks, "block"))
          : std::string("rate        no bound on the error can be given\n");
  return out;
}

std::string rate_run_json(const session::RateRun& run, const io::ArrayFile& group) {
  const SensorArray& array = group.array;
  return io::object({{"group", group.group},
                     {"field", to_string(group.field)},
                     {"calibrated", run.calibrated},
                     {"common_part", io::finite_or_null(run.common)},
                     {"summary", io::object({{"samples", run.samples},
                                             {"samples_at_rest", run.samples_at_rest},
                                             {"blocks", run.blocks},
                                             {"rows_bad", run.log.rows_bad},
                                             {"excluded", io::ids_of(run.last.excluded, array)},
                                             {"off_at_rest", io::ids_of(run.last.off_at_rest, array)},
                                             {"ever_excluded", io::ids_of(run.ever_excluded, array)},
                                             {"ever_off_at_rest", io::ids_of(run.ever_off_at_rest, array)},
                                             {"silent", io::ids_of(run.silent, array)},
                                             {"alarms", run.alarms},
                                             {"in_alarm", run.last.alarm},
                                             {"turned_at_rest", run.turned_at_rest},
                                             {"blocks_with_bound", run.bounded_blocks},
                                             {"bound_mean_radps", mean_bound(run)},
                                             {"bound_worst_radps", run.worst_bound_radps}})}})
             .dump() +
         "\n";
}

bool rate_is_trusted(const session::RateRun& run) noexcept {
  return !run.stopped && run.bounded_blocks > 0 && !run.last.alarm &&
         (run.last.excluded | run.last.off_at_rest | run.silent).empty();
}

std::string rate_sentence(const session::RateRun& run, const io::ArrayFile& group) {
  const SensorSet out = run.last.excluded | run.last.off_at_rest | run.silent;
  if (run.stopped) return "The log ended in an error: " + run.stop.what + ".";
  if (run.bounded_blocks == 0) return "No bound on the error of the rate can be given.";
  if (run.last.alarm && out.empty())
    return "Do not use the rate: the gyros contradict each other, and which of them is faulty cannot be told.";
  if (run.last.alarm)
    return fmt::format("Do not use the rate: beside {}, which are out of service, others contradict each other.",
                       sensor_names(out, group.array));
  if (run.alarms > 0 && out.empty())
    return "All gyros are in service; for a time they contradicted each other, and none could be named.";
  if (out.empty()) return "All gyros are in service.";
  return fmt::format("Do not use the rate of {}; in service: {}.", sensor_names(out, group.array),
                     sensor_names(group.array.all() - out, group.array));
}

std::string dip_text(const session::GroupDip* dip, const SensorArray& accelerometers) {
  if (dip == nullptr)
    return "dip         not checked: [group.reference] states no dip (give dip = \"72.9 deg\", or model = \"wmm\")\n";
  const session::DipCheck& check = dip->check();
  const std::string of_three = dip_of_three_text(dip->of_three(), accelerometers);
  if (check.checked == 0) {
    if (!of_three.empty()) return of_three;
    return "dip         not checked: in no block were the directions of gravity and of the field both usable\n";
  }
  const std::string measured = fmt::format(
      "{:.2f} to {:.2f} deg in {}, {:.2f} expected", deg_from_rad(check.least_rad), deg_from_rad(check.most_rad),
      count_text(static_cast<std::size_t>(check.checked), "block"), deg_from_rad(dip->group().magnetic.dip_rad));
  if (check.disagreeing == 0)
    return fmt::format(
               "dip         {}: gravity and the field agree, as far as their bounds and the reference tell ({:.2f} "
               "deg)\n",
               measured, deg_from_rad(check.widest_allowed_rad)) +
           of_three;
  return fmt::format(
             "dip         {}: gravity and the field DISAGREE in {} of them from t = {:.3f} s on, by up to {:.2f} deg "
             "more than their bounds and the reference allow. Rely on neither direction until it is known why: a "
             "disturbed field, a group turned against the other, a fault that neither can see\n",
             measured, check.disagreeing, check.first_s, deg_from_rad(check.worst_excess_rad)) +
         of_three;
}

std::string dip_sentence(const session::GroupDip* dip, const SensorArray& accelerometers) {
  std::string out;
  for (std::string rest = dip_text(dip, accelerometers); !rest.empty();) {
    const std::size_t end = rest.find('\n');
    out += (out.empty() ? "" : ". ") + rest.substr(kLabel, end - kLabel);
    rest.erase(0, end + 1);
  }
  return out + ".";
}

io::Json dip_json(const session::GroupDip* dip, const io::ArrayFile& group, const SensorArray& accelerometers) {
  const session::DipCheck check = dip == nullptr ? session::DipCheck{} : dip->check();
  io::Json out = io::object({{"group", group.group}, {"blocks_checked", check.checked}});
  out["expected_deg"] = group.magnetic.dip_known ? io::Json(deg_from_rad(group.magnetic.dip_rad)) : io::Json();
  if (check.checked > 0) {
    out["least_deg"] = deg_from_rad(check.least_rad);
    out["most_deg"] = deg_from_rad(check.most_rad);
    out["widest_allowed_deg"] = deg_from_rad(check.widest_allowed_rad);
    out["blocks_disagreeing"] = check.disagreeing;
    out["worst_excess_deg"] = deg_from_rad(check.worst_excess_rad);
  }
  if (dip != nullptr && dip->of_three().judged > 0) {
    const session::DipOfThree& three = dip->of_three();
    out["three_left"] = io::object({{"blocks_judged", three.judged},
                                    {"blocks_protected", three.protected_by_dip},
                                    {"blocks_faulty", three.faulty},
                                    {"verdict", to_string(three.last.answer.verdict)},
                                    {"named", io::ids_of(three.named, accelerometers)},
                                    {"suspects", io::ids_of(three.last.answer.suspects, accelerometers)},
                                    {"bound_deg", deg_from_rad(three.last.answer.bound_rad)}});
  }
  return out;
}

std::string dip_line(const session::DipEvent& event, const io::ArrayFile& group, const SensorArray& accelerometers) {
  const bool judged = event.kind == session::DipEventKind::judged;
  const bool disagree = event.kind == session::DipEventKind::disagree;
  std::string words =
      judged ? "three accelerometers are left, and the dip is their second reference: " +
                   answer_words(event.answer, accelerometers)
             : fmt::format("gravity and the field {}: the dip is {:.2f} deg, {:.2f} expected, {:.2f} allowed",
                           disagree ? "DISAGREE" : "agree again", deg_from_rad(event.dip_rad),
                           deg_from_rad(group.magnetic.dip_rad), deg_from_rad(event.allowed_rad));
  const SensorSet named = event.answer.named < 0 ? SensorSet() : SensorSet::of(event.answer.named);
  return beside_line(event.time_s, "dip", judged ? sensor_names(named, accelerometers) : "-", words);
}

std::string rate_line(const session::RateEvent& event, const SensorArray& array) {
  const SensorSet out = event.excluded | event.off_at_rest;
  std::string words = out.empty() ? "every gyro is in service" : "out of service: " + sensor_names(out, array);
  if (event.alarm && !event.suspects.empty())
    words += "; readings contradict each other, suspected: " + sensor_names(event.suspects, array);
  if (event.alarm && event.suspects.empty()) words += "; readings contradict each other, and none of them can be named";
  if (event.turned_at_rest) words += "; the gyros read a rate at rest that parity blames on none of them";
  return beside_line(event.time_s, to_string(event.cause), sensor_names(out, array), words);
}

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb

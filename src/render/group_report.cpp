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

double mean_bound(const session::RateRun& run) {
  return run.bounded_blocks > 0 ? run.bound_sum_radps / static_cast<double>(run.bounded_blocks) : 0.0;
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
                                             {"turned_at_rest", run.turned_at_rest},
                                             {"blocks_with_bound", run.bounded_blocks},
                                             {"bound_mean_radps", mean_bound(run)},
                                             {"bound_worst_radps", run.worst_bound_radps}})}})
             .dump() +
         "\n";
}

std::string dip_text(const session::DipCheck& check, const io::ArrayFile& group) {
  const io::MagneticReference& reference = group.magnetic;
  if (!reference.dip_known)
    return "dip         not checked: [group.reference] states no dip (give dip = \"72.9 deg\", or model = \"wmm\")\n";
  if (check.checked == 0)
    return "dip         not checked: in no block were the directions of gravity and of the field both usable\n";
  const std::string measured = fmt::format(
      "{:.2f} to {:.2f} deg in {}, {:.2f} expected", deg_from_rad(check.least_rad), deg_from_rad(check.most_rad),
      count_text(static_cast<std::size_t>(check.checked), "block"), deg_from_rad(reference.dip_rad));
  if (check.disagreeing == 0)
    return fmt::format(
        "dip         {}: gravity and the field agree, as far as their bounds and the reference tell ({:.2f} deg)\n",
        measured, deg_from_rad(check.widest_allowed_rad));
  return fmt::format(
      "dip         {}: gravity and the field DISAGREE in {} of them from t = {:.3f} s on, by up to {:.2f} deg more "
      "than their bounds and the reference allow. Rely on neither direction until it is known why: a disturbed field, "
      "a group turned against the other, a fault that neither can see\n",
      measured, check.disagreeing, check.first_s, deg_from_rad(check.worst_excess_rad));
}

std::string dip_json(const session::DipCheck& check, const io::ArrayFile& group) {
  io::Json out = io::object({{"group", group.group}, {"blocks_checked", check.checked}});
  out["expected_deg"] = group.magnetic.dip_known ? io::Json(deg_from_rad(group.magnetic.dip_rad)) : io::Json();
  if (check.checked > 0) {
    out["least_deg"] = deg_from_rad(check.least_rad);
    out["most_deg"] = deg_from_rad(check.most_rad);
    out["widest_allowed_deg"] = deg_from_rad(check.widest_allowed_rad);
    out["blocks_disagreeing"] = check.disagreeing;
    out["worst_excess_deg"] = deg_from_rad(check.worst_excess_rad);
  }
  return io::object({{"dip", std::move(out)}}).dump() + "\n";
}

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb

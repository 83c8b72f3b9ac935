#include "demo_story.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "plumb/core/units.hpp"
#include "plumb/report/words.hpp"
#include "tool.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {
namespace {

using report::ErrorSummary;
using report::TimelineRow;

std::string degrees(double deg) { return fmt::format("{:.2g}°", deg); }

/// First row at or after `from_s` that fits; null where there is none.
template <class Fits>
const TimelineRow* first_row(const report::Timeline& timeline, double from_s, Fits fits) {
  for (const TimelineRow& row : timeline.rows) {
    if (row.time_s >= from_s && fits(row)) return &row;
  }
  return nullptr;
}

/// The moments of the run that the story is about.
struct Moments {
  const TimelineRow* trusted;   ///< first state of trust after power-on
  const TimelineRow* noticed;   ///< first suspicion after the fault
  const TimelineRow* excluded;  ///< first exclusion after the fault
};

Moments moments_of(const DemoFacts& facts) {
  const auto in_trust = [](const TimelineRow& row) { return row.state == HealthState::nominal; };
  const auto suspicious = [](const TimelineRow& row) { return row.state == HealthState::suspect; };
  const auto excluding = [](const TimelineRow& row) { return row.cause == Cause::isolated_fault; };
  return {first_row(facts.timeline, facts.timeline.begin_s, in_trust),
          first_row(facts.timeline, facts.fault_s, suspicious), first_row(facts.timeline, facts.fault_s, excluding)};
}

/// Worst errors after the fault, among the points that plumb vouched for (or not).
ErrorSummary after_fault(const DemoFacts& facts, bool vouched) {
  report::Timeline after;
  for (const report::TimelinePoint& p : facts.timeline.points) {
    if (p.time_s >= facts.fault_s) after.points.push_back(p);
  }
  if (!vouched) return report::errors_where(after, Validity::unconfirmed);
  const ErrorSummary valid = report::errors_where(after, Validity::valid);
  const ErrorSummary degraded = report::errors_where(after, Validity::degraded);
  return {valid.points + degraded.points, std::max(valid.worst_plumb_deg, degraded.worst_plumb_deg),
          std::max(valid.worst_plain_deg, degraded.worst_plain_deg)};
}

double worst_plain_deg(const DemoFacts& facts) {
  double worst = 0.0;
  for (const report::TimelinePoint& p : facts.timeline.points) {
    if (p.time_s >= facts.fault_s) worst = std::max(worst, std::fabs(p.inclination_plain_deg - p.inclination_true_deg));
  }
  return worst;
}

std::string isolation_sentence(const DemoFacts& facts, const Moments& m) {
  const std::string dead = report::sensor_names(facts.dead, facts.array.array);
  if (m.excluded == nullptr) {
    return fmt::format(
        "By the end of the run plumb has not excluded anybody: more than one explanation is left, and it does not "
        "guess. Its "
        "output stays {}.",
        to_string(facts.last.validity));
  }
  const bool right = facts.last.excluded == facts.dead;
  std::string out = fmt::format(
      "At {:.2f} s, {:.2f} s after the fault, only one explanation is left, confirmed at {} stations in different "
      "directions: {} is excluded",
      m.excluded->time_s, m.excluded->time_s - facts.fault_s, facts.array.monitor.isolation_stations,
      m.excluded->sensors);
  return out +
         (right ? ", the sensor that really died." : fmt::format(". That is wrong: the sensor that died is {}.", dead));
}

std::vector<std::string> story_of(const DemoFacts& facts, const Moments& m) {
  std::vector<std::string> out;
  out.push_back(
      "At power-on plumb trusts nobody. The state is suspect and the output unconfirmed, until every sensor has been "
      "seen to "
      "follow the tool through several attitudes" +
      (m.trusted != nullptr ? fmt::format(". At {:.2f} s trust is earned: nominal.", m.trusted->time_s)
                            : std::string(", which did not happen in this run.")));
  out.push_back(fmt::format(
      "At {:.2f} s the output of {} goes dead: it stands at 0 V. In the log it looks like a sensor that lies level.",
      facts.fault_s, report::sensor_names(facts.dead, facts.array.array)));
  if (m.noticed != nullptr) {
    out.push_back(
        fmt::format("At {:.2f} s, with the first quiet block after it, plumb raises the alarm: the statistic is "
                    "{:.4g}, its limit {:.4g}. "
                    "It cannot know yet which sensor is wrong, so it names nobody and calls its output unconfirmed.",
                    m.noticed->time_s, m.noticed->statistic, m.noticed->limit));
  } else {
    out.push_back("plumb has not raised an alarm after it.");
  }
  const ErrorSummary unsure = after_fault(facts, false);
  if (unsure.points > 0) {
    out.push_back(fmt::format(
        "While it is unconfirmed the inclination is wrong by up to {}: no better than without plumb. The difference is "
        "that it says so.",
        degrees(unsure.worst_plumb_deg)));
  }
  out.push_back(isolation_sentence(facts, m));
  const ErrorSummary sure = after_fault(facts, true);
  if (sure.points > 0) {
    out.push_back(
        fmt::format("From then on the inclination is within {} of the truth; without plumb it is wrong by up to {}. "
                    "The state at the "
                    "end is {}: {}.",
                    degrees(sure.worst_plumb_deg), degrees(sure.worst_plain_deg), to_string(facts.last.state),
                    report::meaning(facts.last.state)));
  }
  return out;
}

std::vector<report::RunPage::Figure> figures_of(const DemoFacts& facts, const Moments& m) {
  std::vector<report::RunPage::Figure> out;
  const auto after = [&facts](const TimelineRow* row) {
    return row == nullptr ? std::string("not in this run") : fmt::format("{:.2f} s", row->time_s - facts.fault_s);
  };
  out.push_back({after(m.noticed), "from the fault to the alarm"});
  out.push_back({after(m.excluded), "from the fault to the exclusion of " +
                                        (m.excluded == nullptr ? std::string("a sensor") : m.excluded->sensors)});
  out.push_back({degrees(worst_plain_deg(facts)), "worst inclination error after the fault, without plumb"});
  const ErrorSummary sure = after_fault(facts, true);
  out.push_back(
      {sure.points > 0 ? degrees(sure.worst_plumb_deg) : "none", "worst error that plumb vouched for after the fault"});
  return out;
}

std::string calibration_sentence(const DemoFacts& facts) {
  const FitReport& r = facts.fit.report;
  return fmt::format(
      "From {} still attitudes, with gravity as the only reference: {} of {} parameters are determined (the other {} "
      "are a common "
      "rotation of all axes, which the nominal axes fix). What is left: {:.3f} mg rms in the length of gravity, {:.3f} "
      "mg rms "
      "in parity.",
      facts.fit.stations.size(), r.rank, r.parameters, r.parameters - r.rank, r.norm_rms_mps2 / (1e-3 * kG0_mps2),
      r.parity_rms_mps2 / (1e-3 * kG0_mps2));
}

}  // namespace

report::RunPage demo_page(const DemoFacts& facts) {
  const Moments m = moments_of(facts);
  report::RunPage page;
  page.title = "plumb demo: one of four accelerometers dies";
  page.lead = fmt::format(
      "A simulated drilling tool with four accelerometers surveys {:.0f} s of a well. Sensor {} dies on the way. "
      "plumb, which is "
      "told nothing of it, watches.",
      facts.timeline.end_s - facts.timeline.begin_s, report::sensor_names(facts.dead, facts.array.array));
  page.figures = figures_of(facts, m);
  page.story = story_of(facts, m);
  page.rows = facts.timeline.rows;
  page.calibration = calibration_sentence(facts);
  for (const SensorFigures& f : sensor_figures(facts.fit, facts.array)) {
    page.sensors.push_back({f.id, fmt::format("{:.3f} ± {:.3f}", f.bias_mg, f.bias_sigma_mg),
                            fmt::format("{:.6f}", f.scale), fmt::format("{:.3f}", f.axis_shift_deg),
                            fmt::format("{:.3f}", f.e_cal_mg), fmt::format("{:.3f}", f.residual_rms_mg)});
  }
  page.commands = {"plumb geometry array.toml",
                   "plumb calibrate --array array.toml --log calibration.csv --out calibration.json",
                   "plumb monitor --array array.toml --calibration calibration.json --log drilling.csv \\",
                   "    --events events.jsonl --verdicts verdicts.jsonl"};
  page.files = {{"array.toml", "the array: axes, scales and noise as a datasheet gives them"},
                {"calibration.csv", "the log of the calibration stand, 48 attitudes of 2 s at 100 Hz, in volts"},
                {"drilling.csv", "the log of the drilling run, in volts"},
                {"calibration.json", "what plumb found out about the sensors"},
                {"events.jsonl", "one line per change of state"},
                {"verdicts.jsonl", "one line per quiet block: state, statistic, limit, sensors, vector, bound"},
                {"timeline.csv", "what the picture shows, the truth included"},
                {"timeline.svg", "the picture; timeline.gp is the gnuplot program that drew it"}};
  page.footer = fmt::format(
      "plumb {}, seed {}: the same seed gives the same bytes. `plumb demo --seed 2` draws another tool, other noise "
      "and other "
      "attitudes.",
      kVersion, facts.seed);
  return page;
}

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb

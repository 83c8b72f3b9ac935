// The first page: what was asked for against what was found, and what follows.
#include <fmt/format.h>

#include <cmath>

#include "plumb/core/units.hpp"
#include "plumb/io/json_fields.hpp"
#include "plumb/report/limits.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace report {
namespace {

double mg0(double mps2) { return 1e3 * g0_from_mps2(mps2); }

/// "3 of 20000, 95 % interval 3.1e-05 to 0.00044".
std::string rate_words(const Json& rate) {
  return fmt::format("{} of {}, 95 % interval {:.3g} to {:.3g}", rate["count"].get<std::uint64_t>(),
                     rate["of"].get<std::uint64_t>(), rate["low"].get<double>(), rate["high"].get<double>());
}

/// Scenarios without any case that show a rate below the limit: 1 - (1 - limit)^n >= 97.5 %.
double trials_to_show(double limit) { return std::ceil(std::log(0.025) / std::log1p(-limit)); }

class Criteria {
 public:
  void add(const std::string& name, const std::string& limit, const std::string& limit_from, const std::string& found,
           const char* result, const std::string& reason) {
    list_.push_back(io::object({{"name", name},
                                {"limit", limit},
                                {"limit_from", limit_from},
                                {"found", found},
                                {"result", result},
                                {"reason", reason}}));
  }

  void judge(bool met, const std::string& name, const std::string& limit, const std::string& limit_from,
             const std::string& found, const std::string& reason) {
    add(name, limit, limit_from, found, met ? "met" : "not met", met ? "" : reason);
  }

  /// A rate against a limit: shown by the whole interval, refuted by the whole interval, or open.
  void judge_rate(const std::string& name, const Json& rate, double limit, const std::string& unit) {
    const double low = rate["low"], high = rate["high"];
    const std::string bound = fmt::format("at most {:.3g} per {}", limit, unit);
    if (high <= limit) {
      add(name, bound, "limits file", rate_words(rate), "met", "");
    } else if (low > limit) {
      add(name, bound, "limits file", rate_words(rate), "not met", name + ": the whole interval is above the limit");
    } else {
      add(name, bound, "limits file", rate_words(rate), "open",
          fmt::format("{}: too few trials to say; {:.0f} per {} without a single case would show it (--scenarios)",
                      name, trials_to_show(limit), unit));
    }
  }

  /// What must never be seen, unless a limit is given.
  void judge_never(const std::string& name, const Json& rate, const std::optional<double>& limit) {
    if (limit) return judge_rate(name, rate, *limit, "scenario");
    judge(rate["count"] == 0, name, "none seen", "default", rate_words(rate), name + ": " + rate_words(rate));
  }

  Json take() { return std::move(list_); }

 private:
  Json list_ = Json::array();
};

bool played(const Json& report, const char* which) {
  return report["campaign"].contains(which) && report["campaign"][which].value("played", false);
}

bool refused(const Json& report) { return !report["calibration"].value("accepted", false); }

void judge_array(const UserLimits& limits, const Json& report, Criteria& out) {
  const Json& array = report["array"];
  const int grade = array["figures_of_merit"]["strict_grade"];
  out.judge(grade >= limits.faults, "Faulty sensors isolated for good", fmt::format("at least {}", limits.faults),
            limits.faults_from, fmt::format("{} (strict grade)", grade),
            fmt::format("the array isolates {} faulty sensor{} for good, {} {} asked for", grade, grade == 1 ? "" : "s",
                        limits.faults, limits.faults == 1 ? "is" : "are"));
  const double alert_deg = deg_from_rad(limits.alert_limit_rad);
  const Json& level = array["protection_level_deg"];
  const std::string most = fmt::format("at most {:.4g} deg", alert_deg);
  if (level.is_null()) {
    out.add("Protection level against the alert limit", most, limits.alert_limit_from, "not available", "not met",
            "parity does not check every sensor, so nothing bounds the tilt error");
  } else if (refused(report)) {
    out.add("Protection level against the alert limit", most, limits.alert_limit_from,
            fmt::format("{:.4g} deg of an exact tool", level.get<double>()), "open",
            "without an accepted calibration nothing is known of the part that calibration leaves");
  } else {
    out.judge(level.get<double>() <= alert_deg, "Protection level against the alert limit", most,
              limits.alert_limit_from, fmt::format("{:.4g} deg", level.get<double>()),
              fmt::format("a tilt error of {:.4g} deg can stay undetected, the alert limit is {:.4g} deg",
                          level.get<double>(), alert_deg));
  }
  if (!limits.fault_mps2) return;
  double worst = 0.0;
  bool known = true;
  for (const Json& sensor : array["sensors"]) {
    const Json& least = sensor["thresholds_mps2"]["detectable"];
    known = known && !least.is_null();
    if (!least.is_null()) worst = std::fmax(worst, least.get<double>());
  }
  const std::string found = known ? fmt::format("{:.4g} mg0", mg0(worst)) : "not at all";
  out.judge(known && worst <= *limits.fault_mps2, "Least constant error that is detected in one block",
            fmt::format("at most {:.4g} mg0", mg0(*limits.fault_mps2)), "limits file", found,
            "a constant error is detected from " + found + " on");
}

/// A prediction says what a calibration would leave; that this tool has been calibrated it does not say.
void judge_calibration(const Json& calibration, Criteria& out) {
  const bool accepted = calibration.value("accepted", false);
  const std::string mode = calibration.value("mode", "");
  const std::string found = mode + (accepted ? ", accepted" : ", refused");
  if (accepted && mode == "predicted")
    return out.add("Calibration accepted", "an accepted fit of this tool", "default", found, "open",
                   "this tool was not calibrated: section 3 lists what to record; give the log (--positions) or the "
                   "calibration (--calibration)");
  out.judge(accepted, "Calibration accepted", "an accepted fit of this tool", "default", found,
            "the calibration was refused: " + calibration.value("reason", ""));
}

/// Seconds within which 95 % of the detected faults raised their alarm; negative where none did.
double detected_within_s(const Json& faults) {
  std::uint64_t total = 0, below = 0;
  for (const Json& count : faults["blocks_to_detect"]) total += count.get<std::uint64_t>();
  if (total == 0) return -1.0;
  int blocks = 0;
  for (const Json& count : faults["blocks_to_detect"]) {
    below += count.get<std::uint64_t>();
    ++blocks;
    if (static_cast<double>(below) >= 0.95 * static_cast<double>(total)) break;
  }
  return blocks * faults["plan"]["block_s"].get<double>();
}

/// The rate of the long campaign where the result of one was given, else that of the campaign played here.
const Json& rate_of(const Json& section, const char* name) {
  if (section.contains("reused") && section["reused"]["rates"].contains(name)) return section["reused"]["rates"][name];
  return section.contains("rates") ? section["rates"][name] : section[name];
}

void judge_campaign(const UserLimits& limits, const Json& report, Criteria& out) {
  for (const char* which : {"healthy", "faults"}) {
    if (!played(report, which))
      out.add(std::string("Campaign: ") + which, "played", "default", "not played", "open",
              "the campaign could not be played: " + report["campaign"][which].value("reason", ""));
  }
  if (played(report, "healthy")) {
    const Json& healthy = report["campaign"]["healthy"];
    if (limits.false_alarm_rate)
      out.judge_rate("False alarms", rate_of(healthy, "false_alarm_per_block"), *limits.false_alarm_rate, "block");
    const Json& alert = rate_of(healthy, "unavailable");
    out.judge(2 * alert["count"].get<std::uint64_t>() <= alert["of"].get<std::uint64_t>(),
              "Within the alert limit while healthy", "in at least half of the scenarios", "default",
              "alert in " + rate_words(alert), "an alert stands although nothing is wrong: " + rate_words(alert));
  }
  if (!played(report, "faults")) return;
  const Json& faults = report["campaign"]["faults"];
  out.judge_never("Healthy sensors excluded", rate_of(faults, "wrong_exclusion"), limits.wrong_exclusion_rate);
  out.judge_never("Misleading output", rate_of(faults, "misleading"), limits.misleading_rate);
  if (limits.detect_within_s && report["subject"].value("rows", "") == "stations") {
    out.add("Time to detect, 95 % of the detected faults", fmt::format("at most {:.4g} s", *limits.detect_within_s),
            "limits file", "not in seconds", "open",
            "rows are stations, and the array file does not say how long lies between two of them: judge the blocks to "
            "detect in section 4 by your own pace");
  } else if (limits.detect_within_s) {
    const double within_s = detected_within_s(faults);
    out.judge(within_s >= 0.0 && within_s <= *limits.detect_within_s, "Time to detect, 95 % of the detected faults",
              fmt::format("at most {:.4g} s", *limits.detect_within_s), "limits file",
              within_s < 0.0 ? "nothing detected" : fmt::format("{:.4g} s", within_s),
              "detection takes longer than asked for");
  }
  if (!report["campaign"].contains("replayed")) return;
  const Json& again = report["campaign"]["replayed"];
  out.judge(again["agree"] == again["scenarios"], "Replay by other code agrees", "every scenario", "default",
            fmt::format("{} of {}", again["agree"].get<std::uint64_t>(), again["scenarios"].get<std::uint64_t>()),
            "the campaign and its replay differ: report this");
}

void judge_requirements(const Json& trace, Criteria& out) {
  const std::size_t orphans = trace["orphans"].size();
  out.judge(orphans == 0, "Requirements, hazards and tests meet", "no orphan", "default",
            orphans == 0 ? "no orphan" : fmt::format("{} orphans", orphans),
            orphans == 0 ? "" : "orphans: " + trace["orphans"].front().get<std::string>());
  const int failed = trace["counts"]["failed"];
  // Where no result was given, that none failed says nothing: it is not judged, and the assumptions say so.
  const bool given = trace["test_results"]["given"].get<bool>() || trace["assurance_results"]["given"].get<bool>();
  if (failed == 0 && !given) return;
  out.judge(failed == 0, "Requirements failed", "none", "default", fmt::format("{}", failed),
            fmt::format("{} requirements have a test or a formal item that failed", failed));
}

/// What was measured or found elsewhere and given to the report; nothing is judged where nothing was given.
void judge_evidence(const Json& report, Criteria& out) {
  const Json& proofs = report["traceability"]["assurance_results"];
  if (proofs["given"].get<bool>()) {
    std::string failing;
    for (const Json& item : proofs["items"]) {
      if (item["result"] != "holds") failing += (failing.empty() ? "" : ", ") + item["title"].get<std::string>();
    }
    out.judge(failing.empty(), "Proofs and model checking", "every item holds", "default",
              failing.empty() ? fmt::format("{} hold", proofs["items"].size()) : "failing: " + failing,
              "an item of scripts/assure fails: " + failing);
  }
  const Json& analysis = report["analysis"];
  if (analysis["given"].get<bool>()) {
    const std::size_t findings = analysis["findings"];
    out.judge(findings == 0, "Findings of the static analysis", "none", "default", fmt::format("{}", findings),
              fmt::format("the static analysis has {} finding{}", findings, findings == 1 ? "" : "s"));
  }
  const Json& target = report["resources"]["target"];
  if (!target["given"].get<bool>()) return;
  std::string above;
  for (const Json& item : target["items"]) {
    if (item["limit"].is_number() && item["value"].get<double>() > item["limit"].get<double>())
      above += (above.empty() ? "" : ", ") + item["name"].get<std::string>();
  }
  out.judge(above.empty(), "Resources on the target", "each within its ceiling", "default",
            above.empty() ? "all within" : "above: " + above, "above its ceiling on the target: " + above);
}

/// What a row of a log of stations is taken for.
std::string row_words(const Json& subject) {
  const auto samples = subject.value("samples_per_row", std::uint64_t{1});
  if (samples > 1)
    return fmt::format(
        "Every row is the mean of {} samples, the fewest behind any row of the log of positions, and scatters by the "
        "noise of the array file over the root of that: the monitor will be given no row of fewer.",
        samples);
  return "Every row counts as one sample with the noise of the array file. Where rows are means, let `count` of "
         "[input] "
         "name the column that says of how many samples, and give the log (--positions).";
}

/// First of all: it is the one that no test of plumb can find broken.
std::string standstill_words(const UserLimits& limits) {
  if (!(limits.acceleration_bound_mps2 > 0.0))
    return "A standstill is assumed: no acceleration_bound is stated, and every figure here holds for a tool that does "
           "not accelerate while its readings are quiet. A steady acceleration across gravity is seen by no test; 30 "
           "mg "
           "turn the direction by 1.7 deg.";
  const std::string size =
      fmt::format("A steady acceleration of at most {:.4g} mg0 is allowed for", mg0(limits.acceleration_bound_mps2));
  if (limits.acceleration_turn_rad > limits.alert_limit_rad)
    return size + fmt::format(
                      ", which alone turns the direction by more than the alert limit ({:.4g} deg): the alert "
                      "never ends. A tool that accelerates by more is not covered.",
                      deg_from_rad(limits.alert_limit_rad));
  return size + fmt::format(
                    ": {:.4g} deg of every protection level, and of what the length may be off. A tool that "
                    "accelerates by more is not covered.",
                    deg_from_rad(limits.acceleration_turn_rad));
}

/// Beside it: no test tells drift that all sensors share from gravity, and what a limit does not hold is blamed on
/// somebody.
std::string drift_sentence(const UserLimits& limits) {
  return "Drift since the calibration: " + limits.drift +
         ". A healthy sensor that has drifted further can be excluded, and the direction can be off by more than the "
         "protection level. The array file states it: stability.";
}

Json assumptions_of(const UserLimits& limits, const Json& report) {
  Json out = Json::array();
  out.push_back(standstill_words(limits));
  if (!limits.drift.empty()) out.push_back(drift_sentence(limits));
  const Json& array = report["array"];
  const int grade = array["figures_of_merit"]["strict_grade"];
  out.push_back(fmt::format(
      "Not more than {} of the sensors is or are faulty at once; beyond {} (strict grade) nothing is promised.",
      limits.faults, grade));
  out.push_back(
      fmt::format("Gravity is {:.6f} m/s^2 within three times its stated sigma; the noise of every sensor is "
                  "white and as stated in the array file.",
                  array["gravity_mps2"].get<double>()));
  const std::string mode = report["calibration"].value("mode", "");
  if (mode == "predicted")
    out.push_back(
        "No calibration was given: what it leaves is predicted from a simulated stand with sensors drawn from the "
        "priors of the array file. Verify again with the real one (--positions or --calibration).");
  if (refused(report))
    out.push_back(
        "The calibration was refused: bounds and campaigns take axes, scales and biases of the array file for exact. A "
        "real tool is worse; mend the calibration before any figure here is used.");
  if (report["subject"].value("rows", "") == "stations") out.push_back(row_words(report["subject"]));
  out.push_back(
      "The campaigns speak of the scenarios that they draw: the faults, sizes and attitudes listed, in equal "
      "shares. A rate in the field is another number.");
  if (!report["traceability"]["test_results"]["given"].get<bool>())
    out.push_back("The tests of this build of plumb have passed: their results were not given (--test-results).");
  if (!report["traceability"]["assurance_results"]["given"].get<bool>())
    out.push_back(
        "The theorems and the model behind the requirements hold: their results were not given (--assurance).");
  return out;
}

Json known_limits_of(const Json& array) {
  Json out = Json::array();
  for (const Json& finding : array["warnings"]) out.push_back(finding);
  for (const Json& finding : array["known_limits"]) out.push_back(finding);
  out.push_back(
      io::object({{"name", "colluding_rotation"},
                  {"text",
                   "sensors at fault that all show one turned gravity are told from the healthy ones only where these "
                   "are enough (n >= 2m + c + 1 for m of them)"}}));
  out.push_back(
      io::object({{"name", "three_sensors"},
                  {"text",
                   "with three sensors in use only the length of gravity checks them: no protection level, no "
                   "isolation, and an error across gravity is not seen"}}));
  return out;
}

/// What not to trust, in one sentence.
std::string distrust_of(const Json& report) {
  const int grade = report["array"]["figures_of_merit"]["strict_grade"];
  std::string out = grade > 0 ? fmt::format("any output once more than {} of {} sensors {} faulty; ", grade,
                                            report["array"]["sensors"].size(), grade == 1 ? "is" : "are")
                              : std::string("which sensor is faulty: no fault is isolated; ");
  out +=
      "any output while an alert stands or only three sensors are in use; several sensors that all show the same wrong "
      "gravity";
  if (report["calibration"].value("mode", "") == "predicted")
    out += "; every figure here for a tool that was not calibrated: they are of a simulated one";
  if (refused(report)) out += "; any figure here: the calibration was refused, and they are of an exact tool";
  return out;
}

/// How many, how large, how sure, what not to trust: the questions of someone who is new to it.
Json answers_of(const Json& report) {
  Json out = Json::array();
  const auto add = [&out](const char* question, std::string value, std::string label) {
    out.push_back(io::object({{"question", question}, {"value", std::move(value)}, {"label", std::move(label)}}));
  };
  const Json& merit = report["array"]["figures_of_merit"];
  add("How many faults?", fmt::format("{}", merit["strict_grade"].get<int>()),
      fmt::format(
          "faulty sensors of {} at once are found out and left out, given several attitudes; {} at a single attitude",
          report["array"]["sensors"].size(), merit["parity_grade"].get<int>()));
  double least = 0.0, sure = 0.0;
  bool sees = true, tells = true;
  for (const Json& sensor : report["array"]["sensors"]) {
    const Json& t = sensor["thresholds_mps2"];
    sees = sees && t["detectable"].is_number();
    tells = tells && t["sure_isolation"].is_number();
    least = std::fmax(least, t["detectable"].is_number() ? t["detectable"].get<double>() : 0.0);
    sure = std::fmax(sure, t["sure_isolation"].is_number() ? t["sure_isolation"].get<double>() : 0.0);
  }
  add("How large?", sees ? fmt::format("{:.3g} mg0", mg0(least)) : "never",
      sees ? "constant error of any one sensor that raises an alarm in 999 of 1000 blocks" +
                 (tells ? fmt::format("; the sensor is named for certain above {:.3g} mg0", mg0(sure)) : std::string())
           : "nothing checks every sensor");
  const Json& level = report["array"]["protection_level_deg"];
  add("How wrong unnoticed?", level.is_number() ? fmt::format("{:.3g} deg", level.get<double>()) : "unbounded",
      std::string("tilt error that can stay without an alarm (protection level)") +
          (refused(report) ? ", were the array file exact" : ""));
  if (played(report, "faults")) {
    const Json& wrong = rate_of(report["campaign"]["faults"], "wrong_exclusion");
    add("How sure?", fmt::format("{} of {}", wrong["count"].get<std::uint64_t>(), wrong["of"].get<std::uint64_t>()),
        fmt::format(
            "simulated scenarios of the fault campaign left out a healthy sensor; with 95 % confidence the rate is "
            "below {:.2g} of such scenarios",
            wrong["high"].get<double>()));
    const Json& isolated = rate_of(report["campaign"]["faults"], "isolated");
    const Json& waits = rate_of(report["campaign"]["faults"], "ambiguous");
    add("How often left out?",
        fmt::format("{} of {}", isolated["count"].get<std::uint64_t>(), isolated["of"].get<std::uint64_t>()),
        fmt::format(
            "of the same scenarios, small faults among them, end with exactly the faulty sensors left out; {} end "
            "in an alarm with nobody left out",
            waits["count"].get<std::uint64_t>()));
  } else {
    add("How sure?", "not known", "no scenario was played");
  }
  add("What not to trust?", "Do not trust", distrust_of(report));
  return out;
}

}  // namespace

Json verdict_section(const UserLimits& limits, const Json& report) {
  Criteria criteria;
  judge_array(limits, report, criteria);
  judge_calibration(report["calibration"], criteria);
  judge_campaign(limits, report, criteria);
  judge_requirements(report["traceability"], criteria);
  judge_evidence(report, criteria);
  Json list = criteria.take();
  std::string against, open;
  for (const Json& one : list) {
    std::string& to = one["result"] == "not met" ? against : open;
    if (one["result"] != "met") to += (to.empty() ? "" : "; ") + one["reason"].get<std::string>();
  }
  const std::string name = report["subject"]["name"];
  const char* verdict = !against.empty() ? "not fit" : !open.empty() ? "open" : "fit";
  std::string sentence = name + " is fit for purpose within the limits and assumptions below" +
                         (limits.file.empty() ? "; no limits file was given, so defaults stand in for your own." : ".");
  if (!against.empty()) sentence = name + " is not fit for purpose: " + against + ".";
  if (against.empty() && !open.empty()) sentence = "Whether " + name + " is fit for purpose is open: " + open + ".";
  return io::object({{"verdict", verdict},
                     {"sentence", sentence},
                     {"limits_file", limits.file.empty() ? Json() : Json(limits.file)},
                     {"answers", answers_of(report)},
                     {"criteria", std::move(list)},
                     {"requirements", report["traceability"]["counts"]},
                     {"orphans", report["traceability"]["orphans"]},
                     {"assumptions", assumptions_of(limits, report)},
                     {"known_limits", known_limits_of(report["array"])}});
}

}  // namespace report
}  // namespace PLUMB_ABI
}  // namespace plumb

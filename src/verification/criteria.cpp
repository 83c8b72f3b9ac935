// What was asked for against what was found.
#include <fmt/format.h>

#include <cmath>

#include "field_figures.hpp"
#include "plumb/core/units.hpp"
#include "plumb/scenario/count_text.hpp"
#include "plumb/study/proportion.hpp"
#include "plumb/verification/verdict.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace verification {
namespace {

/// "3 of 20000, 95 % interval 3.09e-05 to 0.000439".
std::string rate_words(const Rate& rate) {
  return fmt::format("{} of {}, {}", rate.count, rate.of,
                     study::interval_words({rate.count, rate.of, rate.low, rate.high}));
}

/// Scenarios without any case that show a rate below the limit: 1 - (1 - limit)^n >= 97.5 %.
double trials_to_show(double limit) { return std::ceil(std::log(0.025) / std::log1p(-limit)); }

/// What was asked for.
struct Asked {
  std::string limit, from = "default";
};

class Criteria {
 public:
  void add(CriterionId id, Asked asked, std::string found, Result result, std::string reason) {
    list_.push_back({id, result, std::move(asked.limit), std::move(asked.from), std::move(found), std::move(reason)});
  }

  /// `reason`: why not.
  void judge(CriterionId id, bool met, Asked asked, std::string found, const std::string& reason) {
    add(id, std::move(asked), std::move(found), met ? Result::met : Result::not_met, met ? "" : reason);
  }

  /// A rate against a limit: shown by the whole interval, refuted by the whole interval, or open.
  void judge_rate(CriterionId id, const Rate& rate, double limit, const char* unit) {
    const std::string title = entry_of(id).title;
    const Asked asked{fmt::format("at most {:.3g} per {}", limit, unit), "limits file"};
    if (rate.high <= limit) return add(id, asked, rate_words(rate), Result::met, "");
    if (rate.low > limit)
      return add(id, asked, rate_words(rate), Result::not_met, title + ": the whole interval is above the limit");
    add(id, asked, rate_words(rate), Result::open,
        fmt::format("{}: too few trials; {:.0f} per {} without a case are needed (--scenarios)", title,
                    trials_to_show(limit), unit));
  }

  /// What must never be seen, unless a limit is given.
  void judge_never(CriterionId id, const Rate& rate, const std::optional<double>& limit) {
    if (limit) return judge_rate(id, rate, *limit, "scenario");
    judge(id, rate.count == 0, {"no case"}, rate_words(rate), entry_of(id).title + (": " + rate_words(rate)));
  }

  std::vector<Criterion> take() { return std::move(list_); }

 private:
  std::vector<Criterion> list_;
};

/// The names of those that fail, with commas.
template <class List, class Fails, class Name>
std::string failing(const List& list, Fails&& fails, Name&& name) {
  std::string out;
  for (const auto& item : list) {
    if (fails(item)) out += (out.empty() ? "" : ", ") + name(item);
  }
  return out;
}

void judge_protection(const UserLimits& limits, const Facts& facts, Criteria& out) {
  const double alert_deg = deg_from_rad(limits.alert_limit_rad);
  const std::optional<double>& level = facts.array.protection_level_deg;
  const AlignmentFacts& alignment = facts.alignment;
  const char* const frame = alignment.in_housing ? "in the housing" : "in the calibrated axes";
  const Asked asked{fmt::format("at most {:.4g} deg {}", alert_deg, frame), limits.alert_limit_from};
  if (!level)
    return out.add(CriterionId::protection_level, asked, "not available", Result::not_met,
                   "parity does not check every sensor, so the tilt error has no bound");
  if (!facts.calibration.accepted)
    return out.add(CriterionId::protection_level, asked, fmt::format("{:.4g} deg of an exact tool", *level),
                   Result::open, "without an accepted calibration the calibration error is unknown");
  if (!alignment.in_housing) {
    return out.judge(CriterionId::protection_level, *level <= alert_deg, asked, fmt::format("{:.4g} deg", *level),
                     fmt::format("a tilt error of {:.4g} deg can stay undetected, the alert limit is {:.4g} deg",
                                 *level, alert_deg));
  }
  const double turned_deg = alignment.bound_deg.value_or(180.0), whole_deg = std::fmin(*level + turned_deg, 180.0);
  const Result result = whole_deg <= alert_deg ? Result::met : *level <= alert_deg ? Result::open : Result::not_met;
  out.add(CriterionId::protection_level, asked,
          fmt::format("{:.4g} deg, and {:.3g} deg of alignment", *level, turned_deg), result,
          result == Result::met
              ? std::string()
              : fmt::format("the direction in the housing may be off by {:.3g} deg, the alert limit is "
                            "{:.4g} deg: {}; {}",
                            whole_deg, alert_deg, alignment.text, alignment.remedy));
}

void judge_array(const UserLimits& limits, const Facts& facts, Criteria& out) {
  const int grade = facts.array.confirmed_grade;
  out.judge(CriterionId::faults_isolated, grade >= limits.faults,
            {fmt::format("at least {}", limits.faults), limits.faults_from}, fmt::format("{} (confirmed grade)", grade),
            fmt::format("the array isolates {} with confirmation, {} {} required",
                        facts.array.chips() ? count_text(grade, "faulty unit") + " (chips, and sensors on none)"
                                            : count_text(grade, "faulty sensor"),
                        limits.faults, by_count(limits.faults, "is", "are")));
  judge_protection(limits, facts, out);
  if (!limits.fault_mps2) return;
  double worst = 0.0;
  bool known = true;
  for (const SensorFacts& sensor : facts.array.sensors) {
    known = known && sensor.detectable_mps2;
    worst = std::fmax(worst, sensor.detectable_mps2.value_or(0.0));
  }
  const std::string found = known ? fine_words(worst, facts.array.field, 4) : "not at all";
  out.judge(CriterionId::detectable_fault, known && worst <= *limits.fault_mps2,
            {"at most " + fine_words(*limits.fault_mps2, facts.array.field, 4), "limits file"}, found,
            "a constant error is detected from " + found + " on");
}

/// A prediction says what a calibration would leave; that this tool has been calibrated it does not say.
void judge_calibration(const CalibrationFacts& calibration, Criteria& out) {
  const Asked asked{"an accepted fit of this tool"};
  const std::string found = calibration.mode + (calibration.accepted ? ", accepted" : ", refused");
  if (calibration.accepted && calibration.predicted())
    return out.add(CriterionId::calibration_accepted, asked, found, Result::open,
                   "this tool was not calibrated: section 3 lists what to record; give the log (--stations) or the "
                   "calibration (--calibration)");
  if (calibration.accepted && calibration.stated())
    return out.add(CriterionId::calibration_accepted, asked, calibration.mode + ", not fitted", Result::open,
                   "no station of this tool has tested the coefficients that were stated: record some attitudes and "
                   "calibrate with plumb calibrate --log");
  out.judge(CriterionId::calibration_accepted, calibration.accepted, asked, found,
            "the calibration was refused: " + calibration.reason);
}

/// A field shows no exchange or reversal that amounts to a turn or a mirror image of the array, so that nothing but a
/// known attitude can close this; of magnetometers the accelerometers, to which the dip ties them.
void judge_wiring(const WiringFacts& wiring, io::FieldKind field, Criteria& out) {
  using State = WiringFacts::State;
  const Result result = wiring.state == State::confirmed ? Result::met
                        : wiring.state == State::open    ? Result::open
                                                         : Result::not_met;
  const bool magnetic = is_magnetic(field);
  out.add(CriterionId::wiring_confirmed,
          {magnetic ? "axes aligned to the accelerometers by the dip"
                    : "a station of known attitude that excludes every other wiring"},
          !wiring.found.empty() ? wiring.found
          : magnetic            ? "not aligned"
                                : "no station of known attitude",
          result, wiring.state == State::confirmed ? "" : wiring.reason);
}

/// Seconds within which 95 % of the detected faults raised their alarm; negative where none did.
double detected_within_s(const FaultCampaign& faults) {
  std::uint64_t total = 0, below = 0;
  for (const std::uint64_t count : faults.blocks_to_detect) total += count;
  if (total == 0) return -1.0;
  int blocks = 0;
  for (const std::uint64_t count : faults.blocks_to_detect) {
    below += count;
    ++blocks;
    if (static_cast<double>(below) >= 0.95 * static_cast<double>(total)) break;
  }
  return blocks * faults.block_s;
}

void judge_time(double limit_s, const Facts& facts, Criteria& out) {
  const Asked asked{fmt::format("at most {:.4g} s", limit_s), "limits file"};
  if (facts.rows_are_stations)
    return out.add(CriterionId::time_to_detect, asked, "not in seconds", Result::open,
                   "rows are stations, and the array file does not say how long lies between two of them: use the "
                   "blocks to detect in section 4");
  const double within_s = detected_within_s(facts.faults);
  out.judge(CriterionId::time_to_detect, within_s >= 0.0 && within_s <= limit_s, asked,
            within_s < 0.0 ? "nothing detected" : fmt::format("{:.4g} s", within_s),
            "detection takes longer than the limit");
}

void judge_played(CriterionId id, bool played, const std::string& reason, Criteria& out) {
  if (!played) out.add(id, {"played"}, "not run", Result::open, "the campaign could not run: " + reason);
}

void judge_campaign(const UserLimits& limits, const Facts& facts, Criteria& out) {
  judge_played(CriterionId::healthy_campaign_played, facts.healthy.played, facts.healthy.reason, out);
  judge_played(CriterionId::fault_campaign_played, facts.faults.played, facts.faults.reason, out);
  if (facts.healthy.played) {
    if (limits.false_alarm_rate)
      out.judge_rate(CriterionId::false_alarms, facts.healthy.false_alarm_per_block, *limits.false_alarm_rate, "block");
    const Rate& alert = facts.healthy.unavailable;
    out.judge(CriterionId::available_while_healthy, 2 * alert.count <= alert.of, {"in at least half of the scenarios"},
              "alert in " + rate_words(alert), "alert without a fault: " + rate_words(alert));
  }
  if (!facts.faults.played) return;
  out.judge_never(CriterionId::wrong_exclusion, facts.faults.wrong_exclusion, limits.wrong_exclusion_rate);
  out.judge_never(CriterionId::misleading, facts.faults.misleading, limits.misleading_rate);
  if (limits.detect_within_s) judge_time(*limits.detect_within_s, facts, out);
  if (!facts.replay) return;
  out.judge(CriterionId::replay_agrees, facts.replay->agree == facts.replay->scenarios, {"every scenario"},
            fmt::format("{} of {}", facts.replay->agree, facts.replay->scenarios),
            "the campaign and its replay differ: report this");
}

void judge_requirements(const TraceFacts& trace, Criteria& out) {
  const std::size_t orphans = trace.orphans.size();
  out.judge(CriterionId::requirements_traced, orphans == 0, {"complete"},
            orphans == 0 ? "complete" : fmt::format("{} gaps", orphans),
            orphans == 0 ? "" : "orphans: " + trace.orphans.front());
  // Where no result was given, that none failed says nothing: it is not judged, and the assumptions say so.
  if (trace.counts.failed == 0 && !trace.tests_given && !trace.proofs) return;
  out.judge(CriterionId::requirements_failed, trace.counts.failed == 0, {"none"},
            fmt::format("{}", trace.counts.failed),
            fmt::format("{} {} a test or a formal item that failed", count_text(trace.counts.failed, "requirement"),
                        by_count(trace.counts.failed, "has", "have")));
}

/// Results are evidence only of the build that they were made by.
void judge_results(const TraceFacts& trace, Criteria& out) {
  const auto given = [&out](CriterionId id, bool is_given, const std::string& other, const char* how) {
    const std::string what =
        id == CriterionId::tests_of_this_build ? "the results of the tests" : "the results of the proofs";
    const Asked asked{"given, and of this version, commit and compiler"};
    if (!is_given) return out.add(id, asked, "not given", Result::open, what + " are not given (" + how + ")");
    out.add(id, asked, other.empty() ? "of this build" : other, other.empty() ? Result::met : Result::open,
            other.empty() ? "" : what + " are evidence of another build: " + other);
  };
  given(CriterionId::tests_of_this_build, trace.tests_given, trace.tests_not_of_this,
        "--test-results build/release/junit.xml, which scripts/test --all writes");
  if (trace.tests_given) {
    const RequirementCounts& n = trace.counts;
    const std::string found = fmt::format("{} of {} active", n.verified, n.active);
    out.add(CriterionId::requirements_verified, {"every active one"}, found,
            n.active > 0 && n.verified == n.active ? Result::met : Result::open,
            n.active > 0 && n.verified == n.active
                ? ""
                : "only " + found + " requirements are verified: some of their tests did not run");
  }
  given(CriterionId::proofs_of_this_build, trace.proofs.has_value(), trace.proofs_not_of_this,
        "--assurance build/assure/results.json, which scripts/assure writes");
}

/// What was measured or found elsewhere and given to the report; nothing is judged where nothing was given.
void judge_evidence(const Facts& facts, Criteria& out) {
  if (facts.trace.proofs) {
    const std::string broken = failing(
        *facts.trace.proofs, [](const ProofItem& p) { return !p.holds; }, [](const ProofItem& p) { return p.title; });
    out.judge(CriterionId::proofs_hold, broken.empty(), {"every item holds"},
              broken.empty() ? fmt::format("{} hold", facts.trace.proofs->size()) : "failing: " + broken,
              "an item of scripts/assure fails: " + broken);
  }
  if (facts.analysis_findings) {
    const std::uint64_t findings = *facts.analysis_findings;
    out.judge(CriterionId::analysis_findings, findings == 0, {"none"}, fmt::format("{}", findings),
              fmt::format("the static analysis has {}", count_text(findings, "finding")));
  }
  if (!facts.target) return;
  const std::string above = failing(
      *facts.target, [](const Resource& r) { return r.limit && r.value > *r.limit; },
      [](const Resource& r) { return r.name; });
  out.judge(CriterionId::target_resources, above.empty(), {"each within its ceiling"},
            above.empty() ? "all within" : "above: " + above, "above its ceiling on the target: " + above);
}

}  // namespace

std::vector<Criterion> judge_criteria(const UserLimits& limits, const Facts& facts) {
  Criteria out;
  judge_array(limits, facts, out);
  judge_calibration(facts.calibration, out);
  judge_wiring(facts.wiring, facts.array.field, out);
  judge_campaign(limits, facts, out);
  judge_requirements(facts.trace, out);
  judge_results(facts.trace, out);
  judge_evidence(facts, out);
  return out.take();
}

}  // namespace verification
}  // namespace PLUMB_ABI
}  // namespace plumb

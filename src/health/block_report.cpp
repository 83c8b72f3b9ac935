#include "plumb/health/detail/block_report.hpp"

#include <cmath>
#include <limits>

#include "plumb/detection/alarm_form.hpp"
#include "plumb/detection/mae_test.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

namespace {

/// In suspect a block is clean below this part of its limit.
double clear_fraction(const JudgeTerms& terms) noexcept {
  return terms.suspect ? terms.settings.config.clear_fraction : 1.0;
}

/// Eqs (26)-(29) for every triple that votes and whose window is full.
void judge_mae(const BlockTests& tests, const JudgeTerms& terms, BlockReport& report) noexcept {
  const BlockEvidence& evidence = tests.block();
  const SensorArray& array = terms.in_force.array;
  const MonitorConfig& config = terms.settings.config;
  const double clear = clear_fraction(terms), quantile = terms.settings.mae_quantile;
  for (int k = 0; k < array.triple_count(); ++k) {
    const Triple& triple = array.triple(k);
    if (!triple.votes || !(terms.in_service & evidence.usable).contains(triple.set()) ||
        terms.mae.triple_samples(k) != config.window)
      continue;
    const double mae = terms.mae.triple_mps2(k);
    MaeLimit limit = given_mae_limit(config.delta_f_mps2);
    if (!(config.delta_f_mps2 > 0.0)) {
      const MaeLimit least = least_mae_limit(array, triple, evidence, config.window, quantile);
      const double ratio = std::fmax(least.ratio(mae), 0.0);
      if (report.mae_limit_mps2 != 0.0 && mae <= least.clear_mps2(clear) && ratio <= 1.0 && ratio <= report.mae_ratio) {
        // Clean, and not the worst: the systematic part would only take it farther from the limit.
        report.triples_tested.add(k);
        report.triples_passed.add(k);
        continue;
      }
      const SetTest& t = tests.of(triple.set());
      if (!t.tested) continue;
      limit = computed_mae_limit(t, evidence, config.window, quantile);
    }
    // Comparisons are written so that what is not a number is beyond its limit.
    if (!(mae <= limit.clear_mps2(clear))) report.mae_clean = false;
    const double told = limit.ratio(mae);
    const double ratio = std::isnan(told) ? std::numeric_limits<double>::infinity() : told;
    report.triples_tested.add(k);
    if (ratio <= 1.0) report.triples_passed.add(k);
    if (ratio > report.mae_ratio || report.mae_limit_mps2 == 0.0) {
      report.mae_ratio = ratio;
      report.mae_worst_mps2 = mae;
      report.mae_limit_mps2 = limit.limit_mps2();
    }
  }
}

void decided(BlockReport& report, BlockKind kind, Cause cause, Cause by, double statistic, double limit) noexcept {
  report.kind = kind;
  report.cause = cause;
  report.decided_by = by;
  report.statistic = statistic;
  report.limit = limit;
}

/// Within every limit: the test that came nearest to its own is the one that is reported.
void decide_clean(const JudgeTerms& terms, BlockReport& report) noexcept {
  const SetTest& t = report.used;
  const TestLimits& limits = terms.settings.limits;
  const bool has_parity = t.parity_rows > 0;
  const double worst = std::fmax(report.parity_ratio, std::fmax(report.norm_ratio, report.mae_ratio));
  // In suspect, clean means a part of the noise limit with the systematic bound on top: scaling that bound too would
  // lock out a healthy tool whose gravity is off by what its sigma allows.
  const double f = clear_fraction(terms);
  const double parity_noise = has_parity ? t.parity_alarm_limit(limits) - t.parity_systematic : 0.0;
  const double norm_noise = t.norm_alarm_limit(limits) - t.norm_systematic;
  const bool parity_clean = t.parity <= f * parity_noise + t.parity_systematic;
  const bool norm_clean = std::fabs(t.norm) <= f * norm_noise + t.norm_systematic;
  const BlockKind kind =
      parity_clean && norm_clean && report.mae_clean && !terms.partial ? BlockKind::clean : BlockKind::soft;
  if (worst == report.parity_ratio && has_parity) {
    decided(report, kind, Cause::passed_block, Cause::parity, t.parity, t.parity_alarm_limit(limits));
  } else if (worst == report.mae_ratio) {
    decided(report, kind, Cause::passed_block, Cause::mae, report.mae_worst_mps2, report.mae_limit_mps2);
  } else {
    decided(report, kind, Cause::passed_block, Cause::norm, std::fabs(t.norm), t.norm_alarm_limit(limits));
  }
}

}  // namespace

BlockReport judge(const BlockTests& tests, const JudgeTerms& terms) noexcept {
  const SensorSet used = terms.in_service & tests.block().usable;
  const TestLimits& limits = terms.settings.limits;
  BlockReport report;
  report.used = tests.of(used);
  if (!report.used.tested) return report;
  if (terms.settings.config.alarm_form == AlarmForm::average_tool && !terms.in_force.owes_calibration())
    report.used = in_quadrature(terms.in_force.array, terms.in_force.gravity, tests.block(), used, report.used,
                                limits.acceleration_mps2);
  const SetTest& t = report.used;
  if (t.parity_rows > 0) report.parity_ratio = t.parity / t.parity_alarm_limit(limits);
  report.norm_ratio = std::fabs(t.norm) / t.norm_alarm_limit(limits);
  // By the datasheet alone a weak triple may be off by more than its limit, which is linear in what the datasheet
  // leaves open. Parity is linear indeed, and the norm of all is nearly so.
  if (!terms.in_force.owes_calibration()) judge_mae(tests, terms, report);
  if (!(report.parity_ratio <= 1.0)) {
    decided(report, BlockKind::alarm, Cause::parity, Cause::parity, t.parity, t.parity_alarm_limit(limits));
  } else if (!(report.norm_ratio <= 1.0)) {
    const bool corroborated = tests.corroborates_norm(used, t);
    decided(report, corroborated ? BlockKind::reference : BlockKind::alarm,
            corroborated ? Cause::norm_mismatch : Cause::norm, Cause::norm, std::fabs(t.norm),
            t.norm_alarm_limit(limits));
  } else if (report.mae_ratio > 1.0) {
    decided(report, BlockKind::alarm, Cause::mae, Cause::mae, report.mae_worst_mps2, report.mae_limit_mps2);
  } else {
    decide_clean(terms, report);
  }
  return report;
}

}  // namespace PLUMB_ABI
}  // namespace plumb

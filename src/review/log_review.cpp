#include "plumb/review/log_review.hpp"

#include <algorithm>
#include <cmath>

#include "agreement.hpp"
#include "chip_checks.hpp"
#include "chips.hpp"
#include "limits.hpp"
#include "timeline.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace review {
namespace {

void set_stretches(const std::vector<Cell>& rest, double block_s, LogReview& out) {
  for (const Cell& cell : rest) {
    Stretch stretch;
    stretch.from_s = std::max(static_cast<double>(cell.span.from) * block_s, out.from_s);
    stretch.to_s = std::min(static_cast<double>(cell.span.to) * block_s, out.to_s);
    out.at_rest_s += stretch.to_s - stretch.from_s;
    for (const Reading& reading : readings_of(cell)) {
      stretch.mean_mps2.push_back(reading.there ? reading.mean_mps2 : logs::kAbsentAxes);
      stretch.uncertainty_mps2.push_back(reading.there ? reading.allowed_mps2 : logs::kAbsent);
    }
    out.stretches.push_back(stretch);
  }
}

bool several_attitudes(const LogReview& review) {
  for (std::size_t chip = 0; chip < review.chips.size(); ++chip) {
    for (const Stretch& one : review.stretches) {
      for (const Stretch& other : review.stretches) {
        if (std::isfinite(one.mean_mps2[chip][0]) && std::isfinite(other.mean_mps2[chip][0]) &&
            angle_deg(one.mean_mps2[chip], other.mean_mps2[chip]) > kAttitude_deg) {
          return true;
        }
      }
    }
  }
  return false;
}

void set_open(const LogDigest& digest, bool moved, LogReview& out) {
  if (out.chips.size() == 1) out.open.push_back(OpenQuestion::one_chip);
  if (out.chips.size() == 2) out.open.push_back(OpenQuestion::two_chips);
  if (out.stretches.empty()) {
    out.open.push_back(OpenQuestion::never_at_rest);
  } else if (!several_attitudes(out)) {
    out.open.push_back(OpenQuestion::one_attitude);
  }
  if (!moved) out.open.push_back(OpenQuestion::never_in_motion);
  const bool slow = std::all_of(out.chips.begin(), out.chips.end(),
                                [](const ChipSummary& chip) { return !(chip.rate_hz >= kFastHz); });
  if (slow) out.open.push_back(OpenQuestion::slow_log);
  const auto any = [&out](auto holds) { return std::any_of(out.chips.begin(), out.chips.end(), holds); };
  if (any([](const ChipSummary& chip) { return chip.calibration.more; }))
    out.open.push_back(OpenQuestion::more_calibration);
  if (out.chips.size() > 1 && any([](const ChipSummary& chip) { return !chip.compared && !chip.calibration.more; }))
    out.open.push_back(OpenQuestion::not_compared);
  const bool parameters = std::any_of(digest.parameters.begin(), digest.parameters.end(),
                                      [](const auto& one) { return one.first.rfind("INS_USE", 0) != 0; });
  if (!parameters) out.open.push_back(OpenQuestion::no_calibration_in_log);
}

/// Chips whose direction is not to be compared: mounted in another way, or with other axes.
void leave_out_turned(const LogReview& review, std::vector<Cell>& motion) {
  for (const Finding& finding : review.findings) {
    if (finding.code != FindingCode::orientation) continue;
    for (Cell& cell : motion) {
      cell.readings[finding.chip] = SourceBlock{};
      if (finding.other != kNoChip) cell.readings[finding.other] = SourceBlock{};
    }
  }
}

/// Runs of one and the same thing become one finding with the worst figure; the place is that of the worst.
void clamp_places(LogReview& out) {
  for (Finding& finding : out.findings) {
    if (finding.from_s < out.from_s) finding.from_s = out.from_s;
    if (finding.to_s > out.to_s) finding.to_s = out.to_s;
  }
}

void merge_runs(std::vector<Finding>& findings) {
  std::vector<Finding> out;
  for (const Finding& finding : findings) {
    const auto same = std::find_if(out.begin(), out.end(), [&](const Finding& one) {
      return one.code == finding.code && one.chip == finding.chip && one.other == finding.other &&
             one.axis == finding.axis;
    });
    if (same == out.end()) {
      out.push_back(finding);
      continue;
    }
    const std::uint64_t times = same->times + finding.times;
    const bool worse = finding.grade > same->grade ||
                       (finding.grade == same->grade && finding.to_s - finding.from_s > same->to_s - same->from_s);
    if (worse) *same = finding;
    same->times = times;
  }
  std::stable_sort(out.begin(), out.end(), [](const Finding& a, const Finding& b) {
    // Of equal grade, what is told of one chip comes before what is not.
    return a.grade != b.grade ? a.grade > b.grade : (a.other == kNoChip && b.other != kNoChip);
  });
  findings = std::move(out);
}

/// Where one of two that differ is told elsewhere in the log, it is likely the one here too.
void name_likely(std::vector<Finding>& findings) {
  const auto differs = [](const Finding& one) {
    return one.code == FindingCode::disagreement || one.code == FindingCode::motion_disagreement;
  };
  const auto told = [&](std::size_t chip) {
    return std::any_of(findings.begin(), findings.end(), [&](const Finding& one) {
      return one.chip == chip && one.other == kNoChip && (differs(one) || one.code == FindingCode::gravity_length);
    });
  };
  for (Finding& finding : findings) {
    if (finding.other == kNoChip || !differs(finding)) continue;
    const bool first = told(finding.chip), second = told(finding.other);
    if (first != second) finding.likely = first ? finding.chip : finding.other;
  }
}

void note_damage(const LogDigest& digest, LogReview& out) {
  out.notes = digest.notes;
  const std::uint64_t unread = digest.extent.bytes - std::min(digest.extent.bytes, digest.extent.read_bytes);
  if (unread == 0 || out.chips.empty()) return;
  Finding finding;
  finding.code = FindingCode::damage;
  finding.figure = static_cast<double>(unread);
  finding.limit = static_cast<double>(digest.extent.bytes);
  out.findings.push_back(finding);
}

}  // namespace

LogReview review_log(const LogDigest& digest, const ReviewSettings& settings) {
  LogReview out;
  out.name = digest.name;
  out.understood = digest.understood;
  out.extent = digest.extent;
  out.chips = chips_of(digest);
  for (const ChipSummary& chip : out.chips) {
    out.from_s = std::fmin(out.from_s, chip.from_s);
    out.to_s = std::fmax(out.to_s, chip.to_s);
  }
  GravityKnown gravity{kEarthMiddle_mps2, kEarthHalf_mps2};
  if (settings.gravity_mps2) gravity = {*settings.gravity_mps2, 0.0};
  out.gravity_mps2 = gravity.middle_mps2;
  out.gravity_half_mps2 = gravity.half_mps2;
  const std::vector<Span> spans = spans_at_rest(digest);
  const std::vector<Cell> rest = cells_at_rest(digest, out.chips, spans);
  std::vector<Cell> motion = cells_in_motion(digest, out.chips, spans);
  set_stretches(rest, digest.block_s, out);
  check_length(rest, digest.block_s, gravity, out);
  judge_rest(rest, digest, gravity, out);
  leave_out_turned(out, motion);
  judge_motion(motion, digest, gravity, out);
  check_noise(rest, digest, out);
  check_drift(spans, digest, out);
  check_change(out);
  check_vibration(motion, digest, out);
  check_clipping(digest, out);
  check_stuck(digest, out);
  check_times(digest, out);
  check_calibration(digest, out);
  check_autopilot(spans, digest, out);
  note_damage(digest, out);
  clamp_places(out);
  merge_runs(out.findings);
  name_likely(out.findings);
  set_open(digest, !motion.empty(), out);
  const bool any_compared =
      std::any_of(out.chips.begin(), out.chips.end(), [](const ChipSummary& c) { return c.compared; });
  out.judged = !out.chips.empty() && (!out.stretches.empty() || any_compared);
  for (const Finding& finding : out.findings) out.grade = std::max(out.grade, finding.grade);
  return out;
}

}  // namespace review
}  // namespace PLUMB_ABI
}  // namespace plumb

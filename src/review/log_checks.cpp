// What a chip shows by itself at any time: vibration, clipping, axes that stand still, times, the calibration it has.
#include <algorithm>
#include <cmath>
#include <set>

#include "chip_checks.hpp"
#include "chips.hpp"
#include "limits.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace review {
namespace {

double time_of(std::int64_t block, const LogDigest& digest) { return static_cast<double>(block) * digest.block_s; }

Finding finding_of(FindingCode code, Grade grade, std::size_t chip, double figure, double limit) {
  Finding out;
  out.code = code;
  out.grade = grade;
  out.chip = chip;
  out.figure = figure;
  out.limit = limit;
  return out;
}

/// Consecutive blocks of a source in which an axis reads one value and nothing else.
struct Still {
  std::size_t first = 0, last = 0;
  double readings = 0.0;
};

bool constant(const SourceBlock& block, std::size_t axis) noexcept {
  return !(block.most_mps2[axis] - block.least_mps2[axis] > 0.0);
}

/// The longest run of each kind: `mask` has the axes that must not change.
Still longest_still(const std::vector<SourceBlock>& blocks, const std::vector<std::size_t>& axes) {
  Still best;
  Still run;
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    const bool still = std::all_of(axes.begin(), axes.end(), [&](std::size_t k) { return constant(blocks[b], k); });
    const bool follows = run.readings > 0.0 && std::all_of(axes.begin(), axes.end(), [&](std::size_t k) {
                           return !(std::abs(blocks[b].mean_mps2[k] - blocks[run.last].mean_mps2[k]) > 0.0);
                         });
    if (!still) {
      run.readings = 0.0;
      continue;
    }
    if (!follows) {
      run.first = b;
      run.readings = 0.0;
    }
    run.last = b;
    run.readings += blocks[b].records;
    if (run.readings > best.readings) best = run;
  }
  return best;
}

/// The greatest change within the span that any axis but those of `but_chip` in `but_axes` shows.
double seen_by_others(const LogDigest& digest, const std::vector<ChipSummary>& chips, const Span& span,
                      std::size_t but_chip, const std::vector<std::size_t>& but_axes) {
  double out = 0.0;
  for (std::size_t i = 0; i < chips.size(); ++i) {
    const SourceBlock block = reading_of(digest, chips[i], span.from, span.to);
    if (block.records < 2) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const bool left_out = i == but_chip && std::find(but_axes.begin(), but_axes.end(), k) != but_axes.end();
      if (!left_out) out = std::max(out, block.most_mps2[k] - block.least_mps2[k]);
    }
  }
  return out;
}

/// Whether the other axes of the chip changed in each block of the run: what is coarse stands still in all of them now
/// and then.
bool others_busy(const std::vector<SourceBlock>& blocks, const Still& run, std::size_t axis) {
  for (std::size_t b = run.first; b <= run.last; ++b) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (k != axis && blocks[b].records > 1 && constant(blocks[b], k)) return false;
    }
  }
  return true;
}

void add_still(const LogDigest& digest, std::size_t chip, const std::vector<std::size_t>& axes, LogReview& out) {
  const std::vector<SourceBlock>& blocks = digest.sources[out.chips[chip].judged].blocks;
  const Still run = longest_still(blocks, axes);
  if (run.readings < kUnchangedInMotion) return;
  const Span span{blocks[run.first].index, blocks[run.last].index + 1};
  const bool moved = seen_by_others(digest, out.chips, span, chip, axes) > kMotionSeen_mps2;
  const bool whole = axes.size() == 3;
  const bool long_enough = run.readings >= kUnchangedReadings && (whole || others_busy(blocks, run, axes.front()));
  if (!moved && !long_enough) return;
  Finding finding =
      finding_of(whole ? FindingCode::chip_frozen : FindingCode::axis_stuck, moved ? Grade::red : Grade::orange, chip,
                 blocks[run.last].mean_mps2[axes.front()], run.readings);
  finding.axis = whole ? -1 : static_cast<int>(axes.front());
  finding.from_s = time_of(span.from, digest);
  finding.to_s = time_of(span.to, digest);
  out.findings.push_back(finding);
}

}  // namespace

void check_vibration(const std::vector<Cell>& motion, const LogDigest& digest, LogReview& out) {
  for (std::size_t chip = 0; chip < out.chips.size(); ++chip) {
    ChipSummary& summary = out.chips[chip];
    const bool spread = digest.sources[summary.judged].source.kind == logs::RecordKind::mean;
    if (!(summary.rate_hz >= kFastHz) && !spread) continue;
    int axis = -1;
    for (const Cell& cell : motion) {
      const SourceBlock& block = cell.readings[chip];
      if (block.weight < kWindowReadings) continue;
      for (std::size_t k = 0; k < 3; ++k) {
        if (!(block.deviation_mps2(k) > (axis < 0 ? -1.0 : summary.vibration_mps2))) continue;
        summary.vibration_mps2 = block.deviation_mps2(k);
        summary.vibration_at_s = time_of(cell.span.from, digest);
        axis = static_cast<int>(k);
      }
    }
    if (axis < 0 || summary.vibration_mps2 <= kVibration_mps2) continue;
    Finding finding =
        finding_of(FindingCode::vibration, summary.vibration_mps2 > kStrongVibration_mps2 ? Grade::red : Grade::orange,
                   chip, summary.vibration_mps2, kVibration_mps2);
    finding.axis = axis;
    finding.from_s = finding.to_s = summary.vibration_at_s;
    out.findings.push_back(finding);
  }
}

void check_clipping(const LogDigest& digest, LogReview& out) {
  for (std::size_t chip = 0; chip < out.chips.size(); ++chip) {
    const ChipSummary& summary = out.chips[chip];
    if (static_cast<double>(summary.clipped) <= kClippedReadings) continue;
    double readings = 0.0;
    Finding finding =
        finding_of(FindingCode::clipping, Grade::orange, chip, static_cast<double>(summary.clipped), kClippedReadings);
    for (const std::size_t source : summary.sources) {
      double here = 0.0;
      for (const SourceBlock& block : digest.sources[source].blocks) {
        here += block.weight;
        if (block.clipped[0] + block.clipped[1] + block.clipped[2] == 0) continue;
        finding.from_s = std::fmin(finding.from_s, time_of(block.index, digest));
        finding.to_s = std::fmax(finding.to_s, time_of(block.index + 1, digest));
      }
      readings = std::max(readings, here);
    }
    if (finding.figure > kClippedShare * readings) finding.grade = Grade::red;
    out.findings.push_back(finding);
  }
}

void check_stuck(const LogDigest& digest, LogReview& out) {
  for (std::size_t chip = 0; chip < out.chips.size(); ++chip) {
    const std::size_t before = out.findings.size();
    add_still(digest, chip, {0, 1, 2}, out);
    if (out.findings.size() > before) continue;
    for (std::size_t axis = 0; axis < 3; ++axis) add_still(digest, chip, {axis}, out);
  }
}

void check_times(const LogDigest& digest, LogReview& out) {
  for (std::size_t chip = 0; chip < out.chips.size(); ++chip) {
    const ChipSummary& summary = out.chips[chip];
    const SourceDigest& source = digest.sources[summary.judged];
    const double length_s = summary.to_s - summary.from_s;
    const Intervals::Gaps gaps = source.intervals.gaps(kGapIntervals);
    const double usual_s = source.intervals.usual_s();
    const bool long_gap = source.longest_gap_s > std::max(kLongGap_s, kGapIntervals * usual_s);
    if (gaps.lost_s > kLostShare * length_s || long_gap) {
      Finding finding = finding_of(FindingCode::gaps, Grade::orange, chip, gaps.lost_s, kLostShare * length_s);
      finding.times = gaps.count;
      finding.from_s = source.longest_gap_at_s;
      finding.to_s = source.longest_gap_at_s + source.longest_gap_s;
      out.findings.push_back(finding);
    }
    if (source.backwards > 0) {
      out.findings.push_back(
          finding_of(FindingCode::backwards, Grade::orange, chip, static_cast<double>(source.backwards), 0.0));
    }
    const double silent_s = out.to_s - summary.to_s;
    if (silent_s > std::max(kStopped_s, kGapIntervals * usual_s)) {
      Finding finding = finding_of(FindingCode::stopped, Grade::red, chip, silent_s, kStopped_s);
      finding.from_s = summary.to_s;
      finding.to_s = out.to_s;
      out.findings.push_back(finding);
    }
  }
}

void check_calibration(const LogDigest& digest, LogReview& out) {
  const bool ids = std::any_of(digest.parameters.begin(), digest.parameters.end(),
                               [](const auto& one) { return one.first.rfind("CAL_ACC", 0) == 0; });
  for (std::size_t chip = 0; chip < out.chips.size(); ++chip) {
    const InstalledCalibration& installed = out.chips[chip].calibration;
    if (!installed.present) {
      // PX4 keeps calibrations by device: where there are some, but none of this one, it flies without.
      if (ids && out.chips[chip].device_id != 0)
        out.findings.push_back(finding_of(FindingCode::uncalibrated, Grade::orange, chip, 0.0, 0.0));
      continue;
    }
    double offset = 0.0;
    double scale = 0.0;
    for (std::size_t k = 0; k < 3; ++k) {
      offset = std::max(offset, std::abs(installed.offset_mps2[k]));
      scale = std::max(scale, std::abs(installed.scale[k] - 1.0));
    }
    if (!(offset > 0.0) && !(scale > 0.0)) {
      out.findings.push_back(finding_of(FindingCode::uncalibrated, Grade::orange, chip, 0.0, 0.0));
    } else if (offset > kFarOffset_mps2) {
      out.findings.push_back(finding_of(FindingCode::far_offset, Grade::orange, chip, offset, kFarOffset_mps2));
    } else if (scale > kFarScale) {
      out.findings.push_back(finding_of(FindingCode::far_scale, Grade::orange, chip, scale, kFarScale));
    }
  }
}

}  // namespace review
}  // namespace PLUMB_ABI
}  // namespace plumb

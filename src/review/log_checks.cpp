// What a chip shows by itself at any time: vibration, clipping, axes that stand still, times, the calibration it has.
#include <algorithm>
#include <cmath>

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

/// The greatest change within the span of the same axis of other chips; `axis` -1: of any axis.
double seen_by_others(const LogDigest& digest, const LogReview& in, const Span& span, std::size_t but_chip, int axis) {
  double out = 0.0;
  for (std::size_t i = 0; i < in.chips.size(); ++i) {
    const SourceBlock block = reading_of(digest, in.chips[i], span.from, span.to);
    if (i == but_chip || block.records < 2) continue;
    for (int k = 0; k < 3; ++k) {
      const auto at = static_cast<std::size_t>(k);
      if (axis < 0 || k == axis) out = std::max(out, block.most_mps2[at] - block.least_mps2[at]);
    }
  }
  return out;
}

/// Whether the other axes of the chip changed in each block of the span: what is coarse stands still in all of them now
/// and then.
bool others_busy(const LogDigest& digest, const ChipSummary& chip, const Span& span, std::size_t axis) {
  for (std::int64_t block = span.from; block < span.to; ++block) {
    const SourceBlock here = reading_of(digest, chip, block, block + 1);
    for (std::size_t k = 0; k < 3; ++k) {
      if (k != axis && here.records > 1 && !(here.most_mps2[k] - here.least_mps2[k] > 0.0)) return false;
    }
  }
  return true;
}

/// Whole blocks of the run where it has some, else those that it touches.
Span span_of(const StillRun& run, double block_s) {
  Span out{static_cast<std::int64_t>(std::ceil(run.from_s / block_s)),
           static_cast<std::int64_t>(std::floor(run.to_s / block_s))};
  if (out.to > out.from) return out;
  return {static_cast<std::int64_t>(std::floor(run.from_s / block_s)),
          static_cast<std::int64_t>(std::floor(run.to_s / block_s)) + 1};
}

/// `axis` -1: all three at once.
void add_still(const LogDigest& digest, std::size_t chip, int axis, LogReview& out) {
  const bool whole = axis < 0;
  const SourceDigest& source = digest.sources[out.chips[chip].judged];
  const StillRun& run = source.longest_still[whole ? 3U : static_cast<std::size_t>(axis)];
  const auto records = static_cast<double>(run.records);
  if (records < kUnchangedInMotion) return;
  const Span span = span_of(run, digest.block_s);
  const bool moved = seen_by_others(digest, out, span, chip, axis) > kMotionSeen_mps2;
  const bool alone = whole || others_busy(digest, out.chips[chip], span, static_cast<std::size_t>(axis));
  if (!moved && (records < kUnchangedReadings || !alone)) return;
  Finding finding = finding_of(whole ? FindingCode::chip_frozen : FindingCode::axis_stuck,
                               moved ? Grade::red : Grade::orange, chip, run.value_mps2, records);
  finding.axis = axis;
  finding.from_s = run.from_s;
  finding.to_s = run.to_s;
  out.findings.push_back(finding);
}

/// The least of three cells in a row: a touchdown is one.
double lasting(const std::vector<Cell>& cells, std::size_t c, std::size_t chip, std::size_t axis) {
  double out = HUGE_VAL;
  for (std::size_t k = c; k < c + 3; ++k) {
    const SourceBlock& block = cells[k].readings[chip];
    out = std::min(out, block.weight < kWindowReadings ? 0.0 : block.deviation_mps2(axis));
  }
  return out;
}

/// Records of other chips behind the end of one.
double records_after(const LogDigest& digest, const LogReview& in, std::size_t chip) {
  double out = 0.0;
  for (std::size_t i = 0; i < in.chips.size(); ++i) {
    if (i == chip) continue;
    double here = 0.0;
    for (const SourceBlock& block : digest.sources[in.chips[i].judged].blocks) {
      if (time_of(block.index, digest) > in.chips[chip].to_s) here += block.records;
    }
    out = std::max(out, here);
  }
  return out;
}

}  // namespace

void check_vibration(const std::vector<Cell>& motion, const LogDigest& digest, LogReview& out) {
  for (std::size_t chip = 0; chip < out.chips.size(); ++chip) {
    ChipSummary& summary = out.chips[chip];
    const bool spread = digest.sources[summary.judged].source.kind == logs::RecordKind::mean;
    if (!(summary.rate_hz >= kFastHz) && !spread) continue;
    int axis = -1;
    for (std::size_t c = 0; c + 2 < motion.size(); ++c) {
      for (std::size_t k = 0; k < 3; ++k) {
        const double here = lasting(motion, c, chip, k);
        if (!(here > (axis < 0 ? 0.0 : summary.vibration_mps2))) continue;
        summary.vibration_mps2 = here;
        summary.vibration_at_s = time_of(motion[c].span.from, digest);
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
      // Means count clips of readings that are not all behind them: their share is not known.
      const bool samples = digest.sources[source].source.kind == logs::RecordKind::sample;
      for (const SourceBlock& block : digest.sources[source].blocks) {
        here += samples ? block.weight : 0.0;
        if (block.clipped[0] + block.clipped[1] + block.clipped[2] == 0) continue;
        finding.from_s = std::fmin(finding.from_s, time_of(block.index, digest));
        finding.to_s = std::fmax(finding.to_s, time_of(block.index + 1, digest));
      }
      readings = std::max(readings, here);
    }
    if (readings > 0.0 && finding.figure > kClippedShare * readings) finding.grade = Grade::red;
    out.findings.push_back(finding);
  }
}

void check_stuck(const LogDigest& digest, LogReview& out) {
  for (std::size_t chip = 0; chip < out.chips.size(); ++chip) {
    const std::size_t before = out.findings.size();
    add_still(digest, chip, -1, out);
    if (out.findings.size() > before) continue;
    for (int axis = 0; axis < 3; ++axis) add_still(digest, chip, axis, out);
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
    if (summary.stray) {
      out.findings.push_back(finding_of(FindingCode::stray, Grade::orange, chip, 1.0, 0.0));
    } else if (gaps.lost_s > kLostShare * length_s || long_gap) {
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
    if (silent_s > std::max(kStopped_s, kGapIntervals * usual_s) &&
        records_after(digest, out, chip) >= kWindowReadings) {
      Finding finding = finding_of(FindingCode::stopped, Grade::red, chip, silent_s, kStopped_s);
      finding.from_s = summary.to_s;
      finding.to_s = out.to_s;
      out.findings.push_back(finding);
    }
    const double late_s = summary.from_s - out.from_s;
    if (late_s > std::max(kStopped_s, kGapIntervals * usual_s)) {
      Finding finding = finding_of(FindingCode::late, Grade::orange, chip, late_s, kStopped_s);
      finding.from_s = out.from_s;
      finding.to_s = summary.from_s;
      out.findings.push_back(finding);
    }
  }
}

void check_calibration(const LogDigest& digest, LogReview& out) {
  const bool ids = std::any_of(digest.parameters.begin(), digest.parameters.end(),
                               [](const auto& one) { return one.first.rfind("CAL_ACC", 0) == 0; });
  for (std::size_t chip = 0; chip < out.chips.size(); ++chip) {
    const InstalledCalibration& installed = out.chips[chip].calibration;
    if (out.chips[chip].disabled)
      out.findings.push_back(finding_of(FindingCode::disabled, Grade::green, chip, 0.0, 0.0));
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

// What the autopilot that wrote a log says of its accelerometers itself.
#include <algorithm>
#include <cmath>

#include "chip_checks.hpp"
#include "limits.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace review {
namespace {

/// The chip that a status speaks of; kNoChip where the log has no readings of it.
std::size_t chip_of(const StatusDigest& status, const LogDigest& digest, const LogReview& in) {
  for (std::size_t chip = 0; chip < in.chips.size(); ++chip) {
    const ChipSummary& summary = in.chips[chip];
    if (status.device_id != 0 ? summary.device_id == status.device_id
                              : digest.sources[summary.judged].source.instance == status.instance)
      return chip;
  }
  // Of the accelerometer in use there is no doubt where it is the only one.
  return status.device_id == 0 && status.instance < 0 && in.chips.size() == 1 ? 0 : kNoChip;
}

bool any_finding_of(std::size_t chip, const LogReview& in) {
  return std::any_of(in.findings.begin(), in.findings.end(), [&](const Finding& one) {
    const bool of_reading = one.code == FindingCode::gravity_length || one.code == FindingCode::disagreement ||
                            one.code == FindingCode::motion_disagreement || one.code == FindingCode::orientation ||
                            one.code == FindingCode::vibration;
    return of_reading && (one.chip == chip || one.other == chip);
  });
}

void add_failed(const StatusDigest& status, std::size_t chip, LogReview& out) {
  const auto reports = static_cast<double>(status.failed.records);
  const bool before_its_first = status.failed.to_s < out.chips[chip].from_s;
  if (reports < kFailedReports || before_its_first) return;
  Finding finding;
  finding.code = FindingCode::autopilot_failed;
  finding.grade = Grade::red;
  finding.chip = chip;
  finding.figure = reports;
  finding.limit = kFailedReports;
  finding.from_s = status.failed.from_s;
  finding.to_s = status.failed.to_s;
  out.findings.push_back(finding);
}

/// The most within stretches at rest: in flight the autopilot's figure is of vibration too.
void add_apart(const StatusDigest& status, std::size_t chip, const std::vector<Span>& rest, double block_s,
               LogReview& out) {
  Finding worst;
  worst.figure = kCaution_mps2;
  for (const Span& span : rest) {
    // Smoothed over some seconds by the autopilot: the first of a stretch may be of the motion before it.
    const std::int64_t settled = span.from + static_cast<std::int64_t>(std::ceil(kShortestStretch_s / block_s));
    for (auto at = status.apart_mps2.lower_bound(settled); at != status.apart_mps2.end() && at->first < span.to; ++at) {
      if (!(at->second > worst.figure)) continue;
      worst.chip = chip;
      worst.figure = at->second;
      worst.from_s = static_cast<double>(at->first) * block_s;
      worst.to_s = worst.from_s + block_s;
    }
  }
  if (worst.chip == kNoChip) return;
  worst.code = FindingCode::autopilot_apart;
  worst.grade = worst.figure > kArmingLimit_mps2 ? Grade::red : Grade::orange;
  worst.limit = kCaution_mps2;
  out.findings.push_back(worst);
}

void add_vibration(const StatusDigest& status, std::size_t chip, LogReview& out) {
  ChipSummary& summary = out.chips[chip];
  // Where the readings came fast enough they are judged themselves.
  if (std::isfinite(summary.vibration_mps2) || !(status.vibration_mps2 > 0.0)) return;
  summary.vibration_mps2 = status.vibration_mps2;
  summary.vibration_at_s = status.vibration_at_s;
  if (!(status.vibration_mps2 > kVibration_mps2)) return;
  Finding finding;
  finding.code = FindingCode::vibration;
  finding.grade = status.vibration_mps2 > kStrongVibration_mps2 ? Grade::red : Grade::orange;
  finding.chip = chip;
  finding.axis = status.vibration_axis;
  finding.figure = status.vibration_mps2;
  finding.limit = kVibration_mps2;
  finding.from_s = finding.to_s = status.vibration_at_s;
  out.findings.push_back(finding);
}

}  // namespace

void check_autopilot(const std::vector<Span>& rest, const LogDigest& digest, LogReview& out) {
  for (const StatusDigest& status : digest.statuses) {
    const std::size_t chip = chip_of(status, digest, out);
    if (chip == kNoChip) continue;
    add_failed(status, chip, out);
    add_vibration(status, chip, out);
    if (!any_finding_of(chip, out)) add_apart(status, chip, rest, digest.block_s, out);
  }
}

}  // namespace review
}  // namespace PLUMB_ABI
}  // namespace plumb

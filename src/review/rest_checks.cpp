// What a chip shows by itself while nothing moves.
#include <algorithm>
#include <cmath>

#include "chip_checks.hpp"
#include "chips.hpp"
#include "limits.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace review {
namespace {

double median_of(std::vector<double> values) {
  if (values.empty()) return logs::kAbsent;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

Grade grade_above(double figure, double red) noexcept { return figure > red ? Grade::red : Grade::orange; }

/// By chip: what it reads in the last third of a span minus the first; NaN where it has too little.
std::vector<Axes> changes_of(const Span& span, const LogDigest& digest, const std::vector<ChipSummary>& chips,
                             std::vector<double>& lengths, std::vector<double>& errors) {
  const std::int64_t third = (span.to - span.from) / 3;
  std::vector<Axes> out(chips.size(), logs::kAbsentAxes);
  lengths.assign(chips.size(), logs::kAbsent);
  errors.assign(chips.size(), 0.0);
  if (third < 1) return out;
  for (std::size_t i = 0; i < chips.size(); ++i) {
    const SourceBlock first = reading_of(digest, chips[i], span.from, span.from + third);
    const SourceBlock last = reading_of(digest, chips[i], span.to - third, span.to);
    if (first.records < 3 || last.records < 3) continue;
    out[i] = difference(last.mean_mps2, first.mean_mps2);
    lengths[i] = length_of(last.mean_mps2) - length_of(first.mean_mps2);
    double variance = 0.0;
    for (std::size_t k = 0; k < 3; ++k) {
      variance += first.deviation_mps2(k) * first.deviation_mps2(k) / first.records;
      variance += last.deviation_mps2(k) * last.deviation_mps2(k) / last.records;
    }
    errors[i] = 1.96 * std::sqrt(variance);
  }
  return out;
}

/// How far each chip wandered: from the median change of all where there are three, else in length alone.
std::vector<double> wandered(const std::vector<Axes>& changes, const std::vector<double>& lengths) {
  std::array<std::vector<double>, 3> columns;
  for (const Axes& change : changes) {
    for (std::size_t k = 0; k < 3 && std::isfinite(change[0]); ++k) columns[k].push_back(change[k]);
  }
  std::vector<double> out(changes.size(), logs::kAbsent);
  for (std::size_t i = 0; i < changes.size(); ++i) {
    if (!std::isfinite(changes[i][0])) continue;
    if (columns[0].size() < 3) {
      out[i] = std::abs(lengths[i]);
      continue;
    }
    const Axes common = {median_of(columns[0]), median_of(columns[1]), median_of(columns[2])};
    out[i] = length_of(difference(changes[i], common));
  }
  return out;
}

}  // namespace

namespace {

/// All chips of two or more are off by the same: the vehicle accelerates, or gravity is not what it is taken for.
bool off_together(const std::vector<Reading>& readings, const GravityKnown& gravity) {
  double least = HUGE_VAL;
  double most = -HUGE_VAL;
  int count = 0;
  for (const Reading& reading : readings) {
    if (!reading.there) continue;
    const double off_mps2 = length_of(reading.mean_mps2) - gravity.middle_mps2;
    least = std::min(least, off_mps2);
    most = std::max(most, off_mps2);
    ++count;
  }
  const double nearest = std::min(std::abs(least), std::abs(most));
  return count > 1 && most - least <= kCaution_mps2 && nearest - gravity.half_mps2 > kCaution_mps2;
}

/// Once for all of them, the worst stretch.
void check_common_length(const std::vector<Cell>& rest, double block_s, const GravityKnown& gravity, LogReview& out) {
  Finding worst;
  worst.code = FindingCode::common_length;
  worst.limit = kCaution_mps2;
  for (const Cell& cell : rest) {
    const std::vector<Reading> readings = readings_of(cell);
    if (!off_together(readings, gravity)) continue;
    const auto first = std::find_if(readings.begin(), readings.end(), [](const Reading& r) { return r.there; });
    const double off_mps2 = length_of(first->mean_mps2) - gravity.middle_mps2;
    if (std::abs(off_mps2) <= std::abs(worst.figure)) continue;
    worst.figure = off_mps2;
    worst.uncertainty = first->allowed_mps2 + gravity.half_mps2;
    worst.from_s = static_cast<double>(cell.span.from) * block_s;
    worst.to_s = static_cast<double>(cell.span.to) * block_s;
  }
  if (std::abs(worst.figure) > 0.0) out.findings.push_back(worst);
}

}  // namespace

void check_length(const std::vector<Cell>& rest, double block_s, const GravityKnown& gravity, LogReview& out) {
  check_common_length(rest, block_s, gravity, out);
  for (std::size_t chip = 0; chip < out.chips.size(); ++chip) {
    Finding worst;
    double worst_beyond = kCaution_mps2;
    for (const Cell& cell : rest) {
      const std::vector<Reading> readings = readings_of(cell);
      const Reading& reading = readings[chip];
      if (!reading.there || out.chips[chip].calibration.more || off_together(readings, gravity)) continue;
      const double off_mps2 = length_of(reading.mean_mps2) - gravity.middle_mps2;
      const double beyond_mps2 = std::abs(off_mps2) - reading.allowed_mps2 - gravity.half_mps2;
      if (!(beyond_mps2 > worst_beyond)) continue;
      worst_beyond = beyond_mps2;
      worst.code = FindingCode::gravity_length;
      worst.chip = chip;
      worst.figure = off_mps2;
      worst.limit = kCaution_mps2;
      worst.uncertainty = reading.allowed_mps2 + gravity.half_mps2;
      worst.grade = grade_above(beyond_mps2, kArmingLimit_mps2);
      worst.from_s = static_cast<double>(cell.span.from) * block_s;
      worst.to_s = static_cast<double>(cell.span.to) * block_s;
    }
    if (worst.chip != kNoChip) out.findings.push_back(worst);
  }
}

void check_noise(const std::vector<Cell>& rest, const LogDigest& digest, LogReview& out) {
  std::vector<double> all;
  for (std::size_t chip = 0; chip < out.chips.size(); ++chip) {
    ChipSummary& summary = out.chips[chip];
    std::array<std::vector<double>, 3> scatters;
    for (const Cell& cell : rest) {
      const SourceBlock& block = cell.readings[chip];
      if (block.weight < kWindowReadings) continue;
      for (std::size_t k = 0; k < 3; ++k) scatters[k].push_back(block.deviation_mps2(k));
    }
    for (std::size_t k = 0; k < 3; ++k) summary.scatter_mps2[k] = median_of(scatters[k]);
    if (std::isfinite(summary.scatter_mps2[0])) {
      const Axes& s = summary.scatter_mps2;
      all.push_back(std::max({s[0], s[1], s[2]}));
    }
  }
  const double usual = median_of(all);
  for (std::size_t chip = 0; chip < out.chips.size(); ++chip) {
    for (std::size_t k = 0; k < 3; ++k) {
      const double scatter = out.chips[chip].scatter_mps2[k];
      const bool odd = all.size() > 2 && scatter > kScatterLeast_mps2 && scatter > kScatterRatio * usual;
      if (!(scatter > kScatter_mps2) && !odd) continue;
      Finding finding;
      finding.code = FindingCode::noise;
      finding.chip = chip;
      finding.axis = static_cast<int>(k);
      finding.figure = scatter;
      finding.limit = odd ? std::min(kScatterRatio * usual, kScatter_mps2) : kScatter_mps2;
      finding.from_s = static_cast<double>(rest.front().span.from) * digest.block_s;
      finding.to_s = static_cast<double>(rest.back().span.to) * digest.block_s;
      out.findings.push_back(finding);
    }
  }
}

void check_drift(const std::vector<Span>& rest, const LogDigest& digest, LogReview& out) {
  std::vector<Finding> worst(out.chips.size());
  std::vector<double> lengths;
  std::vector<double> errors;
  for (const Span& span : rest) {
    const std::vector<Axes> changes = changes_of(span, digest, out.chips, lengths, errors);
    const std::vector<double> far = wandered(changes, lengths);
    for (std::size_t i = 0; i < far.size(); ++i) {
      if (!(far[i] - errors[i] > std::max(kDrift_mps2, worst[i].figure - worst[i].uncertainty))) continue;
      worst[i].code = FindingCode::drift;
      worst[i].chip = i;
      worst[i].figure = far[i];
      worst[i].uncertainty = errors[i];
      worst[i].limit = kDrift_mps2;
      worst[i].grade = grade_above(far[i] - errors[i], kArmingLimit_mps2);
      worst[i].from_s = static_cast<double>(span.from) * digest.block_s;
      worst[i].to_s = static_cast<double>(span.to) * digest.block_s;
    }
  }
  for (const Finding& finding : worst) {
    if (finding.chip != kNoChip) out.findings.push_back(finding);
  }
}

}  // namespace review
}  // namespace PLUMB_ABI
}  // namespace plumb

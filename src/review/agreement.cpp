#include "agreement.hpp"

#include <algorithm>
#include <cmath>

#include "chips.hpp"
#include "limits.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace review {
namespace {

constexpr double kStandardErrors95 = 1.96;

/// Of the mean of a block, all axes together. Records count, not the readings behind them: those of one mean share what
/// moved the vehicle then.
double error_of(const SourceBlock& block) noexcept {
  double variance = 0.0;
  for (std::size_t k = 0; k < 3; ++k) variance += block.deviation_mps2(k) * block.deviation_mps2(k);
  return std::sqrt(variance / static_cast<double>(block.records));
}

double apart_mps2(const Comparison& chips, std::size_t i, std::size_t j) noexcept {
  return length_of(difference(chips.readings[i].mean_mps2, chips.readings[j].mean_mps2));
}
/// Beyond what the two may differ by.
double beyond(const Comparison& chips, std::size_t i, std::size_t j) noexcept {
  return apart_mps2(chips, i, j) - chips.allowed(i, j);
}

double off_gravity(const Reading& reading, const GravityKnown& gravity) noexcept {
  return length_of(reading.mean_mps2) - gravity.middle_mps2;
}

/// Off by more than kCaution for certain; within it for certain.
bool length_wrong(const Reading& reading, const GravityKnown& gravity) noexcept {
  return std::abs(off_gravity(reading, gravity)) - reading.allowed_mps2 - gravity.half_mps2 > kCaution_mps2;
}
bool length_right(const Reading& reading, const GravityKnown& gravity) noexcept {
  return std::abs(off_gravity(reading, gravity)) + reading.allowed_mps2 <= kCaution_mps2;
}

/// Of two: the one with a wrong length, where that explains the difference.
std::size_t told_by_length(const std::vector<Reading>& readings, std::size_t a, std::size_t b,
                           const GravityKnown& gravity) {
  const bool a_wrong = length_wrong(readings[a], gravity) && length_right(readings[b], gravity);
  const bool b_wrong = length_wrong(readings[b], gravity) && length_right(readings[a], gravity);
  if (a_wrong == b_wrong) return kNoChip;
  const Reading& wrong = readings[a_wrong ? a : b];
  const Reading& right = readings[a_wrong ? b : a];
  const double excess = length_of(wrong.mean_mps2) - length_of(right.mean_mps2);
  Axes rest = difference(wrong.mean_mps2, right.mean_mps2);
  for (std::size_t k = 0; k < 3; ++k) rest[k] -= excess * right.mean_mps2[k] / length_of(right.mean_mps2);
  return length_of(rest) <= std::abs(excess) ? (a_wrong ? a : b) : kNoChip;
}

/// The least difference of `chip` from another one, and the greatest of the others among themselves.
struct Apart {
  double least = HUGE_VAL, others = 0.0, least_beyond = HUGE_VAL;
};

Apart apart(const Comparison& chips, std::size_t chip) {
  Apart out;
  for (std::size_t i = 0; i < chips.readings.size(); ++i) {
    if (!chips.readings[i].there || i == chip) continue;
    out.least = std::min(out.least, apart_mps2(chips, i, chip));
    out.least_beyond = std::min(out.least_beyond, beyond(chips, i, chip));
    for (std::size_t j = 0; j < i; ++j) {
      if (chips.readings[j].there && j != chip) out.others = std::max(out.others, apart_mps2(chips, i, j));
    }
  }
  return out;
}

std::size_t told_by_others(const Comparison& chips) {
  for (std::size_t chip = 0; chip < chips.readings.size(); ++chip) {
    if (!chips.readings[chip].there) continue;
    const Apart distances = apart(chips, chip);
    if (distances.least_beyond > kCaution_mps2 && distances.others <= kCaution_mps2 &&
        distances.least >= kNamingRatio * distances.others) {
      return chip;
    }
  }
  return kNoChip;
}

/// Differences of two chips, cell by cell; NaN where one of them says nothing.
using Differences = std::vector<Axes>;

/// The scatter of the differences about a cell: 2.5 times the median step from cell to cell nearby, which is 5.4
/// standard deviations of noise that is equal along three axes. What stays for several cells is no scatter.
double scatter_about(const Differences& differences, std::size_t cell) {
  const std::size_t from = cell > kNearbyCells ? cell - kNearbyCells : 0;
  const std::size_t to = std::min(differences.size(), cell + kNearbyCells + 1);
  std::vector<double> steps;
  for (std::size_t k = from + 1; k < to; ++k) {
    const double step = length_of(difference(differences[k], differences[k - 1]));
    if (std::isfinite(step)) steps.push_back(step);
  }
  if (steps.size() < kFewestSteps) return logs::kAbsent;
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  return kScatterSteps * *middle;
}

bool usable(const SourceBlock& block) noexcept {
  return block.records >= 3 && block.clipped[0] + block.clipped[1] + block.clipped[2] == 0;
}

/// Turning adds w^2 r, and the change of the rate over the cell times r.
double lever_mps2(const Cell& cell, double block_s) noexcept {
  const double length_s = static_cast<double>(cell.span.to - cell.span.from) * block_s;
  return kLeverArm_m * (cell.rate_squares + 2.0 * std::sqrt(cell.rate_squares) / length_s);
}

std::vector<Comparison> side_by_side(const std::vector<Cell>& cells, std::size_t chips) {
  std::vector<Comparison> out(cells.size());
  for (std::size_t c = 0; c < cells.size(); ++c) {
    out[c].readings.resize(chips);
    out[c].allowed_mps2.assign(chips * chips, 0.0);
    for (std::size_t i = 0; i < chips; ++i) {
      out[c].readings[i].there = usable(cells[c].readings[i]);
      out[c].readings[i].mean_mps2 = cells[c].readings[i].mean_mps2;
    }
  }
  return out;
}

/// What noise allows two chips in each cell.
void allow_scatter(std::size_t i, std::size_t j, std::vector<Comparison>& out) {
  Differences differences(out.size(), logs::kAbsentAxes);
  for (std::size_t c = 0; c < out.size(); ++c) {
    const std::vector<Reading>& readings = out[c].readings;
    if (readings[i].there && readings[j].there)
      differences[c] = difference(readings[i].mean_mps2, readings[j].mean_mps2);
  }
  for (std::size_t c = 0; c < out.size(); ++c) {
    const double scatter = scatter_about(differences, c);
    const double allowed = std::isfinite(scatter) ? scatter : HUGE_VAL;
    const std::size_t size = out[c].readings.size();
    out[c].allowed_mps2[i * size + j] = out[c].allowed_mps2[j * size + i] = allowed;
  }
}

/// The mean over the cells about `centre` that have the same chips: noise falls with the root of their number, what
/// turning adds does not.
Comparison averaged(const std::vector<Comparison>& cells, const std::vector<double>& levers_mps2, std::size_t centre) {
  Comparison out = cells[centre];
  const std::size_t from = centre > kAveragedCells ? centre - kAveragedCells : 0;
  const std::size_t to = std::min(cells.size(), centre + kAveragedCells + 1);
  double count = 0.0;
  double lever_mps2 = 0.0;
  for (Reading& reading : out.readings) reading.mean_mps2 = Axes{};
  std::fill(out.allowed_mps2.begin(), out.allowed_mps2.end(), 0.0);
  for (std::size_t c = from; c < to; ++c) {
    bool all = true;
    for (std::size_t i = 0; i < out.readings.size(); ++i)
      all = all && (!out.readings[i].there || cells[c].readings[i].there);
    if (!all) continue;
    count += 1.0;
    lever_mps2 += levers_mps2[c];
    for (std::size_t i = 0; i < out.readings.size(); ++i) {
      for (std::size_t k = 0; k < 3; ++k) out.readings[i].mean_mps2[k] += cells[c].readings[i].mean_mps2[k];
    }
    for (std::size_t p = 0; p < out.allowed_mps2.size(); ++p) out.allowed_mps2[p] += cells[c].allowed_mps2[p];
  }
  for (Reading& reading : out.readings) {
    for (double& x : reading.mean_mps2) x /= count;
  }
  for (double& allowed : out.allowed_mps2) allowed = allowed / (count * std::sqrt(count)) + lever_mps2 / count;
  return out;
}

std::vector<Comparison> compare_in_motion(const std::vector<Cell>& cells, double block_s, std::size_t chips) {
  std::vector<Comparison> single = side_by_side(cells, chips);
  for (std::size_t j = 0; j < chips; ++j) {
    for (std::size_t i = 0; i < j; ++i) allow_scatter(i, j, single);
  }
  std::vector<double> levers_mps2;
  for (const Cell& cell : cells) levers_mps2.push_back(lever_mps2(cell, block_s));
  std::vector<Comparison> out;
  out.reserve(cells.size());
  for (std::size_t c = 0; c < cells.size(); ++c) out.push_back(averaged(single, levers_mps2, c));
  return out;
}

Comparison compare_at_rest(const Cell& cell) {
  Comparison out;
  out.readings = readings_of(cell);
  for (const Reading& a : out.readings) {
    for (const Reading& b : out.readings) out.allowed_mps2.push_back(a.allowed_mps2 + b.allowed_mps2);
  }
  return out;
}

void note_run(const std::vector<const Cell*>& run, const std::vector<Opinion>& opinions, double block_s,
              LogReview& out) {
  std::vector<Opinion> sorted = opinions;
  std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2), sorted.end(),
                   [](const Opinion& a, const Opinion& b) {
                     return a.figure_mps2 - a.allowed_mps2 < b.figure_mps2 - b.allowed_mps2;
                   });
  const Opinion& middle = sorted[sorted.size() / 2];
  Finding finding;
  finding.code = FindingCode::motion_disagreement;
  finding.chip = middle.chip == kNoChip ? middle.first : middle.chip;
  finding.other = middle.chip == kNoChip ? middle.second : kNoChip;
  finding.figure = middle.figure_mps2;
  finding.uncertainty = middle.allowed_mps2;
  finding.limit = kCaution_mps2;
  finding.grade = middle.figure_mps2 - middle.allowed_mps2 > kArmingLimit_mps2 ? Grade::red : Grade::orange;
  finding.from_s = static_cast<double>(run.front()->span.from) * block_s;
  finding.to_s = static_cast<double>(run.back()->span.to) * block_s;
  out.findings.push_back(finding);
}

bool same_verdict(const Opinion& a, const Opinion& b) noexcept {
  return a.chip == b.chip && (a.chip != kNoChip || (a.first == b.first && a.second == b.second));
}

}  // namespace

std::vector<Reading> readings_of(const Cell& cell) {
  std::vector<Reading> out(cell.readings.size());
  for (std::size_t i = 0; i < out.size(); ++i) {
    const SourceBlock& block = cell.readings[i];
    out[i].there = block.records >= 3;
    if (!out[i].there) continue;
    out[i].mean_mps2 = block.mean_mps2;
    out[i].allowed_mps2 = kStandardErrors95 * error_of(block);
  }
  return out;
}

Opinion opinion_of(const Comparison& chips, const GravityKnown& gravity, bool at_rest) {
  Opinion out;
  double worst = -HUGE_VAL;
  std::size_t there = 0;
  for (std::size_t j = 0; j < chips.readings.size(); ++j) {
    if (!chips.readings[j].there) continue;
    ++there;
    for (std::size_t i = 0; i < j; ++i) {
      if (!chips.readings[i].there || !(beyond(chips, i, j) > worst)) continue;
      worst = beyond(chips, i, j);
      out.first = i;
      out.second = j;
    }
  }
  if (out.first == kNoChip) return out;
  out.compared = true;
  out.figure_mps2 = apart_mps2(chips, out.first, out.second);
  out.allowed_mps2 = chips.allowed(out.first, out.second);
  out.disagree = worst > kCaution_mps2;
  if (!out.disagree) return out;
  if (there > 2) {
    out.chip = told_by_others(chips);
    if (out.chip != kNoChip) out.figure_mps2 = apart(chips, out.chip).least;
  } else if (at_rest) {
    out.chip = told_by_length(chips.readings, out.first, out.second, gravity);
    out.told_by_length = out.chip != kNoChip;
  }
  return out;
}

namespace {

bool turned(const Reading& a, const Reading& b) {
  return angle_deg(a.mean_mps2, b.mean_mps2) > kAttitude_deg &&
         std::abs(length_of(a.mean_mps2) - length_of(b.mean_mps2)) <= kCaution_mps2;
}

Finding finding_at(const Cell& cell, double block_s, FindingCode code) {
  Finding out;
  out.code = code;
  out.from_s = static_cast<double>(cell.span.from) * block_s;
  out.to_s = static_cast<double>(cell.span.to) * block_s;
  return out;
}

/// Takes the chips out that read gravity in another direction than each other one, with its length: they are mounted
/// differently. Of two, both.
std::vector<Finding> take_out_turned(const Cell& cell, double block_s, Comparison& chips) {
  std::vector<Finding> out;
  const std::vector<Reading> all = chips.readings;
  const auto there =
      static_cast<std::size_t>(std::count_if(all.begin(), all.end(), [](const Reading& r) { return r.there; }));
  for (std::size_t i = 0; i < all.size(); ++i) {
    std::size_t against = kNoChip;
    std::size_t count = 0;
    for (std::size_t j = 0; j < all.size() && all[i].there; ++j) {
      if (j == i || !all[j].there || !turned(all[i], all[j])) continue;
      against = j;
      ++count;
    }
    if (count == 0 || count + 1 < there || (there == 2 && against < i)) continue;
    Finding finding = finding_at(cell, block_s, FindingCode::orientation);
    finding.chip = i;
    finding.other = there == 2 ? against : kNoChip;
    finding.figure = angle_deg(all[i].mean_mps2, all[against].mean_mps2);
    finding.limit = kAttitude_deg;
    out.push_back(finding);
    chips.readings[i].there = false;
    if (there == 2) chips.readings[against].there = false;
  }
  return out;
}

Finding finding_of(const Opinion& opinion, const Cell& cell, double block_s) {
  Finding out = finding_at(cell, block_s, FindingCode::disagreement);
  out.chip = opinion.chip == kNoChip ? opinion.first : opinion.chip;
  out.other = opinion.chip == kNoChip ? opinion.second : kNoChip;
  out.told_by_length = opinion.told_by_length;
  out.figure = opinion.figure_mps2;
  out.limit = kCaution_mps2;
  out.uncertainty = opinion.allowed_mps2;
  out.grade = opinion.figure_mps2 - opinion.allowed_mps2 > kArmingLimit_mps2 ? Grade::red : Grade::orange;
  return out;
}

/// Of one thing the worst figure is kept.
void keep_worst(const Finding& finding, std::vector<Finding>& found) {
  const auto same = std::find_if(found.begin(), found.end(), [&](const Finding& one) {
    return one.code == finding.code && one.chip == finding.chip && one.other == finding.other;
  });
  if (same == found.end())
    found.push_back(finding);
  else if (same->figure < finding.figure)
    *same = finding;
}

void leave_out(const LogReview& review, Comparison& chips) {
  for (std::size_t i = 0; i < chips.readings.size(); ++i) {
    if (review.chips[i].calibration.more) chips.readings[i].there = false;
  }
}

void mark_compared(const Comparison& chips, LogReview& out) {
  for (std::size_t i = 0; i < chips.readings.size(); ++i) {
    for (std::size_t j = 0; j < chips.readings.size(); ++j) {
      const bool both = i != j && chips.readings[i].there && chips.readings[j].there;
      if (both && chips.allowed(i, j) <= kArmingLimit_mps2) out.chips[i].compared = true;
    }
  }
}

}  // namespace

void judge_rest(const std::vector<Cell>& cells, const LogDigest& digest, const GravityKnown& gravity, LogReview& out) {
  std::vector<Finding> found;
  for (const Cell& cell : cells) {
    Comparison chips = compare_at_rest(cell);
    leave_out(out, chips);
    for (const Finding& finding : take_out_turned(cell, digest.block_s, chips)) keep_worst(finding, found);
    const Opinion opinion = opinion_of(chips, gravity, true);
    if (opinion.compared) mark_compared(chips, out);
    if (opinion.disagree) keep_worst(finding_of(opinion, cell, digest.block_s), found);
  }
  out.findings.insert(out.findings.end(), found.begin(), found.end());
}

void judge_motion(const std::vector<Cell>& cells, const LogDigest& digest, const GravityKnown& gravity,
                  LogReview& out) {
  std::vector<double> differences;
  std::vector<const Cell*> run;
  std::vector<Opinion> opinions;
  const auto close = [&] {
    if (static_cast<int>(run.size()) >= kMotionRun) note_run(run, opinions, digest.block_s, out);
    run.clear();
    opinions.clear();
  };
  std::vector<Comparison> compared = compare_in_motion(cells, digest.block_s, out.chips.size());
  std::size_t unclear = 0;
  for (std::size_t c = 0; c < cells.size(); ++c) {
    leave_out(out, compared[c]);
    const Opinion opinion = opinion_of(compared[c], gravity, false);
    if (!opinion.compared) continue;
    if (opinion.figure_mps2 > kCaution_mps2 && !opinion.disagree) ++unclear;
    mark_compared(compared[c], out);
    differences.push_back(opinion.figure_mps2);
    if (!opinion.disagree || (!opinions.empty() && !same_verdict(opinions.back(), opinion))) close();
    if (!opinion.disagree) continue;
    run.push_back(&cells[c]);
    opinions.push_back(opinion);
  }
  close();
  out.motion_cells = differences.size();
  if (2 * unclear > differences.size()) out.open.push_back(OpenQuestion::motion_unclear);
  if (differences.empty()) return;
  const auto middle = differences.begin() + static_cast<std::ptrdiff_t>(differences.size() / 2);
  std::nth_element(differences.begin(), middle, differences.end());
  out.motion_agreement_mps2 = *middle;
}

}  // namespace review
}  // namespace PLUMB_ABI
}  // namespace plumb

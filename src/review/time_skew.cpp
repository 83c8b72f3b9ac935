#include "plumb/review/time_skew.hpp"

#include <algorithm>
#include <cmath>

#include "chips.hpp"
#include "limits.hpp"
#include "plumb/core/vec3.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace review {
namespace {

/// Shifts that are tried to one usual interval of the slower course.
constexpr double kStepsPerInterval = 4.0;
constexpr double kMostSteps = 4000.0;
constexpr std::size_t kFewestReadings = 50;
/// Of what the best shift explains, a second one must explain less than this.
constexpr double kAmbiguous = 0.8;

double usual_interval(const Course& course) {
  std::vector<double> intervals;
  for (std::size_t k = 1; k < course.time_s.size(); ++k) intervals.push_back(course.time_s[k] - course.time_s[k - 1]);
  const auto middle = intervals.begin() + static_cast<std::ptrdiff_t>(intervals.size() / 2);
  std::nth_element(intervals.begin(), middle, intervals.end());
  return *middle;
}

/// What is left of `first` minus `second` shifted by `lag_s`, their mean difference apart: sum of squares and readings.
struct Misfit {
  double squares = 0.0, readings = 0.0, scatter = 0.0;
  double mean() const noexcept { return readings > 0.0 ? squares / readings : HUGE_VAL; }
};

Misfit misfit(const Course& first, const Course& second, double lag_s, double gap_s, double margin_s) {
  Axes sum{}, squares{}, own{}, own_squares{};
  double count = 0.0;
  std::size_t at = 0;
  const double from_s = second.time_s.front() + margin_s;
  const double to_s = second.time_s.back() - margin_s;
  for (std::size_t k = 0; k < first.time_s.size(); ++k) {
    if (first.time_s[k] < from_s || first.time_s[k] > to_s) continue;  // the same readings whatever the shift
    const double time_s = first.time_s[k] + lag_s;
    while (at + 1 < second.time_s.size() && second.time_s[at + 1] <= time_s) ++at;
    if (at + 1 >= second.time_s.size() || second.time_s[at] > time_s) continue;
    const double width_s = second.time_s[at + 1] - second.time_s[at];
    if (!(width_s > 0.0) || width_s > gap_s) continue;
    const double share = (time_s - second.time_s[at]) / width_s;
    count += 1.0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double there =
          second.force_mps2[at][axis] + share * (second.force_mps2[at + 1][axis] - second.force_mps2[at][axis]);
      const double here = first.force_mps2[k][axis];
      sum[axis] += here - there;
      squares[axis] += (here - there) * (here - there);
      own[axis] += here;
      own_squares[axis] += here * here;
    }
  }
  Misfit out;
  if (count < static_cast<double>(kFewestReadings)) return out;
  out.readings = 3.0 * count;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    out.squares += squares[axis] - sum[axis] * sum[axis] / count;
    out.scatter += own_squares[axis] - own[axis] * own[axis] / count;
  }
  return out;
}

/// Periodic motion looks the same a period later: another shift explains nearly as much, with a ridge in between.
bool another_least(const std::vector<Misfit>& tried, std::vector<Misfit>::const_iterator least) {
  const double explained = least->scatter - least->squares;
  const auto lower = [](const Misfit& a, const Misfit& b) { return a.squares < b.squares; };
  for (auto other = tried.begin(); other != tried.end(); ++other) {
    if (other == least || least->scatter - other->squares < kAmbiguous * explained) continue;
    const auto ridge = std::max_element(std::min(other, least), std::max(other, least), lower);
    if (ridge->squares - least->squares > 0.5 * explained) return true;
  }
  return false;
}

double scatter_of(const SourceBlock& block) noexcept {
  return norm({block.deviation_mps2(0), block.deviation_mps2(1), block.deviation_mps2(2)});
}

}  // namespace

std::optional<Skew> skew_of(const Course& first, const Course& second, double most_s) {
  if (first.time_s.size() < kFewestReadings || second.time_s.size() < kFewestReadings) return std::nullopt;
  const double slower_s = std::max(usual_interval(first), usual_interval(second));
  const double gap_s = kGapIntervals * slower_s;
  const double step_s = std::max(slower_s / kStepsPerInterval, 2.0 * most_s / kMostSteps);
  if (!(step_s > 0.0)) return std::nullopt;
  const int steps = static_cast<int>(most_s / step_s);
  std::vector<Misfit> tried;
  for (int k = -steps; k <= steps; ++k) tried.push_back(misfit(first, second, k * step_s, gap_s, most_s + step_s));
  const auto least = std::min_element(tried.cbegin(), tried.cend(),
                                      [](const Misfit& a, const Misfit& b) { return a.mean() < b.mean(); });
  if (least == tried.begin() || least + 1 >= tried.end() || !(least->readings > 0.0)) return std::nullopt;
  if (least->squares > 0.5 * least->scatter) return std::nullopt;
  // A parabola through the least and two shifts so far away that the sum has doubled: nearer by, noise against noise
  // has ripples as large as what the motion adds.
  const std::ptrdiff_t room = std::min(least - tried.begin(), tried.end() - 1 - least);
  std::ptrdiff_t apart = static_cast<std::ptrdiff_t>(kStepsPerInterval);
  const double here = least->squares;
  const auto rise = [&] { return (least - apart)->squares - 2.0 * here + (least + apart)->squares; };
  while (apart <= room && rise() < 2.0 * here) apart += static_cast<std::ptrdiff_t>(kStepsPerInterval);
  if (apart > room) return std::nullopt;
  if (another_least(tried, least)) return std::nullopt;
  const double before = (least - apart)->squares, after = (least + apart)->squares;
  const double width_s = step_s * static_cast<double>(apart);
  const double curvature = (before - 2.0 * here + after) / (width_s * width_s);
  if (!(curvature > 0.0)) return std::nullopt;
  const double index = static_cast<double>(least - tried.begin()) - steps;
  Skew out;
  out.lag_s = index * step_s + 0.5 * width_s * (before - after) / (before - 2.0 * here + after);
  out.uncertainty_s = 1.96 * std::sqrt(2.0 * here / least->readings / curvature) + 0.5 * step_s;
  return out;
}

std::optional<SkewWindow> skew_window(const LogDigest& digest, const LogReview& found) {
  SkewWindow out;
  for (std::size_t chip = 0; chip < found.chips.size(); ++chip) {
    const bool turned = std::any_of(found.findings.begin(), found.findings.end(), [chip](const Finding& finding) {
      return finding.code == FindingCode::orientation && (finding.chip == chip || finding.other == chip);
    });
    if (found.chips[chip].rate_hz >= kFastHz && !turned) out.chips.push_back(chip);
  }
  if (out.chips.size() < 2) return std::nullopt;
  const std::vector<SourceBlock>& blocks = digest.sources[found.chips[out.chips.front()].judged].blocks;
  const auto wanted = static_cast<std::size_t>(std::max(1.0, std::round(kSkewWindow_s / digest.block_s)));
  double best = 0.0;
  for (std::size_t k = 0; k < blocks.size(); ++k) {
    double sum = 0.0;
    std::size_t end = k;
    for (; end < blocks.size() && blocks[end].index < blocks[k].index + static_cast<std::int64_t>(wanted); ++end) {
      const SourceBlock& block = blocks[end];
      if (block.clipped[0] + block.clipped[1] + block.clipped[2] == 0) sum += scatter_of(block);
    }
    if (sum <= best) continue;
    best = sum;
    out.from_s = static_cast<double>(blocks[k].index) * digest.block_s;
    out.to_s = static_cast<double>(blocks[end - 1].index + 1) * digest.block_s;
  }
  if (best < kSkewMotion_mps2 * static_cast<double>(wanted)) return std::nullopt;
  return out;
}

CourseCollector::CourseCollector(const SkewWindow& window, const LogReview& found)
    : from_s_(window.from_s), to_s_(window.to_s) {
  for (const std::size_t chip : window.chips) courses_[found.chips[chip].judged];
}

void CourseCollector::record(std::size_t number, const logs::ImuRecord& record) {
  if (!(record.time_s >= from_s_ && record.time_s <= to_s_)) return;
  const auto found = courses_.find(number);
  if (found == courses_.end() || found->second.time_s.size() >= kMostReadings) return;
  Course& course = found->second;
  const Axes& f = record.specific_force_mps2;
  const bool finite = std::isfinite(f[0]) && std::isfinite(f[1]) && std::isfinite(f[2]);
  if (!finite || (!course.time_s.empty() && !(record.time_s > course.time_s.back()))) return;
  course.time_s.push_back(record.time_s);
  course.force_mps2.push_back(f);
}

void judge_skew(const SkewWindow& window, const CourseCollector& courses, LogReview& out) {
  const std::size_t first = window.chips.front();
  for (const std::size_t chip : window.chips) {
    if (chip == first) continue;
    const std::optional<Skew> skew =
        skew_of(courses.course(out.chips[first].judged), courses.course(out.chips[chip].judged));
    if (!skew) continue;
    out.chips[chip].lag_s = skew->lag_s;
    out.chips[chip].lag_uncertainty_s = skew->uncertainty_s;
    if (!(std::abs(skew->lag_s) - skew->uncertainty_s > kSkew_s)) continue;
    Finding finding;
    finding.code = FindingCode::skew;
    finding.chip = first;
    finding.other = chip;
    finding.figure = skew->lag_s;
    finding.limit = kSkew_s;
    finding.uncertainty = skew->uncertainty_s;
    finding.from_s = window.from_s;
    finding.to_s = window.to_s;
    out.findings.push_back(finding);
    out.grade = std::max(out.grade, finding.grade);
  }
}

}  // namespace review
}  // namespace PLUMB_ABI
}  // namespace plumb

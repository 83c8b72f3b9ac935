// Whether a chip reads the same again when the vehicle comes back to rest as it stood before.
#include <algorithm>
#include <cmath>

#include "chip_checks.hpp"
#include "chips.hpp"
#include "limits.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace review {
namespace {

/// Attitudes of which the first stretch is kept; more of them are not compared.
constexpr std::size_t kMostAttitudes = 32;

double middle_of(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Axis by axis the median of the chips that read in both stretches; absent where there are none.
Axes common_of(const Stretch& one, const Stretch& other, std::size_t& count) {
  std::array<std::vector<double>, 3> columns;
  for (std::size_t i = 0; i < one.mean_mps2.size(); ++i) {
    if (!std::isfinite(one.mean_mps2[i][0]) || !std::isfinite(other.mean_mps2[i][0])) continue;
    for (std::size_t k = 0; k < 3; ++k) columns[k].push_back(one.mean_mps2[i][k]);
  }
  count = columns[0].size();
  if (count == 0) return logs::kAbsentAxes;
  return {middle_of(columns[0]), middle_of(columns[1]), middle_of(columns[2])};
}

struct Change {
  double figure_mps2 = 0.0, allowed_mps2 = 0.0;
  double beyond_mps2() const noexcept { return figure_mps2 - allowed_mps2; }
};

/// What two stretches of one attitude say of chip `i`, whichever says more: its length, or, where there are three
/// chips, its reading against the median of all. Axes that are turned against the others', in whichever way, make that
/// one change by up to twice what the attitude did.
Change change_of(const Stretch& before, const Stretch& after, std::size_t i, const Axes& first, const Axes& last,
                 bool three) {
  const Axes& was = before.mean_mps2[i];
  const Axes& is = after.mean_mps2[i];
  const double noise = before.uncertainty_mps2[i] + after.uncertainty_mps2[i];
  const Change length{std::abs(length_of(is) - length_of(was)), noise};
  if (!three) return length;
  const Change reading{length_of(difference(difference(is, last), difference(was, first))),
                       noise + 2.0 * length_of(difference(last, first))};
  return reading.beyond_mps2() > length.beyond_mps2() ? reading : length;
}

void compare(const Stretch& before, const Stretch& after, std::vector<Finding>& worst) {
  std::size_t count = 0;
  const Axes first = common_of(before, after, count);
  const Axes last = common_of(after, before, count);
  if (count == 0 || angle_deg(first, last) > kSameAttitude_deg) return;
  for (std::size_t i = 0; i < worst.size(); ++i) {
    if (!std::isfinite(before.mean_mps2[i][0]) || !std::isfinite(after.mean_mps2[i][0])) continue;
    const Change change = change_of(before, after, i, first, last, count > 2);
    if (!(change.beyond_mps2() > std::max(kCaution_mps2, worst[i].figure - worst[i].uncertainty))) continue;
    worst[i].code = FindingCode::changed;
    worst[i].chip = i;
    worst[i].figure = change.figure_mps2;
    worst[i].uncertainty = change.allowed_mps2;
    worst[i].limit = kCaution_mps2;
    worst[i].grade = change.beyond_mps2() > kArmingLimit_mps2 ? Grade::red : Grade::orange;
    worst[i].from_s = before.to_s;
    worst[i].to_s = after.from_s;
  }
}

}  // namespace

void check_change(LogReview& out) {
  std::vector<Finding> worst(out.chips.size());
  std::vector<const Stretch*> attitudes;
  for (const Stretch& stretch : out.stretches) {
    bool known = false;
    for (const Stretch* before : attitudes) {
      compare(*before, stretch, worst);
      std::size_t count = 0;
      const Axes one = common_of(*before, stretch, count);
      known = known || (count > 0 && angle_deg(one, common_of(stretch, *before, count)) <= kSameAttitude_deg);
    }
    if (!known && attitudes.size() < kMostAttitudes) attitudes.push_back(&stretch);
  }
  for (const Finding& finding : worst) {
    if (finding.chip != kNoChip && !out.chips[finding.chip].calibration.more) out.findings.push_back(finding);
  }
}

}  // namespace review
}  // namespace PLUMB_ABI
}  // namespace plumb

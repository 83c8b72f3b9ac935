#include "plumb/campaign/tally.hpp"

#include <algorithm>
#include <cmath>

namespace plumb {
namespace campaign {
namespace {

using std::size_t;

constexpr double kFirstOctave_rad = 0.001 * 3.14159265358979323846 / 180.0;
constexpr double kNrad = 1e9;

struct Name {
  const char* key;
  const char* words;
};
constexpr std::array<Name, kCounts> kNames = {{
    {"scenarios", "played"},
    {"detected", "an alarm at or after the onset"},
    {"isolated", "exactly the faulty sensors are excluded at the end"},
    {"partial", "some of the faulty sensors are excluded, and no healthy one"},
    {"provisional", "only faulty sensors are provisionally excluded, none excluded"},
    {"ambiguous", "an alarm, but no sensor is excluded at the end"},
    {"undetected", "a fault, and no alarm"},
    {"missed_above_threshold", "no alarm, although one sensor had a constant bias of at least 1 MDB"},
    {"wrong_exclusion", "a healthy sensor was excluded"},
    {"wrong_provisional_exclusion", "a healthy sensor was provisionally excluded"},
    {"false_alarm", "an alarm before the onset, or without a fault"},
    {"misleading", "error above the alert limit without an alert"},
    {"beyond_protection", "error above the protection level while usable"},
    {"unavailable", "an alert is active at the end"},
    {"failed", "the monitor ended in the state failed"},
}};

std::uint64_t nrad_of(double angle_rad) noexcept {
  return angle_rad > 0.0 ? static_cast<std::uint64_t>(std::ceil(std::min(angle_rad, 4.0) * kNrad)) : 0;
}

/// Inserts into a rising list and lets the largest fall out.
void keep(FirstNumbers& kept, std::uint64_t number) noexcept {
  if (number >= kept.back()) return;
  size_t at = kept.size() - 1;
  for (; at > 0 && kept[at - 1] > number; --at) kept[at] = kept[at - 1];
  if (at > 0 && kept[at - 1] == number) {  // there already: close the gap again
    for (; at + 1 < kept.size(); ++at) kept[at] = kept[at + 1];
    kept.back() = kNoNumber;
    return;
  }
  kept[at] = number;
}

template <class List>
void append(std::vector<std::uint64_t>& to, const List& from) {
  to.insert(to.end(), from.begin(), from.end());
}

template <class List>
bool take_from(const std::vector<std::uint64_t>& from, size_t& at, List& to) noexcept {
  if (from.size() - at < to.size()) return false;
  std::copy_n(from.begin() + static_cast<std::ptrdiff_t>(at), to.size(), to.begin());
  at += to.size();
  return true;
}

}  // namespace

const char* to_string(Count count) noexcept { return kNames[static_cast<size_t>(count)].key; }
const char* words_of(Count count) noexcept { return kNames[static_cast<size_t>(count)].words; }

const char* to_string(Region region) noexcept {
  static constexpr const char* kWords[kRegions] = {"available", "misleading", "hazardous", "unavailable",
                                                   "unavailable_misleading"};
  return kWords[static_cast<size_t>(region)];
}

int octave_of(double angle_rad) noexcept {
  double end_rad = kFirstOctave_rad;
  int octave = 0;
  while (octave < kOctaves - 1 && !(angle_rad <= end_rad)) {
    end_rad *= 2.0;
    ++octave;
  }
  return octave;
}

Tally::Tally(const Plan& plan) : counts_(plan.cells.size() * kCounts, 0), largest_(plan.cells.size(), 0) {}

void Tally::count_blocks(const Plan& plan, const Outcome& outcome, std::uint64_t& largest_nrad) noexcept {
  const double limit_rad = plan.alert_limit_rad;
  for (int k = 0; k < outcome.blocks; ++k) {
    const BlockOutcome& b = outcome.block[static_cast<size_t>(k)];
    const bool inside = b.usable && b.bounded && b.protection_rad <= limit_rad;
    const bool told = !b.bounded || b.tilt_rad <= b.protection_rad;
    Region region = told ? Region::unavailable : Region::unavailable_misleading;
    if (inside) {
      region = told ? Region::available : b.tilt_rad <= limit_rad ? Region::misleading : Region::hazardous;
    }
    ++regions_[static_cast<size_t>(region)];
    const int level = b.usable && b.bounded ? octave_of(b.protection_rad) : kOctaves;
    ++stanford_[static_cast<size_t>(level * kOctaves + octave_of(b.tilt_rad))];
    if (outcome.first_fault_block >= 0 && k >= outcome.first_fault_block && !b.alarmed) {
      largest_nrad = std::max(largest_nrad, nrad_of(b.tilt_rad));
    }
  }
}

void Tally::add(const Plan& plan, const Spec& spec, const Outcome& o) noexcept {
  const auto cell = static_cast<size_t>(spec.cell);
  std::uint64_t* counts = &counts_[cell * kCounts];
  const auto note = [counts](Count what, bool holds) { counts[static_cast<size_t>(what)] += holds ? 1U : 0U; };
  const bool faulty = o.first_fault_block >= 0;
  const bool lies = faulty && o.faulty != 0;
  const bool nobody = o.excluded == 0 && o.provisionally_excluded == 0;
  const bool only_faulty = ((o.excluded | o.provisionally_excluded) & ~o.faulty) == 0;
  const bool misleading = o.misleading(plan.alert_limit_rad);
  note(Count::scenarios, true);
  note(Count::detected, o.detected());
  note(Count::isolated, lies && o.excluded == o.faulty);
  note(Count::partial, lies && o.excluded != 0 && o.excluded != o.faulty && (o.excluded & ~o.faulty) == 0);
  note(Count::provisional, lies && o.excluded == 0 && o.provisionally_excluded != 0 && only_faulty);
  note(Count::ambiguous, o.detected() && nobody);
  note(Count::undetected, faulty && !o.detected());
  note(Count::missed_above_threshold, lies && !o.detected() && spec.largest_mdb >= 1.0);
  note(Count::wrong_exclusion, o.wrong_exclusion());
  note(Count::wrong_provisional_exclusion, o.wrong_provisional_exclusion());
  note(Count::false_alarm, o.false_alarm());
  note(Count::misleading, misleading);
  note(Count::beyond_protection, o.beyond_protection());
  note(Count::unavailable, o.blocks > 0 && o.block[static_cast<size_t>(o.blocks - 1)].alert);
  note(Count::failed, o.failed);
  if (o.detected()) ++detect_[static_cast<size_t>(o.alarm_block - o.first_fault_block)];
  if (lies && o.isolated_block >= o.first_fault_block) {
    ++isolate_[static_cast<size_t>(o.isolated_block - o.first_fault_block)];
  }
  count_blocks(plan, o, largest_[cell]);
  if (o.wrong_exclusion()) keep(wrong_, spec.number);
  if (misleading) keep(misleading_, spec.number);
}

void Tally::merge(const Tally& other) noexcept {
  const auto sum = [](auto& to, const auto& from) {
    for (size_t k = 0; k < to.size(); ++k) to[k] += from[k];
  };
  sum(counts_, other.counts_);
  sum(detect_, other.detect_);
  sum(isolate_, other.isolate_);
  sum(regions_, other.regions_);
  sum(stanford_, other.stanford_);
  for (size_t k = 0; k < largest_.size(); ++k) largest_[k] = std::max(largest_[k], other.largest_[k]);
  for (const std::uint64_t number : other.wrong_) keep(wrong_, number);
  for (const std::uint64_t number : other.misleading_) keep(misleading_, number);
}

std::uint64_t Tally::count(int cell, Count what) const noexcept {
  return counts_[static_cast<size_t>(cell) * kCounts + static_cast<size_t>(what)];
}

std::uint64_t Tally::total(Count what) const noexcept {
  std::uint64_t sum = 0;
  for (int cell = 0; cell < cells(); ++cell) sum += count(cell, what);
  return sum;
}

std::uint64_t Tally::largest_undetected_nrad() const noexcept {
  return largest_.empty() ? 0 : *std::max_element(largest_.begin(), largest_.end());
}

Tally::Numbers Tally::numbers() const {
  Numbers out;
  append(out.sums, counts_);
  append(out.sums, detect_);
  append(out.sums, isolate_);
  append(out.sums, regions_);
  append(out.sums, stanford_);
  out.maxima = largest_;
  append(out.firsts, wrong_);
  append(out.firsts, misleading_);
  return out;
}

bool Tally::take(const Numbers& numbers) noexcept {
  size_t sum = 0, first = 0, largest = 0;
  const bool whole = take_from(numbers.sums, sum, counts_) && take_from(numbers.sums, sum, detect_) &&
                     take_from(numbers.sums, sum, isolate_) && take_from(numbers.sums, sum, regions_) &&
                     take_from(numbers.sums, sum, stanford_) && take_from(numbers.maxima, largest, largest_) &&
                     take_from(numbers.firsts, first, wrong_) && take_from(numbers.firsts, first, misleading_);
  return whole && sum == numbers.sums.size() && largest == numbers.maxima.size() && first == numbers.firsts.size();
}

int quantile_blocks(const std::array<std::uint64_t, kMostBlocks>& histogram, double share) noexcept {
  std::uint64_t total = 0;
  for (const std::uint64_t count : histogram) total += count;
  if (total == 0) return 0;
  const auto wanted = static_cast<std::uint64_t>(std::ceil(share * static_cast<double>(total)));
  std::uint64_t below = 0;
  for (size_t k = 0; k < histogram.size(); ++k) {
    below += histogram[k];
    if (below >= wanted && below > 0) return static_cast<int>(k) + 1;
  }
  return kMostBlocks;
}

}  // namespace campaign
}  // namespace plumb

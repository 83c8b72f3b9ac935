// Law 22: chips are fault units at rest. Whatever fails in a chip, it leaves and returns as a whole, the grades are
// those of chips, and no healthy unit is excluded while no more fail than the grade.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "laws/law_run.hpp"
#include "support/chip_tool.hpp"

namespace chip_life_law_test {
namespace {

using namespace plumb;
using namespace plumb_test;

/// What the array file states of chips, and nothing that the library derives from it.
class StatedChips {
 public:
  explicit StatedChips(const SensorArray& array) : array_(array) {}
  bool one_unit(int a, int b) const {
    return a == b || (array_.row(a).chip != 0 && array_.row(a).chip == array_.row(b).chip);
  }
  SensorSet whole(SensorSet set) const {
    SensorSet out;
    for (int i = 0; i < array_.size(); ++i) {
      for (int k = 0; k < array_.size(); ++k) {
        if (set.has(k) && one_unit(i, k)) out = out.with(i);
      }
    }
    return out;
  }
  std::vector<SensorSet> units(SensorSet set) const {
    std::vector<SensorSet> out;
    for (SensorSet left = set; !left.empty();) {
      const SensorSet unit = whole(SensorSet::of(left.lowest()));
      out.push_back(unit & set);
      left = left - unit;
    }
    return out;
  }
  /// How many units may lie in one plane with all of what is in the set: every choice of units is tried.
  int most_in_a_plane(SensorSet set) const {
    const std::vector<SensorSet> all = units(set);
    int most = 0;
    for (unsigned chosen = 0; chosen < 1U << all.size(); ++chosen) {
      SensorSet of;
      int count = 0;
      for (std::size_t k = 0; k < all.size(); ++k) {
        if (((chosen >> k) & 1U) == 0) continue;
        of = of | all[k];
        ++count;
      }
      if (!spans(of)) most = std::max(most, count);
    }
    return most;
  }

 private:
  bool spans(SensorSet set) const {
    for (int a = 0; a < array_.size(); ++a) {
      for (int b = 0; b < a; ++b) {
        for (int c = 0; c < b; ++c) {
          if (!set.has(a) || !set.has(b) || !set.has(c)) continue;
          if (std::fabs(dot(array_.axis(a), cross(array_.axis(b), array_.axis(c)))) > 1e-6) return true;
        }
      }
    }
    return false;
  }
  const SensorArray& array_;
};

/// What the law has to say against a step; empty = nothing.
std::string against(const StatedChips& chips, const Verdict& v, SensorSet failed) {
  const SensorSet present = v.in_service | v.provisionally_excluded | v.excluded;
  for (const SensorSet out : {v.excluded, v.provisionally_excluded, v.suspects}) {
    const SensorSet rest = (chips.whole(out) & present) - out;
    if (!rest.empty())
      return names_of(out) + " out of service or suspected, and " + names_of(rest) + " of its chip not";
  }
  const SensorSet monitored = v.in_service | v.provisionally_excluded;
  const int units = static_cast<int>(chips.units(monitored).size()), plane = chips.most_in_a_plane(monitored);
  const int confirmed = std::max(0, units - 1 - plane), provisional = std::max(0, units - 2 - plane);
  if (v.confirmed_grade != confirmed || v.provisional_grade != provisional)
    return "grades " + std::to_string(v.confirmed_grade) + " and " + std::to_string(v.provisional_grade) + " of " +
           std::to_string(units) + " units, c = " + std::to_string(plane);
  if (!failed.contains(v.excluded)) return names_of(v.excluded) + " excluded, and " + names_of(failed) + " faulty";
  for (int i = 0; i < kCapacity; ++i) {
    if (!monitored.has(i)) continue;
    if (!failed.has(i) && v.minimum_faults[slot(i)] > 1)
      return names_of(SensorSet::of(i)) + " healthy takes two faults";
    for (int k = 0; k < i; ++k) {
      if (monitored.has(k) && chips.one_unit(i, k) && v.minimum_faults[slot(i)] != v.minimum_faults[slot(k)])
        return names_of(SensorSet::of(i).with(k)) + " are one unit with two minimum fault counts";
    }
  }
  return {};
}

SensorArray drawn_array(std::uint64_t number) {
  const Vec3 axes[5] = {{0.57735026918962576, 0.57735026918962576, 0.57735026918962576},
                        {-0.57735026918962576, 0.57735026918962576, 0.57735026918962576},
                        {0.6, -0.8, 0.0},
                        {0.0, 0.6, -0.8},
                        {0.28, 0.0, 0.96}};
  constexpr std::array<std::array<int, 2>, 5> kArrays = {{{2, 0}, {2, 1}, {2, 2}, {1, 4}, {1, 5}}};
  const auto [chips, singles] = kArrays[number % kArrays.size()];
  return chip_array(chips, std::vector<Vec3>(axes, axes + singles));
}

/// A chip fails, is excluded, recovers and returns; then an axis of a chip falls silent and comes back.
class ChipLife {
 public:
  ChipLife(std::uint64_t number, TrialNoise& noise)
      : noise_(noise), array_(drawn_array(number)), chips_(array_), tool_(array_, config(), number + 1) {}

  std::string run() {
    const int chip = noise_.below(array_.row(3).chip == 0 ? 1 : 2);
    tool_.fail(chip, kChipFaults[slot(noise_.below(static_cast<int>(kChipFaults.size())))],
               static_cast<std::uint64_t>(1e9 * noise_.uniform()));
    if (!stations(6, false)) return wrong_;
    excluded = !tool_.rig.monitor.verdict().excluded.empty();
    tool_.rig.distort = [](int, double reading, int) { return reading; };
    if (!stations(14, false)) return wrong_;
    returned = excluded && tool_.rig.monitor.verdict().excluded.empty();
    return stations(2, true) ? std::string() : wrong_;
  }

  bool excluded = false, returned = false;
  int station = 0;

 private:
  static MonitorConfig config() {
    MonitorConfig out;
    out.probation_stations = 3;
    return out;
  }
  bool stations(int count, bool silent) {
    for (int k = 0; k < count; ++k, ++station) {
      if (silent) {
        for (int row = 0; row < 4 * tool_.rig.setup.config.window; ++row) {
          Sample s = tool_.rig.sample(direction_at(40 + 20 * k, 10), kG0_mps2);
          s.delivered = s.delivered.without(0);
          tool_.rig.step(s);
        }
      } else {
        tool_.station(2);
      }
      wrong_ = reinstated_in_part();
      if (wrong_.empty()) wrong_ = against(chips_, tool_.rig.monitor.verdict(), tool_.failed);
      if (!wrong_.empty()) return false;
    }
    return true;
  }

  std::string reinstated_in_part() const {
    for (const TransitionRecord& one : tool_.rig.records) {
      const SensorSet rest = chips_.whole(one.sensors) - one.sensors;
      if (one.event == HealthEvent::probation_passed && !rest.empty())
        return names_of(one.sensors) + " reinstated, and " + names_of(rest) + " of its chip not";
    }
    return {};
  }

  TrialNoise& noise_;
  SensorArray array_;
  StatedChips chips_;
  ChipRig tool_;
  std::string wrong_;
};

// Verifies: REQ-206, REQ-070, REQ-071, REQ-099
TEST(Law, TwentyTwoAChipIsSuspectedExcludedAndReinstatedAsAWhole) {
  std::uint64_t excluded = 0, returned = 0;
  const LawCount count = run_law(22, kLawCases / 4, [&](std::uint64_t number, TrialNoise& noise) -> LawOutcome {
    ChipLife life(number, noise);
    std::string wrong = life.run();
    excluded += life.excluded ? 1U : 0U;
    returned += life.returned ? 1U : 0U;
    const int n = drawn_array(number).size();
    if (!wrong.empty()) wrong = "of " + std::to_string(n) + " sensors: " + wrong;
    return {true, wrong, {n, 1, life.station}};
  });
  EXPECT_EQ(count.broken, 0U);
  if (count.cases < 100) return;  // PLUMB_LAW_CASE asks for one
  EXPECT_GT(excluded, count.cases / 4) << "cases in which a chip was excluded";
  EXPECT_GT(returned, count.cases / 8) << "cases in which it returned";
}

}  // namespace
}  // namespace chip_life_law_test

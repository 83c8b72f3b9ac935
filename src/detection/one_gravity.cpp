#include "plumb/detection/detail/one_gravity.hpp"

#include <cstddef>

namespace plumb {
inline namespace PLUMB_ABI {
namespace {

bool is_stated(const BlockTests& tests, const ReferencePanel& panel) noexcept {
  if (panel.universe > ReferenceClaims::kAllSets || !(tests.limits().acceleration_mps2 > 0.0)) return false;
  for (int i = 0; i < panel.universe; ++i) {
    if (panel.monitored.has(i) && !(tests.block().tolerance_mps2[static_cast<std::size_t>(i)] > 0.0F)) return false;
  }
  return true;
}

/// Whether less than half is left of the gravities that the set allows at one vote. Noise alone takes up less; a triple
/// of a healthy set that feels more than gravity may be contradicted before the set is.
bool doubts_one_gravity(const BlockTests& tests, SensorSet set, const SetTest& test, bool hears,
                        VoteRecord& record) noexcept {
  if (!test.tested) return false;
  const LengthError off = length_error(tests, test);
  const auto index = static_cast<int>(set.bits);
  if (hears) record.claims.hear(index, off);
  return record.claims.left_mps2(index, constant_length_error_mps2(tests)) < off.margin_mps2;
}

}  // namespace

bool contradicts_one_gravity(const BlockTests& tests, SensorSet set, bool hears, VoteRecord& record) noexcept {
  const auto index = static_cast<int>(set.bits);
  const SetTest& test = tests.of(set);
  if (hears && test.tested) record.claims.hear(index, length_error(tests, test));
  return record.claims.left_mps2(index, constant_length_error_mps2(tests)) < 0.0;
}

bool holds_one_gravity(const BlockTests& tests, const ReferencePanel& panel, bool hears, VoteRecord& record) noexcept {
  if (!is_stated(tests, panel)) return false;
  bool holds = true;
  const SensorSet all = SensorSet::first(panel.universe);
  for (SensorSet four = SensorSet::first(4); all.contains(four); four = next_of_same_size(four)) {
    if (!panel.monitored.contains(four)) continue;
    const SetTest& test = tests.of(four);
    const bool alive =
        test.parity_consistent(tests.limits()) && record.parity.agrees(tests.array(), tests.limits(), four);
    if (alive && doubts_one_gravity(tests, four, test, hears, record)) holds = false;
  }
  return holds;
}

}  // namespace PLUMB_ABI
}  // namespace plumb

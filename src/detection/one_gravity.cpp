#include "plumb/detection/detail/one_gravity.hpp"

#include <cstddef>

namespace plumb {
inline namespace PLUMB_ABI {
namespace {

bool is_stated(const BlockTests& tests, const ReferencePanel& panel) noexcept {
  if (panel.universe() > ReferenceClaims::kAllSets || !(tests.limits().acceleration_mps2 > 0.0)) return false;
  for (int i = 0; i < tests.array().size(); ++i) {
    if (panel.monitored.has(i) && !(tests.block().tolerance_mps2[static_cast<std::size_t>(i)] > 0.0F)) return false;
  }
  return true;
}

/// Whether less than half is left of the gravities that the set allows at one vote. Noise alone takes up less; a triple
/// of a healthy set that feels more than gravity may be contradicted before the set is.
bool doubts_one_gravity(const BlockTests& tests, SensorSet units, const SetTest& test, bool hears,
                        VoteRecord& record) noexcept {
  if (!test.tested) return false;
  const LengthError off = length_error(tests, test);
  const auto index = static_cast<int>(units.bits);
  if (hears) record.claims.hear(index, off);
  return record.claims.left_mps2(index, constant_length_error_mps2(tests)) < off.margin_mps2;
}

}  // namespace

bool contradicts_one_gravity(const BlockTests& tests, const ReferencePanel& panel, SensorSet units, bool hears,
                             VoteRecord& record) noexcept {
  const auto index = static_cast<int>(units.bits);
  const SetTest& test = tests.of(panel.sensors_of(units));
  if (hears && test.tested) record.claims.hear(index, length_error(tests, test));
  return record.claims.left_mps2(index, constant_length_error_mps2(tests)) < 0.0;
}

bool holds_one_gravity(const BlockTests& tests, const ReferencePanel& panel, bool hears, VoteRecord& record) noexcept {
  if (!is_stated(tests, panel)) return false;
  bool holds = true;
  // Any four sensors are heard, a plane's and another one too; of chips those that check each other.
  const int size = panel.units.grouped() ? panel.smallest_checked() : 4;
  const SensorSet all = panel.units.all(), asked = panel.units.units_of(panel.monitored);
  for (SensorSet some = SensorSet::first(size); all.contains(some); some = next_of_same_size(some)) {
    if (!asked.contains(some)) continue;
    const SensorSet set = panel.sensors_of(some);
    const SetTest& test = tests.of(set);
    const bool alive =
        test.parity_consistent(tests.limits()) && record.parity.agrees(tests.array(), tests.limits(), set);
    if (alive && doubts_one_gravity(tests, some, test, hears, record)) holds = false;
  }
  return holds;
}

}  // namespace PLUMB_ABI
}  // namespace plumb

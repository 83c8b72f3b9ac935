// From the number of a scenario to the scenario.
#include <algorithm>
#include <cmath>

#include "plumb/campaign/outcome.hpp"
#include "plumb/campaign/plan.hpp"
#include "plumb/core/sensor_set.hpp"
#include "plumb/scenario/fault.hpp"
#include "plumb/scenario/portable_math.hpp"
#include "plumb/scenario/random.hpp"

namespace plumb {
namespace campaign {
namespace {

using scenario::Purpose;
using scenario::Stream;

/// Draws in a fixed order; the index of a draw is its place in that order.
class Draws {
 public:
  explicit Draws(std::uint64_t seed) : stream_(seed, Purpose::campaign) {}
  double uniform() noexcept { return stream_.uniform(next_++); }
  double sign() noexcept { return (stream_.bits(next_++) & 1U) != 0 ? -1.0 : 1.0; }
  int below(int choices) noexcept { return std::min(static_cast<int>(uniform() * choices), choices - 1); }

 private:
  Stream stream_;
  std::uint64_t next_ = 0;
};

double size_in_mdb(const FaultPlan& fault, Draws& draws) noexcept {
  if (fault.least_mdb == fault.most_mdb) return fault.least_mdb;
  const double low = scenario::portable_log(fault.least_mdb), high = scenario::portable_log(fault.most_mdb);
  return scenario::portable_exp(low + (high - low) * draws.uniform());
}

/// Units at fault, drawn one after another: every subset of a size is as likely as any other.
class Struck {
 public:
  explicit Struck(const ToolPlan& tool) noexcept : tool_(tool), units_(tool.units()) {
    for (int i = 0; i < tool.sensors; ++i) left_ = left_.with(SensorSet(tool.unit_with(i)).lowest());
  }
  /// The sensors that fail: of the chips half fail with all of their axes, half with one.
  SensorSet next(Draws& draws) noexcept {
    int skip = draws.below(units_--), first = 0;
    while (!left_.has(first) || skip-- > 0) ++first;
    left_ = left_.without(first);
    const SensorSet unit(tool_.unit_with(first));
    if (unit.size() == 1 || draws.below(2) == 0) return unit;
    int one = first;
    for (int axis = draws.below(unit.size()); axis > 0; --axis) {
      do ++one;
      while (!unit.has(one));
    }
    return SensorSet::of(one);
  }

 private:
  const ToolPlan& tool_;
  SensorSet left_;  ///< the first sensors of the units that have not been chosen
  int units_;
};

}  // namespace

std::uint32_t ToolPlan::unit_with(int sensor) const noexcept {
  std::uint32_t out = 1U << sensor;
  const std::uint8_t own = chip[static_cast<std::size_t>(sensor)];
  for (int i = 0; i < sensors && own != 0; ++i) {
    if (chip[static_cast<std::size_t>(i)] == own) out |= 1U << i;
  }
  return out;
}

int ToolPlan::units() const noexcept {
  int out = 0;
  for (int i = 0; i < sensors; ++i) out += SensorSet(unit_with(i)).lowest() == i ? 1 : 0;
  return out;
}

Spec spec_of(const Plan& plan, std::uint64_t number) {
  Spec spec;
  spec.number = number;
  spec.seed = scenario::derive_seed(plan.seed, number);
  Draws draws(spec.seed);
  const auto cells = static_cast<std::uint64_t>(plan.cells.size());
  spec.cell = plan.sweep ? static_cast<int>(number % cells) : draws.below(static_cast<int>(cells));
  const Cell& cell = plan.cells[static_cast<std::size_t>(spec.cell)];
  const ToolPlan& tool = plan.tools[static_cast<std::size_t>(cell.tool)];
  const FaultPlan& fault = plan.faults[static_cast<std::size_t>(cell.fault)];
  spec.tool = cell.tool;
  spec.attitude = cell.attitude;
  spec.stations = plan.stations;
  spec.gravity_sigmas = cell.gravity_sigmas;
  spec.calibration_mps2 = plan.calibration_mps2;
  if (fault.healthy) return spec;
  const int onset = plan.first_onset + draws.below(plan.last_onset - plan.first_onset + 1);
  Struck struck(tool);
  const int units = fault.whole_log ? 1 : std::min(cell.faulty, kMostFaults);
  double mdb = 0.0;
  for (int k = 0; k < units; ++k) {
    SpecFault one;
    one.kind = fault.kind;
    one.onset_station = onset;
    one.duration_stations = fault.duration_stations;
    one.magnitude = fault.magnitude;
    one.upper = fault.upper;
    one.sensor = scenario::kWholeLog;
    if (fault.whole_log) {
      spec.fault[static_cast<std::size_t>(spec.faults++)] = one;
      continue;
    }
    SensorSet failing = struck.next(draws);
    const int room = kMostFaults - spec.faults - (units - 1 - k);  // every unit after this one needs a place
    if (failing.size() > room) failing = SensorSet::of(failing.lowest());
    for (one.sensor = failing.lowest(); one.sensor < tool.sensors; ++one.sensor) {
      if (!failing.has(one.sensor)) continue;
      if (fault.most_mdb > 0.0) {
        mdb = size_in_mdb(fault, draws);
        one.magnitude = draws.sign() * mdb * tool.detectable_mps2[static_cast<std::size_t>(one.sensor)];
      }
      spec.fault[static_cast<std::size_t>(spec.faults++)] = one;
    }
  }
  if (spec.faults == 1) spec.largest_mdb = mdb;
  return spec;
}

std::uint32_t faulty_of(const ToolPlan& tool, const Spec& spec) noexcept {
  std::uint32_t bits = 0;
  for (int k = 0; k < spec.faults; ++k) {
    const SpecFault& fault = spec.fault[static_cast<std::size_t>(k)];
    if (fault.sensor >= 0) bits |= tool.unit_with(fault.sensor);
    if (fault.kind == static_cast<int>(scenario::FaultKind::exchange)) {
      bits |= tool.unit_with(static_cast<int>(fault.magnitude));
    }
  }
  return bits;
}

bool Outcome::misleading(double alert_limit_rad) const noexcept {
  for (int k = 0; k < blocks; ++k) {
    const BlockOutcome& b = block[static_cast<std::size_t>(k)];
    if (b.usable && !b.alert && b.tilt_rad > alert_limit_rad) return true;
  }
  return false;
}

bool Outcome::beyond_protection() const noexcept {
  for (int k = 0; k < blocks; ++k) {
    const BlockOutcome& b = block[static_cast<std::size_t>(k)];
    if (b.usable && b.bounded && b.tilt_rad > b.protection_rad) return true;
  }
  return false;
}

}  // namespace campaign
}  // namespace plumb

/// RapidCheck generators for test cases of a monitor. Cases shrink to the fewest faults, the fewest stations and round
/// numbers. Needs RapidCheck on the user's side.
#pragma once

#include <rapidcheck.h>

#include <array>
#include <cmath>
#include <ostream>
#include <string>
#include <vector>

#include "plumb/array/named.hpp"
#include "plumb/core/config.hpp"
#include "plumb/core/units.hpp"
#include "plumb/scenario/random.hpp"
#include "plumb/testing/case.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace testing {

/// An array from axes, ids a1, a2, ...; size 0 where the axes are refused.
inline SensorArray array_of(const AxisList& axes, int n, double sigma_mps2 = 2e-4 * kG0_mps2) {
  std::array<SensorRow, kCapacity> rows{};
  for (int i = 0; i < n; ++i) {
    SensorRow& row = rows[static_cast<std::size_t>(i)];
    row.id = make_id(("a" + std::to_string(i + 1)).c_str());
    row.axis = axes[static_cast<std::size_t>(i)];
    row.sigma_mps2 = sigma_mps2;
  }
  const Expected<SensorArray> array = SensorArray::make(rows.data(), n);
  return array ? *array : SensorArray();
}

/// n axes on a cone.
inline SensorArray cone_of(int n) {
  AxisList axes{};
  return array_of(axes, cone(axes, n));
}

/// k triads at right angles, each turned by an angle of its own about the diagonal of the frame.
inline SensorArray triads_of(int k) {
  AxisList axes{};
  for (int t = 0; t < k; ++t) {
    for (std::size_t i = 0; i < 3; ++i) {
      Vec3 axis{};
      axis[i] = 1.0;
      const double third = 1.0 / std::sqrt(3.0);
      axes[static_cast<std::size_t>(3 * t) + i] = scenario::seen_from_turned(axis, {third, third, third}, 0.4 * t);
    }
  }
  return array_of(axes, 3 * k);
}

/// The built-in geometries of `least` to `most` sensors.
inline rc::Gen<SensorArray> named_arrays(int least = 4, int most = 8) {
  return rc::gen::exec([least, most] {
    const int n = *rc::gen::inRange(least, most + 1);
    const int way = *rc::gen::inRange(0, 3);
    AxisList axes{};
    int made = 0;
    if (way == 2) made = n == 4 ? paper_tetrahedron(axes) : platonic(axes, n);
    if (way == 1) made = cone_with_axis(axes, n);
    if (made < 3) made = cone(axes, n);
    return array_of(axes, made);
  });
}

/// n axes anywhere, every three of them with a determinant of at least `floor`: the tries go on until that is so.
inline rc::Gen<SensorArray> random_arrays(int n, double floor = 0.15) {
  return rc::gen::suchThat(rc::gen::map(rc::gen::arbitrary<std::uint64_t>(),
                                        [n](std::uint64_t seed) {
                                          const scenario::Stream stream(seed, scenario::Purpose::test);
                                          AxisList axes{};
                                          for (int i = 0; i < n; ++i) {
                                            axes[static_cast<std::size_t>(i)] =
                                                stream.direction(static_cast<std::uint64_t>(i));
                                          }
                                          return array_of(axes, n);
                                        }),
                           [n, floor](const SensorArray& array) {
                             bool good = array.size() == n;
                             for (int k = 0; good && k < array.triple_count(); ++k) {
                               good = std::abs(array.triple(k).det) >= floor;
                             }
                             return good;
                           });
}

/// Two to three triads.
inline rc::Gen<SensorArray> triads() {
  return rc::gen::map(rc::gen::inRange(2, 4), [](int k) { return triads_of(k); });
}

/// How the faulty sensors of a case belong together.
enum class Conspiracy : std::uint8_t { single, simultaneous, sequential, mirrored, colluding };

/// A round acceleration: 1, 2, 5 times a power of ten, 1 mg0 to 1 g0, either sign. Shrinks to 1 mg0.
inline rc::Gen<double> round_accelerations() {
  return rc::gen::exec([] {
    const int step = *rc::gen::inRange(0, 10);
    const bool negative = *rc::gen::arbitrary<bool>();
    constexpr double kMantissa[] = {1.0, 2.0, 5.0};
    const double mg0 = kMantissa[step % 3] * std::pow(10.0, step / 3);
    return (negative ? -mg0 : mg0) * (1e-3 * kG0_mps2);
  });
}

/// A fault of one sensor that needs no other: bias, stuck, held, random, drift, scale, noise, spikes. Simplest first.
inline rc::Gen<scenario::Fault> lone_faults(int sensors, int stations) {
  return rc::gen::exec([sensors, stations] {
    using scenario::FaultKind;
    constexpr FaultKind kKinds[] = {FaultKind::bias_step,    FaultKind::stuck_level, FaultKind::random_level,
                                    FaultKind::random_range, FaultKind::drift,       FaultKind::scale_change,
                                    FaultKind::noise,        FaultKind::spikes};
    scenario::Fault fault;
    fault.kind = kKinds[*rc::gen::inRange(0, 8)];
    fault.sensor = *rc::gen::inRange(0, sensors);
    fault.clock = scenario::Clock::station;
    fault.onset = *rc::gen::inRange(1, std::max(2, stations / 2));
    fault.magnitude = *round_accelerations();
    switch (fault.kind) {
      case FaultKind::random_level:
      case FaultKind::random_range:
        fault.magnitude = -std::abs(fault.magnitude);
        fault.upper = -fault.magnitude;
        break;
      case FaultKind::drift: fault.magnitude *= 0.1; break;
      case FaultKind::scale_change: fault.magnitude = 1.0 + fault.magnitude / kG0_mps2; break;
      case FaultKind::noise: fault.magnitude = std::abs(fault.magnitude); break;
      case FaultKind::spikes: fault.upper = 0.02; break;
      default: break;
    }
    return fault;
  });
}

/// At most `most` faulty sensors of the array; two faults never strike the same one.
inline rc::Gen<std::vector<scenario::Fault>> faults(const SensorArray& array, int most, int stations) {
  const int n = array.size();
  return rc::gen::exec([n, most, stations] {
    const auto way = static_cast<Conspiracy>(*rc::gen::inRange(0, 5));
    auto drawn = *rc::gen::container<std::vector<scenario::Fault>>(lone_faults(n, stations));
    std::vector<scenario::Fault> out;
    SensorSet taken;
    const int room = way == Conspiracy::single ? std::min(1, most) : most;
    for (scenario::Fault fault : drawn) {
      if (taken.has(fault.sensor) || taken.size() >= room) continue;
      taken = taken.with(fault.sensor);
      if (way == Conspiracy::simultaneous) fault.onset = drawn.front().onset;
      if (way == Conspiracy::sequential) fault.onset = std::min<double>(stations, 1 + 3 * (taken.size() - 1));
      if (way == Conspiracy::colluding || way == Conspiracy::mirrored) {
        fault.onset = 1.0;
        fault.kind = scenario::FaultKind::ghost;
        fault.magnitude = rad_from_deg(20.0);
        fault.upper = 0.0;
      }
      out.push_back(fault);
    }
    if (way == Conspiracy::mirrored && n - taken.size() >= 2) {
      // The mirror is the plane of the two lowest healthy axes.
      const SensorSet healthy = SensorSet::first(n) - taken;
      const int j = healthy.lowest();
      const int k = healthy.without(j).lowest();
      for (scenario::Fault& fault : out) {
        fault.kind = scenario::FaultKind::mirror;
        fault.magnitude = j;
        fault.upper = k;
      }
    }
    return out;
  });
}

/// How the tool goes from station to station; shrinks to random attitudes.
inline rc::Gen<Walk> walks() { return rc::gen::element(Walk::random, Walk::random, Walk::rolling, Walk::drilling); }

/// Cases on one array: attitudes, noise, calibration and gravity errors, and up to n - 3 faults.
inline rc::Gen<Case> cases(const SensorArray& array, const MonitorConfig& config = {}) {
  return rc::gen::exec([array, config] {
    Case c;
    c.array = array;
    c.config = config;
    c.stations = *rc::gen::inRange(8, 21);
    c.gravity_error = *rc::gen::element(0.0, 1.0, -1.0, 3.0, -3.0);
    c.calibration_mps2 = 1e-5 * kG0_mps2 * *rc::gen::inRange(0, 6);
    c.noise = *rc::gen::element(1.0, 0.5, 0.0);
    c.faults = *faults(array, std::max(0, array.size() - 3), c.stations);
    c.seed = static_cast<std::uint64_t>(*rc::gen::inRange(1, 1000000));
    c.walk = *walks();
    if (c.walk != Walk::random) c.inclination_rad = rad_from_deg(*rc::gen::element(90.0, 45.0, 5.0, 2.0));
    return c;
  });
}

/// How RapidCheck shows a case: a sentence, and the scenario that replays it.
inline void showValue(const Case& c, std::ostream& out) {
  out << sentence_of(c) << "\nReplay: save what follows as case.toml and run `plumb simulate case.toml`\n"
      << toml_of(c);
}

}  // namespace testing
}  // namespace PLUMB_ABI
}  // namespace plumb

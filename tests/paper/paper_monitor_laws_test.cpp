/// Laws of paper mode over random tools, faults and histories.
#include "plumb/paper/paper_monitor.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cstring>
#include <limits>

#include "paper/paper_rig.hpp"

// Serves: REQ-190

namespace paper_monitor_laws_test {
namespace {

using namespace plumb;
using paper_test::at;
using paper_test::direction_at;
using paper_test::PaperRig;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// Wild values, times, temperatures and dropouts.
Sample wild_sample(calibration_test::Noise& noise, PaperRig& rig) {
  const double specials[] = {kNan, std::numeric_limits<double>::infinity(), 1e308, -1e308, 5e-324, 0.0, 9.8};
  const double angle = 360.0 * noise.uniform();
  Sample s = rig.sample(direction_at(40, noise.uniform() < 0.9 ? 60.0 : angle));
  if (noise.uniform() < 0.02) s.time_s = specials[static_cast<int>(noise.uniform() * 7)];
  if (noise.uniform() < 0.02) s.temperature_degc = specials[static_cast<int>(noise.uniform() * 7)];
  if (noise.uniform() < 0.02) s.count = 0;
  const double wildness = noise.uniform() < 0.7 ? 0.0 : 0.3;
  for (std::size_t i = 0; i < s.raw.size(); ++i) {
    if (noise.uniform() < wildness) s.raw[i] = specials[static_cast<int>(noise.uniform() * 7)];
    if (noise.uniform() < wildness) s.delivered = s.delivered.without(static_cast<int>(i));
  }
  return s;
}

RC_GTEST_PROP(PaperMonitorLaw, IsTotalPartitionsTheSensorsAndReplaysBitForBit, ()) {
  const int n = *rc::gen::inRange(3, 6);
  const auto seed = *rc::gen::arbitrary<std::uint64_t>();
  const int cut = *rc::gen::inRange(1, 400);
  calibration_test::Noise noise(seed);
  PaperRig rig(n, 1);
  auto twin = std::make_unique<PaperMonitor>(*rig.monitor);
  for (int k = 0; k < 500; ++k) {
    if (k == cut) *twin = PaperMonitor(*rig.monitor);  // a snapshot is an assignment
    const Sample s = wild_sample(noise, rig);
    const Verdict& v = rig.monitor->step(s);
    const Verdict& w = twin->step(s);
    RC_ASSERT((v.in_service | v.excluded | v.absent) == v.configured);
    RC_ASSERT(v.in_service.size() + v.excluded.size() + v.absent.size() == n);
    for (const double x : v.gravity_mps2) RC_ASSERT(std::isfinite(x));
    for (const double x : v.covariance) RC_ASSERT(std::isfinite(x));
    for (const double x : v.latest_mps2) RC_ASSERT(std::isfinite(x));
    RC_ASSERT(std::isfinite(v.statistic) && std::isfinite(v.parity) && std::isfinite(v.mae_all_mps2));
    if (v.state == HealthState::suspect) RC_ASSERT(v.validity != Validity::valid && v.validity != Validity::degraded);
    if (v.state == HealthState::failed) RC_ASSERT(v.validity == Validity::invalid);
    RC_ASSERT(std::memcmp(&v.gravity_mps2, &w.gravity_mps2, sizeof(Vec3)) == 0);
    RC_ASSERT(std::memcmp(&v.statistic, &w.statistic, sizeof(double)) == 0);
    RC_ASSERT(v.state == w.state && v.in_service == w.in_service && v.validity == w.validity && v.cause == w.cause);
    RC_ASSERT(v.transition.sequence == w.transition.sequence);
  }
}

RC_GTEST_PROP(PaperMonitorLaw, TheReadingsOfAnExcludedSensorChangeNothing, ()) {
  const int faulty = *rc::gen::inRange(0, 5);
  const auto seed = *rc::gen::inRange<std::uint64_t>(1, 1000);
  calibration_test::Noise noise(seed);
  PaperRig rig(5, 4, seed);
  rig.prove();
  rig.stick(faulty, 0.4 * kG0_mps2);
  rig.tour(8);
  RC_PRE(rig.monitor->verdict().excluded == SensorSet::of(faulty));
  auto twin = std::make_unique<PaperMonitor>(*rig.monitor);
  for (int k = 0; k < 320; ++k) {
    Sample s = rig.sample(direction_at(30.0 + 10.0 * (k / 32), 50.0 * (k / 32)));
    s.raw[at(faulty)] = 77.0;
    const Verdict v = rig.monitor->step(s);
    s.raw[at(faulty)] = -5e3 * noise.uniform();
    const Verdict& w = twin->step(s);
    RC_ASSERT(v.gravity_mps2 == w.gravity_mps2);
    RC_ASSERT(v.latest_mps2 == w.latest_mps2);
    RC_ASSERT(v.statistic == w.statistic);
    RC_ASSERT(v.parity == w.parity);
    RC_ASSERT(v.state == w.state);
  }
}

/// With one fault of four and pooled attitudes the paper's rule names nobody else.
RC_GTEST_PROP(PaperMonitorLaw, OneStuckSensorOfFourNeverExcludesAnother, ()) {
  const int faulty = *rc::gen::inRange(0, 4);
  const auto seed = *rc::gen::inRange<std::uint64_t>(1, 100000);
  calibration_test::Noise noise(seed);
  const double level = noise.within(kG0_mps2);
  PaperRig rig(4, 4, seed);
  rig.prove();
  rig.stick(faulty, level);
  for (int k = 0; k < 16; ++k) rig.stay(scaled(noise.direction(), 1.0));
  RC_ASSERT(SensorSet::of(faulty).contains(rig.ever_excluded));
  RC_PRE(!rig.ever_excluded.empty());  // now and then the level is what it would read
}

}  // namespace
}  // namespace paper_monitor_laws_test

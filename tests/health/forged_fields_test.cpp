// A snapshot in which one figure was exchanged and the sums made true again: every figure, in every state of a monitor.
// The laws of tests/health/snapshot_laws_test.cpp draw a few of them; each rule by which a state is judged has its own.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include "first_calibration_support.hpp"
#include "snapshot_support.hpp"

namespace forged_fields_test {
namespace {

using namespace plumb;
using plumb_test::Bytes;
using plumb_test::direction_at;
using plumb_test::Places;
using plumb_test::random_direction;
using plumb_test::Rig;
using plumb_test::snapshot_of;
using plumb_test::Tool;
using plumb_test::UncalibratedTool;

/// All of them, but of a long row of figures (covariances, stations) every eighth.
std::vector<Places::Place> places_of(HealthMonitor& monitor) {
  constexpr std::size_t kLongRow = 40, kOfLongRow = 8;
  const Places places(monitor);
  std::vector<Places::Place> out;
  for (std::size_t k = 0; k < places.list.size();) {
    std::size_t end = k;
    while (end < places.list.size() && places.list[end].real) ++end;
    const std::size_t step = end - k > kLongRow ? kOfLongRow : 1;
    for (end = end > k ? end : k + 1; k < end; k += step) out.push_back(places.list[k]);
    k = end;
  }
  return out;
}

std::uint64_t read(const Bytes& bytes, const Places::Place& p) {
  std::uint64_t out = 0;
  for (std::size_t k = 0; k < p.width; ++k) out |= std::uint64_t{bytes[p.at + k]} << (8 * k);
  return out;
}

void write(Bytes& bytes, const Places::Place& p, std::uint64_t value) {
  for (std::size_t k = 0; k < p.width; ++k) bytes[p.at + k] = static_cast<std::uint8_t>(value >> (8 * k));
}

/// What is put in the place of a figure: its neighbours, its bits, and what does most harm.
std::vector<std::uint64_t> lies_for(std::uint64_t value, const Places::Place& p) {
  if (!p.real) return {value ^ 1U, value ^ 2U, value ^ 4U, value + 1, value - 1, value ^ 8U, 0, ~std::uint64_t{0}};
  double real = 0.0;
  std::memcpy(&real, &value, sizeof real);
  std::vector<std::uint64_t> out;
  for (const double lie : {-real, 0.0, 2.0 * real + 1.0, 1e200, -1.0, real * (1.0 + 1e-12)}) {
    std::uint64_t bits = 0;
    std::memcpy(&bits, &lie, sizeof bits);
    out.push_back(bits);
  }
  return out;
}

/// What a forged snapshot came to, and whether the monitor keeps its word for a while.
struct Tally {
  int refused = 0, taken = 0;
};

void expect_sane(const Verdict& v, int n) {
  EXPECT_EQ(v.in_service | v.provisionally_excluded | v.excluded | v.absent, v.configured);
  EXPECT_EQ(v.in_service.size() + v.provisionally_excluded.size() + v.excluded.size() + v.absent.size(), n);
  if (v.state == HealthState::failed) {
    EXPECT_EQ(v.validity, Validity::invalid);
  }
  if (v.state == HealthState::suspect) {
    EXPECT_NE(v.validity, Validity::valid);
    EXPECT_NE(v.validity, Validity::degraded);
  }
}

/// A refusal is told and leaves a monitor as fresh as one that was just switched on; what is taken is a state.
void restore_forged(HealthMonitor& victim, const MonitorSetup& setup, const Bytes& bytes, const Sample& sample,
                    Tally& tally) {
  const Expected<void> taken = victim.restore(setup, bytes.data(), bytes.size());
  if (!taken) {
    ++tally.refused;
    ASSERT_EQ(taken.error().code, Errc::snapshot_implausible);
    ASSERT_EQ(victim.verdict().snapshot_refusal, Errc::snapshot_implausible);
    ASSERT_NE(victim.verdict().qualifiers & Qualifier::not_yet_validated, 0);
    return;
  }
  ++tally.taken;
  for (int k = 0; k < 3; ++k) expect_sane(victim.step(sample), setup.array.size());
}

/// The figures of the monitor's snapshot, each with every lie.
Tally forge_all(HealthMonitor& monitor, const MonitorSetup& setup, const Sample& sample, const std::string& name) {
  const Bytes good = snapshot_of(monitor);
  auto victim = std::make_unique<HealthMonitor>();
  EXPECT_TRUE(victim->restore(setup, good.data(), good.size()).has_value()) << name;
  Tally tally;
  Bytes bytes = good;
  for (const Places::Place& p : places_of(monitor)) {
    const std::uint64_t true_value = read(good, p);
    for (const std::uint64_t lie : lies_for(true_value, p)) {
      write(bytes, p, lie);
      if (bytes == good) continue;
      plumb_test::seal(bytes);
      restore_forged(*victim, setup, bytes, sample, tally);
      if (testing::Test::HasFailure()) {
        ADD_FAILURE() << name << ": byte " << p.at << ", " << true_value << " -> " << lie;
        return tally;
      }
      bytes = good;
    }
  }
  return tally;
}

/// Refusals must be the rule where much is remembered, and what is not judged must be taken.
void expect_both(const Tally& tally, const std::string& name) {
  EXPECT_GT(tally.refused, 100) << name;
  EXPECT_GT(tally.taken, 100) << name;
}

void forge(Rig& rig, const std::string& name) {
  HealthMonitor& monitor = rig.monitor;
  const Sample next = rig.sample(direction_at(20, 200), kG0_mps2);
  expect_both(forge_all(monitor, rig.setup, next, name), name);
}

void forge(UncalibratedTool& tool, const std::string& name) {
  const Sample next = tool.sample(direction_at(20, 200));
  expect_both(forge_all(tool.monitor, tool.setup, next, name), name);
}

RecalibrationPhase phase_of(const HealthMonitor& monitor) {
  return monitor.recalibration().progress(monitor.array()).phase;
}

/// Steps until the collection has come to `phase`; under an inhibit an accepted fit waits.
bool lead_to(Tool& tool, RecalibrationPhase phase) {
  for (int k = 0; k < 60; ++k) {
    const Vec3 u = random_direction(tool.directions);
    for (int s = 0; s < 64; ++s) {
      if (phase_of(tool.rig.monitor) == phase) return true;
      if (phase_of(tool.rig.monitor) == RecalibrationPhase::fitting) tool.rig.monitor.inhibit(true);
      tool.rig.step(tool.rig.sample(u, kG0_mps2));
    }
  }
  return false;
}

// Negative: REQ-163
TEST(ForgedFields, OfAValidatedMonitorInTheMiddleOfABlock) {
  Rig rig(plumb_test::tetrahedron());
  rig.prove();
  for (int k = 0; k < 11; ++k) rig.step(rig.sample(direction_at(20, 30), kG0_mps2));
  forge(rig, "nominal");
}

// Negative: REQ-163
TEST(ForgedFields, OfASuspicionAndAnExclusion) {
  Tool tool(4, {}, 3);
  tool.rig.prove();
  tool.fault = [](int i, double r, int) { return i == 2 ? r + 0.3 : r; };
  tool.visit(2);
  ASSERT_EQ(tool.state(), HealthState::suspect);
  forge(tool.rig, "suspect");
  Tool six(6, {}, 3);
  six.rig.prove();
  six.fault = tool.fault;
  six.visit(8);
  ASSERT_EQ(six.rig.monitor.verdict().excluded, SensorSet::of(2));
  forge(six.rig, "excluded");
}

// Negative: REQ-163
TEST(ForgedFields, OfARecalibrationInEachPhase) {
  Tool tool(4, {}, 5);
  tool.drift(2e-3);
  tool.begin();
  tool.visit(3);
  forge(tool.rig, "collecting");
  ASSERT_TRUE(lead_to(tool, RecalibrationPhase::fitting));
  forge(tool.rig, "fitting");
  ASSERT_TRUE(lead_to(tool, RecalibrationPhase::accepted));
  forge(tool.rig, "accepted");
  tool.rig.monitor.inhibit(false);
  tool.visit(2);
  ASSERT_EQ(tool.count(HealthEvent::fit_accepted), 1);
  forge(tool.rig, "adopted");
}

/// Of a snapshot of that monitor, the bytes of its recalibration's lengths: they follow upon the commissioning
/// calibration, scales first, and upon when one was adopted, and are about 1. 0 where they are not found, or not once.
std::size_t place_of_lengths(const HealthMonitor& monitor, const SensorModel& commissioned, const Bytes& bytes) {
  const auto n = static_cast<std::size_t>(monitor.array().size());
  std::vector<double> before(2 * n);
  for (std::size_t i = 0; i < n; ++i) {
    before[i] = commissioned.sensor[i].scale[0];
    before[n + i] = commissioned.sensor[i].bias[0];
  }
  const std::size_t adoption = sizeof(double) + 1;  // when, and whether
  const std::size_t width = before.size() * sizeof(double);
  std::size_t found = 0;
  int times = 0;
  for (std::size_t k = 0; k + width + adoption + n * sizeof(double) <= bytes.size(); ++k) {
    if (std::memcmp(bytes.data() + k, before.data(), width) != 0) continue;
    std::vector<double> length(n);
    std::memcpy(length.data(), bytes.data() + k + width + adoption, n * sizeof(double));
    if (std::any_of(length.begin(), length.end(), [](double l) { return !(std::fabs(l - 1.0) < 0.01); })) continue;
    found = k + width + adoption;
    ++times;
  }
  return times == 1 ? found : 0;
}

/// Every length that is in use is divided by.
void expect_lengths_judged(Rig& rig) {
  const Bytes good = snapshot_of(rig.monitor);
  const std::size_t place = place_of_lengths(rig.monitor, rig.setup.model, good);
  ASSERT_GT(place, 0U);
  auto victim = std::make_unique<HealthMonitor>();
  ASSERT_TRUE(victim->restore(rig.setup, good.data(), good.size()).has_value());
  for (std::size_t i = 0; i < 4; ++i) {
    double length = 0.0;
    std::memcpy(&length, good.data() + place + i * sizeof length, sizeof length);
    ASSERT_NEAR(length, 1.0, 0.01) << i;
    for (const double lie : {0.0, -0.0, 5e-324, 1e-300, 0.4, 1.6, -1.0, 1e300, std::nan(""), HUGE_VAL}) {
      Bytes bytes = good;
      std::memcpy(bytes.data() + place + i * sizeof lie, &lie, sizeof lie);
      plumb_test::seal(bytes);
      const Expected<void> taken = victim->restore(rig.setup, bytes.data(), bytes.size());
      ASSERT_FALSE(taken.has_value()) << i << " " << lie;
      EXPECT_EQ(taken.error().code, Errc::snapshot_implausible) << i << " " << lie;
    }
  }
}

// Negative: REQ-163
TEST(ForgedFields, ALengthThatNoFitCanHaveGivenIsRefused) {
  Tool fitted(4, {}, 5);
  fitted.drift(2e-3);
  fitted.begin();
  ASSERT_TRUE(lead_to(fitted, RecalibrationPhase::accepted));
  expect_lengths_judged(fitted.rig);
  Tool offered(4, {}, 7);
  offered.rig.prove();
  SensorArray array = offered.rig.setup.array;
  plumb_test::leave_uncertainty(array, 3e-4, 3e-5);
  ASSERT_TRUE(offered.rig.monitor.offer_calibration(offered.rig.setup.model, array).has_value());
  expect_lengths_judged(offered.rig);
}

// Negative: REQ-163
TEST(ForgedFields, OfAnOfferThatWaitsAndOfOneThatIsTried) {
  Tool tool(4, {}, 7);
  tool.drift(1e-3);
  tool.rig.prove();
  SensorModel model = tool.rig.setup.model;
  SensorArray array = tool.rig.setup.array;
  for (std::size_t i = 0; i < 4; ++i) model.sensor[i].bias[0] = tool.bias[i];
  plumb_test::leave_uncertainty(array, 3e-4, 3e-5);
  ASSERT_TRUE(tool.rig.monitor.offer_calibration(model, array).has_value());
  forge(tool.rig, "offered");
  tool.visit(3);
  ASSERT_EQ(tool.state(), HealthState::recalibrating);
  forge(tool.rig, "offer tried");
}

// Negative: REQ-163
TEST(ForgedFields, OfAFirstCalibrationAndWhatCameOfIt) {
  UncalibratedTool tool(4, 3);
  tool.start();
  Vec3 u = direction_at(20, 200);
  for (int k = 0; k < 5; ++k) tool.stay(random_direction(tool.noise));
  forge(tool, "initial");
  for (int k = 0; k < 4000 && phase_of(tool.monitor) == RecalibrationPhase::collecting; ++k) {
    const Vec3 wanted = tool.monitor.verdict().recalibration.wanted_direction;
    if (k % 32 == 0) u = norm(wanted) > 0.5 ? wanted : random_direction(tool.noise);
    tool.step(tool.sample(u));
  }
  ASSERT_EQ(phase_of(tool.monitor), RecalibrationPhase::fitting);
  forge(tool, "first fit");
  tool.monitor.inhibit(true);
  tool.follow(30);
  ASSERT_EQ(phase_of(tool.monitor), RecalibrationPhase::accepted);
  forge(tool, "first fit, accepted");
  tool.monitor.inhibit(false);
  tool.follow(30);
  ASSERT_TRUE(tool.calibrated());
  forge(tool, "calibrated by itself");
}

/// The vector that was published last must be that of the evidence, which the host still reads: another one is refused,
/// whichever figure is made endless so that everything seems near to it.
// Negative: REQ-163
TEST(ForgedFields, AVectorThatTheEvidenceDoesNotGiveIsRefused) {
  Rig rig(plumb_test::tetrahedron());
  rig.prove();
  HealthMonitor& monitor = rig.monitor;
  const Bytes good = snapshot_of(monitor);
  auto victim = std::make_unique<HealthMonitor>();
  ASSERT_TRUE(plumb_test::is_taken_up(*victim, rig.setup, good));
  const Places places(monitor);
  const auto published = std::find_if(places.list.begin(), places.list.end(), [&monitor](const Places::Place& p) {
    return p.figure == &monitor.verdict().gravity_mps2[0];
  });
  ASSERT_NE(published, places.list.end());
  Bytes turned = good;
  const double lie = monitor.verdict().gravity_mps2[0] + 1.0;
  std::memcpy(turned.data() + published->at, &lie, sizeof lie);
  EXPECT_FALSE(plumb_test::is_taken_up(*victim, rig.setup, turned));
  for (const Places::Place& p : places.list) {
    if (!p.real || p.at == published->at) continue;
    for (const double endless : {1e30, 1e200, 1e308}) {
      Bytes bytes = turned;
      std::memcpy(bytes.data() + p.at, &endless, sizeof endless);
      EXPECT_FALSE(plumb_test::is_taken_up(*victim, rig.setup, bytes)) << p.at << " " << endless;
    }
  }
}

// Negative: REQ-163
TEST(ForgedFields, OfAMonitorThatHasFailed) {
  Rig rig(plumb_test::tetrahedron());
  rig.prove();
  for (int k = 0; k < 50; ++k) {
    Sample sample = rig.sample(direction_at(40, 10), kG0_mps2);
    sample.delivered = SensorSet::first(2);
    rig.step(sample);
  }
  ASSERT_EQ(rig.monitor.verdict().state, HealthState::failed);
  forge(rig, "failed");
}

}  // namespace
}  // namespace forged_fields_test

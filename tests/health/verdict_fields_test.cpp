// What a verdict says beside the state: temperature and its rate, the triples one by one, the configuration.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "plumb/health/detail/temperature_rate.hpp"
#include "support/simulated_tool.hpp"

// Serves: REQ-124

namespace verdict_fields_test {
namespace {

using namespace plumb;
using plumb_test::direction_at;
using plumb_test::Rig;

/// Minutes at one attitude, the temperature rising by so much.
const Verdict& heated(Rig& rig, double minutes, double degc_per_min) {
  const double start_s = rig.monitor.verdict().time_s;
  for (int k = 0; k < static_cast<int>(minutes * 6000.0); ++k) {
    Sample s = rig.sample(direction_at(60, 250), kG0_mps2);
    s.temperature_degc = 25.0 + degc_per_min * (s.time_s - start_s) / 60.0;
    rig.step(s);
  }
  return rig.monitor.verdict();
}

TEST(VerdictFields, TheRateOfTheTemperatureIsGiven) {
  Rig rig(plumb_test::tetrahedron());
  rig.prove();
  EXPECT_EQ(rig.monitor.verdict().temperature_rate_degc_per_min, 0.0) << "not known yet";
  const Verdict& v = heated(rig, 1.5, 4.0);
  EXPECT_NEAR(v.temperature_rate_degc_per_min, 4.0, 0.05);
  EXPECT_NEAR(v.temperature_degc, 31.0, 0.01);
  EXPECT_TRUE(v.usable & Usable::temperature);
  EXPECT_EQ(v.validity, Validity::valid);
}

TEST(VerdictFields, ATemperatureInAHurryIsNotUsable) {
  Rig rig(plumb_test::tetrahedron());
  rig.prove();
  EXPECT_FALSE(heated(rig, 1.5, -6.0).usable & Usable::temperature);
  EXPECT_TRUE(heated(rig, 2.5, 0.0).usable & Usable::temperature) << "settled again";
}

TEST(TemperatureRate, LooksBackHalfAMinuteToAWholeOne) {
  TemperatureRate rate;
  for (int t = 0; t < 30; ++t) {
    rate.add(t, 20.0 + t);
    EXPECT_EQ(rate.degc_per_min(), 0.0);
  }
  rate.add(30.0, 50.0);
  EXPECT_DOUBLE_EQ(rate.degc_per_min(), 60.0);
  EXPECT_FALSE(rate.slow());
  for (int t = 31; t <= 120; ++t) rate.add(t, 50.0);
  EXPECT_EQ(rate.degc_per_min(), 0.0);
  rate.add(200.0, std::numeric_limits<double>::max());
  EXPECT_TRUE(std::isfinite(rate.degc_per_min()));
  rate.clear();
  rate.add(0.0, -40.0);
  EXPECT_EQ(rate.degc_per_min(), 0.0) << "another clock";
}

int triples_of(const TripleSet& set, const SensorArray& array) {
  int count = 0;
  for (int k = 0; k < array.triple_count(); ++k) count += set.has(k) ? 1 : 0;
  return count;
}

TEST(VerdictFields, EveryTripleSaysWhetherItPassed) {
  Rig rig(plumb_test::tetrahedron());
  EXPECT_TRUE(rig.monitor.verdict().triples_tested.empty());
  rig.prove();
  const SensorArray& array = rig.setup.array;
  EXPECT_EQ(triples_of(rig.monitor.verdict().triples_tested, array), 4);
  EXPECT_EQ(triples_of(rig.monitor.verdict().triples_passed, array), 4);
  rig.distort = [](int i, double r, int) { return i == 2 ? r + 0.3 : r; };
  const Verdict& v = rig.stay(direction_at(45, 200));
  ASSERT_EQ(v.transition.event, HealthEvent::alarm);
  EXPECT_EQ(triples_of(v.triples_tested, array), 4);
  for (int k = 0; k < array.triple_count(); ++k) {
    EXPECT_EQ(v.triples_passed.has(k), !array.triple(k).set().has(2)) << "without the faulty one all agree";
  }
}

TEST(VerdictFields, ATripleThatIsNotTestedIsNotSaidToPass) {
  Rig rig(plumb_test::cone_array(6));
  rig.prove();
  rig.distort = [](int i, double r, int) { return i == 2 ? std::numeric_limits<double>::quiet_NaN() : r; };
  const Verdict& v = rig.stay(direction_at(45, 200), 2);
  ASSERT_EQ(v.absent, SensorSet::of(2));
  const SensorArray& array = rig.setup.array;
  EXPECT_EQ(triples_of(v.triples_tested, array), 10);
  for (int k = 0; k < array.triple_count(); ++k) {
    EXPECT_EQ(v.triples_tested.has(k), !array.triple(k).set().has(2));
    EXPECT_EQ(v.triples_passed.has(k), v.triples_tested.has(k));
  }
}

TEST(VerdictFields, EveryVerdictNamesItsConfiguration) {
  Rig rig(plumb_test::tetrahedron()), same(plumb_test::tetrahedron());
  const std::uint64_t hash = rig.monitor.verdict().config_hash;
  EXPECT_NE(hash, 0U);
  EXPECT_EQ(same.stay(direction_at(20, 10)).config_hash, hash);
  rig.setup.config.isolation_timeout = 7;
  rig.restart();
  const std::uint64_t other = rig.monitor.verdict().config_hash;
  EXPECT_NE(other, hash);
  rig.setup.resolution_raw[2] = 1e-3;
  rig.restart();
  EXPECT_NE(rig.monitor.verdict().config_hash, other);
  EXPECT_EQ(HealthMonitor().verdict().config_hash, 0U) << "not configured";
}

}  // namespace
}  // namespace verdict_fields_test

// The C functions: the same verdicts as the C++ monitor, bit for bit, and every misuse an answer.
#include "plumb/c/plumb.h"

#include <gtest/gtest.h>

#include <cstring>
#include <string>
#include <vector>

#include "../../src/c/c_api.hpp"
#include "c_form.hpp"
#include "health/snapshot_support.hpp"

namespace plumb_c_test {
namespace {

using namespace plumb;
using c_test::c_form;
using c_test::CForm;
using c_test::difference;
using c_test::Memory;
using c_test::same;
using plumb_test::Life;

TEST(CFunctions, GiveTheSameVerdictsOverAMillionSamples) {
  int samples = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    Life life(seed % 2 == 0 ? 4 : 6, seed);
    HealthMonitor& twin = life.tool.rig.monitor;
    const CForm form(life.tool.rig.setup);
    Memory memory;
    ASSERT_EQ(memory.init(&form.config).code, PLUMB_OK);
    plumb_verdict verdict;
    plumb_verdict_defaults(&verdict);
    for (int k = 0; k < 100000; ++k, ++samples) {
      const Sample s = life.next({&twin, &memory.monitor->monitor});
      const plumb_sample given = c_form(s);
      ASSERT_EQ(plumb_monitor_step(memory.monitor, &given, &verdict).code, PLUMB_OK);
      ASSERT_EQ(difference(verdict, twin.step(s)), "") << "seed " << seed << ", sample " << k;
    }
  }
  EXPECT_EQ(samples, 1000000);
}

TEST(CFunctions, WhatTheHostAsksReachesTheMonitor) {
  Life life(4, 3);
  HealthMonitor& twin = life.tool.rig.monitor;
  const CForm form(life.tool.rig.setup);
  Memory memory;
  ASSERT_EQ(memory.init(&form.config).code, PLUMB_OK);
  plumb_monitor* c = memory.monitor;
  EXPECT_EQ(plumb_monitor_reset(c, 1, 15).code, static_cast<int>(Errc::wrong_key));
  EXPECT_EQ(plumb_monitor_set_gravity(c, 32.2, 1e-3).code, static_cast<int>(Errc::implausible_gravity));
  EXPECT_EQ(plumb_monitor_request_recalibration(c).code, static_cast<int>(Errc::wrong_state));
  EXPECT_EQ(plumb_monitor_set_gravity(c, 9.81, 2e-3).code, PLUMB_OK);
  EXPECT_EQ(plumb_monitor_inhibit(c, 1).code, PLUMB_OK);
  const double rate[3] = {0.0, 0.0, 3.0};
  EXPECT_EQ(plumb_monitor_set_rotation(c, 1, rate).code, PLUMB_OK);
  EXPECT_EQ(plumb_monitor_set_rotation(c, 1, nullptr).code, PLUMB_OK);
  EXPECT_EQ(plumb_monitor_reset(c, form.config.reset_key, 15).code, PLUMB_OK);
  twin.set_gravity({9.81, 2e-3, GravityModel::value});
  twin.inhibit(true);
  twin.set_rotation({true, false, {}});
  twin.reset(form.config.reset_key, SensorSet(15));
  plumb_verdict verdict;
  plumb_verdict_defaults(&verdict);
  for (int k = 0; k < 64; ++k) {
    const Sample s = life.next({});
    const plumb_sample given = c_form(s);
    ASSERT_EQ(plumb_monitor_step(c, &given, nullptr).code, PLUMB_OK);
    const Verdict& v = twin.step(s);
    ASSERT_EQ(plumb_monitor_verdict(c, &verdict).code, PLUMB_OK);
    ASSERT_EQ(difference(verdict, v), "");
  }
  EXPECT_EQ(plumb_monitor_begin_time_base(c).code, PLUMB_OK);
  twin.begin_time_base();
  for (int k = 0; k < 64; ++k) {
    Sample s = life.next({});
    s.time_s = 0.01 * k;  // before all that was
    const plumb_sample given = c_form(s);
    ASSERT_EQ(plumb_monitor_step(c, &given, &verdict).code, PLUMB_OK);
    ASSERT_EQ(difference(verdict, twin.step(s)), "");
    ASSERT_NE(verdict.accepted, 0);
  }
  EXPECT_EQ(verdict.reference_mps2, 9.81);
  EXPECT_NE(verdict.qualifiers & Qualifier::inhibited, 0);
}

TEST(CFunctions, ASnapshotCarriesOn) {
  Life life(4, 5);
  const CForm form(life.tool.rig.setup);
  Memory before, after;
  ASSERT_EQ(before.init(&form.config).code, PLUMB_OK);
  for (int k = 0; k < 5000; ++k) {
    const plumb_sample s = c_form(life.next({}));
    plumb_monitor_step(before.monitor, &s, nullptr);
  }
  std::vector<std::uint8_t> bytes(plumb_snapshot_size_max());
  std::size_t written = 0;
  EXPECT_EQ(plumb_monitor_snapshot(before.monitor, bytes.data(), 10, &written).code,
            static_cast<int>(Errc::buffer_too_small));
  EXPECT_EQ(written, 0U);
  ASSERT_EQ(plumb_monitor_snapshot(before.monitor, bytes.data(), bytes.size(), &written).code, PLUMB_OK);
  const auto restore = [&](std::size_t size) {
    return plumb_monitor_restore(after.storage.data(), 8 * after.storage.size(), after.workspace.data(),
                                 8 * after.workspace.size(), &form.config, bytes.data(), size, &after.monitor);
  };
  EXPECT_EQ(restore(written - 1).code, static_cast<int>(Errc::snapshot_truncated));
  ASSERT_NE(after.monitor, nullptr) << "it runs without its history";
  ASSERT_EQ(restore(written).code, PLUMB_OK);
  plumb_verdict a, b;
  plumb_verdict_defaults(&a);
  plumb_verdict_defaults(&b);
  for (int k = 0; k < 5000; ++k) {
    const plumb_sample s = c_form(life.next({}));
    plumb_monitor_step(before.monitor, &s, &a);
    plumb_monitor_step(after.monitor, &s, &b);
    ASSERT_TRUE(same(a, b)) << k;
  }
}

TEST(CFunctions, ChipsCountAsInTheSetup) {
  Life life(6, 5);
  const CForm plain(life.tool.rig.setup);
  CForm form(life.tool.rig.setup);
  for (std::size_t i = 0; i < 6; ++i) form.sensor[i].chip = static_cast<std::int32_t>(1 + i / 2);
  plumb_verdict verdict;
  plumb_verdict_defaults(&verdict);
  const auto grade_of = [&](const CForm& given) {
    Memory memory;
    EXPECT_EQ(memory.init(&given.config).code, PLUMB_OK);
    EXPECT_EQ(plumb_monitor_verdict(memory.monitor, &verdict).code, PLUMB_OK);
    return verdict.confirmed_grade;
  };
  EXPECT_EQ(grade_of(plain), 3);
  EXPECT_EQ(grade_of(form), 1) << "three units, of which one may lie in a plane";
}

TEST(CFunctions, AnswerEveryMisuse) {
  Life life(4, 7);
  CForm form(life.tool.rig.setup);
  Memory m;
  EXPECT_EQ(m.init(nullptr).code, PLUMB_NULL_POINTER);
  EXPECT_EQ(m.monitor, nullptr);
  EXPECT_EQ(plumb_monitor_init(m.storage.data(), 16, m.workspace.data(), 1 << 20, &form.config, &m.monitor).code,
            PLUMB_STORAGE_TOO_SMALL);
  EXPECT_EQ(plumb_monitor_init(reinterpret_cast<char*>(m.storage.data()) + 1, 1 << 20, m.workspace.data(), 1 << 20,
                               &form.config, &m.monitor)
                .code,
            PLUMB_STORAGE_MISALIGNED);
  EXPECT_EQ(plumb_monitor_step(nullptr, nullptr, nullptr).code, PLUMB_NULL_POINTER);
  const plumb_sample sample = c_form(life.next({}));
  EXPECT_EQ(plumb_monitor_step(reinterpret_cast<plumb_monitor*>(m.storage.data()), &sample, nullptr).code,
            PLUMB_NOT_INITIALISED);
  const auto refused = [&](auto change) {
    CForm other(life.tool.rig.setup);
    change(other);
    return m.init(&other.config);
  };
  const auto code = [](Errc e) { return static_cast<int>(e); };
  EXPECT_EQ(refused([](CForm& f) { f.config.struct_size = 8; }).code, PLUMB_WRONG_STRUCT);
  EXPECT_EQ(refused([](CForm& f) { f.sensor[2].struct_size += 8; }).code, PLUMB_WRONG_STRUCT);
  EXPECT_EQ(refused([](CForm& f) { f.config.sensors = 2; }).code, code(Errc::too_few_sensors));
  EXPECT_EQ(refused([](CForm& f) { f.config.sensors = 25; }).code, code(Errc::too_many_sensors));
  EXPECT_EQ(refused([](CForm& f) { f.config.sensor = nullptr; }).code, PLUMB_NULL_POINTER);
  EXPECT_EQ(refused([](CForm& f) { f.config.covariance_size = 3; }).code, code(Errc::out_of_range));
  EXPECT_EQ(refused([](CForm& f) { f.sensor[1].axis[0] = 2.0; }).index, 1);
  EXPECT_EQ(refused([](CForm& f) { f.sensor[1].scale[2] = std::nan(""); }).code, code(Errc::not_finite));
  EXPECT_EQ(refused([](CForm& f) { f.sensor[3].misfit_mps2 = -1.0; }).index, 3);
  EXPECT_EQ(refused([](CForm& f) { f.sensor[2].chip = 256; }).index, 2);
  EXPECT_EQ(refused([](CForm& f) { f.sensor[2].chip = -1; }).code, code(Errc::out_of_range));
  EXPECT_EQ(refused([](CForm& f) { f.config.window = 0; }).code, code(Errc::out_of_range));
  EXPECT_EQ(refused([](CForm& f) { f.config.gravity_mps2 = 1.0; }).code, code(Errc::implausible_gravity));
  EXPECT_EQ(refused([](CForm&) {}).code, PLUMB_OK);
  plumb_verdict small{};
  small.struct_size = 4;
  EXPECT_EQ(plumb_monitor_step(m.monitor, &sample, &small).code, PLUMB_WRONG_STRUCT);
  for (int e = -3; e < 1010; ++e) {
    EXPECT_STRNE(plumb_error_text(e), "");
    EXPECT_STRNE(plumb_error_remedy(e), "");
  }
}

TEST(CFunctions, DefaultsAreThoseOfTheMonitor) {
  plumb_config c;
  plumb_config_defaults(&c);
  MonitorSetup setup = Life(4, 1).tool.rig.setup;
  setup.config = MonitorConfig{};
  CForm form(setup);
  plumb_config plain = form.config;
  Memory m;
  ASSERT_EQ(m.init(&plain).code, PLUMB_OK);
  const MonitorConfig& used = m.monitor->monitor.config();
  const MonitorConfig wanted;
  HealthMonitor twin;
  ASSERT_TRUE(twin.configure(setup).has_value());
  EXPECT_EQ(used.reset_key, wanted.reset_key);
  // A snapshot is bound to every setting: that one fits the other says that all of them agree.
  std::vector<std::uint8_t> bytes(plumb_snapshot_size_max());
  std::size_t written = 0;
  ASSERT_EQ(plumb_monitor_snapshot(m.monitor, bytes.data(), bytes.size(), &written).code, PLUMB_OK);
  EXPECT_TRUE(twin.restore(setup, bytes.data(), written).has_value());
  plumb_verdict verdict;
  plumb_verdict_defaults(&verdict);
  plumb_sample nothing;
  plumb_sample_defaults(&nothing);
  plumb_monitor_step(m.monitor, &nothing, &verdict);
  EXPECT_NE(verdict.qualifiers & PLUMB_STANDSTILL_ASSUMED, 0) << "beyond the eight bits of old";
  setup.config.acceleration_bound_mps2 = 0.05;
  CForm told(setup);
  ASSERT_EQ(m.init(&told.config).code, PLUMB_OK);
  EXPECT_EQ(m.monitor->monitor.config().acceleration_bound_mps2, 0.05);
  plumb_monitor_step(m.monitor, &nothing, &verdict);
  EXPECT_EQ(verdict.qualifiers & PLUMB_STANDSTILL_ASSUMED, 0);
}

}  // namespace
}  // namespace plumb_c_test

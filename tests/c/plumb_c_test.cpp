// The C functions: the same verdicts as the C++ monitor, bit for bit, and every misuse an answer.
#include "plumb/c/plumb.h"

#include <gtest/gtest.h>

#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include "../../src/c/c_api.hpp"
#include "health/snapshot_support.hpp"

namespace {

using namespace plumb;
using plumb_test::Life;

/// A setup in its C form.
struct CForm {
  explicit CForm(const MonitorSetup& setup) {
    plumb_config_defaults(&config);
    const int n = setup.array.size();
    sensor.resize(static_cast<std::size_t>(n));
    for (int i = 0; i < n; ++i) {
      const auto a = static_cast<std::size_t>(i);
      plumb_sensor& s = sensor[a];
      plumb_sensor_defaults(&s);
      std::memcpy(s.id, setup.array.row(i).id.data(), sizeof s.id);
      std::memcpy(s.axis, setup.array.axis(i).data(), sizeof s.axis);
      s.sigma_mps2 = setup.array.sigma_mps2(i);
      std::memcpy(s.scale, setup.model.sensor[a].scale.data(), sizeof s.scale);
      std::memcpy(s.bias_mps2, setup.model.sensor[a].bias.data(), sizeof s.bias_mps2);
      s.reference_degc = setup.model.sensor[a].reference_degc;
      s.misfit_mps2 = setup.array.uncertainty().misfit_mps2[a];
      s.full_scale_raw = setup.full_scale_raw[a];
      std::memcpy(s.lever_arm_m, setup.lever_arm_m[a].data(), sizeof s.lever_arm_m);
    }
    config.sensors = n;
    config.sensor = sensor.data();
    config.covariance = setup.array.uncertainty().covariance.data();
    config.covariance_size = static_cast<std::uint32_t>(RowUncertainty::packed_size(n));
    config.gravity_mps2 = setup.gravity.g_mps2;
    config.gravity_sigma_mps2 = setup.gravity.sigma_mps2;
    config.reads = setup.model.reads == Reads::gravity ? 1 : -1;
    config.lever_arms_known = setup.lever_arms_known ? 1 : 0;
    std::memcpy(config.output_frame, setup.output_frame.data(), sizeof config.output_frame);
    config.recalibrate_after_exclusion = setup.config.recalibrate_after_exclusion ? 1 : 0;
    config.isolation_stations = setup.config.isolation_stations;
  }
  std::vector<plumb_sensor> sensor;
  plumb_config config{};
};

/// Storage as a caller would have it.
struct Memory {
  std::vector<std::uint64_t> storage = std::vector<std::uint64_t>(plumb_monitor_size() / 8 + 1);
  std::vector<std::uint64_t> workspace = std::vector<std::uint64_t>(plumb_workspace_size() / 8 + 1);
  plumb_monitor* monitor = nullptr;

  plumb_error init(const plumb_config* config) {
    return plumb_monitor_init(storage.data(), 8 * storage.size(), workspace.data(), 8 * workspace.size(), config,
                              &monitor);
  }
};

plumb_sample c_form(const Sample& s) {
  plumb_sample out;
  plumb_sample_defaults(&out);
  out.time_s = s.time_s;
  out.delivered = s.delivered.bits;
  std::memcpy(out.raw, s.raw.data(), sizeof s.raw);
  out.temperature_degc = s.temperature_degc;
  out.station = s.station;
  out.count = s.count;
  return out;
}

template <class T, class U>
bool same(const T& a, const U& b) {
  static_assert(sizeof(T) == sizeof(U), "two forms of one thing");
  return std::memcmp(&a, &b, sizeof a) == 0;
}

/// The name of the first field that differs, empty where none does.
std::string difference(const plumb_verdict& c, const Verdict& v) {
#define PLUMB_SAME(field) \
  if (!same(c.field, v.field)) return #field;
  PLUMB_SAME(sample)
  PLUMB_SAME(time_s)
  PLUMB_SAME(state)
  PLUMB_SAME(validity)
  PLUMB_SAME(cause)
  PLUMB_SAME(decided_by)
  PLUMB_SAME(grade)
  PLUMB_SAME(qualifiers)
  PLUMB_SAME(tick)
  PLUMB_SAME(accepted)
  PLUMB_SAME(alert)
  PLUMB_SAME(protection_available)
  PLUMB_SAME(wants_rotation)
  PLUMB_SAME(usable)
  PLUMB_SAME(transition.sequence)
  PLUMB_SAME(transition.from)
  PLUMB_SAME(transition.to)
  PLUMB_SAME(transition.event)
  PLUMB_SAME(transition.cause)
  PLUMB_SAME(transition.grade)
  PLUMB_SAME(transition.sensors)
  PLUMB_SAME(transition.time_s)
  PLUMB_SAME(transition.statistic)
  PLUMB_SAME(transition.limit)
  PLUMB_SAME(configured)
  PLUMB_SAME(in_service)
  PLUMB_SAME(set_aside)
  PLUMB_SAME(excluded)
  PLUMB_SAME(absent)
  PLUMB_SAME(suspects)
  PLUMB_SAME(clipped)
  PLUMB_SAME(restless)
  PLUMB_SAME(not_finite)
  PLUMB_SAME(noisy)
  PLUMB_SAME(stuck)
  PLUMB_SAME(contradicted_clip)
  PLUMB_SAME(strict_grade)
  PLUMB_SAME(parity_grade)
  PLUMB_SAME(live_hypotheses)
  PLUMB_SAME(stations_on_record)
  PLUMB_SAME(block_fill)
  PLUMB_SAME(statistic)
  PLUMB_SAME(limit)
  PLUMB_SAME(margin)
  PLUMB_SAME(mae_all_mps2)
  PLUMB_SAME(mae_worst_mps2)
  PLUMB_SAME(mae_worst_limit_mps2)
  PLUMB_SAME(parity)
  PLUMB_SAME(parity_limit)
  PLUMB_SAME(norm_error_mps2)
  PLUMB_SAME(reference_mps2)
  PLUMB_SAME(reference_sigma_mps2)
  PLUMB_SAME(temperature_degc)
  PLUMB_SAME(gravity_mps2)
  PLUMB_SAME(covariance)
  PLUMB_SAME(age_s)
  PLUMB_SAME(latest_mps2)
  PLUMB_SAME(protection_level_rad)
  PLUMB_SAME(toolface_protection_rad)
#undef PLUMB_SAME
  if (!same(c.recalibration_phase, v.recalibration.phase)) return "recalibration_phase";
  if (!same(c.stations_wanted, v.recalibration.stations_wanted)) return "stations_wanted";
  if (!same(c.turn_along, v.rotation.along)) return "turn_along";
  if (!same(c.turn_change_mps2, v.rotation.change_mps2)) return "turn_change_mps2";
  if (!same(c.turn_angle_rad, v.rotation.angle_rad)) return "turn_angle_rad";
  for (std::size_t i = 0; i < static_cast<std::size_t>(kCapacity); ++i) {
    if (!same(c.sensor_cause[i], v.sensor_cause[i])) return "sensor_cause";
    if (c.fewest_faults[i] != v.fewest_faults[i]) return "fewest_faults";
    if (c.drift_mps2_per_h[i] != static_cast<double>(v.drift_mps2_per_h[i])) return "drift_mps2_per_h";
  }
  return {};
}

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
}

}  // namespace

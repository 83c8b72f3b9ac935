// Every pointer that a C program may forget, and every number of a configuration that is none: answers, argument by
// argument.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include "c_form.hpp"
#include "health/snapshot_support.hpp"

namespace plumb_c_misuse_test {
namespace {

using namespace plumb;
using c_test::c_form;
using c_test::CForm;
using c_test::Memory;
using plumb_test::Life;

void expect_missing(plumb_error e, int argument) {
  EXPECT_EQ(e.code, PLUMB_NULL_POINTER);
  EXPECT_EQ(e.index, argument);
}

TEST(CMisuse, ANullPointerIsReportedByItsPlace) {
  Life life(4, 7);
  const CForm form(life.tool.rig.setup);
  Memory m;
  ASSERT_EQ(m.init(&form.config).code, PLUMB_OK);
  void* storage = m.storage.data();
  void* workspace = m.workspace.data();
  const std::size_t room = 8 * m.storage.size(), desk = 8 * m.workspace.size();
  expect_missing(plumb_config_defaults(nullptr), 0);
  expect_missing(plumb_sensor_defaults(nullptr), 0);
  expect_missing(plumb_sample_defaults(nullptr), 0);
  expect_missing(plumb_verdict_defaults(nullptr), 0);
  expect_missing(plumb_monitor_init(nullptr, room, workspace, desk, &form.config, &m.monitor), 0);
  expect_missing(plumb_monitor_init(storage, room, nullptr, desk, &form.config, &m.monitor), 2);
  expect_missing(plumb_monitor_init(storage, room, workspace, desk, &form.config, nullptr), 5);
  expect_missing(plumb_monitor_restore(storage, room, workspace, desk, &form.config, nullptr, 0, &m.monitor), 5);
  ASSERT_NE(m.monitor, nullptr) << "it runs without its history";
  expect_missing(plumb_monitor_restore(storage, room, workspace, desk, &form.config, nullptr, 0, nullptr), 7);
  expect_missing(plumb_monitor_restore(storage, room, workspace, desk, nullptr, nullptr, 0, &m.monitor), 4);
  ASSERT_EQ(m.init(&form.config).code, PLUMB_OK);
  std::uint8_t byte = 0;
  std::size_t written = 0;
  expect_missing(plumb_monitor_snapshot(m.monitor, nullptr, 1, &written), 1);
  expect_missing(plumb_monitor_snapshot(m.monitor, nullptr, 1, nullptr), 1);
  expect_missing(plumb_monitor_snapshot(m.monitor, &byte, 1, nullptr), 3);
  expect_missing(plumb_monitor_step(m.monitor, nullptr, nullptr), 1);
  expect_missing(plumb_monitor_verdict(m.monitor, nullptr), 1);
  expect_missing(plumb_monitor_offer(m.monitor, nullptr, desk, &form.config), 1);
  expect_missing(plumb_monitor_offer(m.monitor, workspace, desk, nullptr), 3);
  expect_missing(plumb_monitor_calibration(m.monitor, 0, nullptr), 2);
}

TEST(CMisuse, NoFunctionTakesWhatIsNoMonitor) {
  Life life(4, 8);
  const CForm form(life.tool.rig.setup);
  Memory m;
  auto* nothing = reinterpret_cast<plumb_monitor*>(m.storage.data());  // storage that was never initialised
  const plumb_sample sample = c_form(life.next({}));
  plumb_verdict verdict;
  plumb_verdict_defaults(&verdict);
  plumb_sensor sensor;
  plumb_sensor_defaults(&sensor);
  std::uint8_t byte = 0;
  std::size_t written = 0;
  const double rate[3] = {};
  for (plumb_monitor* none : {static_cast<plumb_monitor*>(nullptr), nothing}) {
    const int code = none == nullptr ? PLUMB_NULL_POINTER : PLUMB_NOT_INITIALISED;
    EXPECT_EQ(plumb_monitor_step(none, &sample, &verdict).code, code);
    EXPECT_EQ(plumb_monitor_verdict(none, &verdict).code, code);
    EXPECT_EQ(plumb_monitor_snapshot(none, &byte, 1, &written).code, code);
    EXPECT_EQ(plumb_monitor_reset(none, 0, 0).code, code);
    EXPECT_EQ(plumb_monitor_set_gravity(none, 9.81, 1e-3).code, code);
    EXPECT_EQ(plumb_monitor_set_rotation(none, 1, rate).code, code);
    EXPECT_EQ(plumb_monitor_request_recalibration(none).code, code);
    EXPECT_EQ(plumb_monitor_inhibit(none, 1).code, code);
    EXPECT_EQ(plumb_monitor_begin_time_base(none).code, code);
    EXPECT_EQ(plumb_monitor_calibration(none, 0, &sensor).code, code);
    EXPECT_EQ(plumb_monitor_offer(none, m.workspace.data(), 8 * m.workspace.size(), &form.config).code, code);
  }
}

TEST(CMisuse, ACovarianceThatIsNoneIsRefused) {
  Life life(4, 9);
  CForm form(life.tool.rig.setup);
  Memory m;
  std::vector<double> covariance(form.config.covariance, form.config.covariance + form.config.covariance_size);
  form.config.covariance = covariance.data();
  ASSERT_EQ(m.init(&form.config).code, PLUMB_OK);
  covariance[3] = std::numeric_limits<double>::infinity();
  EXPECT_EQ(m.init(&form.config).index, 3);
  covariance[3] = 0.0;
  covariance[0] = -1.0;
  EXPECT_EQ(m.init(&form.config).code, static_cast<int>(Errc::implausible));
  form.config.covariance = nullptr;  // then there is none, whatever its size says
  EXPECT_EQ(m.init(&form.config).code, PLUMB_OK);
}

TEST(CMisuse, ASensorThatIsNotThereHasNoCalibration) {
  Life life(4, 10);
  const CForm form(life.tool.rig.setup);
  Memory m;
  ASSERT_EQ(m.init(&form.config).code, PLUMB_OK);
  plumb_sensor sensor;
  plumb_sensor_defaults(&sensor);
  for (const int other : {-1, 4}) {
    const plumb_error e = plumb_monitor_calibration(m.monitor, other, &sensor);
    EXPECT_EQ(e.code, static_cast<int>(Errc::out_of_range));
    EXPECT_EQ(e.value, other);
    EXPECT_EQ(e.limit, 3.0);
  }
  EXPECT_EQ(plumb_monitor_calibration(m.monitor, 3, &sensor).code, PLUMB_OK);
}

TEST(CMisuse, ASnapshotWithoutRoomReportsTheFunctionOfThisHeader) {
  Life life(4, 12);
  const CForm form(life.tool.rig.setup);
  Memory m;
  ASSERT_EQ(m.init(&form.config).code, PLUMB_OK);
  std::uint8_t byte = 0;
  std::size_t written = 0;
  const plumb_error e = plumb_monitor_snapshot(m.monitor, &byte, 1, &written);
  EXPECT_EQ(e.code, static_cast<int>(Errc::buffer_too_small));
  EXPECT_GT(e.limit, 1.0);
  EXPECT_STREQ(plumb_error_remedy(e.code), "give at least plumb_snapshot_size_max() bytes");
}

TEST(CMisuse, ReadsAndAlarmFormReachTheMonitor) {
  Life life(4, 11);
  CForm form(life.tool.rig.setup);
  Memory m;
  ASSERT_EQ(m.init(&form.config).code, PLUMB_OK);
  std::vector<std::uint8_t> bytes(plumb_snapshot_size_max());
  std::size_t written = 0;
  ASSERT_EQ(plumb_monitor_snapshot(m.monitor, bytes.data(), bytes.size(), &written).code, PLUMB_OK);
  const auto restored = [&] {
    return plumb_monitor_restore(m.storage.data(), 8 * m.storage.size(), m.workspace.data(), 8 * m.workspace.size(),
                                 &form.config, bytes.data(), written, &m.monitor)
        .code;
  };
  EXPECT_EQ(restored(), PLUMB_OK);
  // A snapshot is bound to every setting: another one is told by a refusal.
  form.config.alarm_for_average_tool = 1;
  EXPECT_NE(restored(), PLUMB_OK);
  form.config.alarm_for_average_tool = 0;
  form.config.reads = -form.config.reads;
  EXPECT_NE(restored(), PLUMB_OK);
}

TEST(CMisuse, AMisfitThatLeavesNoParameterKnownIsRefused) {
  Life life(4, 12);
  CForm form(life.tool.rig.setup);
  Memory m;
  form.sensor[2].misfit_mps2 = 1e160;  // its square is no number
  EXPECT_EQ(m.init(&form.config).code, static_cast<int>(Errc::implausible));
  form.config.covariance = nullptr;
  EXPECT_EQ(m.init(&form.config).code, static_cast<int>(Errc::implausible));
}

/// Neither a verdict that was never written nor one that a refused call left alone may pass for a valid one.
TEST(CMisuse, WithoutAVerdictThereIsNoneThatLooksValid) {
  Life life(4, 13);
  const CForm form(life.tool.rig.setup);
  Memory m;
  plumb_verdict verdict;
  plumb_verdict_defaults(&verdict);
  EXPECT_EQ(verdict.struct_size, sizeof verdict);
  EXPECT_EQ(c_test::difference(verdict, Verdict{}), "");
  const plumb_verdict none = verdict;
  const auto is_none = [&none](const plumb_verdict& v) { return std::memcmp(&v, &none, sizeof v) == 0; };
  ASSERT_EQ(m.init(&form.config).code, PLUMB_OK);
  plumb_sample sample = c_form(life.next({}));
  ASSERT_EQ(plumb_monitor_step(m.monitor, &sample, &verdict).code, PLUMB_OK);
  ASSERT_FALSE(is_none(verdict));
  sample.struct_size = 0;
  EXPECT_EQ(plumb_monitor_step(m.monitor, &sample, &verdict).code, PLUMB_WRONG_STRUCT);
  EXPECT_TRUE(is_none(verdict));
  ASSERT_EQ(plumb_monitor_verdict(m.monitor, &verdict).code, PLUMB_OK);
  ASSERT_FALSE(is_none(verdict));
  EXPECT_EQ(plumb_monitor_step(m.monitor, nullptr, &verdict).code, PLUMB_NULL_POINTER);
  EXPECT_TRUE(is_none(verdict));
  ASSERT_EQ(plumb_monitor_verdict(m.monitor, &verdict).code, PLUMB_OK);
  std::fill(m.storage.begin(), m.storage.end(), 0U);  // a reset of the processor that cleared its memory
  EXPECT_EQ(plumb_monitor_verdict(m.monitor, &verdict).code, PLUMB_NOT_INITIALISED);
  EXPECT_TRUE(is_none(verdict));
  verdict.struct_size = 8;  // then nobody knows how much room there is
  EXPECT_EQ(plumb_monitor_verdict(m.monitor, &verdict).code, PLUMB_NOT_INITIALISED);
  EXPECT_EQ(verdict.struct_size, 8U);
}

TEST(CMisuse, ReadsIsOneOfTwo) {
  Life life(4, 14);
  CForm form(life.tool.rig.setup);
  Memory m;
  for (const int reads : {0, 2, -2, 1 << 30}) {
    form.config.reads = reads;
    const plumb_error e = m.init(&form.config);
    EXPECT_EQ(e.code, static_cast<int>(Errc::out_of_range));
    EXPECT_EQ(e.value, reads);
    EXPECT_EQ(m.monitor, nullptr);
  }
  for (const int reads : {1, -1}) {
    form.config.reads = reads;
    EXPECT_EQ(m.init(&form.config).code, PLUMB_OK);
  }
}

TEST(CMisuse, AWorkspaceInTheStorageIsRefused) {
  Life life(4, 15);
  const CForm form(life.tool.rig.setup);
  const std::size_t home = plumb_monitor_size(), desk = plumb_workspace_size();
  std::vector<std::uint64_t> both((2 * home + 2 * desk) / 8 + 2);
  auto* const bytes = reinterpret_cast<unsigned char*>(both.data());
  plumb_monitor* monitor = nullptr;
  const auto init = [&](std::size_t storage, std::size_t workspace) {
    return plumb_monitor_init(bytes + storage, home, bytes + workspace, desk, &form.config, &monitor);
  };
  for (const plumb_error& e : {init(0, 0), init(0, home - 8), init(desk - 8, 0), init(8, 0), init(0, 8)}) {
    EXPECT_EQ(e.code, PLUMB_STORAGE_OVERLAPS);
    EXPECT_EQ(e.index, 2);
  }
  EXPECT_EQ(init(desk, 0).code, PLUMB_OK);
  ASSERT_EQ(init(0, home).code, PLUMB_OK);
  EXPECT_EQ(plumb_monitor_offer(monitor, bytes + 8, desk, &form.config).code, PLUMB_STORAGE_OVERLAPS);
  plumb_verdict verdict;
  plumb_verdict_defaults(&verdict);
  EXPECT_EQ(plumb_monitor_verdict(monitor, &verdict).code, PLUMB_OK);
  EXPECT_EQ(verdict.configured, 15U) << "untouched";
}

TEST(CMisuse, NumbersWithoutANameHaveNone) {
  for (const int none : {-1, -256, 255, 256, 1 << 30}) {
    EXPECT_STREQ(plumb_state_text(none), "?") << none;
    EXPECT_STREQ(plumb_validity_text(none), "?") << none;
    EXPECT_STREQ(plumb_cause_text(none), "?") << none;
  }
  EXPECT_STREQ(plumb_state_text(PLUMB_FAILED), "failed");
}

}  // namespace
}  // namespace plumb_c_misuse_test

// The dip as a C program sees it: the same answers as in C++, and what is refused.
#include "plumb/c/plumb_dip.h"

#include <gtest/gtest.h>

#include <cstring>
#include <vector>

#include "c/c_form.hpp"
#include "support/three_left.hpp"

namespace plumb_dip_test {
namespace {

using namespace plumb;
using namespace three_left;

plumb_dip_field c_form(const FieldReading& reading, const FieldReference& expected) {
  plumb_dip_field out;
  plumb_dip_field_defaults(&out);
  std::copy(reading.field_nt.begin(), reading.field_nt.end(), out.field_nt);
  out.axis_sigma_nt = reading.axis_error_nt.sigma;
  out.axis_bound_nt = reading.axis_error_nt.bound;
  out.vector_nt = reading.vector_nt;
  out.turn_rad = reading.turn_rad;
  out.total_nt = expected.total_nt;
  out.total_sigma_nt = expected.total_error_nt.sigma;
  out.total_bound_nt = expected.total_error_nt.bound;
  out.dip_rad = expected.dip_rad;
  out.dip_sigma_rad = expected.dip_error_rad.sigma;
  out.dip_bound_rad = expected.dip_error_rad.bound;
  return out;
}

plumb_dip_station c_form(const DipStation& from) {
  plumb_dip_station out;
  plumb_dip_station_defaults(&out);
  out.used = from.used.bits;
  std::copy(from.mean_mps2.begin(), from.mean_mps2.end(), out.mean_mps2);
  std::copy(from.sigma_mps2.begin(), from.sigma_mps2.end(), out.sigma_mps2);
  std::copy(from.bound_mps2.begin(), from.bound_mps2.end(), out.bound_mps2);
  out.gravity_mps2 = from.gravity.g_mps2;
  out.gravity_sigma_mps2 = from.gravity.sigma_mps2;
  out.acceleration_mps2 = from.acceleration_mps2;
  out.sigmas = from.sigmas;
  return out;
}

void expect_same(const plumb_dip_answer& c, const DipAnswer& own) {
  EXPECT_EQ(c.verdict, static_cast<int>(own.verdict));
  EXPECT_EQ(c.refusal, static_cast<int>(own.refusal));
  EXPECT_EQ(c.named, own.named);
  EXPECT_EQ(c.suspects, own.suspects.bits);
  EXPECT_EQ(c.mirrors, own.mirrors.bits);
  EXPECT_EQ(std::memcmp(c.gravity_mps2, own.gravity_mps2.data(), sizeof c.gravity_mps2), 0);
  EXPECT_EQ(c.bound_rad, own.bound_rad);
}

std::vector<double> axes_of(const SensorArray& array) {
  std::vector<double> out;
  for (int i = 0; i < array.size(); ++i) out.insert(out.end(), array.axis(i).begin(), array.axis(i).end());
  return out;
}

struct CDip {
  std::vector<std::uint64_t> storage = std::vector<std::uint64_t>(plumb_dip_size() / 8 + 1);
  plumb_dip* dip = nullptr;
};

// Verifies: REQ-222
TEST(CDip, AnswersOverStationsAsInCpp) {
  for (const bool faulty : {false, true}) {
    ThreeLeft tool;
    const SensorArray& array = tool.rig.setup.array;
    const std::vector<double> axes = axes_of(array);
    CDip c;
    ASSERT_EQ(plumb_dip_init(c.storage.data(), 8 * c.storage.size(), axes.data(), array.size(), PLUMB_DIP_CONSTANT_BIAS,
                             &c.dip)
                  .code,
              PLUMB_OK);
    DipEvidence own(DipAssumption::constant_bias);
    if (faulty) tool.f_mps2 = 0.25 * kG0_mps2;
    for (const Vec3& down : {direction_at(40, 70), direction_at(65, 200)}) {
      tool.rig.stay(down, 2);
      const DipStation station = dip_station(tool.rig.monitor, tool.rig.setup, field_at(down), reference());
      const plumb_dip_station given = c_form(station);
      const plumb_dip_field field = c_form(station.field, station.reference);
      plumb_dip_answer found;
      plumb_dip_answer_defaults(&found);
      ASSERT_EQ(plumb_dip_add(c.dip, &given, &field, &found).code, PLUMB_OK);
      expect_same(found, own.add(judge_dip(array, station)));
      EXPECT_EQ(found.verdict == PLUMB_DIP_FAULT, faulty) << plumb_dip_refusal_text(found.refusal);
    }
    EXPECT_EQ(plumb_dip_forget(c.dip).code, PLUMB_OK);
  }
}

// Verifies: REQ-222
TEST(CDip, WatchesBesideAMonitorAsInCpp) {
  ThreeLeft tool;
  const c_test::CForm form(tool.rig.setup);
  c_test::Memory memory;
  ASSERT_EQ(memory.init(&form.config).code, PLUMB_OK);
  // The same monitor in the C storage: its state by a snapshot.
  std::vector<std::uint8_t> bytes(plumb_snapshot_size_max());
  CDip c;
  ASSERT_EQ(plumb_dip_watch_init(c.storage.data(), 8 * c.storage.size(), PLUMB_DIP_ANY_FAULT, &c.dip).code, PLUMB_OK);
  DipWatch own;
  const Vec3 down = direction_at(40, 70);
  tool.f_mps2 = tool.mirror_mps2(down);
  const DipReport expected = tool.report(own, down, 3);
  const Expected<std::size_t> size = tool.rig.monitor.snapshot(bytes.data(), bytes.size());
  ASSERT_TRUE(size.has_value());
  const plumb_error restored =
      plumb_monitor_restore(memory.storage.data(), 8 * memory.storage.size(), memory.workspace.data(),
                            8 * memory.workspace.size(), &form.config, bytes.data(), *size, &memory.monitor);
  ASSERT_EQ(restored.code, PLUMB_OK) << plumb_error_text(restored.code);
  const plumb_dip_field field = c_form(field_at(down), reference());
  plumb_dip_report found;
  plumb_dip_report_defaults(&found);
  ASSERT_EQ(plumb_dip_watch_add(c.dip, memory.monitor, memory.workspace.data(), 8 * memory.workspace.size(),
                                &form.config, &field, &found)
                .code,
            PLUMB_OK);
  expect_same(found.answer, expected.answer);
  EXPECT_EQ(found.answer.verdict, PLUMB_DIP_FAULT);
  EXPECT_EQ(found.answer.named, 1);
  EXPECT_EQ(found.protected_by_dip, expected.protected_by_dip ? 1 : 0);
  EXPECT_EQ(found.protection_level_calibrated_axes_rad, expected.protection_level_calibrated_axes_rad);
  EXPECT_EQ(found.protection_level_housing_rad, expected.protection_level_housing_rad);
}

// Negative: REQ-222
TEST(CDip, RefusesWhatItCannotWorkWithAndLeavesNoOldAnswer) {
  const ThreeLeft tool;
  const std::vector<double> axes = axes_of(tool.rig.setup.array);
  CDip c;
  const auto init = [&](std::int32_t sensors, std::int32_t assumption) {
    return plumb_dip_init(c.storage.data(), 8 * c.storage.size(), axes.data(), sensors, assumption, &c.dip).code;
  };
  EXPECT_EQ(init(2, 0), static_cast<int>(Errc::too_few_sensors));
  EXPECT_EQ(init(99, 0), static_cast<int>(Errc::too_many_sensors));
  EXPECT_EQ(init(4, 2), static_cast<int>(Errc::out_of_range));
  EXPECT_EQ(c.dip, nullptr);
  EXPECT_EQ(plumb_dip_init(c.storage.data(), 8, axes.data(), 4, 0, &c.dip).code, PLUMB_STORAGE_TOO_SMALL);
  EXPECT_EQ(plumb_dip_init(nullptr, 0, axes.data(), 4, 0, &c.dip).code, PLUMB_NULL_POINTER);
  ASSERT_EQ(init(4, 0), PLUMB_OK);
  plumb_dip_station station;
  plumb_dip_station_defaults(&station);
  plumb_dip_field field;
  plumb_dip_field_defaults(&field);
  plumb_dip_answer found;
  plumb_dip_answer_defaults(&found);
  ASSERT_EQ(plumb_dip_add(c.dip, &station, &field, &found).code, PLUMB_OK);
  EXPECT_EQ(found.verdict, PLUMB_DIP_NOT_JUDGED);
  EXPECT_STREQ(plumb_dip_verdict_text(found.verdict), to_string(DipVerdict::not_judged));
  EXPECT_STREQ(plumb_dip_refusal_text(found.refusal), to_string(DipRefusal::too_few_sensors));
  found.verdict = PLUMB_DIP_CONSISTENT;
  found.bound_rad = 0.01;
  station.struct_size = 8;
  EXPECT_EQ(plumb_dip_add(c.dip, &station, &field, &found).code, PLUMB_WRONG_STRUCT);
  EXPECT_EQ(found.verdict, PLUMB_DIP_NOT_JUDGED);
  EXPECT_EQ(found.bound_rad, kPi);
  plumb_dip_report report;
  plumb_dip_report_defaults(&report);
  report.protected_by_dip = 1;
  // One of stations is no watch, and the other way round.
  EXPECT_EQ(plumb_dip_watch_add(c.dip, nullptr, nullptr, 0, nullptr, &field, &report).code, PLUMB_NOT_INITIALISED);
  EXPECT_EQ(report.protected_by_dip, 0);
  ASSERT_EQ(plumb_dip_watch_init(c.storage.data(), 8 * c.storage.size(), 0, &c.dip).code, PLUMB_OK);
  EXPECT_EQ(plumb_dip_watch_add(c.dip, nullptr, nullptr, 0, nullptr, &field, &report).code, PLUMB_NULL_POINTER);
  EXPECT_EQ(plumb_dip_add(c.dip, &station, &field, &found).code, PLUMB_NOT_INITIALISED);
  EXPECT_EQ(plumb_dip_forget(nullptr).code, PLUMB_NULL_POINTER);
  EXPECT_EQ(plumb_dip_field_defaults(nullptr).code, PLUMB_NULL_POINTER);
  EXPECT_EQ(plumb_dip_station_defaults(nullptr).code, PLUMB_NULL_POINTER);
  EXPECT_EQ(plumb_dip_answer_defaults(nullptr).code, PLUMB_NULL_POINTER);
  EXPECT_EQ(plumb_dip_report_defaults(nullptr).code, PLUMB_NULL_POINTER);
}

}  // namespace
}  // namespace plumb_dip_test

// Calibrations across the C border: one that the host offers, and none at all.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "../../src/c/c_api.hpp"
#include "c_form.hpp"
#include "health/first_calibration_support.hpp"
#include "health/recalibration_support.hpp"

namespace plumb_c_calibration_test {
namespace {

using namespace plumb;
using c_test::c_form;
using c_test::CForm;
using c_test::difference;
using c_test::Memory;
using plumb_test::Tool;
using plumb_test::UncalibratedTool;

/// The datasheet of the tool, as an embedder would type it in.
CForm datasheet_form(const UncalibratedTool& tool) {
  CForm form(tool.setup);
  form.config.calibrated = 0;
  form.config.covariance = nullptr;
  form.config.covariance_size = 0;
  for (std::size_t i = 0; i < form.sensor.size(); ++i) {
    const Prior& prior = tool.sheet.sensor[i].prior;
    form.sensor[i].misfit_mps2 = 0.0;
    form.sensor[i].prior_bias_mps2 = prior.bias_mps2;
    form.sensor[i].prior_scale = prior.scale;
    form.sensor[i].prior_axis_rad = prior.axis_rad;
  }
  return form;
}

plumb_error offer(Memory& memory, const plumb_config* config) {
  return plumb_monitor_offer(memory.monitor, memory.workspace.data(), 8 * memory.workspace.size(), config);
}

// Verifies: REQ-136
TEST(CCalibration, AToolWithoutOneMakesItsOwnAsInCpp) {
  UncalibratedTool tool(4, 11);
  tool.start();
  CForm form = datasheet_form(tool);
  Memory memory;
  ASSERT_EQ(memory.init(&form.config).code, PLUMB_OK);
  plumb_verdict verdict;
  plumb_verdict_defaults(&verdict);
  const int most = 32 * (Recalibration::first_stations_needed(4) + 20);
  for (int k = 0; k < most && !tool.calibrated(); k += 32) {
    const Vec3 wanted = tool.monitor.verdict().recalibration.wanted_direction;
    const Vec3 direction = norm(wanted) > 0.5 ? wanted : plumb_test::random_direction(tool.noise);
    for (int sample = 0; sample < 32; ++sample) {
      const Sample s = tool.sample(direction);
      const plumb_sample given = c_form(s);
      ASSERT_EQ(plumb_monitor_step(memory.monitor, &given, &verdict).code, PLUMB_OK);
      ASSERT_EQ(difference(verdict, tool.step(s)), "") << k;
    }
  }
  ASSERT_TRUE(tool.calibrated());
  for (int i = 0; i < 4; ++i) {
    plumb_sensor fitted = form.sensor[static_cast<std::size_t>(i)];
    ASSERT_EQ(plumb_monitor_calibration(memory.monitor, i, &fitted).code, PLUMB_OK);
    EXPECT_NE(fitted.bias_mps2[0], form.sensor[static_cast<std::size_t>(i)].bias_mps2[0]) << i;
    EXPECT_EQ(fitted.bias_mps2[0], tool.monitor.model().sensor[static_cast<std::size_t>(i)].bias[0]) << i;
    EXPECT_EQ(fitted.scale[0], tool.monitor.model().sensor[static_cast<std::size_t>(i)].scale[0]) << i;
    EXPECT_TRUE(c_test::same(fitted.axis, tool.monitor.array().axis(i))) << i;
  }
}

// Negative: REQ-136
TEST(CCalibration, ADatasheetThatCannotBeOneIsRefused) {
  const UncalibratedTool tool(4, 12);
  const auto refused = [&tool](auto change) {
    CForm form = datasheet_form(tool);
    change(form);
    Memory memory;
    return memory.init(&form.config);
  };
  EXPECT_EQ(refused([](CForm&) {}).code, PLUMB_OK);
  const plumb_error surely = refused([](CForm& f) { f.sensor[2].prior_scale = 0.0; });
  EXPECT_EQ(surely.code, static_cast<int>(Errc::implausible));
  EXPECT_EQ(surely.index, 2);
  EXPECT_EQ(refused([](CForm& f) { f.sensor[1].prior_axis_rad = std::nan(""); }).index, 1);
  std::vector<double> covariance(static_cast<std::size_t>(RowUncertainty::packed_size(4)), 0.0);
  EXPECT_EQ(refused([&covariance](CForm& f) { f.config.covariance = covariance.data(); }).code,
            static_cast<int>(Errc::out_of_range))
      << "known and unknown at once";
}

// Verifies: REQ-135
TEST(CCalibration, AnOfferIsTriedAndAdoptedAsInCpp) {
  Tool tool(4, {}, 4);
  tool.drift(2e-3);
  Memory memory;
  const CForm before(tool.rig.setup);
  ASSERT_EQ(memory.init(&before.config).code, PLUMB_OK);
  HealthMonitor& twin = tool.rig.monitor;
  plumb_verdict verdict;
  plumb_verdict_defaults(&verdict);
  const auto stay = [&](const Vec3& direction) {
    for (int k = 0; k < 2 * tool.rig.setup.config.window; ++k) {
      const Sample s = tool.rig.sample(direction, kG0_mps2);
      const plumb_sample given = c_form(s);
      ASSERT_EQ(plumb_monitor_step(memory.monitor, &given, &verdict).code, PLUMB_OK);
      ASSERT_EQ(difference(verdict, twin.step(s)), "");
    }
  };
  plumb_test::Noise noise(5);
  for (int station = 0; station < 12; ++station) stay(plumb_test::random_direction(noise));
  ASSERT_EQ(verdict.state, PLUMB_NOMINAL);

  MonitorSetup made = tool.rig.setup;
  for (std::size_t i = 0; i < 4; ++i) made.model.sensor[i].bias[0] = tool.bias[i];
  plumb_test::leave_uncertainty(made.array, 3e-4, 3e-5);
  CForm given(made);
  ASSERT_EQ(offer(memory, &given.config).code, PLUMB_OK);
  ASSERT_TRUE(twin.offer_calibration(made.model, made.array).has_value());
  for (int station = 0; station < 40; ++station) stay(plumb_test::random_direction(noise));
  plumb_sensor now = before.sensor[1];
  ASSERT_EQ(plumb_monitor_calibration(memory.monitor, 1, &now).code, PLUMB_OK);
  EXPECT_NEAR(now.bias_mps2[0], tool.bias[1], 1e-12);
  EXPECT_NE(now.bias_mps2[0], before.sensor[1].bias_mps2[0]);
}

// Negative: REQ-135
TEST(CCalibration, AnOfferThatIsNoneIsAnswered) {
  Tool tool(4);
  CForm form(tool.rig.setup);
  Memory memory;
  EXPECT_EQ(offer(memory, &form.config).code, PLUMB_NULL_POINTER) << "no monitor yet";
  ASSERT_EQ(memory.init(&form.config).code, PLUMB_OK);
  EXPECT_EQ(offer(memory, nullptr).code, PLUMB_NULL_POINTER);
  EXPECT_EQ(offer(memory, nullptr).index, 3);
  EXPECT_EQ(plumb_monitor_offer(memory.monitor, memory.workspace.data(), 8, &form.config).code,
            PLUMB_STORAGE_TOO_SMALL);
  EXPECT_EQ(offer(memory, &form.config).code, static_cast<int>(Errc::wrong_state)) << "not proven yet";
  form.config.calibrated = 0;
  form.config.covariance = nullptr;
  EXPECT_EQ(offer(memory, &form.config).code, static_cast<int>(Errc::not_calibrated));
  plumb_sensor sensor;
  plumb_sensor_defaults(&sensor);
  EXPECT_EQ(plumb_monitor_calibration(memory.monitor, 4, &sensor).code, static_cast<int>(Errc::out_of_range));
  EXPECT_EQ(plumb_monitor_calibration(memory.monitor, 0, nullptr).code, PLUMB_NULL_POINTER);
}

}  // namespace
}  // namespace plumb_c_calibration_test

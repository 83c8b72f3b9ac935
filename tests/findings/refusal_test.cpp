#include "plumb/findings/refusal.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "plumb/findings/column_findings.hpp"
#include "plumb/findings/fit_remarks.hpp"
#include "plumb/io/array_file.hpp"

namespace refusal_test {
namespace {

using namespace plumb;
using findings::CalibrationRun;
using findings::Finding;
using findings::FindingCode;

io::ArrayFile array() { return *io::read_array_file(PLUMB_SOURCE_DIR "/examples/paper_tool.toml"); }
io::ArrayFile array_with_temperature() { return *io::read_array_file(PLUMB_SOURCE_DIR "/examples/oven_tool.toml"); }

/// A log of 100 rows in which every channel speaks, with `stations` of all sensors, which nobody has judged.
CalibrationRun run_of(const io::ArrayFile& array, std::size_t stations, Errc code) {
  CalibrationRun run;
  run.log.rows = 100;
  run.log.varied = array.array.all();
  run.stations.resize(stations);
  for (std::size_t k = 0; k < stations; ++k) {
    run.stations[k].delivered = array.array.all();
    run.stations[k].temperature_degc = 25.0;
    for (int i = 0; i < array.array.size(); ++i) {
      // Of the length of gravity, in the unit of the log.
      const SensorCoefficients& c = array.datasheet.sensor[static_cast<std::size_t>(i)].coefficients;
      run.stations[k].mean[static_cast<std::size_t>(i)] =
          c.bias[0] + c.scale[0] * array.gravity.g_mps2 * array.array.axis(i)[k % 3];
    }
  }
  run.study.attitudes.resize(stations);
  run.refusal.code = code;
  return run;
}

TEST(RefusalFindings, TooFewStationsAreCounted) {
  const io::ArrayFile file = array();
  CalibrationRun run = run_of(file, 5, Errc::too_few_stations);
  run.refusal.limit = 9.0;
  const std::vector<Finding> list = findings::refusal_of(run, file);
  ASSERT_EQ(list.size(), 1U);
  EXPECT_EQ(list[0].code, FindingCode::too_few_stations);
  EXPECT_EQ(list[0].value, 5.0);
  EXPECT_EQ(list[0].limit, 9.0);
}

TEST(RefusalFindings, ALogWithoutAStillStretchSaysSoInstead) {
  const io::ArrayFile file = array();
  CalibrationRun run = run_of(file, 0, Errc::too_few_stations);
  run.log_findings = {{FindingCode::tool_not_at_rest}};
  EXPECT_EQ(findings::refusal_of(run, file).front().code, FindingCode::no_stretch_at_rest);
}

TEST(RefusalFindings, ColumnsThatLackNumbersFollowWhereTooLittleWasRecorded) {
  const io::ArrayFile file = array();
  CalibrationRun run = run_of(file, 5, Errc::unobservable);
  run.log.missing[2] = 40;
  const std::vector<Finding> list = findings::refusal_of(run, file);
  ASSERT_EQ(list.size(), 2U);
  EXPECT_EQ(list[0].code, FindingCode::undetermined);
  EXPECT_EQ(list[1].code, FindingCode::column_empty);
  EXPECT_EQ(list[1].sensor, 2);
  EXPECT_EQ(list[1].value, 40.0);
  EXPECT_EQ(list[1].limit, 100.0);
}

TEST(RefusalFindings, StuckColumnsComeBeforeAnyValueThatTheySpoil) {
  const io::ArrayFile file = array();
  CalibrationRun run = run_of(file, 12, Errc::implausible);
  run.log.not_finite[1] = 100;
  run.log.varied = SensorSet::first(3);  // the fourth repeats itself
  const std::vector<Finding> list = findings::refusal_of(run, file);
  ASSERT_EQ(list.size(), 2U);
  EXPECT_EQ(list[0].code, FindingCode::column_not_finite);
  EXPECT_EQ(list[0].sensor, 1);
  EXPECT_EQ(list[1].code, FindingCode::column_constant);
  EXPECT_EQ(list[1].sensor, 3);
}

TEST(RefusalFindings, AGravityThatIsNotTheEarthsComesBeforeStuckColumns) {
  const io::ArrayFile file = array();
  CalibrationRun run = run_of(file, 12, Errc::implausible);
  run.log.missing[1] = 100;
  run.concern = Concern::gravity;
  run.refusal.value = 9.5;
  EXPECT_EQ(findings::refusal_of(run, file).front().code, FindingCode::gravity_out_of_range);
}

/// Three sensors whose outliers left too much doubt, by a chance of 1e-5 that was to be 1e-3 at least, and whose length
/// is off too: the chance is no residual, and holds no bound.
TEST(RefusalFindings, ABoundThatHoldsIsNotTheReason) {
  const io::ArrayFile file = array();
  CalibrationRun run = run_of(file, 12, Errc::poor_fit);
  run.report.parameters = 12;
  run.report.stations = 20;
  run.report.outliers = 3;
  run.report.norm_rms_mps2 = 0.07;
  run.refusal.value = 1e-5;
  run.refusal.limit = 1e-3;
  EXPECT_EQ(findings::refusal_of(run, file).front().code, FindingCode::outliers_of_three);
  run.refusal.value = 0.07;
  run.refusal.limit = 0.05;
  EXPECT_EQ(findings::refusal_of(run, file).front().code, FindingCode::residual_too_large);
}

TEST(RefusalFindings, TheMistakeThatWouldExplainAnImplausibleValueFollowsIt) {
  const io::ArrayFile file = array();
  CalibrationRun run = run_of(file, 12, Errc::poor_fit);
  run.concern = Concern::inconsistent_sensor;
  run.refusal.index = 1;
  run.second_look.exchanged = {{0, 3}, {2, 2}};
  const std::vector<Finding> list = findings::refusal_of(run, file);
  ASSERT_EQ(list.size(), 3U);
  EXPECT_EQ(list[0].code, FindingCode::inconsistent_sensor);
  EXPECT_EQ(list[0].sensor, 1);
  EXPECT_EQ(list[1].code, FindingCode::accepted_if_exchanged);
  EXPECT_EQ(list[1].other, 3);
  EXPECT_EQ(list[2].code, FindingCode::accepted_if_reversed);
  EXPECT_EQ(list[2].sensor, 2);
}

TEST(RefusalFindings, AFitThatDivergedReportsTheReadingThatCausedIt) {
  const io::ArrayFile file = array();
  CalibrationRun run = run_of(file, 12, Errc::diverged);
  run.refusal.index = 4;
  run.stations[4].mean[2] = -1e9;
  const Finding f = findings::refusal_of(run, file).front();
  EXPECT_EQ(f.code, FindingCode::station_reading_impossible);
  EXPECT_EQ(f.other, 4);
  EXPECT_EQ(f.sensor, 2);
  EXPECT_EQ(f.value, -1e9);
  run.stations[4].temperature_degc = 1200.0;
  EXPECT_EQ(findings::refusal_of(run, file).front().code, FindingCode::station_temperature_impossible);
}

TEST(RefusalFindings, SensorsThatWereAbsentAreReportedWhereNothingElseIsWrong) {
  const io::ArrayFile file = array();
  CalibrationRun run = run_of(file, 12, Errc::diverged);
  EXPECT_EQ(findings::refusal_of(run, file).front().code, FindingCode::not_converged);
  for (std::size_t k = 0; k < 8; ++k) run.stations[k].delivered = file.array.all().without(3);
  const Finding f = findings::refusal_of(run, file).front();
  EXPECT_EQ(f.code, FindingCode::sensor_absent);
  EXPECT_EQ(f.sensor, 3);
  EXPECT_EQ(f.value, 8.0);
}

TEST(RefusalFindings, ByThePapersMethodHaveCodesOfTheirOwn) {
  const io::ArrayFile file = array();
  CalibrationRun run = run_of(file, 12, Errc::ok);
  run.paper_refusal = Error{Errc::unobservable, -1, 10.0, 9.0};
  EXPECT_EQ(findings::paper_refusal_of(run, file).code, FindingCode::paper_rank_too_high);
  run.paper_refusal.value = 7.0;
  EXPECT_EQ(findings::paper_refusal_of(run, file).code, FindingCode::paper_undetermined);
  run.paper_refusal.code = Errc::diverged;
  EXPECT_EQ(findings::paper_refusal_of(run, file).code, FindingCode::paper_not_converged);
}

TEST(TemperatureUnit, IsFoundByWhatTheStationsCannotBe) {
  const io::ArrayFile file = array_with_temperature();
  CalibrationRun run = run_of(file, 4, Errc::ok);
  EXPECT_FALSE(findings::temperature_unit(run, file));
  for (Station& s : run.stations) s.temperature_degc += 273.15;
  const std::optional<Finding> kelvin = findings::temperature_unit(run, file);
  ASSERT_TRUE(kelvin);
  EXPECT_TRUE(kelvin->code == FindingCode::temperature_in_kelvin ||
              kelvin->code == FindingCode::claimed_temperature_in_kelvin);
  EXPECT_DOUBLE_EQ(kelvin->value, 298.15);
}

TEST(CoverageRemarks, SayWhatTheAttitudesLack) {
  const io::ArrayFile file = array();
  CalibrationRun run = run_of(file, 3, Errc::ok);
  run.study.coverage.attitudes = 3;
  run.study.coverage.inclinations = 2;
  for (std::size_t i = 0; i < 4; ++i) {
    run.study.coverage.highest[i] = 0.9;
    run.study.coverage.lowest[i] = i == 2 ? -0.1 : -0.9;
  }
  const std::vector<Finding> list = findings::coverage_remarks(run, file);
  ASSERT_EQ(list.size(), 3U);
  EXPECT_EQ(list[0].code, FindingCode::few_attitudes);
  EXPECT_EQ(list[1].code, FindingCode::few_inclinations);
  EXPECT_EQ(list[2].code, FindingCode::range_below_not_covered);
  EXPECT_EQ(list[2].sensor, 2);
  EXPECT_EQ(list[2].value, -0.1);
}

}  // namespace
}  // namespace refusal_test

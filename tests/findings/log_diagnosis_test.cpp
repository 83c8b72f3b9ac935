#include "plumb/findings/log_diagnosis.hpp"

#include <gtest/gtest.h>

#include "plumb/findings/unit_guess.hpp"

namespace log_diagnosis_test {
namespace {

using namespace plumb;
using findings::Finding;
using findings::FindingCode;

io::ArrayFile array() { return *io::read_array_file(PLUMB_SOURCE_DIR "/examples/paper_tool.toml"); }

/// So many rows of gravity along z, 10 ms apart, `factor` times as long, with a jitter of `noise` declared sigmas.
std::vector<Finding> diagnosed(const io::ArrayFile& array, int rows, double factor, double noise, double step_s) {
  findings::LogDiagnosis diagnosis(array);
  Sample sample;
  for (int k = 0; k < rows; ++k) {
    sample.time_s = step_s * k;
    Readings y{};
    for (int i = 0; i < array.array.size(); ++i) {
      const auto a = static_cast<std::size_t>(i);
      y[a] = factor * array.gravity.g_mps2 * array.array.axis(i)[2] +
             ((k + i) % 2 == 0 ? noise : -noise) * array.array.sigma_mps2(i);
    }
    diagnosis.add(sample, y, array.array.all());
  }
  return diagnosis.findings();
}

TEST(LogDiagnosis, SaysWhereNothingStandsOut) {
  const std::vector<Finding> list = diagnosed(array(), 640, 1.0, 1.0, 0.01);
  ASSERT_EQ(list.size(), 1U);
  EXPECT_EQ(list[0].code, FindingCode::tool_not_at_rest);
}

TEST(LogDiagnosis, CountsTheRowsOfALogThatIsTooShort) {
  const std::vector<Finding> list = diagnosed(array(), 40, 1.0, 1.0, 0.01);
  ASSERT_EQ(list.size(), 1U);
  EXPECT_EQ(list[0].code, FindingCode::log_too_short);
  EXPECT_EQ(list[0].value, 40.0);
}

TEST(LogDiagnosis, NamesTheSensorThatScattersMost) {
  const io::ArrayFile file = array();
  const std::vector<Finding> list = diagnosed(file, 640, 1.0, 5.0, 0.01);
  ASSERT_EQ(list.size(), 1U);
  EXPECT_EQ(list[0].code, FindingCode::noise_at_rest);
  EXPECT_GE(list[0].sensor, 0);
  EXPECT_GT(list[0].value, 4.0 * list[0].limit);
  EXPECT_EQ(list[0].other, file.array.size());
}

TEST(LogDiagnosis, FindsAWrongUnitAndThenReportsNoNoise) {
  const std::vector<Finding> list = diagnosed(array(), 640, 1000.0, 5000.0, 0.01);
  ASSERT_EQ(list.size(), 1U);
  EXPECT_EQ(list[0].code, FindingCode::vector_length_wrong);
  EXPECT_NEAR(list[0].value, 1000.0, 1.0);
}

TEST(LogDiagnosis, FindsRowsThatAreFartherApartThanAGap) {
  const std::vector<Finding> list = diagnosed(array(), 640, 1.0, 1.0, 10.0);
  ASSERT_EQ(list.size(), 1U);
  EXPECT_EQ(list[0].code, FindingCode::row_step_beyond_gap);
  EXPECT_NEAR(list[0].value, 10.0, 1e-9);
}

TEST(UnitGuess, NamesTheUnitThatFits) {
  const io::ArrayFile file = array();  // in volts
  EXPECT_EQ(findings::likely_unit(file, 1.0).kind, findings::UnitGuess::Kind::none);
  const findings::UnitGuess guess = findings::likely_unit(file, 1000.0);
  EXPECT_EQ(guess.kind, findings::UnitGuess::Kind::unit);
  EXPECT_STREQ(guess.unit, "mV");
}

}  // namespace
}  // namespace log_diagnosis_test

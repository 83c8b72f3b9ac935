// What a run says about the array file and the calibration.
#include "plumb/render/run_findings.hpp"

#include <gtest/gtest.h>

#include "plumb/core/units.hpp"

namespace run_findings_test {
namespace {

using namespace plumb;

bool says(const std::string& text, const std::string& what) { return text.find(what) != std::string::npos; }

io::ArrayFile stated() {
  io::ArrayFile array;
  array.path = "my tool.toml";
  return array;
}

std::string text_of(const Verdict& last) { return render::findings_text(last, stated()); }

TEST(RunFindings, NothingIsSaidOfARunAsStated) { EXPECT_EQ(text_of(Verdict{}), ""); }

TEST(RunFindings, GravityIsReportedWithTheValueToConfigure) {
  Verdict v;
  v.norm_mismatch.length_mps2 = 2.7e-3 * kG0_mps2;
  v.norm_mismatch.length_bound_mps2 = 2e-4 * kG0_mps2;
  v.norm_mismatch.configure_mps2 = 9.83313;
  const std::string text = text_of(v);
  EXPECT_TRUE(says(text, "+2.70 mg0, within 0.20 mg0")) << text;
  EXPECT_TRUE(says(text, "value = \"9.83313 m/s^2\"")) << text;
}

TEST(RunFindings, NoiseIsReportedWithWhatToWrite) {
  Verdict v;
  v.noise_factor = 2.1;
  v.noise_correlation = 20.0;
  const std::string text = text_of(v);
  EXPECT_TRUE(says(text, "write 2.1 times the noise")) << text;
  EXPECT_TRUE(says(text, "20 samples carry the information of one")) << text;
  const std::string command = "plumb noise STILL.csv --array 'my tool.toml' measures it";
  const std::size_t first = text.find(command);
  ASSERT_NE(first, std::string::npos) << text;
  EXPECT_NE(text.find(command, first + 1), std::string::npos) << "with each of the two lines: " << text;
}

TEST(RunFindings, AContradictedCalibrationIsReportedWithItsRemedy) {
  Verdict v;
  v.calibration.contradicted = true;
  v.calibration.attitudes = 7;
  v.calibration.ratio = 9.0;
  v.calibration.tolerance_mps2 = 1e-3 * kG0_mps2;
  EXPECT_TRUE(says(text_of(v), "at 7 attitudes: residuals are 9.0 times")) << text_of(v);
  EXPECT_TRUE(says(text_of(v), "wider by 1.00 mg0. Remedy: calibrate again")) << text_of(v);
  EXPECT_TRUE(says(text_of(v), "by a drift since the calibration or")) << text_of(v);
  v.calibration.refused = true;
  EXPECT_TRUE(says(text_of(v), "no output is valid")) << text_of(v);
}

}  // namespace
}  // namespace run_findings_test

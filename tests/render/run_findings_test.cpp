// What a run says about the array file and the calibration.
#include "plumb/render/run_findings.hpp"

#include <gtest/gtest.h>

#include "plumb/core/units.hpp"

namespace run_findings_test {
namespace {

using namespace plumb;

bool says(const std::string& text, const std::string& what) { return text.find(what) != std::string::npos; }

TEST(RunFindings, NothingIsSaidOfARunAsStated) { EXPECT_EQ(render::findings_text(Verdict{}), ""); }

TEST(RunFindings, GravityIsReportedWithTheValueToConfigure) {
  Verdict v;
  v.norm_mismatch.length_mps2 = 2.7e-3 * kG0_mps2;
  v.norm_mismatch.length_bound_mps2 = 2e-4 * kG0_mps2;
  v.norm_mismatch.configure_mps2 = 9.83313;
  const std::string text = render::findings_text(v);
  EXPECT_TRUE(says(text, "+2.70 mg0, within 0.20 mg0")) << text;
  EXPECT_TRUE(says(text, "value = \"9.83313 m/s^2\"")) << text;
}

TEST(RunFindings, NoiseIsReportedWithWhatToWrite) {
  Verdict v;
  v.noise_factor = 2.1;
  v.noise_correlation = 20.0;
  const std::string text = render::findings_text(v);
  EXPECT_TRUE(says(text, "write 2.1 times the noise")) << text;
  EXPECT_TRUE(says(text, "20 samples carry the information of one")) << text;
}

TEST(RunFindings, AContradictedCalibrationIsReportedWithItsRemedy) {
  Verdict v;
  v.calibration.contradicted = true;
  v.calibration.attitudes = 7;
  v.calibration.ratio = 9.0;
  v.calibration.tolerance_mps2 = 1e-3 * kG0_mps2;
  EXPECT_TRUE(says(render::findings_text(v), "at 7 attitudes: residuals are 9.0 times")) << render::findings_text(v);
  EXPECT_TRUE(says(render::findings_text(v), "wider by 1.00 mg0. Remedy: calibrate again")) << render::findings_text(v);
  EXPECT_TRUE(says(render::findings_text(v), "by a drift since the calibration or")) << render::findings_text(v);
  v.calibration.refused = true;
  EXPECT_TRUE(says(render::findings_text(v), "no output is valid")) << render::findings_text(v);
}

}  // namespace
}  // namespace run_findings_test

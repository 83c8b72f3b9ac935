// A recalibration that was read back: what its bounds cannot have let pass is not taken up.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <memory>
#include <vector>

#include "first_calibration_support.hpp"
#include "plumb/core/detail/archive.hpp"
#include "recalibration_support.hpp"

// Serves: REQ-163

namespace recalibration_resume_test {
namespace {

using namespace plumb;
using plumb_test::random_direction;
using plumb_test::Shadow;
using plumb_test::UncalibratedTool;
using Outcome = Recalibration::Outcome;
using Bytes = std::vector<std::uint8_t>;

Bytes bytes_of(const Recalibration& r, int sensors) {
  ArchiveWriter counter(nullptr, 0, sensors);
  counter.put(r);
  Bytes out(counter.used());
  ArchiveWriter(out.data(), out.size(), sensors).put(r);
  return out;
}

/// Whether these bytes are a recalibration at all; then `into` is that one.
bool read_back(const Bytes& bytes, int sensors, Recalibration& into) {
  ArchiveReader in(bytes.data(), bytes.size(), sensors);
  in.get(into);
  return in.sound() && in.left() == 0;
}

Recalibration::InForce in_force(const Shadow& s) { return {s.model, s.array, s.gravity, s.limits}; }

// Negative: REQ-163
TEST(RecalibrationResume, CoefficientsBeyondTheBoundsAreNotTakenUp) {
  Shadow s(5, 21);
  const auto taken = [&s](double bias_sigmas, double scale_sigmas) {
    SensorModel model = s.model;
    model.sensor[2].bias[0] += bias_sigmas * s.drift_sigmas.bias_mps2;
    model.sensor[2].scale[0] *= 1.0 + scale_sigmas * s.drift_sigmas.scale;
    Recalibration twin = *s.fit;
    return twin.resume({model, s.array, s.gravity, s.limits});
  };
  EXPECT_TRUE(taken(4.9, 4.9));
  EXPECT_FALSE(taken(5.1, 0.0));
  EXPECT_FALSE(taken(0.0, 5.1));
}

/// Scales and the factor that widens the covariance of a fit are 1 here: less than that, or no number, is believed of
/// none of them.
// Negative: REQ-163
TEST(RecalibrationResume, AnAcceptedFitOfASmallerUncertaintyIsNotTakenUp) {
  constexpr int kSensors = 5;
  Shadow s(kSensors, 21);
  s.drift(5e-4 * kG0_mps2, 1e-4);
  s.start();
  ASSERT_EQ(s.roam(24), Outcome::accepted);
  const Bytes good = bytes_of(*s.fit, kSensors);
  Recalibration twin = *s.fit;
  ASSERT_TRUE(read_back(good, kSensors, twin));
  EXPECT_TRUE(twin.resume(in_force(s)));
  const double one = 1.0;
  int ones = 0;
  for (std::size_t k = 0; k + sizeof one <= good.size(); ++k) {
    if (std::memcmp(good.data() + k, &one, sizeof one) != 0) continue;
    ++ones;
    for (const double lie : {0.5, -1.0, std::nan(""), HUGE_VAL}) {
      Bytes bytes = good;
      std::memcpy(bytes.data() + k, &lie, sizeof lie);
      EXPECT_FALSE(read_back(bytes, kSensors, twin) && twin.resume(in_force(s))) << k << ": " << lie;
    }
  }
  EXPECT_EQ(ones, kSensors + 1);
}

// Negative: REQ-163
TEST(RecalibrationResume, AnOfferOfAnotherArrayIsNotTakenUp) {
  Shadow five(5, 22), six(6, 22);
  ASSERT_TRUE(five.fit->offer(in_force(five), five.model, five.array, five.array.all(), 0.0).has_value());
  EXPECT_TRUE(five.fit->resume(in_force(five)));
  EXPECT_FALSE(five.fit->resume(in_force(six)));
}

/// Nobody may offer one then; whoever does has a state that is none.
// Negative: REQ-163
TEST(RecalibrationResume, AnOfferInTheMiddleOfAFitIsNotTakenUp) {
  Shadow s(5, 23);
  s.start();
  for (int k = 0; k < 16; ++k) s.offer(random_direction(s.noise));
  ASSERT_EQ(s.step(0.0), Outcome::none);
  ASSERT_EQ(s.fit->progress(s.array).phase, RecalibrationPhase::fitting);
  EXPECT_TRUE(s.fit->resume(in_force(s)));
  ASSERT_TRUE(s.fit->offer(in_force(s), s.model, s.array, s.array.all(), 0.0).has_value());
  EXPECT_FALSE(s.fit->resume(in_force(s)));
}

/// Before its first calibration a monitor has none in force, so that nothing can have been offered or adopted over it.
// Negative: REQ-163
TEST(RecalibrationResume, WithoutACalibrationThereIsNoOfferAndNoFitInFlight) {
  constexpr int kSensors = 4;
  UncalibratedTool tool(kSensors, 3);
  const TestLimits limits = TestLimits::from_rates(kSensors, 1e-5, 1e-6);
  const Recalibration::InForce now = {tool.setup.model, tool.setup.array, tool.setup.gravity, limits};
  Recalibration r;
  r.configure(tool.setup.model, {}, rad_from_deg(2.0), true);
  EXPECT_TRUE(r.resume(now));
  const Bytes good = bytes_of(r, kSensors);
  int adopted = 0;
  for (std::size_t k = 0; k < good.size(); ++k) {
    Bytes bytes = good;
    bytes[k] = 1;
    Recalibration twin = r;
    if (!read_back(bytes, kSensors, twin) || !twin.first() || !twin.adopted()) continue;
    ++adopted;
    EXPECT_FALSE(twin.resume(now)) << k;
  }
  EXPECT_EQ(adopted, 1);
  SensorArray sure = tool.setup.array;
  plumb_test::leave_uncertainty(sure);
  ASSERT_TRUE(r.offer(now, tool.setup.model, sure, sure.all(), 0.0).has_value());
  EXPECT_FALSE(r.resume(now));
}

}  // namespace
}  // namespace recalibration_resume_test

#include "plumb/render/words.hpp"

#include <gtest/gtest.h>

#include "plumb/array/geometry.hpp"

namespace plumb {
namespace render {
namespace words_test {
namespace {

std::string about(HealthEvent event) { return explain(Cause::calibration, Grade::none, event); }

TEST(Words, SayWhatBecameOfACalibration) {
  EXPECT_NE(about(HealthEvent::fit_accepted).find("accepted"), std::string::npos);
  EXPECT_NE(about(HealthEvent::fit_rejected).find("refused"), std::string::npos);
  EXPECT_NE(about(HealthEvent::recalibrate).find("recalibration of the sensors in service"), std::string::npos);
  for (const HealthEvent other : {HealthEvent::none, HealthEvent::alarm}) {
    EXPECT_EQ(about(other).find("accepted"), std::string::npos);
    EXPECT_EQ(about(other).find("refused"), std::string::npos);
  }
}

TEST(Words, DistinguishAConfirmedExclusionFromAProvisionalOne) {
  EXPECT_NE(explain(Cause::isolated_fault, Grade::provisional).find("provisionally excluded"), std::string::npos);
  EXPECT_NE(explain(Cause::isolated_fault, Grade::confirmed).find("faulty and excluded"), std::string::npos);
}

TEST(Words, OfANoisySensorNameIt) {
  const SensorRow rows[] = {{make_id("ax"), {1.0, 0.0, 0.0}, 1e-3},
                            {make_id("ay"), {0.0, 1.0, 0.0}, 1e-3},
                            {make_id("az"), {0.0, 0.0, 1.0}, 1e-3}};
  const SensorArray array = *SensorArray::make(rows, 3);
  Verdict v;
  v.transition.cause = Cause::noisy;
  v.transition.sensors = SensorSet::of(1);
  EXPECT_EQ(explain(verification::named_event(v), array), "ay scatters while the others are at rest");
  v.transition.cause = Cause::isolated_fault;
  const std::string plain = explain(verification::named_event(v), array);
  EXPECT_EQ(plain, explain(Cause::isolated_fault));
  v.sensor_cause[1] = Cause::noisy;
  EXPECT_EQ(explain(verification::named_event(v), array), plain + "; ay scatters while the others are at rest");
  v.sensor_cause[1] = Cause::stuck;
  EXPECT_EQ(explain(verification::named_event(v), array), plain + "; stuck: ay");
  v.transition = TransitionRecord{};
  v.noisy = SensorSet::of(2) | SensorSet::of(0);
  EXPECT_NE(explain(verification::named_event(v), array).find("ax, az scatter while"), std::string::npos);
}

}  // namespace
}  // namespace words_test
}  // namespace render
}  // namespace plumb

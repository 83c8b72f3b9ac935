#include "plumb/render/words.hpp"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace words_test
}  // namespace render
}  // namespace plumb

// Whatever is said of motion, and of whomever: it decides nothing that rest decides.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "support/motion_twin.hpp"

namespace motion_finding_laws_test {
namespace {

// Verifies: REQ-200
RC_GTEST_PROP(MotionFindingLaw, NothingIsDecidedForGoodByWhatIsFoundInMotion, ()) {
  plumb_test::MotionLife life(*rc::gen::inRange(4, plumb::kCapacity + 1), *rc::gen::arbitrary<std::uint64_t>());
  const std::string wrong = life.run(60);
  RC_TAG(life.heard > 0 ? "heard" : "not heard");
  RC_ASSERT(wrong == "");
}

}  // namespace
}  // namespace motion_finding_laws_test

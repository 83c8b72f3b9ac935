#include "../../src/detection/largest_eigenvalue.hpp"

#include <gtest/gtest.h>

// Serves: REQ-052

namespace largest_eigenvalue_test {
namespace {

using namespace plumb;

TEST(LargestEigenvalue, IsInfiniteWhereAnEntryIsNoNumber) {
  EXPECT_EQ(detection_detail::largest_eigenvalue({2.0, 0.0, 0.0, 0.0, 3.0, 0.0, 0.0, 0.0, 1.0}), 3.0);
  EXPECT_EQ(detection_detail::largest_eigenvalue(
                {2.0, 0.0, 0.0, 0.0, std::numeric_limits<double>::quiet_NaN(), 0.0, 0.0, 0.0, 1.0}),
            std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace largest_eigenvalue_test

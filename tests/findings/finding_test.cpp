#include "plumb/findings/finding.hpp"

#include <gtest/gtest.h>

#include <set>
#include <string>

namespace finding_test {
namespace {

using namespace plumb;
using findings::FindingCode;

TEST(Finding, HasAUniqueIdInLowerCase) {
  std::set<std::string> ids;
  for (const findings::FindingId& row : findings::kFindingIds) {
    const std::string id = row.id;
    EXPECT_TRUE(ids.insert(id).second) << id;
    EXPECT_EQ(id.find_first_not_of("abcdefghijklmnopqrstuvwxyz_"), std::string::npos) << id;
    EXPECT_EQ(findings::to_string(row.code), id);
  }
  EXPECT_EQ(ids.size(), findings::kFindingCodes);
}

TEST(Finding, IsFoundInAListByItsCode) {
  const std::vector<findings::Finding> list = {{FindingCode::sensor_absent, 2, 5.0, 8.0}, {FindingCode::not_converged}};
  EXPECT_TRUE(findings::has(list, FindingCode::not_converged));
  EXPECT_FALSE(findings::has(list, FindingCode::inconsistent_sensor));
}

}  // namespace
}  // namespace finding_test

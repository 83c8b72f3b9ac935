#include "plumb/scenario/count_text.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>

namespace count_text_test {
namespace {

using namespace plumb;

TEST(CountText, OneIsSingularAndEveryOtherCountIsPlural) {
  EXPECT_EQ(count_text(1, "row"), "1 row");
  EXPECT_EQ(count_text(0, "row"), "0 rows");
  EXPECT_EQ(count_text(2, "row"), "2 rows");
  EXPECT_EQ(count_text(-1, "row"), "-1 rows");
}

TEST(CountText, TakesAnyKindOfNumber) {
  EXPECT_EQ(count_text(std::size_t{1}, "byte"), "1 byte");
  EXPECT_EQ(count_text(std::uint64_t{18446744073709551615U}, "byte"), "18446744073709551615 bytes");
  EXPECT_EQ(count_text(1.0, "station"), "1 station");
  EXPECT_EQ(count_text(12.0, "station"), "12 stations");
}

TEST(CountText, APluralOfItsOwnIsUsedAsItIs) {
  EXPECT_EQ(count_text(1, "block at rest", "blocks at rest"), "1 block at rest");
  EXPECT_EQ(count_text(4, "block at rest", "blocks at rest"), "4 blocks at rest");
}

TEST(CountText, VerbsAgreeWithTheCount) {
  EXPECT_EQ(by_count(1, "is", "are"), "is");
  EXPECT_EQ(by_count(0, "is", "are"), "are");
  EXPECT_EQ(by_count(2.0, "is", "are"), "are");
}

}  // namespace
}  // namespace count_text_test

#include "plumb/io/date.hpp"

#include <gtest/gtest.h>

#include <string>

namespace date_test {
namespace {

using plumb::io::day_number;

TEST(Date, DaysAreCountedOverMonthsAndLeapYears) {
  EXPECT_EQ(*day_number("1970-01-01"), 0);
  EXPECT_EQ(*day_number("1970-03-01"), 59);
  EXPECT_EQ(*day_number("2000-02-29"), 11016);
  EXPECT_EQ(*day_number("2026-03-31"), 20543);
  EXPECT_EQ(*day_number("2199-12-31"), 84005);
  EXPECT_EQ(*day_number("2100-03-01") - *day_number("2100-02-28"), 1) << "2100 is no leap year";
}

TEST(Date, WhatIsNoneIsRefusedWithTheForm) {
  for (const char* wrong :
       {"", "2026", "31.03.2026", "2026-3-31", "2026-13-01", "2026-00-10", "2026-02-29", "2026-04-31", "2026-04-00",
        "1969-12-31", "2200-01-01", "2026-03-31T00:00", "2026/03/31", "2o26-03-31", "-026-03-31"}) {
    const auto day = day_number(wrong);
    ASSERT_FALSE(day.has_value()) << wrong;
    EXPECT_NE(day.error().what.find("is no date"), std::string::npos);
    EXPECT_NE(day.error().remedy.find("2026-03-31"), std::string::npos);
  }
}

}  // namespace
}  // namespace date_test

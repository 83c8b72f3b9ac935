#include "plumb/core/error.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cstring>
#include <set>
#include <string>

namespace plumb {
namespace error_test {
namespace {

constexpr int kLast = static_cast<int>(kLastErrc);

TEST(ErrorText, EveryCodeHasATextOfItsOwn) {
  std::set<std::string> described;
  std::set<std::string> remedied;
  for (int c = 0; c <= kLast; ++c) {
    described.insert(describe(static_cast<Errc>(c)));
    remedied.insert(remedy(static_cast<Errc>(c)));
  }
  const auto codes = static_cast<std::size_t>(kLast) + 1;
  EXPECT_EQ(described.size(), codes);
  EXPECT_EQ(remedied.size(), codes);
  EXPECT_EQ(described.count(describe(static_cast<Errc>(kLast + 1))), 0U)
      << "a code beyond the last has the fallback text";
}

TEST(ErrorText, SaysWhatTheContractQuotes) {
  EXPECT_STREQ(describe(Errc::axis_not_unit), "axis is not of unit length");
  EXPECT_STREQ(remedy(Errc::axis_not_unit), "divide the axis by its length");
}

TEST(Error, FailCarriesCodeIndexAndFigures) {
  const Expected<int> e = fail(Errc::axis_not_unit, 3, 1.5, 1.0);
  ASSERT_FALSE(e.has_value());
  EXPECT_EQ(e.error().code, Errc::axis_not_unit);
  EXPECT_EQ(e.error().index, 3);
  EXPECT_EQ(e.error().value, 1.5);
  EXPECT_EQ(e.error().limit, 1.0);
  EXPECT_TRUE(e.error() == (Error{Errc::axis_not_unit, 3, 0.0, 0.0}));
  EXPECT_FALSE(e.error() == (Error{Errc::axis_not_unit, 2, 1.5, 1.0}));
}

RC_GTEST_PROP(ErrorTextLaw, AnyByteIsDescribed, ()) {
  const auto code = static_cast<Errc>(*rc::gen::inRange(0, 256));
  RC_ASSERT(describe(code) != nullptr && std::strlen(describe(code)) > 0);
  RC_ASSERT(remedy(code) != nullptr && std::strlen(remedy(code)) > 0);
}

TEST(Error, IsTheSameByCodeAndPlace) {
  const Error one{Errc::out_of_range, 2, 1.0, 3.0};
  EXPECT_TRUE((one == Error{Errc::out_of_range, 2, 7.0, 8.0}));
  EXPECT_FALSE((one == Error{Errc::not_finite, 2, 1.0, 3.0}));
  EXPECT_FALSE((one == Error{Errc::out_of_range, 1, 1.0, 3.0}));
}

}  // namespace
}  // namespace error_test
}  // namespace plumb

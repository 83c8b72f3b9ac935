// The laws that users get, one test each, on arrays that leave them room to break: a cone of seven, two triads and an
// array with four axes in one plane. Linked with the library as it is, and with every planted defect meant for them.
#include <gtest/gtest.h>

#include <cctype>
#include <cmath>
#include <string>

#include "plumb/testing/monitor_laws.hpp"

namespace plumb {
namespace testing {
namespace shipped_laws_test {
namespace {

/// Seven axes, four of them in the horizontal plane: c = 4, m_strict = 2.
SensorArray half_flat() {
  AxisList axes{};
  for (std::size_t i = 0; i < 4; ++i) {
    const double angle = (0.1 + static_cast<double>(i)) * kPi / 4.0;
    axes[i] = {std::cos(angle), std::sin(angle), 0.0};
  }
  for (std::size_t i = 4; i < 7; ++i) {
    const double angle = (0.3 + static_cast<double>(i)) * 2.0 * kPi / 3.0;
    axes[i] = {0.6 * std::cos(angle), 0.6 * std::sin(angle), 0.8};
  }
  return array_of(axes, 7);
}

class ShippedLaw : public ::testing::TestWithParam<std::size_t> {};

TEST_P(ShippedLaw, Holds) {
  const Law& law = laws()[GetParam()];
  MonitorConfig config;
  config.alert_limit_rad = rad_from_deg(0.5);
  EXPECT_TRUE(keeps(law, cone_of(7), config));
  EXPECT_TRUE(keeps(law, triads_of(2), config));
  EXPECT_TRUE(keeps(law, half_flat(), config));
}

INSTANTIATE_TEST_SUITE_P(All, ShippedLaw, ::testing::Range<std::size_t>(0, 10), [](const auto& which) {
  std::string name = laws()[which.param].name;
  for (char& c : name) c = std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
  return name;
});

TEST(ShippedLaws, AreTen) { EXPECT_EQ(laws().size(), 10U); }

}  // namespace
}  // namespace shipped_laws_test
}  // namespace testing
}  // namespace plumb

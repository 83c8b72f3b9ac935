/// Small campaigns for tests.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "plumb/campaign/campaign_file.hpp"
#include "plumb/campaign/engine.hpp"
#include "plumb/campaign/kernel.hpp"
#include "plumb/io/output_file.hpp"

namespace plumb_test {

inline plumb::campaign::CampaignFile campaign_from(const std::string& text) {
  const auto file = plumb::campaign::parse_campaign_text(text, "test.toml");
  EXPECT_TRUE(file.has_value()) << file.error().text();
  return file ? *file : plumb::campaign::CampaignFile{};
}

inline std::string small_text() {
  return *plumb::io::read_file(std::string(PLUMB_SOURCE_DIR) + "/tests/campaign/small.toml");
}
inline plumb::campaign::CampaignFile small_campaign(std::uint64_t scenarios) {
  plumb::campaign::CampaignFile file = campaign_from(small_text());
  file.plan.scenarios = scenarios;
  return file;
}

inline std::unique_ptr<plumb::campaign::Kernel> kernel_of(const plumb::campaign::Plan& plan, int least = 0) {
  auto kernel = plumb::campaign::make_kernel(plan, least);
  EXPECT_TRUE(kernel.has_value()) << kernel.error();
  return kernel ? std::move(*kernel) : nullptr;
}

/// The same to the last bit.
inline void expect_same(const plumb::campaign::Outcome& a, const plumb::campaign::Outcome& b, const std::string& what) {
  ASSERT_EQ(a.blocks, b.blocks) << what;
  EXPECT_EQ(a.first_fault_block, b.first_fault_block) << what;
  EXPECT_EQ(a.alarm_block, b.alarm_block) << what;
  EXPECT_EQ(a.isolated_block, b.isolated_block) << what;
  EXPECT_EQ(a.faulty, b.faulty) << what;
  EXPECT_EQ(a.excluded, b.excluded) << what;
  EXPECT_EQ(a.provisionally_excluded, b.provisionally_excluded) << what;
  EXPECT_EQ(a.ever_excluded, b.ever_excluded) << what;
  EXPECT_EQ(a.ever_provisionally_excluded, b.ever_provisionally_excluded) << what;
  EXPECT_EQ(a.failed, b.failed) << what;
  for (int k = 0; k < a.blocks; ++k) {
    const auto& one = a.block[static_cast<std::size_t>(k)];
    const auto& two = b.block[static_cast<std::size_t>(k)];
    EXPECT_EQ(one.tilt_rad, two.tilt_rad) << what << ", block " << k;
    EXPECT_EQ(one.protection_rad, two.protection_rad) << what << ", block " << k;
    EXPECT_EQ(one.bounded, two.bounded) << what << ", block " << k;
    EXPECT_EQ(one.usable, two.usable) << what << ", block " << k;
    EXPECT_EQ(one.alert, two.alert) << what << ", block " << k;
    EXPECT_EQ(one.alarmed, two.alarmed) << what << ", block " << k;
  }
}

}  // namespace plumb_test

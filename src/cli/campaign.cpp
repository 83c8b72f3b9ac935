// plumb campaign: many scenarios, counted.
#include <memory>

#include "../command/campaign.hpp"
#include "tool.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {

namespace {
constexpr const char* kCampaignAbout =
    "Play a campaign: as many scenarios as you like - tools, attitudes, faults, sizes, errors of gravity and of\n"
    "calibration - through the monitor, and count the results: detected, isolated,\n"
    "ambiguous, wrongly excluded, misleading, with a 95 % confidence interval for each rate.";
}  // namespace

Command add_campaign(const Options& tool) {
  auto options = std::make_shared<command::CampaignOptions>();
  const Options own = tool.add_command(
      "campaign", "run many simulated scenarios through the monitor and count the results, with confidence intervals");
  command::add_campaign_options(own, *options);
  return {own, kCampaignAbout, [options] {
            campaign::Ranks alone;
            return command::run_campaign(*options, alone);
          }};
}

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb

// plumb campaign: many scenarios, counted.
#include <memory>

#include "campaign_run.hpp"
#include "tool.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {

namespace {
constexpr const char* kCampaignAbout =
    "Play a campaign: as many scenarios as you like - tools, attitudes, faults, sizes, errors of gravity and of\n"
    "calibration - through the monitor, and count what became of them: detected, isolated, ambiguous, wrongly "
    "excluded,\n"
    "misleading, with the interval that each count leaves for its rate.";
}  // namespace

Command add_campaign(const Options& tool) {
  auto options = std::make_shared<CampaignOptions>();
  const Options command =
      tool.add_command("campaign", "many scenarios through the monitor, counted, with their intervals");
  add_campaign_options(command, *options);
  return {command, kCampaignAbout, [options] {
            campaign::Ranks alone;
            return run_campaign(*options, alone);
          }};
}

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb

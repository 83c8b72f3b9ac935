/// The campaign file (TOML): docs/campaign.md lists its keys.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "plumb/campaign/plan.hpp"
#include "plumb/campaign/tally.hpp"
#include "plumb/io/field.hpp"
#include "plumb/io/file_error.hpp"

namespace plumb {
namespace campaign {

/// At most so many scenarios may raise a count: else the campaign is a verification that did not pass.
struct Expectation {
  Count count = Count::wrong_exclusion;
  std::uint64_t at_most = 0;
};

struct CampaignFile {
  std::string path;
  Plan plan;
  std::vector<Expectation> expect;
};

/// Refuses, with file, line, field and remedy, all that cannot be played. `lookup` answers where a group of an array
/// file states a place and a date; without one such a group is refused.
io::FileExpected<CampaignFile> read_campaign(const std::string& path, const io::FieldLookup& lookup = {});
/// The same from text; `path` is used in messages.
io::FileExpected<CampaignFile> parse_campaign_text(const std::string& text, const std::string& path,
                                                   const io::FieldLookup& lookup = {});

/// Of everything in the plan that decides about a result, seed and number of scenarios included.
std::uint64_t hash_of(const Plan& plan);

}  // namespace campaign
}  // namespace plumb

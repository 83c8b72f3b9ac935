/// The result of a campaign (JSON): readable at any time, and enough to go on from.
#pragma once

#include <string>

#include "plumb/campaign/campaign_file.hpp"
#include "plumb/campaign/engine.hpp"

namespace plumb {
namespace campaign {

/// Rates with their Clopper-Pearson intervals, times, diagram, cells, and the counts themselves. The same counts give
/// the same bytes: nothing in it tells of time, threads or interruptions.
std::string result_text(const CampaignFile& file, const Progress& progress);

/// What a result file has counted. Errors: unreadable, or of another campaign (file, seed or number of scenarios).
io::FileExpected<Progress> read_result(const std::string& path, const CampaignFile& file);

/// A table for people.
std::string summary_text(const CampaignFile& file, const Progress& progress);

/// Expectations that are not met, as a text; empty where all are.
std::string broken_expectations(const CampaignFile& file, const Progress& progress);

}  // namespace campaign
}  // namespace plumb

/// What `plumb campaign` does, for one process and for ranks alike.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "options.hpp"
#include "plumb/campaign/engine.hpp"
#include "plumb/io/file_error.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace command {

struct CampaignOptions {
  std::string file;
  std::string out;
  std::string replay;
  std::optional<std::uint64_t> seed, scenarios;
  int threads = 1;
  double every_s = 30.0;
  bool resume = false;
  bool json = false;
};

/// The options on the command line, and what `--help` says at its end.
void add_campaign_options(const Options& command, CampaignOptions& options);

io::ExitCode run_campaign(const CampaignOptions& options, campaign::Ranks& ranks);

}  // namespace command
}  // namespace PLUMB_ABI
}  // namespace plumb

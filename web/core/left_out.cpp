// What of the corpus of bench/replay is read from files, which there are none of in a browser.
#include "fixed_cases.hpp"

namespace plumb_replay {

std::vector<FixedCase> drill_cases() { return {}; }

std::vector<FixedCase> recording_cases(const std::string&, const std::string&, std::vector<std::string>& skipped) {
  skipped.emplace_back("recordings: there are no files here");
  return {};
}

}  // namespace plumb_replay

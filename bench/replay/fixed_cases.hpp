// The cases that are not drawn: the demo's drills, the paper's monitor, and public recordings.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace plumb_replay {

struct Stage;

struct FixedCase {
  std::string name;
  std::function<void(const Stage&)> play;
};

std::vector<FixedCase> drill_cases();
std::vector<FixedCase> paper_cases();
/// Of the recordings that are there; what is left out and why goes to `skipped`.
std::vector<FixedCase> recording_cases(const std::string& folder, const std::string& examples,
                                       std::vector<std::string>& skipped);

}  // namespace plumb_replay

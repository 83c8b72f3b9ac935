/// A report of the paper's tool, made once per test process by the tool itself.
#pragma once

#include <nlohmann/json.hpp>

#include "cli/tool_runner.hpp"

namespace plumb_test {

using Json = nlohmann::ordered_json;

/// A station of examples/stand.toml as it was simulated: one that excludes every other wiring of the paper's tool.
inline constexpr const char* kKnownStation = "5:33.5,13.2";

/// Runs `plumb verify` with few scenarios.
inline Outcome verify(const Directory& where, std::vector<std::string> more, const std::string& scenarios = "200") {
  std::vector<std::string> arguments = {"verify", "--scenarios", scenarios};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return run(where, arguments);
}

inline Json report_in(const std::filesystem::path& folder) { return Json::parse(read_text(folder / "report.json")); }

inline const Directory& verified_paper_tool() {
  static const Directory directory;
  static const bool made = [] {
    std::filesystem::copy_file(PLUMB_SOURCE_DIR "/examples/paper_tool.toml", directory / "tool.toml");
    const Outcome outcome = verify(directory, {"--array", "tool.toml", "--out", "report"}, "600");
    EXPECT_EQ(outcome.code, 6) << outcome.err;  // its calibration is but predicted
    return true;
  }();
  EXPECT_TRUE(made);
  return directory;
}

inline const Json& paper_report() {
  static const Json report = report_in(verified_paper_tool() / "report");
  return report;
}

}  // namespace plumb_test

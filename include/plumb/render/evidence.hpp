/// What other programs found about this build, as the verification report takes it in: the findings of the static
/// analysis, and what the monitor costs on its target.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "plumb/core/config.hpp"
#include "plumb/io/file_error.hpp"
#include "plumb/verification/facts.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {

using Json = nlohmann::ordered_json;

/// The findings of clang-tidy as it prints them, `path:line:column: warning: text [check]`, each with its notes. A
/// finding that is printed several times (a header, read by many files) counts once. An empty text has no findings; one
/// in which no line is clang-tidy's is refused.
struct Analysis {
  std::uint64_t findings = 0;
  Json section;  ///< of the report
};
io::FileExpected<Analysis> read_analysis(const std::string& path);
io::FileExpected<Analysis> parse_analysis(const std::string& text, const std::string& path);
/// The section of the report that stands where no log was given.
Json no_analysis();
/// The findings as SARIF 2.1.0, for code hosts and viewers.
std::string sarif_json(const Json& analysis, const std::string& version);

/// What scripts/baremetal measured: build/metal/results.json. Errors: unreadable, another schema, an item without name
/// or value.
struct TargetResources {
  std::vector<verification::Resource> items;
  Json section;  ///< of the report
};
io::FileExpected<TargetResources> read_resources(const std::string& path);
io::FileExpected<TargetResources> parse_resources(const std::string& text, const std::string& path);
Json no_resources();

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb

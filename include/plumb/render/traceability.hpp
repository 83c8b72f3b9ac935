/// Requirements, the hazards that they answer, the tests and formal items that check them, and what became of those:
/// every link in both directions, and whatever hangs in the air.
#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "plumb/core/config.hpp"
#include "plumb/io/file_error.hpp"
#include "plumb/render/identity.hpp"
#include "plumb/verification/facts.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {

using Json = nlohmann::ordered_json;

/// What the build found in docs/requirements, in the tags of the tests and in docs/assurance.md (JSON, schema
/// "plumb-traceability").
const char* built_in_traceability() noexcept;

/// Such a text from a file, for requirements of one's own. Errors: unreadable, another schema, a part missing.
io::FileExpected<Json> read_traceability(const std::string& path);
/// The same from text; `path` is used in messages.
io::FileExpected<Json> parse_traceability(const std::string& text, const std::string& path);

enum class TestResult { passed, failed, not_run };

/// Results by name, as `ctest --output-junit` writes them. A test with parameters is known by the name without them and
/// has failed where any of its instances has.
using TestResults = std::map<std::string, TestResult>;
io::FileExpected<TestResults> read_test_results(const std::string& path);
/// Of which build they are, by the properties plumb.commit, plumb.compiler and plumb.flags of the suite, which
/// scripts/test writes. Errors: as above.
io::FileExpected<BuildKey> read_test_build(const std::string& path);

/// What `scripts/assure` wrote: items and their details by name.
struct AssuranceResults {
  struct Item {
    std::string kind, tool, version, figure, title;
    double seconds = 0.0;
    bool holds = false;
    bool listed = false;  ///< an item of its own rather than the detail of one
  };
  std::map<std::string, Item> item;
  std::string version;  ///< the commit of the sources
  bool complete = false;
};
io::FileExpected<AssuranceResults> read_assurance(const std::string& path);

/// The section of the report. Without results a requirement is "traced" at best; with them "verified" where each of its
/// tests ran and passed and each formal item that was given holds.
struct Traceability {
  verification::TraceFacts facts;
  Json section;
};
Traceability traceability_section(const Json& trace, const std::optional<TestResults>& tests,
                                  const std::optional<AssuranceResults>& assurance);

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb

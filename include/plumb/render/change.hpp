/// What differs between two reports of the same schema.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "plumb/io/file_error.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {

using Json = nlohmann::ordered_json;

/// The master JSON of an earlier report. Errors: unreadable, no report, another version of the schema.
io::FileExpected<Json> read_report(const std::string& path);

/// Every value that differs, by its place, but for the blocks `run` and `change`. Entries of lists are matched by their
/// id, name or other key, so that one more in the middle is one change.
Json change_section(const Json& before, const Json& now);

inline constexpr const char* kReportSchema = "plumb-verification";
inline constexpr int kReportVersion = 1;

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb

/// What a recorded roll test came to (`plumb monitor --roll-test`).
#pragma once

#include <string>

#include "plumb/io/json_fields.hpp"
#include "plumb/session/roll_test.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {

/// What it came to, in one line: which sensors are validated or which turn is missing, who is out, which doubt stands,
/// and in which state the run begins.
std::string roll_test_text(const session::RollTest& test, const std::string& path, const HealthMonitor& monitor,
                           const Mat3& frame);
/// The same for the summary of --json.
io::Json roll_test_json(const session::RollTest& test, const HealthMonitor& monitor, const Mat3& frame);

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb

/// The state machine as JSON: every cell of the table that runs in the monitor.
#pragma once

#include <string>

#include "plumb/core/config.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {

std::string model_json();

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb

/// `upgrade_text` of JSON (private to src/io).
#pragma once

#include <string>

#include "plumb/io/upgrade.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {

/// Throws Refusal.
Upgraded upgrade_json(const std::string& text, const std::string& path);

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb

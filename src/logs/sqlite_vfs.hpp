/// How SQLite reaches a file here: it reads its whole pages, and nothing beside it (private to src/logs).
#pragma once

#include <sqlite3.h>

#include <cstdint>

#include "plumb/core/config.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace logs {

/// The name of the file system to open a database with. It knows no journals, no locks and no writing. A page that the
/// file holds only in part does not exist: SQLite's own would fill it up with zeros, which are readings as well.
/// Null where SQLite does not take it.
const char* whole_pages_vfs();

/// Where in the file of such a database the last page was read.
std::uint64_t last_read_offset(sqlite3* database) noexcept;

}  // namespace logs
}  // namespace PLUMB_ABI
}  // namespace plumb

#include "sqlite_file.hpp"

#include <cstring>

#include "plumb/io/printable.hpp"
#include "sqlite_vfs.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace logs {
namespace {

/// Instructions of SQLite's machine between two looks at what is left.
constexpr int kWorkAtATime = 10000;
/// A row takes some twenty bytes and some twenty instructions: this is enough for any sound file, and a tree that leads
/// into itself comes to an end.
constexpr std::uint64_t kWorkOfAnyFile = 10000000;
constexpr std::uint64_t kWorkOfAByte = 4;

/// Rows of other topics may be images: they are passed over, not read.
constexpr int kLongestRow = 1 << 30;
constexpr int kLongestSql = 1 << 20;

int allow(void*, int action, const char*, const char* what, const char*, const char*) {
  if (action == SQLITE_SELECT || action == SQLITE_READ) return SQLITE_OK;
  return action == SQLITE_FUNCTION && what != nullptr && std::strcmp(what, "length") == 0 ? SQLITE_OK : SQLITE_DENY;
}

}  // namespace

void SqliteRows::start_behind(std::int64_t id) noexcept {
  sqlite3_reset(statement_.get());
  sqlite3_bind_int64(statement_.get(), 1, id);
}

SqliteRows::Step SqliteRows::next() noexcept {
  const int code = sqlite3_step(statement_.get());
  return code == SQLITE_ROW ? Step::row : code == SQLITE_DONE ? Step::end : Step::failed;
}

std::string_view SqliteRows::text(int column) const noexcept {
  const unsigned char* text = sqlite3_column_text(statement_.get(), column);
  if (text == nullptr) return {};
  const auto size = static_cast<std::size_t>(sqlite3_column_bytes(statement_.get(), column));
  return {reinterpret_cast<const char*>(text), size};  // NOLINT(*-reinterpret-cast): UTF-8 as text
}

std::string_view SqliteRows::bytes(int column) const noexcept {
  const void* bytes = sqlite3_column_blob(statement_.get(), column);
  if (bytes == nullptr) return {};
  const auto size = static_cast<std::size_t>(sqlite3_column_bytes(statement_.get(), column));
  return {static_cast<const char*>(bytes), size};
}

int SqliteFile::count_work(void* self) noexcept {
  auto& left = static_cast<SqliteFile*>(self)->work_left_;
  if (left < static_cast<std::uint64_t>(kWorkAtATime)) return 1;
  left -= static_cast<std::uint64_t>(kWorkAtATime);
  return 0;
}

bool SqliteFile::open(const std::string& path, std::uint64_t size, bool is_cut) {
  const char* vfs = whole_pages_vfs();
  if (vfs == nullptr) return false;
  sqlite3* made = nullptr;
  const int code = sqlite3_open_v2(path.c_str(), &made, SQLITE_OPEN_READONLY | SQLITE_OPEN_NOMUTEX, vfs);
  database_.reset(made);
  if (code != SQLITE_OK) return false;
  work_left_ = kWorkOfAnyFile + kWorkOfAByte * size;
  sqlite3_progress_handler(made, kWorkAtATime, &SqliteFile::count_work, this);
  sqlite3_limit(made, SQLITE_LIMIT_LENGTH, kLongestRow);
  sqlite3_limit(made, SQLITE_LIMIT_SQL_LENGTH, kLongestSql);
  sqlite3_limit(made, SQLITE_LIMIT_EXPR_DEPTH, 100);
  sqlite3_limit(made, SQLITE_LIMIT_ATTACHED, 0);
  sqlite3_db_config(made, SQLITE_DBCONFIG_ENABLE_LOAD_EXTENSION, 0, nullptr);
  sqlite3_db_config(made, SQLITE_DBCONFIG_ENABLE_TRIGGER, 0, nullptr);
  sqlite3_db_config(made, SQLITE_DBCONFIG_ENABLE_VIEW, 0, nullptr);
  sqlite3_db_config(made, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
  // Else a database that is shorter than it says would not be read at all. Nothing can be written.
  if (is_cut) sqlite3_db_config(made, SQLITE_DBCONFIG_WRITABLE_SCHEMA, 1, nullptr);
  sqlite3_set_authorizer(made, &allow, nullptr);
  return true;
}

bool SqliteFile::has_table(const char* name) {
  // A view and a virtual table have no page of their own.
  SqliteRows rows = prepare(std::string("SELECT rootpage FROM sqlite_master WHERE type = 'table' AND rootpage > 0 AND "
                                        "name = '") +
                            name + "'");
  return rows && rows.next() == SqliteRows::Step::row;
}

SqliteRows SqliteFile::prepare(const std::string& sql) {
  sqlite3_stmt* made = nullptr;
  if (sqlite3_prepare_v2(database_.get(), sql.c_str(), -1, &made, nullptr) != SQLITE_OK) return {};
  return SqliteRows(made);
}

std::uint64_t SqliteFile::last_read() const noexcept {
  return database_ == nullptr ? 0 : last_read_offset(database_.get());
}

std::string SqliteFile::what() const {
  if (database_ == nullptr) return "there is no memory for it";
  constexpr std::size_t kTold = 200;
  return io::printable_line(std::string_view(sqlite3_errmsg(database_.get())).substr(0, kTold));
}

}  // namespace logs
}  // namespace PLUMB_ABI
}  // namespace plumb

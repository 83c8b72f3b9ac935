/// An SQLite database that nobody vouches for, opened to read two tables of it (private to src/logs).
#pragma once

#include <sqlite3.h>

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "plumb/core/config.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace logs {

/// One statement and its rows.
class SqliteRows {
 public:
  enum class Step : std::uint8_t { row, end, failed };

  SqliteRows() = default;
  explicit SqliteRows(sqlite3_stmt* statement) : statement_(statement) {}
  explicit operator bool() const noexcept { return statement_ != nullptr; }

  void start_behind(std::int64_t id) noexcept;
  Step next() noexcept;
  std::int64_t whole(int column) const noexcept { return sqlite3_column_int64(statement_.get(), column); }
  std::string_view text(int column) const noexcept;
  /// Valid until the next step; empty for NULL.
  std::string_view bytes(int column) const noexcept;

 private:
  struct Finalize {
    void operator()(sqlite3_stmt* statement) const noexcept { sqlite3_finalize(statement); }
  };
  std::unique_ptr<sqlite3_stmt, Finalize> statement_;
};

/// Read only, without its journals, extensions, views, triggers or virtual tables; what may be read is columns of
/// tables, and the work that is done for it is in proportion to the file.
class SqliteFile {
 public:
  /// `is_cut` where the file is shorter than the database says: it is read all the same.
  bool open(const std::string& path, std::uint64_t size, bool is_cut);
  /// A table as the database stores it, no view and nothing computed.
  bool has_table(const char* name);
  SqliteRows prepare(const std::string& sql);
  /// The page that was read last begins at this byte: what a row is about lies there, or on a page read before.
  std::uint64_t last_read() const noexcept;
  /// What went wrong last.
  std::string what() const;

 private:
  struct Close {
    void operator()(sqlite3* database) const noexcept { sqlite3_close_v2(database); }
  };
  static int count_work(void* self) noexcept;

  std::unique_ptr<sqlite3, Close> database_;
  std::uint64_t work_left_ = 0;
};

}  // namespace logs
}  // namespace PLUMB_ABI
}  // namespace plumb

#include "sqlite_vfs.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cstring>

namespace plumb {
inline namespace PLUMB_ABI {
namespace logs {
namespace {

constexpr const char* kName = "plumb-whole-pages";

/// SQLite gives the memory, and calls by the table that `base` points to.
struct PagesFile {
  sqlite3_file base;
  int descriptor;
  sqlite3_int64 size;  ///< of the pages that are whole
  sqlite3_int64 last;  ///< read
};

PagesFile& self(sqlite3_file* file) noexcept {
  return *reinterpret_cast<PagesFile*>(file);  // NOLINT(*-reinterpret-cast): `base` is its first member
}

int close_file(sqlite3_file* file) noexcept {
  ::close(self(file).descriptor);
  return SQLITE_OK;
}

int read_file(sqlite3_file* file, void* out, int count, sqlite3_int64 offset) noexcept {
  PagesFile& pages = self(file);
  const sqlite3_int64 there = offset < pages.size ? pages.size - offset : 0;
  const auto wanted = static_cast<std::size_t>(there < count ? there : count);
  auto* bytes = static_cast<unsigned char*>(out);
  std::size_t read = 0;
  while (read < wanted) {
    const ssize_t got = ::pread(pages.descriptor, bytes + read, wanted - read, offset + static_cast<off_t>(read));
    if (got < 0) return SQLITE_IOERR_READ;
    if (got == 0) break;
    read += static_cast<std::size_t>(got);
  }
  pages.last = offset;
  if (read == static_cast<std::size_t>(count)) return SQLITE_OK;
  std::memset(bytes + read, 0, static_cast<std::size_t>(count) - read);
  return SQLITE_IOERR_SHORT_READ;
}

int file_size(sqlite3_file* file, sqlite3_int64* out) noexcept {
  *out = self(file).size;
  return SQLITE_OK;
}

int read_only_write(sqlite3_file*, const void*, int, sqlite3_int64) noexcept { return SQLITE_READONLY; }
int read_only_truncate(sqlite3_file*, sqlite3_int64) noexcept { return SQLITE_READONLY; }
int done(sqlite3_file*, int) noexcept { return SQLITE_OK; }
int nobody_has_it(sqlite3_file*, int* out) noexcept {
  *out = 0;
  return SQLITE_OK;
}
int not_known(sqlite3_file*, int, void*) noexcept { return SQLITE_NOTFOUND; }
int sector_size(sqlite3_file*) noexcept { return 512; }
int characteristics(sqlite3_file*) noexcept { return SQLITE_IOCAP_IMMUTABLE; }

const sqlite3_io_methods& methods() noexcept {
  static const sqlite3_io_methods kMethods = [] {
    sqlite3_io_methods out{};
    out.iVersion = 1;
    out.xClose = &close_file;
    out.xRead = &read_file;
    out.xWrite = &read_only_write;
    out.xTruncate = &read_only_truncate;
    out.xSync = &done;
    out.xFileSize = &file_size;
    out.xLock = &done;
    out.xUnlock = &done;
    out.xCheckReservedLock = &nobody_has_it;
    out.xFileControl = &not_known;
    out.xSectorSize = &sector_size;
    out.xDeviceCharacteristics = &characteristics;
    return out;
  }();
  return kMethods;
}

/// Of the database's head; 0 where it is none that can be.
sqlite3_int64 page_size(int descriptor) noexcept {
  std::array<unsigned char, 2> bytes{};
  if (::pread(descriptor, bytes.data(), bytes.size(), 16) != static_cast<ssize_t>(bytes.size())) return 0;
  const sqlite3_int64 stated = bytes[0] * 256 + bytes[1];
  return stated == 1 ? 65536 : stated;
}

int open_file(sqlite3_vfs*, const char* path, sqlite3_file* file, int flags, int* out_flags) noexcept {
  file->pMethods = nullptr;  // until there is one to close
  if (path == nullptr || (flags & SQLITE_OPEN_MAIN_DB) == 0) return SQLITE_CANTOPEN;
  PagesFile& pages = self(file);
  pages.descriptor = ::open(path, O_RDONLY | O_CLOEXEC);
  if (pages.descriptor < 0) return SQLITE_CANTOPEN;
  struct stat status {};
  const sqlite3_int64 page = page_size(pages.descriptor);
  if (::fstat(pages.descriptor, &status) != 0 || !S_ISREG(status.st_mode) || page < 512) {
    ::close(pages.descriptor);
    return SQLITE_CANTOPEN;
  }
  pages.size = status.st_size / page * page;
  pages.last = 0;
  pages.base.pMethods = &methods();
  if (out_flags != nullptr) *out_flags = SQLITE_OPEN_READONLY | SQLITE_OPEN_MAIN_DB;
  return SQLITE_OK;
}

int remove_nothing(sqlite3_vfs*, const char*, int) noexcept { return SQLITE_OK; }
/// There is no journal beside it.
int has_nothing(sqlite3_vfs*, const char*, int, int* out) noexcept {
  *out = 0;
  return SQLITE_OK;
}
int same_path(sqlite3_vfs*, const char* path, int count, char* out) noexcept {
  const std::size_t size = std::strlen(path) + 1;
  if (size > static_cast<std::size_t>(count)) return SQLITE_CANTOPEN;
  std::memcpy(out, path, size);
  return SQLITE_OK;
}

}  // namespace

const char* whole_pages_vfs() {
  static const bool kRegistered = [] {
    const sqlite3_vfs* usual = sqlite3_vfs_find(nullptr);
    if (usual == nullptr) return false;
    static sqlite3_vfs vfs;  // SQLite keeps it, and links it to others
    vfs = *usual;            // its clock and random numbers
    vfs.iVersion = 1;
    vfs.szOsFile = sizeof(PagesFile);
    vfs.pNext = nullptr;
    vfs.zName = kName;
    vfs.xOpen = &open_file;
    vfs.xDelete = &remove_nothing;
    vfs.xAccess = &has_nothing;
    vfs.xFullPathname = &same_path;
    return sqlite3_vfs_register(&vfs, 0) == SQLITE_OK;
  }();
  return kRegistered ? kName : nullptr;
}

std::uint64_t last_read_offset(sqlite3* database) noexcept {
  sqlite3_file* file = nullptr;
  if (sqlite3_file_control(database, "main", SQLITE_FCNTL_FILE_POINTER, static_cast<void*>(&file)) != SQLITE_OK)
    return 0;
  return file == nullptr || file->pMethods != &methods() ? 0 : static_cast<std::uint64_t>(self(file).last);
}

}  // namespace logs
}  // namespace PLUMB_ABI
}  // namespace plumb

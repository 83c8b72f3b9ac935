/// What a file is, by its first bytes (private to src/logs).
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "plumb/core/config.hpp"
#include "plumb/io/file_error.hpp"
#include "plumb/io/mapped_file.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace logs {

enum class FileKind : std::uint8_t { ulog, dataflash, mcap, sqlite, own, foreign };

/// One that is recognised by bytes at a fixed place.
struct KnownFile {
  std::size_t offset;
  std::string_view bytes;
  FileKind kind;
  const char* what;    ///< "is packed with gzip"
  const char* remedy;  ///< where it is not read
};

/// Enough of a file to recognise it.
constexpr std::size_t kMagicBytes = 512;
/// Null where the first bytes of a file are those of none that is known.
const KnownFile* known_file(std::string_view begin) noexcept;

/// What a character of a text takes: UTF-16 is known by its mark, or by the zeros between figures and Latin letters.
enum class TextWidth : std::uint8_t { bytes, wide_le, wide_be };
TextWidth text_width(std::string_view begin) noexcept;

/// Whether they may be text in UTF-8, in UTF-16 or in a code page: no zero bytes but in UTF-16, few control characters.
bool is_text(std::string_view begin) noexcept;

/// Opens a log and looks whether it is a regular file with bytes in it; `give` is what to do where it is none.
io::FileExpected<void> open_log(const std::string& path, const char* give, io::MappedFile& file);
/// Up to `count` of the first bytes, valid until the next call of `file`.
std::string_view first_bytes(io::MappedFile& file, std::size_t count);

}  // namespace logs
}  // namespace PLUMB_ABI
}  // namespace plumb

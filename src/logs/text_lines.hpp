/// The lines of a text in UTF-8, a code page or UTF-16, as they stream by (private to src/logs).
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "plumb/core/config.hpp"
#include "plumb/io/mapped_file.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace logs {

class TextLines {
 public:
  enum class Encoding : std::uint8_t { utf8, utf16_le, utf16_be };
  static constexpr std::uint64_t kLongest = 1U << 20U;  ///< bytes of a line

  explicit TextLines(io::MappedFile& file);

  /// Valid until the next one; in UTF-8 where the text is in UTF-16. Ends are LF, CR LF, or CR where there is no LF.
  bool next(std::string_view& line);
  Encoding encoding() const noexcept { return encoding_; }
  std::uint64_t number() const noexcept { return number_; }   ///< of the line, from 1
  std::uint64_t offset() const noexcept { return offset_; }   ///< of its first byte
  std::uint64_t end() const noexcept { return at_; }          ///< of what follows it
  bool is_too_long() const noexcept { return is_too_long_; }  ///< only its beginning was given
  bool has_end() const noexcept { return has_end_; }          ///< false for a last line that just stops

 private:
  bool next_of_bytes(std::string_view& line);
  bool next_of_units(std::string_view& line);
  void put(std::uint32_t unit);

  io::MappedFile& file_;
  Encoding encoding_ = Encoding::utf8;
  char line_end_ = '\n';
  std::uint64_t at_ = 0;
  std::uint64_t offset_ = 0;
  std::uint64_t number_ = 0;
  bool is_too_long_ = false;
  bool has_end_ = true;
  std::uint32_t high_ = 0;  ///< the first half of a pair of surrogates
  std::string buffer_;
};

}  // namespace logs
}  // namespace PLUMB_ABI
}  // namespace plumb

/// ULog, the log of PX4, as bytes: its messages, the formats that it describes itself with, and numbers out of a
/// message. Source: the format's page in PX4's developer guide, version 1 of the format.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

#include "plumb/core/config.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {

inline constexpr std::array<unsigned char, 7> kUlogMagic = {'U', 'L', 'o', 'g', 0x01, 0x12, 0x35};
inline constexpr std::size_t kUlogHeader = 16;  ///< bytes: magic, version (uint8), time of the start in us (uint64)
inline constexpr std::size_t kUlogMessageHeader = 3;  ///< bytes: uint16 size, uint8 type
inline constexpr std::size_t kUlogFlagBytes = 40;     ///< of a message of flag bits: 8 compatible, 8 not, 3 offsets
inline constexpr unsigned char kNewestUlog = 1;

enum class UlogType : std::uint8_t {
  none,  ///< no such field
  int8,
  uint8,
  int16,
  uint16,
  int32,
  uint32,
  int64,
  uint64,
  float32,
  float64,
  boolean,
  character,
  nested,  ///< another format
};

struct UlogField {
  std::string name;
  UlogType type = UlogType::none;
  std::string nested;       ///< name of the other format
  std::uint32_t count = 1;  ///< elements of an array
};

/// One number of a message: its type and where it stands.
struct UlogCell {
  UlogType type = UlogType::none;
  std::uint32_t offset = 0;

  explicit operator bool() const noexcept { return type != UlogType::none; }
};
using UlogCells = std::array<UlogCell, 3>;

std::uint64_t ulog_unsigned(const unsigned char* bytes, std::size_t count) noexcept;
/// Negative ones as two's complement; 0 for what is no whole number.
std::uint64_t ulog_whole(const unsigned char* payload, const UlogCell& cell) noexcept;
double ulog_number(const unsigned char* payload, const UlogCell& cell) noexcept;
/// Of one element; 0 for a nested one.
std::uint32_t ulog_size(UlogType type) noexcept;
bool ulog_is_whole(UlogType type) noexcept;
/// "float[3]" has three; false where it is no type. `out` keeps its name.
bool ulog_type(std::string_view text, UlogField& out);

/// A value with its name: information ('I'), a parameter ('P').
struct UlogKey {
  UlogField field;
  std::string_view value;  ///< its bytes
};
/// From the bytes behind a message's header; false where the name runs past them or is none.
bool ulog_key(std::string_view payload, UlogKey& out);

/// A message as it is written: `payload` has at most 65535 bytes.
std::string ulog_message(char type, std::string_view payload);
/// One of a key and its value: `typed_name` ("uint32_t count") has at most 255 bytes.
std::string ulog_key_message(char type, std::string_view typed_name, std::string_view value);

/// Where the fields of a message stand.
class UlogLayout {
 public:
  void place(const UlogField& field, std::uint32_t offset) { placed_.push_back({&field, offset}); }
  /// Element `index` of a field of a basic type; empty where there is none of this name, or not so many.
  UlogCell cell(std::string_view name, std::uint32_t index = 0) const;
  /// Three elements from `first` on; all are empty where one is.
  UlogCells three(std::string_view name, std::uint32_t first = 0) const;

  std::uint32_t size = 0;      ///< in bytes, padding at the end included
  std::uint32_t unpadded = 0;  ///< without the padding at the end, which a logger may leave out

 private:
  struct Placed {
    const UlogField* field;
    std::uint32_t offset;
  };
  std::vector<Placed> placed_;
};

/// All formats of a log. What it holds is bounded whatever the log says.
class UlogFormats {
 public:
  static constexpr std::size_t kMostFormats = 2048;
  static constexpr std::size_t kMostFields = 32768;  ///< of all formats together
  static constexpr std::size_t kMostFieldsOfOne = 1024;
  static constexpr std::size_t kLongestName = 255;
  static constexpr std::uint32_t kLargest = 65533;  ///< bytes of a message behind its number
  static constexpr int kDeepest = 16;

  /// "name:type field;type[3] field;". What is wrong with it, or empty.
  std::string define(std::string_view text);
  bool has(const std::string& name) const { return formats_.count(name) != 0; }
  /// In the order of the message; null where there is no format of this name.
  const std::vector<UlogField>* fields(const std::string& name) const;
  /// Valid as long as this; the error is a sentence.
  tl::expected<UlogLayout, std::string> layout(const std::string& name) const;

 private:
  using Fields = std::vector<UlogField>;
  using Sizes = std::map<std::string, std::uint32_t>;
  tl::expected<std::uint32_t, std::string> field_size(const UlogField& field, int depth, Sizes& known) const;
  tl::expected<std::uint32_t, std::string> nested_size(const std::string& name, int depth, Sizes& known) const;

  std::map<std::string, Fields> formats_;
  std::size_t fields_ = 0;
};

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb

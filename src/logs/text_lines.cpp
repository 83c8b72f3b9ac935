#include "text_lines.hpp"

#include <algorithm>
#include <cstring>

#include "log_magic.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace logs {
namespace {

constexpr std::uint64_t kStep = 1U << 16U;
constexpr std::uint64_t kShown = 256;  ///< of a line that is too long

std::string_view without_cr(std::string_view line) noexcept {
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  return line;
}

}  // namespace

TextLines::TextLines(io::MappedFile& file) : file_(file) {
  const std::string_view begin = first_bytes(file, kStep);
  switch (text_width(begin)) {
    case TextWidth::wide_le: encoding_ = Encoding::utf16_le; break;
    case TextWidth::wide_be: encoding_ = Encoding::utf16_be; break;
    case TextWidth::bytes: break;
  }
  if (encoding_ == Encoding::utf8) {
    if (begin.substr(0, 3) == "\xEF\xBB\xBF") at_ = 3;
    if (begin.find('\n') == std::string_view::npos && begin.find('\r') != std::string_view::npos) line_end_ = '\r';
  } else if (begin.substr(0, 2) == "\xFF\xFE" || begin.substr(0, 2) == "\xFE\xFF") {
    at_ = 2;
  }
}

bool TextLines::next(std::string_view& line) {
  if (at_ >= file_.size()) return false;
  offset_ = at_;
  is_too_long_ = false;
  ++number_;
  return encoding_ == Encoding::utf8 ? next_of_bytes(line) : next_of_units(line);
}

bool TextLines::next_of_bytes(std::string_view& line) {
  const std::uint64_t rest = file_.size() - at_;
  std::uint64_t count = std::min(rest, kStep);
  while (true) {
    const unsigned char* bytes = file_.at(at_, static_cast<std::size_t>(count));
    if (bytes == nullptr) {
      at_ = file_.size();
      return false;
    }
    const char* text = reinterpret_cast<const char*>(bytes);  // NOLINT(*-reinterpret-cast): bytes of a file as text
    const void* found = std::memchr(text, line_end_, static_cast<std::size_t>(count));
    has_end_ = found != nullptr;
    if (found != nullptr) {
      line = std::string_view(text, static_cast<std::size_t>(static_cast<const char*>(found) - text));
      at_ += line.size() + 1;
      line = without_cr(line);
      return true;
    }
    if (count == rest || count >= kLongest) {
      is_too_long_ = count >= kLongest;
      line = std::string_view(text, static_cast<std::size_t>(is_too_long_ ? kShown : count));
      at_ += count;
      break;
    }
    count = std::min({rest, 4 * count, kLongest});
  }
  if (!is_too_long_) return true;
  buffer_ = line;
  line = buffer_;
  while (at_ < file_.size()) {  // the rest of it
    const std::uint64_t piece = std::min(file_.size() - at_, kStep);
    const unsigned char* bytes = file_.at(at_, static_cast<std::size_t>(piece));
    const void* found = bytes == nullptr ? nullptr : std::memchr(bytes, line_end_, static_cast<std::size_t>(piece));
    at_ += found == nullptr ? piece : static_cast<std::uint64_t>(static_cast<const unsigned char*>(found) - bytes) + 1;
    if (found != nullptr || bytes == nullptr) break;
  }
  return true;
}

/// A unit of UTF-16 in UTF-8. Halves of pairs that stand alone become U+FFFD.
void TextLines::put(std::uint32_t unit) {
  std::uint32_t point = unit;
  if (unit >= 0xD800 && unit < 0xDC00) {
    if (high_ != 0) buffer_ += "\xEF\xBF\xBD";
    high_ = unit;
    return;
  }
  if (unit >= 0xDC00 && unit < 0xE000) {
    point = high_ != 0 ? 0x10000U + ((high_ - 0xD800U) << 10U) + (unit - 0xDC00U) : 0xFFFDU;
  } else if (high_ != 0) {
    buffer_ += "\xEF\xBF\xBD";
  }
  high_ = 0;
  const auto tail = [](std::uint32_t bits) { return static_cast<char>(0x80U | (bits & 0x3FU)); };
  if (point < 0x80) {
    buffer_ += static_cast<char>(point);
  } else if (point < 0x800) {
    buffer_ += {static_cast<char>(0xC0U | point >> 6U), tail(point)};
  } else if (point < 0x10000) {
    buffer_ += {static_cast<char>(0xE0U | point >> 12U), tail(point >> 6U), tail(point)};
  } else {
    buffer_ += {static_cast<char>(0xF0U | point >> 18U), tail(point >> 12U), tail(point >> 6U), tail(point)};
  }
}

bool TextLines::next_of_units(std::string_view& line) {
  const std::size_t low = encoding_ == Encoding::utf16_le ? 0 : 1;
  buffer_.clear();
  high_ = 0;
  has_end_ = false;
  while (at_ + 2 <= file_.size() && !has_end_) {
    const std::uint64_t count = std::min(file_.size() - at_, kStep) / 2 * 2;
    const unsigned char* bytes = file_.at(at_, static_cast<std::size_t>(count));
    if (bytes == nullptr) break;
    std::size_t k = 0;
    for (; k < count && !has_end_; k += 2) {
      const std::uint32_t unit = bytes[k + low] + (static_cast<std::uint32_t>(bytes[k + 1 - low]) << 8U);
      has_end_ = unit == '\n';
      if (!has_end_ && buffer_.size() < kLongest) put(unit);
    }
    at_ += k;
  }
  if (!has_end_) at_ = file_.size();  // one byte may be left
  is_too_long_ = buffer_.size() >= kLongest;
  line = without_cr(buffer_);
  if (is_too_long_) line = line.substr(0, kShown);
  return true;
}

}  // namespace logs
}  // namespace PLUMB_ABI
}  // namespace plumb

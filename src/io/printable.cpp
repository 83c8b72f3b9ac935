#include "plumb/io/printable.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {
namespace {

void put_hex(unsigned char c, std::string& out) {
  constexpr const char* kDigits = "0123456789abcdef";
  out += "\\x";
  out += kDigits[c >> 4U];
  out += kDigits[c & 0xFU];
}

std::string written_out(std::string_view text, std::string_view allowed) {
  std::string out;
  out.reserve(text.size());
  for (std::size_t k = 0; k < text.size(); ++k) {
    const auto c = static_cast<unsigned char>(text[k]);
    const auto next = k + 1 < text.size() ? static_cast<unsigned char>(text[k + 1]) : static_cast<unsigned char>(0);
    if (c == 0xC2 && next >= 0x80 && next < 0xA0) {  // U+0080 to U+009F
      put_hex(next, out);
      ++k;
    } else if ((c < 0x20 || c == 0x7F) && allowed.find(text[k]) == std::string_view::npos) {
      put_hex(c, out);
    } else {
      out += text[k];
    }
  }
  return out;
}

}  // namespace

std::string printable(std::string_view text) { return written_out(text, "\n\t"); }

std::string printable_line(std::string_view text) { return written_out(text, "\t"); }

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb

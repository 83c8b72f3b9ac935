#include "text_tools.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <system_error>

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {
namespace {

char lower(char c) noexcept { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

/// Cost of one character for another. A wrong digit is no slip of the finger: it names another sensor.
std::size_t replacement(char x, char y) noexcept {
  const auto digit = [](char c) { return c >= '0' && c <= '9'; };
  return x == y ? 0U : digit(x) && digit(y) ? 3U : 1U;
}

/// Optimal string alignment distance; names longer than kLongest are not compared.
std::size_t edits(std::string_view a, std::string_view b) {
  constexpr std::size_t kLongest = 64;
  if (a.size() > kLongest || b.size() > kLongest) return 2 * kLongest;
  std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) d[i][0] = i;
  for (std::size_t j = 0; j <= b.size(); ++j) d[0][j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const char x = lower(a[i - 1]);
      const char y = lower(b[j - 1]);
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, d[i - 1][j - 1] + replacement(x, y)});
      if (i > 1 && j > 1 && x == lower(b[j - 2]) && lower(a[i - 2]) == y)
        d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
    }
  }
  return d[a.size()][b.size()];
}

}  // namespace

std::string_view trimmed(std::string_view text) noexcept {
  const auto blank = [](char c) { return c == ' ' || c == '\t'; };
  while (!text.empty() && blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && blank(text.back())) text.remove_suffix(1);
  return text;
}

std::string joined(const std::vector<std::string>& names) {
  std::string out;
  for (const std::string& name : names) {
    if (!out.empty()) out += ", ";
    out += name;
  }
  return out;
}

std::string nearest_name(std::string_view given, const std::vector<std::string>& known) {
  std::string best;
  auto fewest = static_cast<std::size_t>(-1);
  for (const std::string& name : known) {
    const std::size_t distance = edits(given, name);
    const std::size_t bearable = std::max<std::size_t>(1, (std::max(given.size(), name.size()) + 2) / 3);
    if (distance < fewest && distance <= bearable && distance < name.size()) {
      fewest = distance;
      best = name;
    }
  }
  return best;
}

std::string did_you_mean(std::string_view given, const std::vector<std::string>& known) {
  const std::string near = nearest_name(given, known);
  return near.empty() ? std::string() : "did you mean \"" + near + "\"? ";
}

std::string brief(double value, int digits) {
  std::array<char, 64> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value + 0.0 /* no -0 */,
                                 std::chars_format::general, digits);
  return {text.data(), end.ptr};
}

std::string system_message(int error_number) { return std::generic_category().message(error_number); }

std::string last_part(const std::string& path) {
  const std::size_t slash = path.find_last_of('/');
  return slash == std::string::npos ? path : path.substr(slash + 1);
}

std::string in_quotes(std::string_view text) {
  constexpr std::size_t kShown = 60;
  std::string out = "\"";
  for (const char c : text.substr(0, kShown)) out += static_cast<unsigned char>(c) < 0x20 || c == 0x7f ? '?' : c;
  if (text.size() > kShown) out += "...";
  return out + "\"";
}

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb

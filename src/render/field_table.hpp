/// What is reported, one figure a row: text, JSON and page walk one table of these (private to src/render; the
/// page's walkers are in html_view.hpp).
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "plumb/io/json_fields.hpp"
#include "plumb/render/figures.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {

/// `Of` is what the figure is taken from. One that is not finite is null in the JSON and a dash elsewhere.
template <class... Of>
struct FieldOf {
  const char* key;  ///< in the JSON
  double (*value)(const Of&...);
  double of_json;             ///< what the figure is multiplied by there
  const char *above, *below;  ///< two lines over its column in the text; null above: not in the text
  double of_text;
  const char* format;
  int width;
  const char* page;  ///< title on the page; null: not there
  double of_page;    ///< what the figure of the JSON is multiplied by there
};

template <class Table, class... Of>
void put_fields(io::Json& out, const Table& table, const Of&... of) {
  for (const auto& field : table) out[field.key] = io::finite_or_null(field.value(of...) * field.of_json);
}

/// Instead of a size that is beyond the full scale of its sensor: no fault of it is so large.
inline constexpr const char* kBeyondFullScale = "none (beyond full scale)";
inline constexpr const char* kBeyondKey = "beyond_full_scale";  ///< of the list of such figures in the JSON

/// Of `table` the figures for which `is_beyond(k)` holds: null in the JSON, and named beside it.
template <class Table, class IsBeyond>
io::Json put_beyond(io::Json& figures, const Table& table, IsBeyond is_beyond) {
  io::Json out = io::Json::array();
  std::size_t k = 0;
  for (const auto& field : table) {
    if (!is_beyond(k++)) continue;
    figures[field.key] = nullptr;
    out.push_back(field.key);
  }
  return out;
}

/// The width of column k where some figure of it has other words; `has_words(k)` says so.
template <class Table, class HasWords>
std::vector<int> widths_with_words(const Table& table, HasWords has_words) {
  const int room = static_cast<int>(std::string_view(kBeyondFullScale).size());
  std::vector<int> out;
  for (const auto& field : table) out.push_back(has_words(out.size()) ? std::max(field.width, room) : field.width);
  return out;
}

/// The line of headings that `line` names; `instead` where a field has none. `widths`: empty = those of the table.
template <class Table, class Line>
std::string text_head(const Table& table, Line line, const std::string& instead = "",
                      const std::vector<int>& widths = {}) {
  std::string out;
  std::size_t k = 0;
  for (const auto& field : table) {
    const int width = widths.empty() ? field.width : widths[k];
    ++k;
    if (field.above == nullptr) continue;
    const char* const words = field.*line;
    out += fmt::format(" {:>{}}", words == nullptr ? instead : words, width);
  }
  return out + "\n";
}

/// `instead(k)` is what stands in place of figure k; null: the figure. `fine`: what a figure in mg0 is multiplied by
/// instead, the fine units of 1 inside of the field of the array.
template <class Table, class Instead, class... Of>
std::string text_row_or(const Table& table, const std::vector<int>& widths, Instead instead, double fine,
                        const Of&... of) {
  std::string out;
  std::size_t k = 0;
  for (const auto& field : table) {
    const char* const words = instead(k);
    const int width = widths.empty() ? field.width : widths[k];
    ++k;
    if (field.above == nullptr) continue;
    const double value = field.value(of...) * (field.of_text == kMg0 ? fine : field.of_text);
    const std::string figure =
        std::isfinite(value) ? unsigned_zero(fmt::format(fmt::runtime(field.format), value)) : "-";
    out += fmt::format(" {:>{}}", words != nullptr ? std::string(words) : figure, width);
  }
  return out + "\n";
}

template <class Table, class... Of>
std::string text_row(const Table& table, const Of&... of) {
  return text_row_or(
      table, std::vector<int>(), [](std::size_t) -> const char* { return nullptr; }, kMg0, of...);
}

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb

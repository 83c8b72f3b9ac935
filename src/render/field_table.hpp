/// What is reported, one figure a row: text, JSON and page walk one table of these (private to src/render; the
/// page's walkers are in html_view.hpp).
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <string>

#include "plumb/io/json_fields.hpp"

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

/// The line of headings that `line` names; `instead` where a field has none.
template <class Table, class Line>
std::string text_head(const Table& table, Line line, const std::string& instead = "") {
  std::string out;
  for (const auto& field : table) {
    if (field.above == nullptr) continue;
    const char* const words = field.*line;
    out += fmt::format(" {:>{}}", words == nullptr ? instead : words, field.width);
  }
  return out + "\n";
}

template <class Table, class... Of>
std::string text_row(const Table& table, const Of&... of) {
  std::string out;
  for (const auto& field : table) {
    if (field.above == nullptr) continue;
    const double value = field.value(of...);
    out += fmt::format(" {:>{}}",
                       std::isfinite(value) ? fmt::format(fmt::runtime(field.format), value * field.of_text) : "-",
                       field.width);
  }
  return out + "\n";
}

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb

#include "plumb/render/field_words.hpp"

#include <cctype>
#include <string_view>
#include <utility>

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {
namespace {

bool in_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

/// Whole words only: the id "mg07" stays.
void replace_word(std::string& text, std::string_view word, std::string_view by) {
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at)) {
    const std::size_t end = at + word.size();
    const bool whole = (at == 0 || !in_word(text[at - 1])) && (end == text.size() || !in_word(text[end]));
    if (whole) text.replace(at, word.size(), by);
    at += whole ? by.size() : word.size();
  }
}

}  // namespace

double in_fine(const io::ArrayFile& array, double inside) noexcept {
  return io::units_of(array.field).fine_per_inside * inside;
}

const char* fine_unit(const io::ArrayFile& array) noexcept { return io::units_of(array.field).fine; }

std::string in_field_words(std::string text, io::FieldKind field) {
  if (field == io::FieldKind::gravity) return text;
  const io::FieldUnits& units = io::units_of(field);
  for (const auto& [word, by] :
       {std::pair<std::string_view, std::string_view>{"stability 0.2 mg0", "stability 7.85 nT"},
        {"m/s^2 for mae", "units of 4 uT for mae"},
        {"acceleration of", "disturbance of"},
        {"acceleration 0", "disturbance 0"},
        {"mg0 = 0.001 x 9.80665 m/s^2", "nT = 0.001 uT"},
        {"[input]", "[[group]]"},
        {"[monitor]", "[group.monitor]"},
        {"hold the tool still at a known attitude, inclination",
         "hold the tool still where the direction of the field in the tool is known, its angle from z"},
        {"mg0", units.fine},
        {"m/s^2", units.coarse},
        {"[gravity]", "[group.reference]"},
        {"normal gravity", units.vector},
        {"gravity", units.vector},
        {"accelerometer", units.sensor}})
    replace_word(text, word, by);
  for (std::size_t at = text.find("|G|"); at != std::string::npos; at = text.find("|G|", at)) text[at + 1] = 'B';
  return text;
}

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb

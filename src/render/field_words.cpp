#include "plumb/render/field_words.hpp"

#include <array>
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

struct Suffix {
  std::string_view of_gravity, of_field;
  double factor;
};

bool ends_with(std::string_view text, std::string_view end) {
  return text.size() >= end.size() && text.substr(text.size() - end.size()) == end;
}

io::Json scaled_by(const io::Json& value, double factor) {  // NOLINT(misc-no-recursion) as deep as its lists
  if (value.is_number()) return factor * value.get<double>();
  if (!value.is_array()) return value;
  io::Json out = io::Json::array();
  for (const io::Json& one : value) out.push_back(scaled_by(one, factor));
  return out;
}

constexpr double kNt = 1e3 / io::kInside_per_ut;
/// The longer ones first.
constexpr std::array<Suffix, 6> kMagnetic = {{{"_per_mps2", "_per_nt", 1.0 / kNt},
                                              {"_mps2_per_h", "_nt_per_h", kNt},
                                              {"_mps2_2", "_nt_2", kNt* kNt},
                                              {"_mps2", "_nt", kNt},
                                              {"_mg0", "_nt", 1e-3 * kG0_mps2* kNt},
                                              {"_per_g0", "_per_ut", io::kInside_per_ut / kG0_mps2}}};

io::Json of_magnetic(const io::Json& value) {  // NOLINT(misc-no-recursion) as deep as the result
  if (value.is_array()) {
    io::Json out = io::Json::array();
    for (const io::Json& one : value) out.push_back(of_magnetic(one));
    return out;
  }
  if (!value.is_object()) return value;
  io::Json out = io::Json::object();
  for (const auto& [old, one] : value.items()) {
    std::string key = old;
    if (const std::size_t at = key.find("gravity"); at != std::string::npos) key.replace(at, 7, "field");
    double factor = 0.0;
    for (const Suffix& suffix : kMagnetic) {
      if (!ends_with(key, suffix.of_gravity)) continue;
      key.replace(key.size() - suffix.of_gravity.size(), std::string::npos, suffix.of_field);
      factor = suffix.factor;
      break;
    }
    out[key] = factor > 0.0 ? scaled_by(one, factor) : of_magnetic(one);
  }
  return out;
}

}  // namespace

double in_fine(const io::ArrayFile& array, double inside) noexcept {
  return io::units_of(array.field).fine_per_inside * inside;
}

const char* fine_unit(const io::ArrayFile& array) noexcept { return io::units_of(array.field).fine; }

std::string in_field_words(std::string text, io::FieldKind field) {
  if (field == io::FieldKind::gravity) return text;
  const io::FieldUnits& units = io::units_of(field);
  for (const auto& [word, by] : {std::pair<std::string_view, std::string_view>{"mg0", units.fine},
                                 {"m/s^2", units.coarse},
                                 {"[gravity]", "[group.reference]"},
                                 {"normal gravity", units.vector},
                                 {"gravity", units.vector},
                                 {"accelerometer", units.sensor}})
    replace_word(text, word, by);
  return text;
}

io::Json in_field_units(const io::Json& value, io::FieldKind field) {
  return field == io::FieldKind::magnetic ? of_magnetic(value) : value;
}

std::string in_field_units(const std::string& line, io::FieldKind field) {
  if (field != io::FieldKind::magnetic) return line;
  const bool newline = !line.empty() && line.back() == '\n';
  return of_magnetic(io::parsed(line)).dump() + (newline ? "\n" : "");
}

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb

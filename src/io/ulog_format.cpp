#include "plumb/io/ulog_format.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

#include "plumb/io/printable.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {
namespace {

struct NamedType {
  std::string_view name;
  UlogType type;
};
constexpr std::array<NamedType, 12> kUlogTypes = {{{"int8_t", UlogType::int8},
                                                   {"uint8_t", UlogType::uint8},
                                                   {"int16_t", UlogType::int16},
                                                   {"uint16_t", UlogType::uint16},
                                                   {"int32_t", UlogType::int32},
                                                   {"uint32_t", UlogType::uint32},
                                                   {"int64_t", UlogType::int64},
                                                   {"uint64_t", UlogType::uint64},
                                                   {"float", UlogType::float32},
                                                   {"double", UlogType::float64},
                                                   {"bool", UlogType::boolean},
                                                   {"char", UlogType::character}}};

/// 0 where it is no count of elements that a message could hold.
std::uint32_t element_count(std::string_view digits) noexcept {
  if (digits.empty() || digits.size() > 5) return 0;
  std::uint32_t out = 0;
  for (const char c : digits) {
    if (c < '0' || c > '9') return 0;
    out = 10 * out + static_cast<std::uint32_t>(c - '0');
  }
  return out <= UlogFormats::kLargest ? out : 0;
}

bool same_fields(const std::vector<UlogField>& a, const std::vector<UlogField>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const UlogField& x, const UlogField& y) {
    return x.name == y.name && x.type == y.type && x.nested == y.nested && x.count == y.count;
  });
}

/// "type name"; false where it is no field.
bool parse_field(std::string_view text, UlogField& out) {
  const std::size_t space = text.find(' ');
  if (space == std::string_view::npos || space + 1 >= text.size()) return false;
  const std::string_view name = text.substr(space + 1);
  if (name.size() > UlogFormats::kLongestName || name.find(' ') != std::string_view::npos) return false;
  out.name = name;
  return ulog_type(text.substr(0, space), out);
}

std::string quoted_name(std::string_view name) {
  return "\"" + printable_line(name.substr(0, UlogFormats::kLongestName)) + "\"";
}

bool is_padding(const UlogField& field) noexcept { return field.name.compare(0, 8, "_padding") == 0; }

}  // namespace

std::uint64_t ulog_unsigned(const unsigned char* bytes, std::size_t count) noexcept {
  std::uint64_t out = 0;
  for (std::size_t k = count; k > 0; --k) out = out << 8U | bytes[k - 1];
  return out;
}

std::uint32_t ulog_size(UlogType type) noexcept {
  switch (type) {
    case UlogType::int8:
    case UlogType::uint8:
    case UlogType::boolean:
    case UlogType::character: return 1;
    case UlogType::int16:
    case UlogType::uint16: return 2;
    case UlogType::int32:
    case UlogType::uint32:
    case UlogType::float32: return 4;
    case UlogType::int64:
    case UlogType::uint64:
    case UlogType::float64: return 8;
    case UlogType::none:
    case UlogType::nested: break;
  }
  return 0;
}

bool ulog_is_whole(UlogType type) noexcept {
  return ulog_size(type) != 0 && type != UlogType::float32 && type != UlogType::float64;
}

std::uint64_t ulog_whole(const unsigned char* payload, const UlogCell& cell) noexcept {
  if (!ulog_is_whole(cell.type)) return 0;
  const std::uint32_t size = ulog_size(cell.type);
  std::uint64_t out = ulog_unsigned(payload + cell.offset, size);
  const bool has_sign = cell.type == UlogType::int8 || cell.type == UlogType::int16 || cell.type == UlogType::int32;
  if (has_sign && (out >> (8U * size - 1U)) != 0) out |= ~std::uint64_t{0} << (8U * size);
  return out;
}

double ulog_number(const unsigned char* payload, const UlogCell& cell) noexcept {
  if (cell.type == UlogType::float32) {
    const auto bits = static_cast<std::uint32_t>(ulog_unsigned(payload + cell.offset, 4));
    float out = 0.0F;
    std::memcpy(&out, &bits, sizeof out);
    return static_cast<double>(out);
  }
  const std::uint64_t whole = ulog_whole(payload, cell);
  if (cell.type == UlogType::float64) {
    const std::uint64_t bits = ulog_unsigned(payload + cell.offset, 8);
    double out = 0.0;
    std::memcpy(&out, &bits, sizeof out);
    return out;
  }
  const bool has_sign = cell.type == UlogType::int8 || cell.type == UlogType::int16 || cell.type == UlogType::int32 ||
                        cell.type == UlogType::int64;
  if (has_sign && (whole >> 63U) != 0) return -static_cast<double>(~whole + 1U);
  return static_cast<double>(whole);
}

bool ulog_type(std::string_view text, UlogField& out) {
  const std::size_t bracket = text.find('[');
  out.count = 1;
  if (bracket != std::string_view::npos) {
    if (text.back() != ']') return false;
    out.count = element_count(text.substr(bracket + 1, text.size() - bracket - 2));
  }
  const std::string_view name = text.substr(0, bracket);
  if (name.empty() || name.size() > UlogFormats::kLongestName || out.count == 0) return false;
  const auto* const found =
      std::find_if(kUlogTypes.begin(), kUlogTypes.end(), [&](const NamedType& type) { return type.name == name; });
  out.type = found == kUlogTypes.end() ? UlogType::nested : found->type;
  out.nested = out.type == UlogType::nested ? std::string(name) : std::string();
  return true;
}

bool ulog_key(std::string_view payload, UlogKey& out) {
  if (payload.empty()) return false;
  const std::size_t length = static_cast<unsigned char>(payload[0]);
  if (length + 1 > payload.size()) return false;
  const std::string_view key = payload.substr(1, length);
  const std::size_t space = std::min(key.find(' '), key.size());
  if (space + 1 >= key.size() || !ulog_type(key.substr(0, space), out.field)) return false;
  out.field.name = key.substr(space + 1);
  out.value = payload.substr(1 + length);
  return true;
}

std::string ulog_message(char type, std::string_view payload) {
  std::string out;
  out += static_cast<char>(payload.size() & 0xFFU);
  out += static_cast<char>(payload.size() >> 8U & 0xFFU);
  out += type;
  return out.append(payload);
}

std::string ulog_key_message(char type, std::string_view typed_name, std::string_view value) {
  std::string payload(1, static_cast<char>(typed_name.size()));
  return ulog_message(type, payload.append(typed_name).append(value));
}

UlogCell UlogLayout::cell(std::string_view name, std::uint32_t index) const {
  for (const Placed& placed : placed_) {
    if (placed.field->name != name) continue;
    const std::uint32_t one = ulog_size(placed.field->type);
    if (one == 0 || index >= placed.field->count) return {};
    return {placed.field->type, placed.offset + index * one};
  }
  return {};
}

UlogCells UlogLayout::three(std::string_view name, std::uint32_t first) const {
  const UlogCells out = {cell(name, first), cell(name, first + 1), cell(name, first + 2)};
  return out[2] ? out : UlogCells{};
}

std::string UlogFormats::define(std::string_view text) {
  const std::size_t colon = text.find(':');
  if (colon == std::string_view::npos || colon == 0) return "a format without a name is left out";
  if (colon > kLongestName) return "a format with a name of more than 255 characters is left out";
  const std::string name(text.substr(0, colon));
  Fields fields;
  std::string_view rest = text.substr(colon + 1);
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find(';'), rest.size());
    const std::string_view one = rest.substr(0, end);
    rest.remove_prefix(std::min(end + 1, rest.size()));
    if (one.empty()) continue;
    if (fields.size() == kMostFieldsOfOne)
      return "the format " + quoted_name(name) + " has more than 1024 fields, left out";
    UlogField field;
    if (!parse_field(one, field))
      return "the format " + quoted_name(name) + " has no field in " + quoted_name(one) + ", left out";
    fields.push_back(std::move(field));
  }
  if (fields.empty()) return "the format " + quoted_name(name) + " has no fields, left out";
  const auto known = formats_.find(name);
  if (known != formats_.end()) {
    if (same_fields(known->second, fields)) return {};
    return "the format " + quoted_name(name) + " comes a second time with other fields, the first one stays";
  }
  if (formats_.size() == kMostFormats) return "more than 2048 formats, " + quoted_name(name) + " is left out";
  if (fields_ + fields.size() > kMostFields)
    return "more than 32768 fields in all formats together, " + quoted_name(name) + " is left out";
  fields_ += fields.size();
  formats_.emplace(name, std::move(fields));
  return {};
}

const std::vector<UlogField>* UlogFormats::fields(const std::string& name) const {
  const auto found = formats_.find(name);
  return found == formats_.end() ? nullptr : &found->second;
}

tl::expected<std::uint32_t, std::string> UlogFormats::field_size(  // NOLINT(misc-no-recursion) kDeepest levels
    const UlogField& field, int depth, Sizes& known) const {
  std::uint32_t one = ulog_size(field.type);
  if (field.type == UlogType::nested) {
    const auto nested = nested_size(field.nested, depth + 1, known);
    if (!nested) return nested;
    one = *nested;
  }
  return one * field.count;  // both below 2^16
}

// Down to other formats and theirs; bounded by kDeepest, and each format is gone through once.
tl::expected<std::uint32_t, std::string> UlogFormats::nested_size(  // NOLINT(misc-no-recursion) kDeepest levels
    const std::string& name, int depth, Sizes& known) const {
  const auto format = formats_.find(name);
  if (format == formats_.end()) return tl::make_unexpected("the log has no format " + quoted_name(name));
  if (depth > kDeepest) return tl::make_unexpected(std::string("its formats are nested more than 16 deep"));
  constexpr std::uint32_t kOpen = 0;
  const auto entry = known.emplace(name, kOpen);
  if (!entry.second) {
    if (entry.first->second == kOpen)
      return tl::make_unexpected("the format " + quoted_name(name) + " contains itself");
    return entry.first->second;
  }
  std::uint32_t size = 0;
  for (const UlogField& field : format->second) {
    const auto bytes = field_size(field, depth, known);
    if (!bytes) return bytes;
    if (*bytes > kLargest - size)
      return tl::make_unexpected("the format " + quoted_name(name) + " is larger than a message can be");
    size += *bytes;
  }
  entry.first->second = size;
  return size;
}

tl::expected<UlogLayout, std::string> UlogFormats::layout(const std::string& name) const {
  Sizes known;
  const auto whole = nested_size(name, 0, known);
  if (!whole) return tl::make_unexpected(whole.error());
  UlogLayout out;
  for (const UlogField& field : formats_.find(name)->second) {
    const auto bytes = field_size(field, 0, known);
    if (!bytes) return tl::make_unexpected(bytes.error());
    out.place(field, out.size);
    out.size += *bytes;
    if (!is_padding(field)) out.unpadded = out.size;
  }
  return out;
}

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb

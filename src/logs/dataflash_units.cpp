// Numbers and text of a DataFlash message, and the units they are in.
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <string_view>

#include "dataflash_format.hpp"
#include "plumb/core/units.hpp"
#include "plumb/io/printable.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace logs {
namespace {

template <class T>
T load(const unsigned char* bytes) noexcept {
  T value = 0;
  for (std::size_t k = 0; k < sizeof(T); ++k) value = static_cast<T>(value | static_cast<T>(bytes[k]) << (8 * k));
  return value;
}

std::uint16_t u16(const unsigned char* bytes) noexcept {
  return static_cast<std::uint16_t>(bytes[0] | static_cast<unsigned>(bytes[1]) << 8U);
}

template <class T, class U>
T same_bits(U bits) noexcept {
  static_assert(sizeof(T) == sizeof(U));
  T value{};
  std::memcpy(&value, &bits, sizeof(T));
  return value;
}

double half_float(std::uint16_t bits) noexcept {
  const int exponent = static_cast<int>(bits >> 10U & 31U);
  const double fraction = bits & 1023U;
  double size = 0.0;
  if (exponent == 31) {
    size = fraction > 0.0 ? kAbsent : std::numeric_limits<double>::infinity();
  } else {
    size = exponent == 0 ? std::ldexp(fraction, -24) : std::ldexp(fraction + 1024.0, exponent - 25);
  }
  return (bits & 0x8000U) != 0 ? -size : size;
}

double raw_at(const unsigned char* at, char letter) noexcept {
  switch (letter) {
    case 'f': return static_cast<double>(same_bits<float>(load<std::uint32_t>(at)));
    case 'Q': return static_cast<double>(load<std::uint64_t>(at));
    case 'B':
    case 'M': return static_cast<double>(*at);
    case 'H':
    case 'C': return static_cast<double>(u16(at));
    case 'I':
    case 'E': return static_cast<double>(load<std::uint32_t>(at));
    case 'b': return static_cast<double>(same_bits<std::int8_t>(*at));
    case 'h':
    case 'c': return static_cast<double>(same_bits<std::int16_t>(u16(at)));
    case 'i':
    case 'e':
    case 'L': return static_cast<double>(same_bits<std::int32_t>(load<std::uint32_t>(at)));
    case 'q': return static_cast<double>(same_bits<std::int64_t>(load<std::uint64_t>(at)));
    case 'd': return same_bits<double>(load<std::uint64_t>(at));
    case 'g': return half_float(u16(at));
    default: return kAbsent;
  }
}

/// Of a column with no FMTU.
double usual_factor(std::string_view label, char letter, bool is_time) noexcept {
  if (is_time) return label == "TimeMS" ? 1e-3 : 1e-6;
  switch (letter) {
    case 'c':
    case 'C':
    case 'e':
    case 'E': return 0.01;
    case 'L': return 1e-7;
    default: return 1.0;
  }
}

std::string_view text_of(const unsigned char* bytes, std::size_t size) noexcept {
  const char* text = reinterpret_cast<const char*>(bytes);  // NOLINT(*-reinterpret-cast): bytes of a file as text
  const void* end = std::memchr(text, 0, size);
  return {text, end == nullptr ? size : static_cast<std::size_t>(static_cast<const char*>(end) - text)};
}

}  // namespace

double number_at(const unsigned char* message, const Field& field) noexcept {
  return field.present() ? raw_at(message + field.offset, field.letter) * field.factor : kAbsent;
}

std::string_view text_at(const unsigned char* message, const Field& field) noexcept {
  switch (field.letter) {
    case 'n': return text_of(message + field.offset, 4);
    case 'N': return text_of(message + field.offset, 16);
    case 'Z': return text_of(message + field.offset, 64);
    default: return {};
  }
}

/// A multiplier of FMTU holds for the number as it stands in the log: it replaces the hundredth that the letters c, C,
/// e and E imply. What FMTU leaves open is taken as the label has it. NaN where FMTU names what is not known here: a
/// reading of an unknown unit is no reading.
double DataflashFormats::factor(std::uint8_t type, Layout& layout, std::size_t index, std::string_view label,
                                Quantity quantity, std::uint64_t offset) {
  struct Unit {
    Quantity quantity;
    std::string_view label;
    double factor;
  };
  static constexpr std::array<Unit, 11> kUnits = {{{Quantity::time, "s", 1.0},
                                                   {Quantity::time, "ms", 1e-3},
                                                   {Quantity::time, "us", 1e-6},
                                                   {Quantity::force, "m/s/s", 1.0},
                                                   {Quantity::force, "m/s^2", 1.0},
                                                   {Quantity::force, "cm/s/s", 1e-2},
                                                   {Quantity::force, "mm/s/s", 1e-3},
                                                   {Quantity::rate, "rad/s", 1.0},
                                                   {Quantity::rate, "deg/s", rad_from_deg(1.0)},
                                                   {Quantity::rate, "mrad/s", 1e-3},
                                                   {Quantity::temperature, "degC", 1.0}}};
  const double usual = usual_factor(label, layout.letters[index], quantity == Quantity::time);
  const auto unit_id = static_cast<unsigned char>(unit_chars_[type].units[index]);
  const auto multiplier_id = static_cast<unsigned char>(unit_chars_[type].multipliers[index]);
  if (quantity == Quantity::none || unit_id == 0) return usual;
  const UnitLabel& chars = unit_labels_[unit_id];
  const std::string_view unit_label(chars.data(), ::strnlen(chars.data(), chars.size()));
  const Unit* unit = nullptr;
  for (const Unit& candidate : kUnits) {
    if (candidate.quantity == quantity && candidate.label == unit_label) unit = &candidate;
  }
  const double multiplier = multiplier_id == 0 ? 0.0 : multipliers_[multiplier_id];
  const bool is_open = unit_id == '-' || unit_id == '?';
  const bool known = (unit != nullptr || is_open) && !(multiplier < 0.0);
  const double unit_factor = unit != nullptr ? unit->factor : 1.0;
  double out = usual;
  if (!known) {
    out = kAbsent;
  } else if (multiplier > 0.0) {
    out = multiplier * unit_factor;
  } else if (quantity != Quantity::time) {
    out = usual * unit_factor;
  }
  if (std::abs(out / usual - 1.0) < 1e-9) out = usual;  // 1e-6 and not what a product makes of it
  if ((known && !(std::abs(out - usual) > 0.0)) || layout.units_told || !notes_.wanted(DataflashTrouble::unit, offset))
    return out;
  const std::string column = layout.name_text() + "." + std::string(label);
  const std::string stated = "has the unit '" + io::printable_line(unit_label) + "' and the multiplier '" +
                             io::printable_line({&unit_chars_[type].multipliers[index], multiplier_id == 0 ? 0U : 1U}) +
                             "'";
  notes_.say(offset,
             column + " " + stated + (known ? ": converted" : ", one of them unknown here: its readings are left out"));
  return out;
}

}  // namespace logs
}  // namespace PLUMB_ABI
}  // namespace plumb

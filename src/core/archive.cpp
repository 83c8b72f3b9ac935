#include "plumb/core/detail/archive.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

static_assert(sizeof(SensorSet) == sizeof(std::uint32_t) && std::is_standard_layout_v<SensorSet>,
              "a set is stored as its bits");

namespace {

/// An object of that many bytes as a number, whatever the byte order of the machine; and back.
template <class Unsigned>
std::uint64_t load_as(const void* from) noexcept {
  Unsigned bits = 0;
  std::memcpy(&bits, from, sizeof bits);
  return bits;
}
template <class Unsigned>
void store_as(void* to, std::uint64_t bits) noexcept {
  const auto narrow = static_cast<Unsigned>(bits);
  std::memcpy(to, &narrow, sizeof narrow);
}

std::uint64_t load(const void* from, std::size_t width) noexcept {
  switch (width) {
    case 1: return load_as<std::uint8_t>(from);
    case 2: return load_as<std::uint16_t>(from);
    case 4: return load_as<std::uint32_t>(from);
    default: return load_as<std::uint64_t>(from);
  }
}

void store(void* to, std::uint64_t bits, std::size_t width) noexcept {
  switch (width) {
    case 1: return store_as<std::uint8_t>(to, bits);
    case 2: return store_as<std::uint16_t>(to, bits);
    case 4: return store_as<std::uint32_t>(to, bits);
    default: return store_as<std::uint64_t>(to, bits);
  }
}

/// A shift by more digits than there are has no meaning; no width asks for one, and none can.
std::int64_t sign_extended(std::uint64_t bits, std::size_t width) noexcept {
  const std::uint64_t sign = std::uint64_t{1} << ((8 * width - 1) % 64);
  return static_cast<std::int64_t>((bits ^ sign) - sign);
}

/// The exponent is not that of an infinity or of no number.
bool finite_bits(std::uint64_t bits, std::size_t width) noexcept {
  constexpr std::uint64_t kDouble = 0x7FF0'0000'0000'0000ULL, kFloat = 0x7F80'0000ULL;
  const std::uint64_t exponent = width == sizeof(double) ? kDouble : kFloat;
  return (bits & exponent) != exponent;
}

}  // namespace

void Archive::put_bits(std::uint64_t bits, std::size_t width) noexcept {
  for (std::size_t k = 0; k < width; ++k) {
    const auto byte = static_cast<std::uint8_t>(bits >> (8 * k) & 0xFFU);
    if (to_ != nullptr && used_ < room_) to_[used_] = byte;
    ++used_;
    crc_.add(byte);
  }
}

std::uint64_t Archive::get_bits(std::size_t width) noexcept {
  if (width > left_) sound_ = false;
  if (!sound_) return 0;
  std::uint64_t bits = 0;
  for (std::size_t k = 0; k < width; ++k) bits |= std::uint64_t{from_[k]} << (8 * k);
  from_ += width;
  left_ -= width;
  return bits;
}

bool Archive::accepts(std::uint64_t bits, ScalarForm form, const Within* range) const noexcept {
  switch (form.kind) {
    case ScalarForm::Kind::real: return finite_bits(bits, form.width);
    case ScalarForm::Kind::set: return SensorSet::first(sensors_).contains(SensorSet(static_cast<std::uint32_t>(bits)));
    case ScalarForm::Kind::flag: return bits <= 1;
    case ScalarForm::Kind::ranged: {
      const std::int64_t number = sign_extended(bits, form.width);
      return number >= range->low && number <= range->high;
    }
    case ScalarForm::Kind::number:
    case ScalarForm::Kind::any_real: break;
  }
  return true;
}

void Archive::one(void* value, ScalarForm form, const Within* range) noexcept {
  if (!reads_) return put_bits(load(value, form.width), form.width);
  const std::uint64_t bits = get_bits(form.width);
  sound_ = sound_ && accepts(bits, form, range);
  if (sound_) store(value, bits, form.width);
}

}  // namespace PLUMB_ABI
}  // namespace plumb

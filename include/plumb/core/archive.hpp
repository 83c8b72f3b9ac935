/// Writes and reads what the `fields()` of a class name: little-endian, IEEE 754, one value after the other without
/// gaps, so that neither byte order nor padding nor layout of the machine shows.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <type_traits>

#include "plumb/core/crc64.hpp"
#include "plumb/core/fields.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

static_assert(std::numeric_limits<double>::is_iec559 && sizeof(double) == 8 && std::numeric_limits<float>::is_iec559 &&
                  sizeof(float) == 4,
              "snapshots hold IEEE 754 numbers");

namespace archive_detail {

template <class T>
std::uint64_t bits_of(T value) noexcept {
  if constexpr (std::is_same_v<T, double>) {
    std::uint64_t bits = 0;
    std::memcpy(&bits, &value, sizeof bits);
    return bits;
  } else if constexpr (std::is_same_v<T, float>) {
    std::uint32_t bits = 0;
    std::memcpy(&bits, &value, sizeof bits);
    return bits;
  } else if constexpr (std::is_same_v<T, SensorSet>) {
    return value.bits;
  } else if constexpr (std::is_enum_v<T>) {
    return static_cast<std::uint64_t>(static_cast<std::underlying_type_t<T>>(value));
  } else {
    return static_cast<std::uint64_t>(value);
  }
}

}  // namespace archive_detail

/// Writes into `room` bytes at `to`, and goes on counting where they are not enough; `to` may be null, to count alone.
class ArchiveWriter {
 public:
  ArchiveWriter(std::uint8_t* to, std::size_t room, int sensors) noexcept : to_(to), room_(room), sensors_(sensors) {}

  template <class T>
  void put(const T& value) noexcept {
    transfer(*this, value, AnyBits{});
  }
  /// The low `width` bytes.
  void put_bits(std::uint64_t bits, std::size_t width) noexcept {
    for (std::size_t k = 0; k < width; ++k) {
      const auto byte = static_cast<std::uint8_t>(bits >> (8 * k) & 0xFFU);
      if (to_ != nullptr && used_ < room_) to_[used_] = byte;
      ++used_;
      crc_.add(byte);
    }
  }
  std::size_t used() const noexcept { return used_; }
  std::uint64_t crc() const noexcept { return crc_.value(); }  ///< of all that was put

  int sensors() const noexcept { return sensors_; }
  void fail() noexcept {}
  template <class T>
  void done(const T&) noexcept {}
  template <class T, class Check>
  void scalar(const T& value, const Check&) noexcept {
    put_bits(archive_detail::bits_of(value), sizeof(T));
  }

 private:
  std::uint8_t* to_;
  std::size_t room_;
  std::size_t used_ = 0;
  Crc64 crc_;
  int sensors_;
};

/// Reads back. What breaks its rule is not stored, and nothing behind it is.
class ArchiveReader {
 public:
  ArchiveReader(const std::uint8_t* from, std::size_t size, int sensors) noexcept
      : from_(from), left_(size), sensors_(sensors) {}

  template <class T>
  void get(T& value) noexcept {
    transfer(*this, value, ByType{});
  }
  std::uint64_t get_bits(std::size_t width) noexcept {
    if (width > left_) sound_ = false;
    if (!sound_) return 0;
    std::uint64_t bits = 0;
    for (std::size_t k = 0; k < width; ++k) bits |= std::uint64_t{from_[k]} << (8 * k);
    from_ += width;
    left_ -= width;
    return bits;
  }
  bool sound() const noexcept { return sound_; }
  std::size_t left() const noexcept { return left_; }

  int sensors() const noexcept { return sensors_; }
  void fail() noexcept { sound_ = false; }
  template <class T>
  void done(T& object) noexcept {
    if (!sound_) return;
    FieldsOf::rebuild(object, 0);
    if (!FieldsOf::plausible(object, 0)) sound_ = false;
  }
  template <class T, class Check>
  void scalar(T& value, const Check& check) noexcept {
    const std::uint64_t bits = get_bits(sizeof(T));
    T read{};
    if (sound_ && accepted(bits, check, read)) value = read;
  }

 private:
  template <class T, class Check>
  bool accepted(std::uint64_t bits, const Check& check, T& out) noexcept {
    if constexpr (std::is_same_v<T, double>) {
      std::memcpy(&out, &bits, sizeof out);
      sound_ = std::is_same_v<Check, AnyBits> || std::isfinite(out);
    } else if constexpr (std::is_same_v<T, float>) {
      const auto narrow = static_cast<std::uint32_t>(bits);
      std::memcpy(&out, &narrow, sizeof out);
      sound_ = std::is_same_v<Check, AnyBits> || std::isfinite(out);
    } else if constexpr (std::is_same_v<T, SensorSet>) {
      out = SensorSet(static_cast<std::uint32_t>(bits));
      sound_ = SensorSet::first(sensors_).contains(out);
    } else if constexpr (std::is_same_v<T, bool>) {
      sound_ = bits <= 1;
      out = bits == 1;
    } else if constexpr (std::is_same_v<Check, Within>) {
      const std::int64_t number = sign_extended<T>(bits);
      sound_ = number >= check.low && number <= check.high;
      if (sound_) out = static_cast<T>(number);
    } else {
      out = static_cast<T>(bits);
    }
    return sound_;
  }
  template <class T>
  static std::int64_t sign_extended(std::uint64_t bits) noexcept {
    constexpr unsigned kUnused = 64U - 8U * sizeof(T);
    const auto number = static_cast<std::int64_t>(bits << kUnused);
    return number / (std::int64_t{1} << kUnused);
  }

  const std::uint8_t* from_;
  std::size_t left_;
  int sensors_;
  bool sound_ = true;
};

}  // namespace PLUMB_ABI
}  // namespace plumb

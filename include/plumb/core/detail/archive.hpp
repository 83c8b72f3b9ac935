/// Writes and reads what the `fields()` of a class name: little-endian, IEEE 754, one value after the other without
/// gaps, so that neither byte order nor padding nor layout of the machine shows.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <type_traits>

#include "plumb/core/detail/crc64.hpp"
#include "plumb/core/detail/fields.hpp"

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

/// How a scalar is written down, and what it must be to be read back.
struct ScalarForm {
  enum class Kind : std::uint8_t { number, ranged, flag, set, real, any_real };
  Kind kind = Kind::number;
  std::uint8_t width = 0;  ///< bytes
};

/// What both directions share: they lead over the same fields, so that the code that does is there once, and all
/// scalars of one form go through one function.
class Archive {
 public:
  int sensors() const noexcept { return sensors_; }
  void fail() noexcept { sound_ = false; }
  template <class T>
  void done(T& object) noexcept {
    if (!reads_ || !sound_) return;
    FieldsOf::rebuild(object, 0);
    if (!FieldsOf::plausible(object, 0)) sound_ = false;
  }
  template <class T, class Check>
  void scalar(T& value, const Check& check) noexcept {
    constexpr ScalarForm kForm = form_of<T, Check>();
    if constexpr (std::is_same_v<Check, Within>) {
      one(&value, kForm, &check);
    } else {
      static_cast<void>(check);
      one(&value, kForm, nullptr);
    }
  }

 protected:
  Archive(bool reads, int sensors) noexcept : reads_(reads), sensors_(sensors) {}
  std::uint64_t get_bits(std::size_t width) noexcept;
  void put_bits(std::uint64_t bits, std::size_t width) noexcept;

  bool reads_;
  bool sound_ = true;
  int sensors_;
  const std::uint8_t* from_ = nullptr;
  std::size_t left_ = 0;
  std::uint8_t* to_ = nullptr;
  std::size_t room_ = 0;
  std::size_t used_ = 0;
  Crc64 crc_;

 private:
  template <class T, class Check>
  static constexpr ScalarForm form_of() noexcept {
    using Form = ScalarForm::Kind;
    constexpr auto kWidth = static_cast<std::uint8_t>(sizeof(T));
    if constexpr (std::is_floating_point_v<T>) {
      return {std::is_same_v<Check, AnyBits> ? Form::any_real : Form::real, kWidth};
    } else if constexpr (std::is_same_v<T, SensorSet>) {
      return {Form::set, kWidth};
    } else if constexpr (std::is_same_v<T, bool>) {
      return {Form::flag, kWidth};
    } else {
      static_assert(std::is_integral_v<T> || std::is_enum_v<T>);
      return {std::is_same_v<Check, Within> ? Form::ranged : Form::number, kWidth};
    }
  }
  /// Reads or writes the scalar of that form at `value`; a writer leaves it alone.
  void one(void* value, ScalarForm form, const Within* range) noexcept;
  bool accepts(std::uint64_t bits, ScalarForm form, const Within* range) const noexcept;
};

/// Writes into `room` bytes at `to`, and goes on counting where they are not enough; `to` may be null, to count alone.
class ArchiveWriter : private Archive {
 public:
  ArchiveWriter(std::uint8_t* to, std::size_t room, int sensors) noexcept : Archive(false, sensors) {
    to_ = to;
    room_ = room;
  }

  template <class T>
  void put(const T& value) noexcept {
    transfer<Archive>(*this, const_cast<T&>(value), AnyBits{});  // NOLINT(*-const-cast): a writer leaves it alone
  }
  using Archive::put_bits;  ///< the low `width` bytes
  std::size_t used() const noexcept { return used_; }
  std::uint64_t crc() const noexcept { return crc_.value(); }  ///< of all that was put
};

/// Reads back. What breaks its rule is not stored, and nothing behind it is.
class ArchiveReader : private Archive {
 public:
  ArchiveReader(const std::uint8_t* from, std::size_t size, int sensors) noexcept : Archive(true, sensors) {
    from_ = from;
    left_ = size;
  }

  template <class T>
  void get(T& value) noexcept {
    transfer<Archive>(*this, value, ByType{});
  }
  using Archive::get_bits;
  bool sound() const noexcept { return sound_; }
  std::size_t left() const noexcept { return left_; }
};

}  // namespace PLUMB_ABI
}  // namespace plumb

/// A bool that storage damaged by itself cannot make undefined: any byte but 0 reads as true. For flags that a step
/// reads before it has found its storage as it was left.
#pragma once

#include <cstdint>

#include "plumb/core/detail/fields.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

class Flag {
 public:
  constexpr Flag(bool on = false) noexcept : byte_(on ? 1U : 0U) {}  // NOLINT(hicpp-explicit-conversions)
  constexpr operator bool() const noexcept { return byte_ != 0; }    // NOLINT(hicpp-explicit-conversions)

 private:
  std::uint8_t byte_;

  friend struct FieldsOf;
  static constexpr auto fields() noexcept { return field_list(within(&Flag::byte_, 0, 1)); }
};

}  // namespace PLUMB_ABI
}  // namespace plumb

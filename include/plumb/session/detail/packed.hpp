/// Verdicts and setups as bytes, the same whatever the capacity: what one build packs another one unpacks. Within one
/// process, so that nothing is checked and numbers are as the machine has them (private to this module).
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>
#include <vector>

#include "plumb/health/health_monitor.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace stepping_detail {

/// Unlike a snapshot all members of a class, and of an array how long it is: that may be the capacity.
class Packer {
 public:
  explicit Packer(std::uint8_t* to) noexcept : at_(to) {}

  template <class T>
  void operator()(const T& value) noexcept {
    if constexpr (kHasFields<T>) {
      constexpr field_detail::ListOf<T>* kList = nullptr;
      members(value, kList);
    } else if constexpr (kIsArray<T>) {
      raw(static_cast<std::uint32_t>(value.size()));
      for (const auto& element : value) (*this)(element);
    } else {
      raw(value);
    }
  }
  const std::uint8_t* end() const noexcept { return at_; }

 private:
  template <class T, std::size_t... I, class... F>
  void members(const T& value, const FieldList<std::index_sequence<I...>, F...>*) noexcept {
    ((*this)(value.*(field_detail::Listed<T, I>::kField.member)), ...);
  }
  template <class T>
  void raw(const T& value) noexcept {
    static_assert(std::is_trivially_copyable_v<T>);
    std::memcpy(at_, &value, sizeof value);
    at_ += sizeof value;
  }
  std::uint8_t* at_;
};

class Unpacker {
 public:
  explicit Unpacker(const std::uint8_t* from) noexcept : at_(from) {}

  template <class T>
  void operator()(T& value) noexcept {
    if constexpr (kHasFields<T>) {
      constexpr field_detail::ListOf<T>* kList = nullptr;
      members(value, kList);
    } else if constexpr (kIsArray<T>) {
      std::uint32_t given = 0;
      raw(given);
      const std::size_t common = std::min<std::size_t>(given, value.size());
      for (std::size_t k = 0; k < common; ++k) (*this)(value[k]);
      std::fill(value.begin() + static_cast<std::ptrdiff_t>(common), value.end(), typename T::value_type{});
      typename T::value_type beyond{};
      for (std::size_t k = common; k < given; ++k) (*this)(beyond);
    } else {
      raw(value);
    }
  }
  const std::uint8_t* end() const noexcept { return at_; }

 private:
  template <class T, std::size_t... I, class... F>
  void members(T& value, const FieldList<std::index_sequence<I...>, F...>*) noexcept {
    ((*this)(value.*(field_detail::Listed<T, I>::kField.member)), ...);
  }
  template <class T>
  void raw(T& value) noexcept {
    static_assert(std::is_trivially_copyable_v<T>);
    std::memcpy(&value, at_, sizeof value);
    at_ += sizeof value;
  }
  const std::uint8_t* at_;
};

/// Bytes that a packed value takes at most: its own, and a length for every array in it.
template <class T>
inline constexpr std::size_t kPackedRoom = 2 * sizeof(T);

inline void pack(const Verdict& verdict, std::vector<std::uint8_t>& bytes) {
  const std::size_t begin = bytes.size();
  bytes.resize(begin + kPackedRoom<Verdict>);
  Packer packer(bytes.data() + begin);
  packer(verdict);
  bytes.resize(static_cast<std::size_t>(packer.end() - bytes.data()));
}

/// Leads either of them over all that a monitor is built from. The misalignment is omitted: a monitor takes a model
/// without any. `rows` and `uncertainty` are those of the array.
template <class Pipe, class Setup, class Rows, class Uncertainty>
void lead(Pipe& pipe, Setup& setup, Rows& rows, Uncertainty& uncertainty) noexcept {
  pipe(setup.model.size);
  pipe(setup.model.reads);
  const int n = setup.model.size;
  for (std::size_t i = 0; i < static_cast<std::size_t>(n); ++i) {
    pipe(setup.model.sensor[i]);
    pipe(rows[i]);
    pipe(uncertainty.misfit_mps2[i]);
    pipe(setup.full_scale_raw[i]);
    pipe(setup.resolution_raw[i]);
    pipe(setup.lever_arm_m[i]);
    pipe(setup.stability[i]);
  }
  for (std::size_t k = 0; k < static_cast<std::size_t>(RowUncertainty::packed_size(n)); ++k)
    pipe(uncertainty.covariance[k]);
  pipe(uncertainty.common_scale);
  pipe(setup.gravity);
  pipe(setup.config);
  pipe(setup.output_frame);
  pipe(setup.lever_arms_known);
  pipe(setup.calibrated);
  pipe(setup.days_since_calibration);
}

}  // namespace stepping_detail
}  // namespace PLUMB_ABI
}  // namespace plumb

/// One list of the members of a class, from which its state is written, read back, checked and measured.
///
/// A class that is part of a snapshot has `static constexpr auto fields() noexcept { return field_list(...); }`,
/// private with `friend struct FieldsOf` where its members are, and names in it EVERY member in the order of
/// declaration:
///
///   &C::member                     all of it; doubles must be finite, sets hold sensors of the array only
///   any(&C::member)                the same, but any bits will do
///   within(&C::member, low, high)  a signed integer, which must have a range; up_to(&C::member, last) an enumeration
///   per_sensor(field), leading(field, f), counted(field, &C::f)
///                                  of an array only the elements that are in use: one per sensor of the array,
///                                  f(number of sensors), or this->f()
///   only_when(field, &C::f)        only where this->f()
///   not_stored(&C::member)         configured, derived from the others, or without meaning between two steps
///
/// Two more members are used where they exist: `void rebuild() noexcept` derives what was not stored, `bool plausible()
/// const noexcept` answers whether what was read can be a state at all.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <tuple>
#include <type_traits>

#include "plumb/core/sensor_set.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

struct ByType {};
struct AnyBits {};
struct Within {
  std::int64_t low, high;
};

struct Whole {};
struct NotStored {};
struct Leading {
  int (*count)(int sensors) noexcept;
};
template <class C>
struct Counted {
  int (C::*count)() const noexcept;
};
template <class C>
struct OnlyWhen {
  bool (C::*holds)() const noexcept;
};

template <class C, class M, class Check, class Extent>
struct Field {
  using Class = C;
  using Member = M;
  M C::*member;
  Check check;
  Extent extent;
};

namespace field_detail {

template <class C, class M>
constexpr auto as_field(M C::*member) noexcept {
  return Field<C, M, ByType, Whole>{member, {}, {}};
}
template <class C, class M, class Check, class Extent>
constexpr auto as_field(Field<C, M, Check, Extent> field) noexcept {
  return field;
}
template <class C, class M, class Check, class Extent>
constexpr auto extended(Field<C, M, Check, Whole> field, Extent extent) noexcept {
  return Field<C, M, Check, Extent>{field.member, field.check, extent};
}
constexpr int one_each(int sensors) noexcept { return sensors; }

}  // namespace field_detail

template <class C, class M>
constexpr auto any(M C::*member) noexcept {
  return Field<C, M, AnyBits, Whole>{member, {}, {}};
}
template <class C, class M>
constexpr auto within(M C::*member, std::int64_t low, std::int64_t high) noexcept {
  return Field<C, M, Within, Whole>{member, {low, high}, {}};
}
template <class C, class M>
constexpr auto up_to(M C::*member, M last) noexcept {
  static_assert(std::is_enum_v<M>);
  return within(member, 0, static_cast<std::int64_t>(last));
}
template <class C, class M>
constexpr auto not_stored(M C::*member) noexcept {
  return Field<C, M, ByType, NotStored>{member, {}, {}};
}
template <class F>
constexpr auto leading(F field, int (*count)(int sensors) noexcept) noexcept {
  return field_detail::extended(field_detail::as_field(field), Leading{count});
}
template <class F>
constexpr auto per_sensor(F field) noexcept {
  return leading(field, &field_detail::one_each);
}
template <class F, class C>
constexpr auto counted(F field, int (C::*count)() const noexcept) noexcept {
  return field_detail::extended(field_detail::as_field(field), Counted<C>{count});
}
template <class F, class C>
constexpr auto only_when(F field, bool (C::*holds)() const noexcept) noexcept {
  return field_detail::extended(field_detail::as_field(field), OnlyWhen<C>{holds});
}
template <class... F>
constexpr auto field_list(F... field) noexcept {
  return std::make_tuple(field_detail::as_field(field)...);
}

/// The way to the lists, which are private where the members are.
struct FieldsOf {
  template <class T>
  static constexpr auto list() noexcept -> decltype(T::fields()) {
    return T::fields();
  }
  template <class T>
  static auto rebuild(T& object, int) noexcept -> decltype(object.rebuild()) {
    object.rebuild();
  }
  template <class T>
  static void rebuild(T&, long) noexcept {}
  template <class T>
  static auto plausible(const T& object, int) noexcept -> decltype(object.plausible()) {
    return object.plausible();
  }
  template <class T>
  static bool plausible(const T&, long) noexcept {
    return true;
  }
};

template <class T, class = void>
inline constexpr bool kHasFields = false;
template <class T>
inline constexpr bool kHasFields<T, std::void_t<decltype(FieldsOf::list<T>())>> = true;

template <class T>
inline constexpr bool kIsArray = false;
template <class T, std::size_t N>
inline constexpr bool kIsArray<std::array<T, N>> = true;

namespace field_detail {

constexpr std::size_t rounded_up(std::size_t size, std::size_t alignment) noexcept {
  return (size + alignment - 1) / alignment * alignment;
}

/// sizeof(T), were the members in the list all that T has.
template <class T>
constexpr std::size_t laid_out_size() noexcept {
  std::size_t end = 0;
  const auto lay = [&end](auto field) {
    using Member = typename decltype(field)::Member;
    end = rounded_up(end, alignof(Member)) + sizeof(Member);
  };
  std::apply([&lay](auto... field) { (lay(field), ...); }, FieldsOf::list<T>());
  return rounded_up(end, alignof(T));
}

}  // namespace field_detail

/// Bytes that a value takes in a snapshot: a scalar its own size (an enumeration that of its numbers, a bool one, a set
/// four), and never more than `stored_size_max` for all else.
template <class T>
constexpr std::size_t stored_size_max() noexcept {
  if constexpr (kHasFields<T>) {
    // What no size betrays, a small member that lies in padding, a test of the snapshot finds.
    static_assert(field_detail::laid_out_size<T>() == sizeof(T), "a member of this class is missing in its fields()");
    std::size_t sum = 0;
    const auto add = [&sum](auto field) {
      using F = decltype(field);
      if constexpr (!std::is_same_v<decltype(F::extent), NotStored>) sum += stored_size_max<typename F::Member>();
    };
    std::apply([&add](auto... field) { (add(field), ...); }, FieldsOf::list<T>());
    return sum;
  } else if constexpr (kIsArray<T>) {
    return std::tuple_size_v<T> * stored_size_max<typename T::value_type>();
  } else {
    static_assert(std::is_arithmetic_v<T> || std::is_enum_v<T> || std::is_same_v<T, SensorSet>, "has no fields()");
    return sizeof(T);
  }
}

/// Leads an archive over all that is stored of `object`. An archive has `sensors()`, `fail()`, `done(object)` and
/// `scalar(value, check)`.
template <class Archive, class T, class Check>
void transfer(Archive& archive, T& object, const Check& check) noexcept;

namespace field_detail {

template <class Archive, class T, class Check>
void transfer_some(Archive& archive, T& array, const Check& check, int count) noexcept {
  if (count < 0 || static_cast<std::size_t>(count) > array.size()) return archive.fail();
  for (std::size_t k = 0; k < static_cast<std::size_t>(count); ++k) transfer(archive, array[k], check);
}

template <class Archive, class T, class F>
void transfer_field(Archive& archive, T& object, const F& field) noexcept {
  using Extent = decltype(F::extent);
  auto& member = object.*(field.member);
  if constexpr (std::is_same_v<Extent, Whole>) {
    transfer(archive, member, field.check);
  } else if constexpr (std::is_same_v<Extent, Leading>) {
    transfer_some(archive, member, field.check, field.extent.count(archive.sensors()));
  } else if constexpr (std::is_same_v<Extent, Counted<typename F::Class>>) {
    transfer_some(archive, member, field.check, (object.*(field.extent.count))());
  } else if constexpr (std::is_same_v<Extent, OnlyWhen<typename F::Class>>) {
    if ((object.*(field.extent.holds))()) transfer(archive, member, field.check);
  } else {
    static_assert(std::is_same_v<Extent, NotStored>);
  }
}

}  // namespace field_detail

template <class Archive, class T, class Check>
void transfer(Archive& archive, T& object, const Check& check) noexcept {
  using Object = std::remove_const_t<T>;
  if constexpr (kHasFields<Object>) {
    std::apply(
        [&archive, &object](const auto&... field) { (field_detail::transfer_field(archive, object, field), ...); },
        FieldsOf::list<Object>());
    archive.done(object);
  } else if constexpr (kIsArray<Object>) {
    for (auto& element : object) transfer(archive, element, check);
  } else {
    static_assert(!(std::is_signed_v<Object> && std::is_integral_v<Object> && sizeof(Object) > 1) ||
                      !std::is_same_v<Check, ByType>,
                  "a signed integer needs within()");
    static_assert(!std::is_enum_v<Object> || std::is_same_v<Check, Within>, "an enumeration needs up_to()");
    archive.scalar(object, check);
  }
}

}  // namespace PLUMB_ABI
}  // namespace plumb

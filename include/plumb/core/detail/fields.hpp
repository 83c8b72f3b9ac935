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
#include <type_traits>
#include <utility>

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
/// The field as it is, or not stored: for what only some builds keep.
template <bool kStored, class F>
constexpr auto stored_if(F field) noexcept {
  const auto made = field_detail::as_field(field);
  if constexpr (kStored) {
    return made;
  } else {
    return not_stored(made.member);
  }
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

/// A flat list: a std::tuple of a hundred members costs every file that sees one a second to compile.
template <std::size_t I, class F>
struct FieldSlot {
  F field;
};
template <class Indices, class... F>
struct FieldList;
template <std::size_t... I, class... F>
struct FieldList<std::index_sequence<I...>, F...> : FieldSlot<I, F>... {
  constexpr explicit FieldList(F... field) noexcept : FieldSlot<I, F>{field}... {}
  template <class Visitor>
  constexpr void each(const Visitor& visit) const noexcept {
    (visit(FieldSlot<I, F>::field), ...);
  }
};
template <class... F>
constexpr auto field_list(F... field) noexcept {
  return FieldList<std::index_sequence_for<F...>, decltype(field_detail::as_field(field))...>(
      field_detail::as_field(field)...);
}

/// The way to the lists, which are private where the members are.
struct FieldsOf {
  template <class T>
  static constexpr auto list() noexcept -> decltype(T::fields()) {
    return T::fields();
  }
  /// Lists of core/detail/storage_map.hpp.
  template <class T>
  static constexpr auto changing() noexcept -> decltype(T::changing()) {
    return T::changing();
  }
  template <class T>
  static constexpr auto core() noexcept -> decltype(T::core()) {
    return T::core();
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
template <class T, class Indices, class... F>
constexpr std::size_t laid_out_size(const FieldList<Indices, F...>*) noexcept {
  std::size_t end = 0;
  ((end = rounded_up(end, alignof(typename F::Member)) + sizeof(typename F::Member)), ...);
  return rounded_up(end, alignof(T));
}

template <class T>
using ListOf = decltype(FieldsOf::list<T>());

}  // namespace field_detail

/// Bytes that a value takes in a snapshot: a scalar its own size (an enumeration that of its numbers, a bool one, a set
/// four), and never more than `stored_size_max` for all else.
template <class T>
constexpr std::size_t stored_size_max() noexcept;

namespace field_detail {

template <class C, class M, class Check, class Extent>
constexpr std::size_t field_size_max(const Field<C, M, Check, Extent>*) noexcept {
  if constexpr (std::is_same_v<Extent, NotStored>) {
    return 0;
  } else {
    return stored_size_max<M>();
  }
}
template <class Indices, class... F>
constexpr std::size_t list_size_max(const FieldList<Indices, F...>*) noexcept {
  return (std::size_t{0} + ... + field_size_max(static_cast<const F*>(nullptr)));
}

}  // namespace field_detail

template <class T>
constexpr std::size_t stored_size_max() noexcept {
  if constexpr (kHasFields<T>) {
    // What no size betrays, a small member that lies in padding, a test of the snapshot finds.
    constexpr field_detail::ListOf<T>* kList = nullptr;
    static_assert(field_detail::laid_out_size<T>(kList) == sizeof(T),
                  "a member of this class is missing in its fields()");
    return field_detail::list_size_max(kList);
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

/// The list of a class as a constant: it is not built at run time, whatever the compiler optimises for.
template <class T>
inline constexpr auto kListOf = FieldsOf::list<T>();

template <std::size_t I, class F>
constexpr const F& field_at(const FieldSlot<I, F>& slot) noexcept {
  return slot.field;
}

/// Field I of a class. All of it is known here: what is left at run time is the address of the member.
template <class T, std::size_t I>
struct Listed {
  static constexpr auto kField = field_at<I>(kListOf<T>);
  static constexpr auto kCheck = kField.check;
};

template <std::size_t I, class Archive, class T>
void transfer_field(Archive& archive, T& object) noexcept {
  using Object = std::remove_const_t<T>;
  using ThisField = Listed<Object, I>;
  constexpr auto kField = ThisField::kField;
  using Extent = decltype(kField.extent);
  auto& member = object.*(kField.member);
  if constexpr (std::is_same_v<Extent, Whole>) {
    transfer(archive, member, ThisField::kCheck);
  } else if constexpr (std::is_same_v<Extent, Leading>) {
    transfer_some(archive, member, ThisField::kCheck, kField.extent.count(archive.sensors()));
  } else if constexpr (std::is_same_v<Extent, Counted<Object>>) {
    transfer_some(archive, member, ThisField::kCheck, (object.*(kField.extent.count))());
  } else if constexpr (std::is_same_v<Extent, OnlyWhen<Object>>) {
    if ((object.*(kField.extent.holds))()) transfer(archive, member, ThisField::kCheck);
  } else {
    static_assert(std::is_same_v<Extent, NotStored>);
  }
}

template <class Archive, class T, std::size_t... I, class... F>
void transfer_all(Archive& archive, T& object, const FieldList<std::index_sequence<I...>, F...>*) noexcept {
  (transfer_field<I>(archive, object), ...);
}

}  // namespace field_detail

template <class Archive, class T, class Check>
void transfer(Archive& archive, T& object, const Check& check) noexcept {
  using Object = std::remove_const_t<T>;
  if constexpr (kHasFields<Object>) {
    constexpr field_detail::ListOf<Object>* kList = nullptr;
    field_detail::transfer_all(archive, object, kList);
    archive.done(object);
  } else if constexpr (kIsArray<Object>) {
    for (auto& element : object) transfer(archive, element, check);
  } else {
    static_assert(!std::is_signed_v<Object> || !std::is_integral_v<Object> || sizeof(Object) == 1 ||
                      !std::is_same_v<Check, ByType>,
                  "a signed integer needs within()");
    static_assert(!std::is_enum_v<Object> || std::is_same_v<Check, Within>, "an enumeration needs up_to()");
    archive.scalar(object, check);
  }
}

}  // namespace PLUMB_ABI
}  // namespace plumb

/// A member of a class by its place in the list of its fields: for tests of what damaged memory or a state that was
/// read back may hold. Fields are listed in the order of declaration.
#pragma once

#include <type_traits>

#include "plumb/core/fields.hpp"

namespace plumb_test {

template <std::size_t I, class M, class T>
M& member(T& object) {
  constexpr auto kField = plumb::field_detail::field_at<I>(plumb::FieldsOf::list<T>());
  static_assert(std::is_same_v<typename decltype(kField)::Member, M>, "another member stands there");
  return object.*(kField.member);
}

}  // namespace plumb_test

/// JSON built from literals, cheap to compile. The initializer lists of nlohmann_json instantiate its traits anew for
/// every length of a string literal; these take a key as a pointer.
#pragma once

#include <initializer_list>
#include <nlohmann/json.hpp>
#include <string>
#include <type_traits>
#include <utility>

#include "plumb/array/sensor_array.hpp"

// Compiled once, in json_fields.cpp.
extern template nlohmann::basic_json<nlohmann::ordered_map>::basic_json(
    const nlohmann::basic_json<nlohmann::ordered_map>&);
extern template nlohmann::basic_json<nlohmann::ordered_map>::basic_json(
    std::initializer_list<nlohmann::detail::json_ref<nlohmann::ordered_json>>, bool, nlohmann::detail::value_t);
extern template std::string nlohmann::basic_json<nlohmann::ordered_map>::dump(int, char, bool,
                                                                              nlohmann::detail::error_handler_t) const;

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {

using Json = nlohmann::ordered_json;

/// A member of an object. Not for keeping: object() takes the value out of it.
class Field {
 public:
  /// What a Json is made of: text, a number, a truth value, nullptr, a Json, a container of them. What is in braces has
  /// to say which it is: object({...}), texts({...}), Json().
  template <class T>
  Field(const char* key, T&& value) : key_(key) {
    using Plain = std::decay_t<T>;
    if constexpr (std::is_same_v<Plain, Json> || std::is_same_v<Plain, std::string>) {
      set(std::forward<T>(value));
    } else if constexpr (std::is_same_v<Plain, const char*> || std::is_same_v<Plain, char*>) {
      set(static_cast<const char*>(value));
    } else if constexpr (std::is_same_v<Plain, bool>) {
      set(static_cast<bool>(value));
    } else if constexpr (std::is_floating_point_v<Plain>) {
      set(static_cast<double>(value));
    } else if constexpr (std::is_integral_v<Plain> && std::is_signed_v<Plain>) {
      set(static_cast<Json::number_integer_t>(value));
    } else if constexpr (std::is_integral_v<Plain>) {
      set(static_cast<Json::number_unsigned_t>(value));
    } else {
      value_ = std::forward<T>(value);
    }
  }

 private:
  friend Json object(std::initializer_list<Field> fields);

  void set(const char* value);
  void set(const std::string& value);
  void set(bool value);
  void set(double value);
  void set(Json::number_integer_t value);
  void set(Json::number_unsigned_t value);
  void set(const Json& value);
  void set(Json&& value);

  const char* key_;
  mutable Json value_;
};

/// The object with these members, in this order; of two with the same key the first counts.
Json object(std::initializer_list<Field> fields);

/// The array of these texts.
Json texts(std::initializer_list<const char*> items);

/// Null where there is no figure: JSON has no infinity.
Json finite_or_null(double value);

/// The ids of these sensors.
Json ids_of(SensorSet set, const SensorArray& array);

/// What JSON text says; discarded where it is none.
Json parsed(const std::string& text);

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb

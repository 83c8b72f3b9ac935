#include "plumb/io/json_fields.hpp"

#include <cmath>

template nlohmann::basic_json<nlohmann::ordered_map>::basic_json(const nlohmann::basic_json<nlohmann::ordered_map>&);
template nlohmann::basic_json<nlohmann::ordered_map>::basic_json(
    std::initializer_list<nlohmann::detail::json_ref<nlohmann::ordered_json>>, bool, nlohmann::detail::value_t);
template std::string nlohmann::basic_json<nlohmann::ordered_map>::dump(int, char, bool,
                                                                       nlohmann::detail::error_handler_t) const;

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {

void Field::set(const char* value) { value_ = value; }
void Field::set(const std::string& value) { value_ = value; }
void Field::set(bool value) { value_ = value; }
void Field::set(double value) { value_ = value; }
void Field::set(Json::number_integer_t value) { value_ = value; }
void Field::set(Json::number_unsigned_t value) { value_ = value; }
void Field::set(const Json& value) { value_ = value; }
void Field::set(Json&& value) { value_ = std::move(value); }

Json object(std::initializer_list<Field> fields) {
  Json out = Json::object();
  for (const Field& field : fields) out.emplace(field.key_, std::move(field.value_));
  return out;
}

Json texts(std::initializer_list<const char*> items) {
  Json out = Json::array();
  for (const char* item : items) out.push_back(item);
  return out;
}

Json finite_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(); }

Json parsed(const std::string& text) { return Json::parse(text, nullptr, false); }

Json ids_of(SensorSet set, const SensorArray& array) {
  Json out = Json::array();
  for (int i = 0; i < array.size(); ++i) {
    if (set.has(i)) out.push_back(array.row(i).id.data());
  }
  return out;
}

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb

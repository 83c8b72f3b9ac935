/// The text of a calibration file with what it takes to say where something is wrong (private to src/io).
#pragma once

#include <algorithm>
#include <cstddef>
#include <initializer_list>
#include <limits>
#include <memory>
#include <string>
#include <type_traits>

#include "calibration_json.hpp"
#include "plumb/io/array_file.hpp"
#include "plumb/io/calibration_file.hpp"
#include "plumb/paper/paper_calibration.hpp"
#include "refusal.hpp"
#include "text_tools.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {

inline constexpr const char* kMakeAnew = "run plumb calibrate again, or copy the original file again";

/// The text with what it takes to say where something is wrong; its functions throw Refusal.
struct Source {
  std::string path;
  std::string text;

  int line_at(std::size_t position) const {
    return 1 + static_cast<int>(std::count(
                   text.begin(), text.begin() + static_cast<std::ptrdiff_t>(std::min(position, text.size())), '\n'));
  }
  /// Line of the first `key` behind `section`, 0 where it does not stand.
  int line_of(const std::string& section, const std::string& key) const {
    const std::size_t from = text.find("\"" + section + "\"");
    const std::size_t at = from == std::string::npos ? from : text.find(key, from);
    return at == std::string::npos ? 0 : line_at(at);
  }
  [[noreturn]] void fail(int line, const std::string& field, const std::string& what, const std::string& remedy) const {
    throw Refusal(FileError{path, line, field, what, remedy});
  }
  const Json& member(const Json& object, const std::string& key) const {
    const auto found = object.is_object() ? object.find(key) : object.end();
    if (!object.is_object() || found == object.end()) fail(0, key, "is missing", kMakeAnew);
    return *found;
  }
  double number(const Json& value, const std::string& key) const {
    if (value.is_number()) return value.get<double>();
    if (value == "nan") return std::numeric_limits<double>::quiet_NaN();
    if (value == "inf") return std::numeric_limits<double>::infinity();
    if (value == "-inf") return -std::numeric_limits<double>::infinity();
    fail(0, key, "is not a number", kMakeAnew);
  }
  double number_of(const Json& object, const std::string& key) const { return number(member(object, key), key); }
  template <class T>
  T whole_of(const Json& object, const std::string& key) const {
    const Json& value = member(object, key);
    if (!value.is_number_integer()) fail(0, key, "is not a whole number", kMakeAnew);
    const bool fits = value.is_number_unsigned()
                          ? value.get<std::uint64_t>() <= static_cast<std::uint64_t>(std::numeric_limits<T>::max())
                          : std::is_signed_v<T> &&
                                value.get<std::int64_t>() >= static_cast<std::int64_t>(std::numeric_limits<T>::min());
    if (!fits) fail(line_of(key, key), key, "is " + value.dump() + ", out of range", kMakeAnew);
    return value.get<T>();
  }
  std::string text_of(const Json& object, const std::string& key) const {
    const Json& value = member(object, key);
    if (!value.is_string()) fail(0, key, "is not a string", kMakeAnew);
    return value.get<std::string>();
  }
  const Json& list(const Json& value, const std::string& key, std::size_t size) const {
    if (!value.is_array() || value.size() != size) fail(0, key, "is not a list of " + std::to_string(size), kMakeAnew);
    return value;
  }
  void numbers(const Json& value, const std::string& key, double* out, std::size_t count) const {
    list(value, key, count);
    for (std::size_t k = 0; k < count; ++k) out[k] = number(value[k], key);
  }
  void numbers_of(const Json& object, const std::string& key, double* out, std::size_t count) const {
    numbers(member(object, key), key, out, count);
  }
};

template <class Enum>
Enum enum_from(const Source& source, const Json& object, const std::string& key, std::initializer_list<Enum> all) {
  const std::string word = source.text_of(object, key);
  for (const Enum value : all) {
    if (word == to_string(value)) return value;
  }
  source.fail(0, key, in_quotes(word) + " is not known", kMakeAnew);
}

/// Whose file it is.
struct Schema {
  const char* name;
  int oldest, newest;  ///< versions that are read
  const char* remedy;  ///< what to give where it is another file
};

/// The text as JSON; refuses what is empty, truncated, no JSON or nested too deeply.
Json parsed(const Source& source);
/// Refuses another schema or version, and what the checksum does not fit.
void check_envelope(const Source& source, const Json& root, const Schema& schema);
/// Refuses the calibration of another array: names the id, axis, scale or bias that differs.
void check_array(const Source& source, const Json& root, const ArrayFile& array);

/// Refuses a fit by the paper's method that says of readings what plumb's own fit of the same file contradicts.
void check_paper(const Source& source, const PaperCalibration& paper, const Calibration& calibration,
                 const ArrayFile& array);

/// The section `paper`: the fits by the paper's method, in the order of the triples of the array.
std::shared_ptr<const PaperCalibration> read_paper(const Source& source, const Json& section, const ArrayFile& array);

/// The section `motion`.
std::shared_ptr<const MotionCalibration> read_motion(const Source& source, const Json& section, const ArrayFile& array);

/// Refuses figures that no calibration has: not finite, negative counts and sigmas, covariances beyond their variances.
void check_content(const Source& source, const CalibrationFile& file);

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb

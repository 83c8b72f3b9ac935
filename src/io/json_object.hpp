/// One JSON object written member by member, without building it in memory first: a record per sample must be cheap.
#pragma once

#include <charconv>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>

#include "plumb/io/records.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {

/// Writes the members of one object in the order of the calls.
class Object {
 public:
  explicit Object(std::string& out) : out_(out) { out_ += '{'; }
  void close() { out_ += '}'; }

  void number(const char* key, double value) {
    name(key);
    append_json_number(out_, value);
  }
  /// null where `known` is false.
  void number_if(bool known, const char* key, double value) {
    name(key);
    append_json_number(out_, known ? value : std::nan(""));
  }
  void whole(const char* key, std::int64_t value) {
    name(key);
    append_whole(value);
  }
  void flag(const char* key, bool value) {
    name(key);
    out_ += value ? "true" : "false";
  }
  void nothing(const char* key) {
    name(key);
    out_ += "null";
  }
  /// A member that is an object itself; to be closed before the next member.
  Object object(const char* key) {
    name(key);
    return Object(out_);
  }
  /// `value` needs no escapes: one of plumb's own words.
  void word(const char* key, const char* value) {
    name(key);
    out_.append("\"").append(value).append("\"");
  }
  void sensors(const char* key, SensorSet set, const SensorArray& array) {
    name(key);
    out_ += '[';
    bool first = true;
    for (int i = 0; i < array.size(); ++i) {
      if (!set.has(i)) continue;
      if (!first) out_ += ',';
      first = false;
      append_json_string(out_, array.row(i).id.data());
    }
    out_ += ']';
  }
  template <std::size_t N>
  void numbers(const char* key, const std::array<double, N>& values) {
    name(key);
    for (std::size_t k = 0; k < N; ++k) {
      out_ += k == 0 ? '[' : ',';
      append_json_number(out_, values[k]);
    }
    out_ += ']';
  }
  /// s_i in the order of the array; null where no hypothesis keeps the sensor healthy.
  void minimum_faults(const char* key, const Verdict& verdict, int size) {
    name(key);
    out_ += '[';
    for (int i = 0; i < size; ++i) {
      const std::uint8_t value = verdict.minimum_faults[static_cast<std::size_t>(i)];
      if (i > 0) out_ += ',';
      if (value == kNoHypothesis) {
        out_ += "null";
      } else {
        append_whole(value);
      }
    }
    out_ += ']';
  }
  /// Why each sensor is out of service or doubted, in the order of the array.
  void causes(const char* key, const Verdict& verdict, int size) {
    name(key);
    out_ += '[';
    for (int i = 0; i < size; ++i) {
      out_.append(i > 0 ? ",\"" : "\"")
          .append(to_string(verdict.sensor_cause[static_cast<std::size_t>(i)]))
          .append("\"");
    }
    out_ += ']';
  }
  /// What of the verdict may be used.
  void usable(const char* key, std::uint16_t bits) { named_bits(key, bits, kUsableNames); }
  /// Those tested and not passed, each by its three sensors.
  void failing_triples(const char* key, const Verdict& verdict, const SensorArray& array) {
    name(key);
    out_ += '[';
    bool first = true;
    for (int k = 0; k < array.triple_count(); ++k) {
      if (!verdict.triples_tested.has(k) || verdict.triples_passed.has(k)) continue;
      for (std::size_t s = 0; s < 3; ++s) {
        out_ += s > 0 ? "," : first ? "[" : ",[";
        append_json_string(out_, array.row(array.triple(k).sensors[s]).id.data());
      }
      first = false;
      out_ += ']';
    }
    out_ += ']';
  }
  /// Sixteen hexadecimal digits: no number of JSON holds 64 bits. null where it is not known.
  void hash(const char* key, std::uint64_t value) {
    if (value == 0) return nothing(key);
    static constexpr char kHex[] = "0123456789abcdef";
    name(key);
    out_ += '"';
    for (unsigned k = 0; k < 16; ++k) out_ += kHex[value >> (60U - 4U * k) & 15U];
    out_ += '"';
  }
  void drifts(const char* key, const Verdict& verdict, int size) {
    name(key);
    out_ += '[';
    for (int i = 0; i < size; ++i) {
      if (i > 0) out_ += ',';
      append_json_number(out_, static_cast<double>(verdict.drift_mps2_per_h[static_cast<std::size_t>(i)]));
    }
    out_ += ']';
  }
  void qualifiers(const char* key, std::uint16_t bits) { named_bits(key, bits, kQualifierNames); }

 private:
  void name(const char* key) {
    if (!first_) out_ += ',';
    first_ = false;
    out_.append("\"").append(key).append("\":");
  }
  template <std::size_t N>
  void named_bits(const char* key, std::uint16_t bits, const std::array<const char*, N>& names) {
    name(key);
    out_ += '[';
    bool first = true;
    for (std::size_t k = 0; k < N; ++k) {
      if ((static_cast<unsigned>(bits) >> k & 1U) == 0) continue;
      if (!first) out_ += ',';
      first = false;
      out_.append("\"").append(names[k]).append("\"");
    }
    out_ += ']';
  }
  void append_whole(std::int64_t value) {
    char text[24];
    out_.append(text, std::to_chars(text, text + sizeof text, value).ptr);
  }

  std::string& out_;
  bool first_ = true;
};

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb

/// JSON Lines: one object per transition and per verdict. Stable key order, every double with full
/// precision (null where not finite), sensor sets as arrays of ids, angles in deg with `_deg` keys.
#pragma once

#include <array>
#include <string>
#include <string_view>

#include "plumb/array/sensor_array.hpp"
#include "plumb/core/vec3.hpp"
#include "plumb/health/verdict.hpp"
#include "plumb/io/array_file.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {

/// The bits of `Verdict::qualifiers`, and those of `Verdict::usable`, by name.
inline constexpr std::array<const char*, 12> kQualifierNames = {"not_yet_validated",    "moving",
                                                                "initial_calibration",  "provisional",
                                                                "no_redundancy",        "timed_out",
                                                                "three_sensor_fit",     "inhibited",
                                                                "standstill_assumed",   "stability_unstated",
                                                                "uncertainty_unstated", "alignment_unstated"};
inline constexpr std::array<const char*, 9> kUsableNames = {"vector",           "inclination", "toolface",
                                                            "protection_level", "monitored",   "stationary",
                                                            "temperature",      "calibration", "reference"};
static_assert(1U << (kQualifierNames.size() - 1) == Qualifier::alignment_unstated, "a name for every qualifier");
static_assert(1U << (kUsableNames.size() - 1) == Usable::reference, "a name for every use");

/// Without a newline at the end.
std::string event_json(const TransitionRecord& record, const SensorArray& array);

/// `frame` (rows, ArrayFile::output_frame) is applied to the vectors, their covariance and the angles
/// here and nowhere else.
std::string verdict_json(const Verdict& verdict, const SensorArray& array, const Mat3& frame = kIdentity3);

/// The same into a string that the caller reuses from record to record.
void append_event_json(std::string& out, const TransitionRecord& record, const SensorArray& array);
void append_verdict_json(std::string& out, const Verdict& verdict, const SensorArray& array,
                         const Mat3& frame = kIdentity3);

/// F v and F C F'.
Vec3 in_frame(const Mat3& frame, const Vec3& v) noexcept;
Mat3 covariance_in_frame(const Mat3& frame, const Mat3& covariance) noexcept;

/// The quoted JSON string of any bytes (control characters escaped; bytes that are not UTF-8 become U+FFFD).
void append_json_string(std::string& out, std::string_view text);
/// The number, or null where it is not finite.
void append_json_number(std::string& out, double value);

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb

/// The monitor's vocabulary in plain words, for tables and pages.
#pragma once

#include <string>
#include <vector>

#include "plumb/array/sensor_array.hpp"
#include "plumb/health/verdict.hpp"
#include "plumb/io/array_file.hpp"
#include "plumb/verification/tool_health.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {

/// "a1, a3", or `none` for the empty set.
std::string sensor_names(SensorSet set, const SensorArray& array, const char* none = "-");

/// "a, b and c".
std::string listed(const std::vector<std::string>& names);

/// Why the monitor says what it says, for someone who has not read the manual. `grade` is that of an exclusion; `event`
/// tells what became of a calibration.
std::string explain(Cause cause, Grade grade = Grade::none, HealthEvent event = HealthEvent::none);

/// The same of an event, with the sensors that are noisy, stuck or at full scale by name.
std::string explain(const verification::NamedEvent& event, const SensorArray& array);

/// How to measure the noise that the sensors of this file have, with the command: for remarks on a declared noise that
/// a log contradicts.
std::string measure_noise_words(const io::ArrayFile& array);

/// What a state means, in one sentence.
const char* meaning(HealthState state) noexcept;

/// What the output may be used for, in a few words.
const char* meaning(Validity validity) noexcept;

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb

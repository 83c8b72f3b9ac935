/// What a tool records at rest: samples by attitude, and the station means that a calibration is made from.
#pragma once

#include <cstdint>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "plumb/core/config.hpp"
#include "plumb/core/sample.hpp"
#include "plumb/gravity/gravity.hpp"
#include "plumb/scenario/scenario.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace study {

/// Errors of this module are texts that say what was found and what to do.
template <class T>
using StudyExpected = tl::expected<T, std::string>;

/// Samples at rest, attitude by attitude.
struct Survey {
  std::vector<std::vector<Sample>> attitude;
};

/// What the recordings of one study are for. The numbers choose the streams and are part of every result: never
/// renumber, only append. (The scenarios of `scenario/library.hpp` use 0 to 9.)
enum class Part : std::uint8_t { validation = 16, faults = 17, one_attitude = 18, proving = 19 };

/// `attitudes` random attitudes with `samples` each at 100 Hz, tagged, motion not recorded; of a stream of its own.
scenario::Scenario survey_run(const scenario::Tool& tool, std::uint64_t seed, Part part, int attitudes, int samples);

/// Plays a scenario with station tags and keeps what was recorded at rest. Errors: those of `Simulator::make`.
StudyExpected<Survey> record(const scenario::Scenario& scenario);

/// One station per attitude: the means of all its samples.
std::vector<Station> stations_of(const Survey& survey);

/// Gravity as every study knows it: standard gravity, known as well as a model knows it.
inline GravityReference study_gravity() noexcept { return GravityReference{}; }

}  // namespace study
}  // namespace PLUMB_ABI
}  // namespace plumb

/// What text and page say of a survey alike (private to src/render).
#pragma once

#include <string>

#include "plumb/render/survey_report.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {

inline constexpr double kMg_mps2 = 1e-3 * kG0_mps2;

/// "50123", or "50123 to 50131" where the references of the first and of the last station are written differently.
std::string survey_span(const std::string& first, const std::string& last);
double total_sigma(const geomagnetic::Sigma& sigma);
/// Degrees with two decimals, "-" where there is no angle. An azimuth of 360.00 is 0.00.
std::string survey_degrees(const survey::OrUndefined<survey::Angle>& angle);
std::string survey_level(const survey::OrUndefined<survey::Angle>& angle, double risk);
/// "V too near vertical for an azimuth", of the flags that stations have; empty where none has one.
std::string flag_words(const survey::Survey& found);
/// "passed", or what each part of the test found. `unit` is what figures are divided by, `name` what they are in then.
std::string error_test_words(const survey::ErrorTest& test, double unit, const char* name, const survey::Survey& found);
/// What became of alignment and axial interference, with the stations left out of them; empty where nobody asked.
std::string alignment_words(const survey::Survey& found);
std::string axial_words(const survey::Survey& found);
/// ", with the stated sag 0.2 deg", or that nothing is stated: of a position's sigma.
std::string sigma_words(const survey::PathSigmas& sigmas);
/// Where the path ends, or why there is none.
std::string path_words(const survey::Survey& found);

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb

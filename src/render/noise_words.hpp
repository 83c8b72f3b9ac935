/// Numbers and sentences of the study of noise that text and page share (private to src/render).
#pragma once

#include <string>
#include <vector>

#include "plumb/render/noise_report.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {

/// How the figures of a column are shown: factor from the unit of the readings, and its name.
struct ShownUnit {
  double factor = 1.0;
  std::string name;
};
/// "mg0" for accelerations, "nT" and "deg/s" for groups of another field, else that of the log.
ShownUnit shown_unit(const NoiseAxis& axis);
/// "ug0" for accelerations, "nT", "deg/h": for Allan deviations.
ShownUnit fine_unit(const NoiseAxis& axis);

/// "white noise N".
std::string term_words(noise::Term term);
/// "ug0/sqrt(Hz)", "deg/sqrt(h)"; the factor is from the unit of the readings and seconds.
ShownUnit term_unit(noise::Term term, const NoiseAxis& axis);
/// "101", "99 .. 103"; of a term that is not visible "not visible" and "below 0.12".
std::string term_value(noise::Term term, const NoiseAxis& axis);
std::string term_interval(noise::Term term, const NoiseAxis& axis);
/// "record 3.2 more hours for this term"; empty where it is visible.
std::string term_remark(const noise::TermEstimate& term);

/// "23.4 Hz, amplitude 0.5 mg0, 120 times the floor (mains, 3 x 50 Hz)".
std::string peak_words(const noise::Peak& peak, const NoiseAxis& axis);
/// "white over 32 samples: ...".
std::string whiteness_words(const NoiseAxis& axis);
/// "0.212 mg0", as `noise` takes it.
std::string declare_words(const NoiseAxis& axis);
/// "declared 0.2 mg0: 1.06 times"; empty where nothing is.
std::string declared_words(const NoiseAxis& axis);

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb

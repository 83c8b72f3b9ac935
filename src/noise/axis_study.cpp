#include "plumb/noise/axis_study.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace plumb {
inline namespace PLUMB_ABI {
namespace noise {

AxisStudy study_axis(const StillLog& log, std::size_t column, const StudyOptions& options) {
  AxisStudy out;
  out.name = log.columns[column].name;
  out.stretch = longest_stretch(log, column);
  const std::vector<double> readings = std::move(out.stretch.readings);
  out.stretch.readings.clear();
  out.readings = readings.size();
  out.duration_s = static_cast<double>(readings.size()) * out.stretch.period_s;
  if (out.stretch.refused != Refused::no) return out;
  for (const double y : readings) out.mean += (y - readings.front()) / static_cast<double>(readings.size());
  out.mean += readings.front();
  const double period_s = out.stretch.period_s;
  out.spectrum = power_spectrum(readings, period_s);
  out.fit = fit_noise(readings, period_s, bands_of(out.spectrum, readings.size(), period_s));
  const std::vector<double> sums = prefix_sums(readings);
  out.allan = allan_deviation(sums, period_s, options.per_octave);
  const Coefficients noise = out.fit.values();
  add_intervals(out.allan, noise, readings.size(), period_s);
  const std::size_t block = std::min(options.block, readings.size() / 4);
  out.whiteness = whiteness(readings, sums, noise, period_s, std::max<std::size_t>(block, 1));
  // Below its resolution a column does not show how far it is off: that of a value rounded to it counts.
  out.whiteness.declare_sigma = std::max(out.whiteness.declare_sigma, out.stretch.resolution / std::sqrt(12.0));
  return out;
}

}  // namespace noise
}  // namespace PLUMB_ABI
}  // namespace plumb

#include "plumb/survey/saturation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace plumb {
inline namespace PLUMB_ABI {
namespace survey {
namespace {

constexpr int kFewestEqual = 3;
/// A tool that moved by so much of the triad's length between the equal readings would have changed the channel too.
constexpr double kMoved = 0.02;
constexpr const char* kNames[] = {"gx", "gy", "gz", "bx", "by", "bz"};

double reading_of(const Measurement& m, std::size_t component) {
  return component < 3 ? m.gravity_mps2[component] : m.field_tesla[component - 3];
}

/// Largest range of another component of the triad, over its length, among the stations that read `value`.
double moved_meanwhile(const std::vector<Measurement>& measured, std::size_t component, double value) {
  const std::size_t first = component < 3 ? 0 : 3;
  double length = 0.0, out = 0.0;
  for (std::size_t other = first; other < first + 3; ++other) {
    double least = std::numeric_limits<double>::infinity(), most = -least;
    for (const Measurement& m : measured) {
      if (reading_of(m, component) != value) continue;
      least = std::fmin(least, reading_of(m, other));
      most = std::fmax(most, reading_of(m, other));
      length = std::fmax(length, std::fabs(reading_of(m, other)));
    }
    out = std::fmax(out, most - least);
  }
  return length > 0.0 ? out / length : 0.0;
}

}  // namespace

std::string SaturatedChannel::text() const {
  const bool field = component >= 3;
  return fmt::format("{} reads {:.{}f} {} at {} stations, its largest, and all of them fail: it is saturated or stuck",
                     kNames[component], field ? value * 1e9 : value, field ? 0 : 4, field ? "nT" : "m/s^2", stations);
}

std::vector<SaturatedChannel> saturated_channels(const std::vector<Measurement>& measured,
                                                 const std::vector<SurveyStation>& judged) {
  std::vector<SaturatedChannel> out;
  for (std::size_t component = 0; component < 6; ++component) {
    SaturatedChannel one{component, 0.0, 0};
    for (const Measurement& m : measured) {
      const double reading = reading_of(m, component);
      if (std::fabs(reading) > std::fabs(one.value)) one.value = reading;
    }
    bool all_fail = true;
    for (std::size_t k = 0; k < std::min(measured.size(), judged.size()); ++k) {
      if (reading_of(measured[k], component) != one.value) continue;
      ++one.stations;
      const StationChecks& c = judged[k].checks;
      all_fail = all_fail && !(component < 3 ? c.gravity.passed : c.field_passed());
    }
    if (one.value != 0.0 && all_fail && one.stations >= kFewestEqual &&
        moved_meanwhile(measured, component, one.value) > kMoved)
      out.push_back(one);
  }
  return out;
}

}  // namespace survey
}  // namespace PLUMB_ABI
}  // namespace plumb

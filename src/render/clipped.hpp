/// An axis that one far value does not flatten (private to src/render).
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "plumb/core/config.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {

/// The axis ends where most values are well inside; a value beyond is drawn at its edge, with what it is in words.
class Clipped {
 public:
  /// `least`: what the axis shows at any rate, a limit say.
  Clipped(std::vector<double> values, double least) {
    values.erase(std::remove_if(values.begin(), values.end(), [](double v) { return !std::isfinite(v); }),
                 values.end());
    for (double& value : values) value = std::fabs(value);
    std::sort(values.begin(), values.end());
    const double usual = values.empty() ? 0.0 : values[(values.size() - 1) * 3 / 4];
    const double most = values.empty() ? 0.0 : values.back();
    const double scale = std::max(least, kUsualTimes * usual);
    edge_ = most <= kFlattened * scale || !(scale > 0.0) ? std::max(most, least) : scale;
    if (!(edge_ > 0.0)) edge_ = 1.0;
  }
  double edge() const { return edge_; }
  double room() const { return kRoom * edge_; }
  bool beyond(double value) const { return std::fabs(value) > edge_; }
  double drawn(double value) const { return std::clamp(value, -edge_, edge_); }
  std::string range() const { return fmt::format("set yrange [{:.6g}:{:.6g}]\n", -room(), room()); }
  /// Beside a value that is drawn at the edge; at `x` in the units of the axis below.
  std::string label(double x, double value) const {
    return fmt::format(
        "set label '{:+.3g}' at first {:.8g},{:.6g} offset 1.2,0 left front font ',12' tc rgb '#c53a3a'\n", value, x,
        drawn(value));
  }

 private:
  static constexpr double kRoom = 1.25;       ///< above the edge, so that no mark is cut
  static constexpr double kUsualTimes = 2.0;  ///< beyond the size that three of four values keep to
  static constexpr double kFlattened = 3.0;   ///< up to here nothing is flattened
  double edge_ = 1.0;
};

/// So many values beyond the edge are written out: more would cover one another.
inline constexpr std::size_t kMostLabels = 8;

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb

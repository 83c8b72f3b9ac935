#include "plumb/findings/temperature_gaps.hpp"

#include <algorithm>
#include <cmath>

#include "plumb/calibration/temperature_fit.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace findings {

void TemperatureGaps::add(double time_s, double temperature_degc, bool held) {
  if (held) {
    if (!open_) now_.begin_s = time_s;
    now_.end_s = time_s;
    open_ = true;
    return;
  }
  if (open_ && std::fabs(temperature_degc - before_degc_) > kLevelMargin_degc) gaps_.push_back(now_);
  open_ = false;
  before_degc_ = temperature_degc;
}

void TemperatureGaps::finish() {
  if (open_) gaps_.push_back(now_);
  open_ = false;
}

bool TemperatureGaps::cover(const Station& station) const {
  return std::any_of(gaps_.begin(), gaps_.end(), [&station](const Gap& gap) {
    return station.begin_s >= gap.begin_s && station.end_s <= gap.end_s;
  });
}

}  // namespace findings
}  // namespace PLUMB_ABI
}  // namespace plumb

/// Rows without a temperature get the one before. Whether that can be relied on, station by station.
#pragma once

#include <vector>

#include "plumb/core/sample.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace findings {

/// Watches the rows go by and keeps the gaps over which the temperature changed by more than a monitor lets pass
/// (kLevelMargin_degc), and the one that no further temperature ended: there it may have become anything.
class TemperatureGaps {
 public:
  /// `held`: the row got its temperature from a row before it.
  void add(double time_s, double temperature_degc, bool held);
  /// After the last row.
  void finish();

  /// Whether every row of the station lies in one such gap.
  bool cover(const Station& station) const;

 private:
  struct Gap {
    double begin_s = 0.0, end_s = 0.0;
  };
  std::vector<Gap> gaps_;
  Gap now_;
  bool open_ = false;
  double before_degc_ = 0.0;
};

}  // namespace findings
}  // namespace PLUMB_ABI
}  // namespace plumb

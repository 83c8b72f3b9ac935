/// How fast the temperature changes, over half a minute or more: a sensor lags behind its thermometer.
#pragma once

#include <cmath>

#include "plumb/core/config.hpp"
#include "plumb/core/fields.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

class TemperatureRate {
 public:
  static constexpr double kSpan_s = 30.0;
  /// Beyond it compensation by the present temperature is not to be trusted.
  static constexpr double kMost_degc_per_min = 5.0;

  void clear() noexcept { *this = TemperatureRate{}; }
  /// Both finite, time increasing since `clear`.
  void add(double time_s, double temperature_degc) noexcept {
    if (!known_) old_ = young_ = {time_s, temperature_degc};
    known_ = true;
    if (time_s - young_.time_s >= kSpan_s) {
      old_ = young_;
      young_ = {time_s, temperature_degc};
    }
    const double span_s = time_s - old_.time_s;
    const double rate = span_s >= kSpan_s ? 60.0 * (temperature_degc - old_.temperature_degc) / span_s : 0.0;
    degc_per_min_ = std::fmax(-kTold, std::fmin(kTold, rate));
  }
  double degc_per_min() const noexcept { return degc_per_min_; }  ///< 0 = not known yet
  bool slow() const noexcept { return std::fabs(degc_per_min_) <= kMost_degc_per_min; }

 private:
  static constexpr double kTold = 1e6;  ///< a broken thermometer gives no infinity
  struct Mark {
    double time_s = 0.0;
    double temperature_degc = 0.0;
    static constexpr auto fields() noexcept { return field_list(&Mark::time_s, &Mark::temperature_degc); }
  };
  Mark old_, young_;
  double degc_per_min_ = 0.0;
  bool known_ = false;

  friend struct FieldsOf;
  static constexpr auto fields() noexcept {
    using T = TemperatureRate;
    return field_list(&T::old_, &T::young_, &T::degc_per_min_, &T::known_);
  }
};

}  // namespace PLUMB_ABI
}  // namespace plumb

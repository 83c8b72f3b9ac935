/// How fast the temperature changes, over half a minute or more: a sensor lags behind its thermometer.
#pragma once

#include <cmath>

#include "plumb/core/config.hpp"
#include "plumb/core/detail/fields.hpp"

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
    known_long_enough_ = known_long_enough_ || span_s >= kSpan_s;
    const double rate = span_s >= kSpan_s ? 60.0 * (temperature_degc - old_.temperature_degc) / span_s : 0.0;
    degc_per_min_ = std::fmax(-kTold, std::fmin(kTold, rate));
    lag_degc_per_min_ = std::fmax(std::fabs(degc_per_min_), kept(time_s) * lag_degc_per_min_);
    lag_time_s_ = time_s;
  }
  double degc_per_min() const noexcept { return degc_per_min_; }  ///< 0 = not known yet
  /// What a lag behind the thermometer goes by: the largest rate so far, forgotten as a lag of two minutes is; until a
  /// rate is known, the largest at which compensation is trusted.
  double lag_degc_per_min() const noexcept { return known_long_enough_ ? lag_degc_per_min_ : kMost_degc_per_min; }
  bool slow() const noexcept { return std::fabs(degc_per_min_) <= kMost_degc_per_min; }

 private:
  static constexpr double kTold = 1e6;  ///< a broken thermometer gives no infinity
  static constexpr double kLag_s = 120.0;
  /// Of a lag, what is left since the last block: no less than exp(-t / kLag_s), and no exponential.
  double kept(double time_s) const noexcept {
    const double span = (time_s - lag_time_s_) / kLag_s;
    return span > 0.0 ? 1.0 / (1.0 + span) : 1.0;
  }
  struct Mark {
    double time_s = 0.0;
    double temperature_degc = 0.0;
    static constexpr auto fields() noexcept { return field_list(&Mark::time_s, &Mark::temperature_degc); }
  };
  Mark old_, young_;
  double degc_per_min_ = 0.0;
  double lag_degc_per_min_ = 0.0, lag_time_s_ = 0.0;
  bool known_ = false, known_long_enough_ = false;

  friend struct FieldsOf;
  static constexpr auto fields() noexcept {
    using T = TemperatureRate;
    return field_list(&T::old_, &T::young_, &T::degc_per_min_, &T::lag_degc_per_min_, &T::lag_time_s_, &T::known_,
                      &T::known_long_enough_);
  }
};

}  // namespace PLUMB_ABI
}  // namespace plumb

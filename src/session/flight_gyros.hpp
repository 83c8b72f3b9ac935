/// The redundant gyros of a [[group]] in a simulated flight.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "plumb/core/sample.hpp"
#include "plumb/io/array_file.hpp"
#include "plumb/scenario/fault.hpp"
#include "plumb/scenario/flight.hpp"
#include "plumb/scenario/injector.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace session {

/// Errors of each axis are drawn within the bounds of `[group.rate]`: scale, turn of the axis, bias, lag, and shift by
/// specific force; noise is that of the file. It is the group that the file describes.
class FlightGyros {
 public:
  /// `number` tells the groups of one tool apart. Errors: a group of magnetometers, as a flight has no field; a fault
  /// that the group cannot have.
  static io::FileExpected<FlightGyros> make(const io::ArrayFile& group, const std::vector<scenario::Fault>& faults,
                                            std::uint64_t seed, std::uint32_t number);

  /// Of the instants of a flight in their order. `faulty`: those that a fault is on.
  Sample next(const scenario::FlightSample& flown, SensorSet& faulty);
  std::vector<int> without_effect() const { return injector_.without_effect(); }

 private:
  struct Axis {
    Vec3 axis{}, per_force_s_per_m{};
    double scale = 1.0, bias_radps = 0.0, lag_s = 0.0, noise_radps = 0.0;
  };
  FlightGyros(const io::ArrayFile& group, scenario::Injector injector)
      : group_(&group), model_(group.datasheet.model()), injector_(std::move(injector)) {}
  Axis drawn(int sensor) const;
  double raw_of(int sensor, double rate_radps) const;

  const io::ArrayFile* group_;
  SensorModel model_;
  scenario::Injector injector_;
  std::vector<Axis> axis_;
  std::uint64_t seed_ = 0, row_ = 0;
  std::uint32_t sub_ = 0;  ///< of the streams, before the axis
  Vec3 last_radps_{};
  double last_s_ = 0.0;
};

}  // namespace session
}  // namespace PLUMB_ABI
}  // namespace plumb

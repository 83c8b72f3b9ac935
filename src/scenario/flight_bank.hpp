/// Every channel of a flight at once: its input from the motion, its filter, its recent past (private to src/scenario).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "flight_motion.hpp"
#include "plumb/core/config.hpp"
#include "plumb/core/vec3.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace scenario {

/// What the bank must know of one sensor.
struct BankSensor {
  Vec3 axis{};         ///< true
  Vec3 lever_arm_m{};  ///< true
  double gain = 1.0;
  double bandwidth_hz = 260.0;
  double rectification = 0.0;
};

/// Sensors, then the nine components of specific force, angular rate and angular acceleration behind the nominal
/// filter, then the three rates of each gyro behind its own. Between instants the input is a straight line, for which
/// the filter is solved exactly.
class FlightBank {
 public:
  /// `gyro_hz`: bandwidth of each gyro, at most kMostGyros. `instants`: how many of them are remembered, at least.
  FlightBank(const std::vector<BankSensor>& sensors, const std::vector<double>& gyro_hz, double nominal_hz,
             double step_s, bool rectifies_before_filter, std::size_t instants);

  void step(const MotionInstant& motion) noexcept;
  std::uint64_t steps() const noexcept { return steps_; }

  /// Output of a sensor at `instant` + `part` (0 <= part < 1), both neighbours among those remembered.
  double sensor(std::size_t sensor, std::uint64_t instant, double part) const noexcept {
    return between(sensor, instant, part);
  }
  /// The same of the rates of a gyro, in the tool frame.
  Vec3 rate(std::size_t gyro, std::uint64_t instant, double part) const noexcept;
  /// Truth number 0 (specific force), 1 (angular rate) or 2 (angular acceleration).
  Vec3 nominal(std::size_t number, std::uint64_t instant) const noexcept;

 private:
  static constexpr std::size_t kNominal = 9;
  static constexpr std::size_t kChannels = kCapacity + kNominal + 3 * kMostGyros;
  using Row = std::array<double, kChannels>;
  /// Of the specific force (3), of the angular acceleration (3), of the products xx, yy, zz, xy, xz, yz of the rate
  /// (6).
  static constexpr std::size_t kWeights = 12;

  void set_filter(std::size_t channel, double bandwidth_hz, double step_s) noexcept;
  void set_weights(std::size_t channel, const BankSensor& sensor) noexcept;
  void filter(const Row& input) noexcept;
  void rectify(const Row& input) noexcept;
  double between(std::size_t channel, std::uint64_t instant, double part) const noexcept;
  const double* at(const std::vector<double>& past, std::uint64_t instant) const noexcept {
    return past.data() + (instant & mask_) * channels_;
  }

  std::size_t sensors_, channels_;
  bool before_filter_;
  double mean_share_;
  std::array<Row, kWeights> weight_{};
  Row gain_{}, rectification_{};
  Row from_value_{}, from_slope_{}, from_last_{}, from_now_{};  ///< of the next value
  Row to_value_{}, to_slope_{}, to_last_{}, to_now_{};          ///< of the next slope
  Row value_{}, slope_{}, last_{};  ///< slope in units of the value per instant, like the remembered ones
  Row mean_{}, square_{};
  std::uint64_t mask_;
  std::uint64_t steps_ = 0;
  std::vector<double> values_, slopes_;
};

}  // namespace scenario
}  // namespace PLUMB_ABI
}  // namespace plumb

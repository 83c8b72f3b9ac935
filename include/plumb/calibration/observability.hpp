/// What the recorded attitudes cover, and which ones would tell most next. The planner works with the information
/// about the 4n fit parameters (docs/theory.md, section 9.1) with the datasheet as prior, so that it ranks attitudes
/// from the first station on.
#pragma once

#include <array>

#include "plumb/calibration/datasheet.hpp"
#include "plumb/core/sample.hpp"
#include "plumb/core/sensor_set.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

/// A recorded or planned attitude.
struct SeenAttitude {
  Vec3 direction{};  ///< unit vector of gravity in the tool frame
  SensorSet delivered;
  double samples = 1.0;  ///< behind the mean
};

/// How well the attitudes tell the nine harmonics apart that the length of gravity is judged by: the least eigenvalue
/// of their Gram matrix, 1 for the uniform sphere, 0 for attitudes in one plane or fewer than nine of them.
double excitation_of(const Vec3* direction, int count) noexcept;

/// Bins of 5 deg between 0 and 180 deg; inclinations in one bin or in two neighbours count as one.
inline constexpr int kInclinationBins = 37;

/// The attitudes as a driller sees them, and as each sensor does.
struct Coverage {
  int attitudes = 0;
  int inclinations = 0;  ///< distinct ones, by kInclinationBins
  double inclination_min_rad = 0.0;
  double inclination_max_rad = 0.0;
  /// Least and largest h_i . u over the attitudes at which the sensor delivered: the part of +-1 g that it has seen.
  /// Both 0 where it never did.
  std::array<double, kCapacity> lowest{};
  std::array<double, kCapacity> highest{};
};
Coverage coverage_of(const Datasheet& datasheet, const SeenAttitude* attitudes, int count) noexcept;

/// An attitude to record, on a grid that a hand can set.
struct PlannedAttitude {
  double inclination_rad = 0.0;  ///< 0 .. pi, steps of 15 deg
  double toolface_rad = 0.0;     ///< gravity toolface, steps of 30 deg; 0 where vertical
  Vec3 direction{};
  /// log det of (1 + what it tells): above 1 where it tells of something that the datasheet alone knows.
  double gain = 0.0;
};

/// Greedy D-optimal choice of stations. Plain state, no heap: 170 KB at capacity 24, 19 KB at 8, 6 KB at 4.
class StationPlanner {
 public:
  /// Proposes nothing where no fit would start: size, sigmas, priors and gravity as in `Calibrator::finish`.
  StationPlanner(const Datasheet& datasheet, double g_mps2) noexcept;

  /// Takes note of an attitude. False (and nothing changes) where it tells nothing: fewer than three sensors, no
  /// finite direction, no samples.
  bool add(const SeenAttitude& attitude) noexcept;

  /// The attitude that raises the information most, with all sensors and so many samples; gain 0 where the planner has
  /// nothing to propose. Does not add it.
  PlannedAttitude best(double samples) noexcept;

  /// `best` and `add`, `wanted` times; returns how many were written.
  int plan(double samples, int wanted, PlannedAttitude* out) noexcept;

 private:
  static constexpr std::size_t kParameters = std::size_t{4} * kCapacity;
  using Square = std::array<double, kParameters * kParameters>;

  double gain_of(const SeenAttitude& attitude) const noexcept;
  bool refresh() noexcept;

  const Datasheet* datasheet_;
  double g_mps2_;
  bool usable_ = false;
  bool fresh_ = false;    ///< `covariance_` belongs to `information_`
  Square information_{};  ///< of prior and stations, in prior units, lower triangle, stride 4n
  Square covariance_{};   ///< its inverse
};

}  // namespace PLUMB_ABI
}  // namespace plumb

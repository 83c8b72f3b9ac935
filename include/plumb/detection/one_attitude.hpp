/// What the length of gravity isolates at a single attitude, and where it hides faults (theorem T8): a triple
/// with one faulty sensor passes near two errors, zero and the mirror value of `mirror_error`.
#pragma once

#include <array>

#include "plumb/array/mirror.hpp"
#include "plumb/detection/thresholds.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

/// At one attitude, over all sensors and the triples with them that vote.
struct AttitudeFigures {
  /// Every larger single fault, of whichever sensor, fails every triple it is in [m/s^2].
  double clear_from_mps2 = 0.0;
  /// Least mirror value: a fault of this size has a second explanation of the right length [m/s^2].
  double nearest_mirror_mps2 = 0.0;
  /// Sensors with a triple whose two undetected intervals have grown together: gravity lies nearly in the plane of the
  /// other two axes, and not even small faults are distinguished from none.
  SensorSet blind;
};

class OneAttitude {
 public:
  OneAttitude(const SensorArray& array, const GravityReference& gravity, const ErrorBudget& budget) noexcept;

  /// Half of the interval of errors of sensor i that pass where gravity lies in the plane of the other two axes, worst
  /// triple: sqrt((2 G d + d^2) / |w|^2), d = limit of the triple plus the errors of its readings [m/s^2]. Infinite
  /// where sensor i is in no triple that votes.
  double blind_half_width_mps2(int i) const noexcept;
  /// Beyond this no attitude has a mirror within reach: (2 G + d) / |w|, worst triple [m/s^2].
  double any_attitude_mps2(int i) const noexcept;
  /// Over `count` attitudes together: every larger error of sensor i, of either sign, fails each triple with it at one
  /// of them at least [m/s^2]. Infinite where sensor i is in no triple that votes.
  double clear_over_mps2(const Vec3* down, int count, int i) const noexcept;
  /// True where an error f of sensor i fails every monitored triple with it, for gravity g = G times `down`.
  bool isolates(const Vec3& down, int i, double f_mps2) const noexcept;
  AttitudeFigures at(const Vec3& down) const noexcept;

 private:
  /// One sensor of one triple: passes while |f| |f - f*| <= reach.
  struct Entry {
    Vec3 weight{};       ///< column of the inverse
    double reach = 0.0;  ///< (2 G d + d^2) / |w|^2 [(m/s^2)^2]
  };
  /// f*: the error that has a second explanation of the right length [m/s^2].
  double mirror_of(const Entry& entry, const Vec3& down) const noexcept;
  /// The largest error that passes at every attitude.
  double passes_all(const Entry& entry, const Vec3* down, int count) const noexcept;
  /// Calls f(sensor, entry) for every entry; `f` returns nothing.
  template <class F>
  void for_each(F&& f) const noexcept;

  std::array<std::array<Entry, 3>, kTripleCapacity> entries_{};
  std::array<std::array<std::uint8_t, 3>, kTripleCapacity> sensors_{};
  int triples_ = 0;
  double g_mps2_ = 0.0;
};

}  // namespace PLUMB_ABI
}  // namespace plumb

/// Does the calibration keep what its covariance promises? Asked of the first attitudes after power-on or adoption,
/// before anybody is convicted by limits that rest on it: one faulty sensor leaves the others consistent everywhere, a
/// covariance that is ten times too small leaves nobody so.
#pragma once

#include <array>
#include <cstdint>

#include "plumb/core/config.hpp"
#include "plumb/core/fields.hpp"
#include "plumb/core/flag.hpp"
#include "plumb/core/sensor_set.hpp"
#include "plumb/core/units.hpp"
#include "plumb/core/vec3.hpp"
#include "plumb/detection/set_test.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

/// What is told of a calibration that its first attitudes contradict.
struct CalibrationFinding {
  Flag contradicted;
  Flag refused;                 ///< no tolerance up to `kMostLearnedTolerance_mps2` explains them: nothing is valid
  int attitudes = 0;            ///< that contradict it
  double ratio = 0.0;           ///< rms of the residuals there, in units of what noise and covariance allow
  double tolerance_mps2 = 0.0;  ///< in force for every sensor since then, on top of its stability

  static constexpr int kMostAttitudes = 12;
  static constexpr auto fields() noexcept {
    using F = CalibrationFinding;
    return field_list(&F::contradicted, &F::refused, within(&F::attitudes, 0, kMostAttitudes), any(&F::ratio),
                      &F::tolerance_mps2);
  }
};

/// Errors beyond this are no matter of a covariance: then the coefficients are not those of these sensors.
inline constexpr double kMostLearnedTolerance_mps2 = 4e-3 * kG0_mps2;

class CalibrationCheck {
 public:
  /// Seven attitudes leave three sensors, whose length alone is checked, six degrees of freedom.
  static constexpr int kLeast = 7;
  static constexpr int kMost = CalibrationFinding::kMostAttitudes;

  /// What the readings are tested with.
  struct Terms {
    const SensorArray& array;
    const GravityReference& gravity;
    const TestLimits& limits;
  };

  void clear() noexcept { *this = CalibrationCheck{}; }
  /// Gravity is another: what was read under the former one does not go with what will be.
  void forget_readings() noexcept { size_ = 0; }

  bool open() const noexcept { return !corroborated_; }
  bool refused() const noexcept { return finding_.refused; }
  /// One block more, clean or not. Where so many in a row are clean the tool shows no more attitudes than it has, and
  /// what it is trusted for is those.
  static constexpr int kBelieved = 12;
  void count(bool clean) noexcept { clean_run_ = !clean ? 0 : clean_run_ < kBelieved ? clean_run_ + 1 : kBelieved; }
  bool believed() const noexcept { return !gathers() || clean_run_ == kBelieved; }
  /// There are attitudes to come that may tell.
  bool gathers() const noexcept { return open() && size_ < kMost; }
  const CalibrationFinding& finding() const noexcept { return finding_; }
  float tolerance_mps2() const noexcept { return static_cast<float>(finding_.tolerance_mps2); }

  /// Keeps what `block` read along `direction`, if no attitude on record is within `apart_rad` of it: true where it
  /// did.
  bool add(const Vec3& direction, const BlockEvidence& block, double apart_rad) noexcept;
  /// Whether `set` agrees with itself and, up to one offset, with gravity at all attitudes on record, and there are
  /// enough of them to say so.
  bool vouches(const Terms& terms, SensorSet set) const noexcept;
  /// All sensors agree at enough attitudes: from here on the limits are believed.
  void corroborate(const Terms& terms, SensorSet posed) noexcept;
  /// No fault of at most `grade` sensors explains what is on record: the finding is made, and tolerance learned or the
  /// calibration refused. True where that was so.
  bool contradict(const Terms& terms, SensorSet posed, int grade) noexcept;

 private:
  struct Entry {
    std::array<float, kCapacity> mean_mps2{};
    std::array<float, 3> u{};
    float samples = 0.0F, moved_mps2 = 0.0F;
    float tolerance_mps2 = 0.0F;  ///< the largest of all sensors: fewer contradictions, and one number
    SensorSet usable;

    bool plausible() const noexcept { return samples > 0.0F && tolerance_mps2 >= 0.0F && moved_mps2 >= 0.0F; }
    static constexpr auto fields() noexcept {
      return field_list(per_sensor(&Entry::mean_mps2), &Entry::u, &Entry::samples, &Entry::moved_mps2,
                        &Entry::tolerance_mps2, &Entry::usable);
    }
  };
  struct Fit {
    double sum = 0.0;  ///< of squares, each 1 on average where noise and covariance are true
    int degrees = 0, attitudes = 0;
    bool within(double mean_square) const noexcept;
  };
  Fit fit(const Terms& terms, SensorSet set, double tolerance_mps2) const noexcept;
  double least_tolerance_mps2(const Terms& terms, SensorSet posed) const noexcept;

  Flag corroborated_;
  int clean_run_ = 0;
  int size_ = 0;
  std::array<Entry, kMost> entry_{};
  CalibrationFinding finding_;

  friend struct FieldsOf;
  int size() const noexcept { return size_; }
  static constexpr auto fields() noexcept {
    using C = CalibrationCheck;
    return field_list(&C::corroborated_, within(&C::clean_run_, 0, kBelieved), within(&C::size_, 0, kMost),
                      counted(&C::entry_, &C::size), &C::finding_);
  }
};

}  // namespace PLUMB_ABI
}  // namespace plumb

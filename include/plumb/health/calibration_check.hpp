/// Does the calibration keep what its covariance promises? Asked of the first attitudes after power-on or adoption,
/// before anybody is excluded by limits that rest on it: one faulty sensor leaves the others consistent everywhere, a
/// covariance that is ten times too small leaves no sensor so.
#pragma once

#include <array>
#include <cstdint>

#include "plumb/core/config.hpp"
#include "plumb/core/detail/fields.hpp"
#include "plumb/core/detail/flag.hpp"
#include "plumb/core/sensor_set.hpp"
#include "plumb/core/units.hpp"
#include "plumb/core/vec3.hpp"
#include "plumb/detection/set_test.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

/// What is reported of a calibration that its first attitudes contradict.
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
  /// Gravity has been set anew: what was read under the former value does not go with what follows. A doubt stays until
  /// the next attitude is judged.
  void forget_readings() noexcept {
    size_ = 0;
    next_ = SensorSet{};
  }
  /// The sensors in service are others.
  void forget_doubt() noexcept { doubted_ = finding_.refused; }

  /// Until enough attitudes agree to close it: exclusions ask for more than the limits, and attitudes are added.
  bool open() const noexcept { return !closed_; }
  /// What is on record is seldom seen of a calibration that is right, and does not rest on enough to be reported; or is
  /// refused.
  bool doubted() const noexcept { return doubted_; }
  /// Something agreed with the calibration, if only at a few attitudes.
  bool corroborated() const noexcept { return corroborated_; }
  bool refused() const noexcept { return finding_.refused; }
  /// One block more, clean or not. Where so many in a row are clean the tool shows no more attitudes than it has, and
  /// what it is trusted for is those.
  static constexpr int kBelieved = 12;
  void count(bool clean) noexcept { clean_run_ = !clean ? 0 : clean_run_ < kBelieved ? clean_run_ + 1 : kBelieved; }
  bool believed() const noexcept { return !gathers() || clean_run_ == kBelieved; }
  /// There are attitudes to come that have to tell before anything rests on the calibration.
  bool gathers() const noexcept { return !corroborated_ && (size_ < kMost || searches()); }
  const CalibrationFinding& finding() const noexcept { return finding_; }
  float tolerance_mps2() const noexcept { return static_cast<float>(finding_.tolerance_mps2); }

  /// Keeps what `block` read along `direction`, if no attitude on record is within `apart_rad` of it: true where it
  /// did. The oldest makes room.
  bool add(const Vec3& direction, const BlockEvidence& block, double apart_rad) noexcept;
  /// Whether `monitored` without `isolated` agree with themselves and, up to one offset, with gravity at all attitudes
  /// on record, there are enough of them to say so, and they would not do so by chance if all were off alike.
  bool corroborates(const Terms& terms, SensorSet monitored, SensorSet isolated) const noexcept;
  /// What the attitudes on record say together, after one more: whether the calibration is believed (all agree at some
  /// of them, and no `episode` is open), whether the check is over (they do so at `kLeast`), whether there is doubt,
  /// and whether to search for who could be at fault.
  void weigh(const Terms& terms, SensorSet monitored, SensorSet in_service, bool episode) noexcept;
  /// The search for a fault of at most `grade` sensors that explains what is on record, a bounded part of it in each
  /// block. No attitude is added meanwhile.
  bool searches() const noexcept { return !next_.empty(); }
  /// One part. True where the last of them found none: the finding is made, and tolerance learned or the calibration
  /// refused.
  bool search(const Terms& terms, SensorSet monitored, int grade) noexcept;

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
    int tests = 0;  ///< of a set at an attitude: the work that it was
    bool within(double mean_square) const noexcept;
  };
  /// Where the residuals come to more than `most` per degree of freedom, the rest of them may be omitted.
  static constexpr double kAll = 1e300;
  Fit fit(const Terms& terms, SensorSet set, double tolerance_mps2, double most = kAll) const noexcept;
  /// How many numbers, drawn once for a tool, its errors at the attitudes on record amount to.
  double independent(const Fit& found, SensorSet set) const noexcept;
  bool explained_without(const Terms& terms, SensorSet monitored, SensorSet faulty, int& tests) const noexcept;
  void contradict(const Terms& terms, SensorSet monitored) noexcept;
  double least_tolerance_mps2(const Terms& terms, SensorSet monitored) const noexcept;

  Flag corroborated_, closed_, doubted_;
  int clean_run_ = 0;
  int size_ = 0;
  SensorSet next_, searched_;  ///< fault set to be tried next, none: no search; among whom
  std::array<Entry, kMost> entry_{};
  CalibrationFinding finding_;

  friend struct FieldsOf;
  bool plausible() const noexcept { return doubted_ || !finding_.refused; }
  int size() const noexcept { return size_; }
  static constexpr auto fields() noexcept {
    using C = CalibrationCheck;
    return field_list(&C::corroborated_, &C::closed_, &C::doubted_, within(&C::clean_run_, 0, kBelieved),
                      within(&C::size_, 0, kMost), &C::next_, &C::searched_, counted(&C::entry_, &C::size),
                      &C::finding_);
  }
};

}  // namespace PLUMB_ABI
}  // namespace plumb

/// `SensorArray`: which rows measure what. Single-axis accelerometers with unit axes h_i on one rigid
/// body measure y = H g + e (paper eq 4), H is n x 3, in the tool frame, SI units.
#pragma once

#include <array>
#include <cstdint>

#include "plumb/array/sensor_units.hpp"
#include "plumb/core/config.hpp"
#include "plumb/core/detail/fields.hpp"
#include "plumb/core/error.hpp"
#include "plumb/core/sensor_set.hpp"
#include "plumb/core/vec3.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

/// Name of a sensor, at most 15 characters, zero padded.
using SensorId = std::array<char, 16>;
SensorId make_id(const char* text) noexcept;

/// One row of the measurement matrix.
struct SensorRow {
  SensorId id{};
  Vec3 axis{};              ///< unit vector in the tool frame
  double sigma_mps2 = 0.0;  ///< white noise of one sample, 1 sigma
  /// Sensors of one chip, which may fail together, bear the same number; 0: a unit of its own.
  std::uint8_t chip = 0;

  /// A monitor that calibrates itself first turns axes.
  static constexpr auto fields() noexcept {
    return field_list(not_stored(&SensorRow::id), &SensorRow::axis, &SensorRow::sigma_mps2,
                      not_stored(&SensorRow::chip));
  }
};

/// z_p z_q of z = (g, 1), row by row.
struct AttitudeProducts {
  explicit AttitudeProducts(const Vec3& g_mps2) noexcept;
  std::array<double, 16> value;
};

/// What calibration leaves in every row: covariance of (axis error [m/s^2 per m/s^2], offset error
/// [m/s^2]), four numbers a sensor, packed lower triangle over 4n; plus a per-sensor misfit that no
/// parameter explains. All zero for a perfectly known array. The length of gravity where the array was calibrated is
/// not part of the covariance (docs/theory.md, section 3.3): an error of it scales all rows alike, which no parity
/// sees.
struct RowUncertainty {
  static constexpr int kSize = 4 * kCapacity * (4 * kCapacity + 1) / 2;
  std::array<double, kSize> covariance{};       ///< SI; entry (a,b), a >= b, at a(a+1)/2+b
  std::array<double, kCapacity> misfit_mps2{};  ///< 1 sigma per sensor and attitude
  double common_scale = 0.0;                    ///< 1 sigma of that gravity, relative

  /// Covariance of the errors of sensors i and j at gravity vector g [m/s^2]: z' Cov_ij z with
  /// z = (g, 1), plus misfit^2 where i == j. docs/theory.md, section 3.3. [(m/s^2)^2]
  double at(int i, int j, const Vec3& g_mps2) const noexcept { return at(i, j, AttitudeProducts(g_mps2)); }
  /// The same for many pairs at one attitude.
  double at(int i, int j, const AttitudeProducts& attitude) const noexcept;
  /// Without the misfit: what the parameters leave, the same in every tool that is at this attitude again.
  double of_parameters_at(int i, int j, const AttitudeProducts& attitude) const noexcept;

  static constexpr int packed_size(int sensors) noexcept { return 4 * sensors * (4 * sensors + 1) / 2; }
  /// True where all that concerns the first `sensors` rows is zero.
  bool is_zero(int sensors) const noexcept;
  /// Those of the first `sensors` whose bias has no variance, or whose scale and axis have none, whatever their misfit.
  SensorSet without_variance(int sensors) const noexcept;
  /// No variance, that of a misfit included, below zero or so large that nothing is known (1e12), no covariance beyond
  /// what its two variances allow, but for rounding.
  bool is_covariance() const noexcept;
  static constexpr auto fields() noexcept {
    return field_list(leading(&RowUncertainty::covariance, &packed_size), per_sensor(&RowUncertainty::misfit_mps2),
                      &RowUncertainty::common_scale);
  }
};

/// Three sensors and what they can do together.
struct Triple {
  std::array<std::uint8_t, 3> sensors{};
  bool votes = false;      ///< |det| >= kMinTripleDet: may raise a MAE alarm
  double det = 0.0;        ///< determinant of the three axes
  double condition = 0.0;  ///< ratio of the extreme singular values

  SensorSet set() const noexcept {
    return SensorSet::of(sensors[0]) | SensorSet::of(sensors[1]) | SensorSet::of(sensors[2]);
  }
  static constexpr auto fields() noexcept {
    return field_list(&Triple::sensors, &Triple::votes, any(&Triple::det), any(&Triple::condition));
  }
};

/// |x|^2 = y'Ay of a triple: A11, A22, A33, 2 A12, 2 A13, 2 A23 (eqs 22-25).
using TripleForm = std::array<double, 6>;

inline constexpr double kMinTripleDet = 0.05;
/// Beyond this ratio of the sigmas of an array the precise sensors alone would decide, and normal matrices lose digits.
inline constexpr double kMaxSigmaRatio = 300.0;
/// A third axis within this sine of the plane of two others counts as lying in it (coplanarity c).
inline constexpr double kPlaneTolerance = 0.05;
inline constexpr double kAxisLengthTolerance = 1e-6;

class SensorArray {
 public:
  /// Checks and builds. Errors: too_few_sensors, too_many_sensors, axis_not_unit (index),
  /// axes_rank_deficient, duplicate_id (index), empty_id, sigma_not_positive (index), not_finite.
  /// Parallel axes are allowed (arrays of triads), duplicate ids are not.
  ///
  ///   plumb::SensorRow rows[4];
  ///   for (std::size_t i = 0; i < 4; ++i) rows[i] = {plumb::make_id(ids[i]), axes[i], sigma_mps2};
  ///   const plumb::Expected<plumb::SensorArray> array = plumb::SensorArray::make(rows, 4);
  ///   if (!array) std::puts(plumb::remedy(array.error().code));
  static Expected<SensorArray> make(const SensorRow* rows, int n) noexcept;

  /// An empty array (size 0): a placeholder inside states that are filled later.
  SensorArray() noexcept = default;

  int size() const noexcept { return size_; }
  SensorSet all() const noexcept { return SensorSet::first(size_); }
  const SensorRow& row(int i) const noexcept { return rows_[static_cast<std::size_t>(i)]; }
  const Vec3& axis(int i) const noexcept { return row(i).axis; }
  double sigma_mps2(int i) const noexcept { return row(i).sigma_mps2; }
  /// What may fail at once.
  const SensorUnits& units() const noexcept { return units_; }

  /// All C(n,3) triples in lexicographic order, near-singular ones included.
  int triple_count() const noexcept { return triple_count_of(size_); }
  const Triple& triple(int k) const noexcept { return triples_[static_cast<std::size_t>(k)]; }
  TripleForm form(int k) const noexcept;
  /// Coefficient c of the forms of all triples, one after the other: the kernel takes several triples at once.
  const double* form_coefficients(std::size_t c) const noexcept { return form_[c].data(); }
  /// Index of the triple {i,j,k}, i < j < k; -1 where the three are no triple of this array.
  int triple_index(int i, int j, int k) const noexcept;

  const RowUncertainty& uncertainty() const noexcept { return uncertainty_; }
  void set_uncertainty(const RowUncertainty& u) noexcept;
  /// Entry (a, b) of the covariance of all rows, 4n x 4n, the common scale included.
  double row_covariance(int a, int b) const noexcept;
  /// True where calibration leaves nothing open: every entry of `uncertainty` that concerns a row is zero.
  bool perfectly_known() const noexcept { return perfectly_known_; }
  /// The sensors whose row counts as exact: a calibration was to state what it leaves of them, and states zero.
  SensorSet taken_for_exact() const noexcept { return taken_for_exact_; }
  /// As many rows as there are, in place of those that there are; the uncertainty stays. Errors: those of `make`, and
  /// nothing has changed.
  Expected<void> set_rows(const SensorRow* rows) noexcept;

 private:
  void derive() noexcept;

  friend struct FieldsOf;
  void rebuild() noexcept;
  void see_what_is_exact() noexcept;
  bool plausible() const noexcept;
  static constexpr auto fields() noexcept {
    return field_list(per_sensor(&SensorArray::rows_), not_stored(&SensorArray::triples_),
                      not_stored(&SensorArray::form_), &SensorArray::uncertainty_, not_stored(&SensorArray::size_),
                      not_stored(&SensorArray::perfectly_known_), not_stored(&SensorArray::taken_for_exact_),
                      not_stored(&SensorArray::units_));
  }

  std::array<SensorRow, kCapacity> rows_{};
  std::array<Triple, kTripleCapacity> triples_{};
  std::array<std::array<double, kTripleCapacity>, 6> form_{};
  RowUncertainty uncertainty_{};
  int size_ = 0;
  bool perfectly_known_ = true;
  SensorSet taken_for_exact_;
  SensorUnits units_;
};

}  // namespace PLUMB_ABI
}  // namespace plumb

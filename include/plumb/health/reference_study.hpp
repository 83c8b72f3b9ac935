/// Parity good, length off: is it gravity or a common scale, which leave the direction alone, or a bias that all
/// sensors share, which turns it? One attitude cannot tell; several can, and where they cannot, the answer is
/// "undecided".
#pragma once

#include <array>
#include <cstdint>

#include "plumb/core/config.hpp"
#include "plumb/core/detail/fields.hpp"
#include "plumb/core/units.hpp"
#include "plumb/core/vec3.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

enum class NormMismatchKind : std::uint8_t {
  none,          ///< the length is not off
  undecided,     ///< too few attitudes, or neither explanation holds alone
  common_scale,  ///< common scale or gravity: the direction is usable within `turn_rad`
  common_bias,   ///< a bias along `bias_mps2`: the direction is not usable
};
const char* to_string(NormMismatchKind kind) noexcept;

struct NormMismatch {
  NormMismatchKind kind = NormMismatchKind::none;
  int attitudes = 0;
  double length_mps2 = 0.0;        ///< kappa G: what is off alike at every attitude
  double length_bound_mps2 = 0.0;  ///< of its error; 0 = none found
  double configure_mps2 = 0.0;     ///< common_scale: the length of gravity to configure; 0 = none found
  double widened_mps2 = 0.0;       ///< by so much the monitor has widened what it takes gravity to be known to
  Vec3 bias_mps2{};                ///< a: what is off along a direction, tool frame
  double turn_rad = 0.0;  ///< most that `a` and the acceleration allowed for can turn the direction; 0 = no bound yet

  static constexpr int kMostAttitudes = 12;
  static constexpr auto fields() noexcept {
    using F = NormMismatch;
    return field_list(up_to(&F::kind, NormMismatchKind::common_bias), within(&F::attitudes, 0, kMostAttitudes),
                      any(&F::length_mps2), any(&F::length_bound_mps2), any(&F::configure_mps2), any(&F::widened_mps2),
                      any(&F::bias_mps2), any(&F::turn_rad));
  }
};

/// What the monitor widens its gravity by for an offset that it has found; farther off it is reported and not believed.
inline constexpr double kMostGravityOffset_mps2 = 1e-2 * kG0_mps2;

/// |x| - G at up to kMax attitudes against kappa G + a.u. Errors are taken as bounded, not as random: what calibration
/// leaves is the same at every block, and averages away over none.
class ReferenceStudy {
 public:
  static constexpr int kMax = NormMismatch::kMostAttitudes;
  /// Four parameters and two attitudes that can contradict them.
  static constexpr int kLeast = 6;

  void clear() noexcept { *this = ReferenceStudy{}; }
  /// Whether one length that is off alike everywhere explains this attitude beside those on record.
  bool agrees(double length_error_mps2, double bound_mps2) const noexcept;
  bool empty() const noexcept { return size_ == 0; }
  /// `bound_mps2`: largest error of |x| - G that noise and calibration explain. An attitude nearer than `apart_rad` to
  /// one on record is no change: true where it was.
  /// `noise_mps2`: the part of the bound that is noise, and averages away over the attitudes.
  bool add(const Vec3& direction, double length_error_mps2, double bound_mps2, double apart_rad,
           double noise_mps2 = 0.0) noexcept;
  /// `gravity_bound_mps2`: largest credible error of the gravity reference. `usable_rad`: turn that the user can bear.
  NormMismatch find(double g_mps2, double gravity_bound_mps2, double usable_rad) const noexcept;

 private:
  /// In single precision: 6e-8 is nothing to a direction, nor to what a length is off by.
  struct Entry {
    std::array<float, 3> u{};
    float off_mps2 = 0.0F, bound_mps2 = 0.0F, noise_mps2 = 0.0F;

    Vec3 direction() const noexcept {
      return {static_cast<double>(u[0]), static_cast<double>(u[1]), static_cast<double>(u[2])};
    }
    double off() const noexcept { return static_cast<double>(off_mps2); }
    double bound() const noexcept { return static_cast<double>(bound_mps2); }
    double noise() const noexcept { return static_cast<double>(noise_mps2); }
    bool plausible() const noexcept { return bound_mps2 > 0.0F && noise_mps2 >= 0.0F; }
    static constexpr auto fields() noexcept {
      return field_list(&Entry::u, &Entry::off_mps2, &Entry::bound_mps2, &Entry::noise_mps2);
    }
  };
  int size_ = 0;
  std::array<Entry, kMax> entry_{};

  friend struct FieldsOf;
  int size() const noexcept { return size_; }
  static constexpr auto fields() noexcept {
    return field_list(within(&ReferenceStudy::size_, 0, kMax), counted(&ReferenceStudy::entry_, &ReferenceStudy::size));
  }
};

}  // namespace PLUMB_ABI
}  // namespace plumb

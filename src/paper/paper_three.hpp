/// The step of the paper's fit for three sensors, in a fraction of the time of the general one. Private to the
/// calibration module.
///
/// The vector x is affine in the three readings, and each derivative of |x|^2 is x times something affine in one
/// reading: a quadratic of the readings that vanishes where x does. Nine coefficients say all of such a quadratic, so
/// that J = F K, with F the nine monomials at each station and K the coefficients of each derivative, both of full
/// rank. The step of smallest norm is then -K^+ F^+ e. F'F comes from moments of the readings that no parameter
/// enters; what is left of a step over the stations is the error itself.
#pragma once

#include "paper_step.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace paper {

class ThreeSensorStep {
 public:
  /// Whether the fit has this form: three sensors whose bias drifts alike at all stations (one temperature, or no
  /// drift in the datasheet).
  bool begin(const Problem& problem) noexcept;

  /// The cost at theta, and what `step` and `shows_all` need of the stations there.
  double look(const Problem& problem, const PaperParameters& theta) noexcept;

  /// From where `look` was last. False where F or K is so uneven that it may not have full rank.
  bool step(const Problem& problem, PaperParameters& out) noexcept;

  /// Whether all nine singular values of J in prior units are beyond doubt above `floor` times the largest, where
  /// `look` was last. False does not say that they are not.
  bool shows_all(const Problem& problem, double floor) noexcept;

 private:
  static constexpr int kSensors = 3;
  static constexpr int kSize = paper_parameters(kSensors);
  static constexpr int kStride = 12;  ///< nine coefficients and the constant, in fours
  using Column = std::array<double, kStride>;
  using Matrix = std::array<double, std::size_t{kStride} * kStride>;

  /// Of three readings u: slope . u + constant.
  struct Affine {
    Vec3 slope{};
    double constant = 0.0;
  };

  static Column monomials(const Vec3& u) noexcept;
  static void product(const Affine& a, int sensor, double slope, double constant, double prior, Column& out) noexcept;
  void set_coefficients(const Problem& problem) noexcept;
  void set_squares(const Problem& problem) noexcept;
  bool factorise() noexcept;

  double g_mps2_ = 0.0;
  Vec3 drift_{};      ///< B* at the start [m/s^2]: the readings that the moments are of have it taken off
  Matrix moments_{};  ///< lower triangle; the last row is that of the constant
  Vec3 scale_{};      ///< now, of a reading before its bias over one of the moments [m/s^2]
  Vec3 shrink_{};     ///< its inverse
  Vec3 offset_{};     ///< its part from drift_ [m/s^2]
  Vec3 now_{};        ///< B* where `look` was
  Vec3 inverse_{};    ///< 1 / SF there
  std::array<Vec3, kSensors> column_{};
  Column slope_{};                           ///< sum of error times monomials
  std::array<Column, kSize> coefficient_{};  ///< K, prior units
  Column origin_{};                          ///< monomials where x vanishes
  Matrix stations_{};                        ///< F'F, then its factor or inverse
  Matrix parameters_{};                      ///< K K', the same
};

}  // namespace paper
}  // namespace PLUMB_ABI
}  // namespace plumb

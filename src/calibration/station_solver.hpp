/// One station after the other: its rows, the direction of gravity that explains them, and what is left. Private to the
/// calibration module.
#pragma once

#include "fit_internal.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace fit {

/// Below this part of its weight a row has no residual of its own: it is wanted for the vector.
inline constexpr double kOwnResidual = 1e-6;

enum class Loaded : std::uint8_t { used, skipped, not_finite };

/// Channels of a station that the fit may use: delivered, and inside the full scale where the datasheet knows it.
SensorSet usable_channels(const Datasheet& datasheet, const Station& station) noexcept;
bool independent(const Datasheet& datasheet, SensorSet delivered) noexcept;
int usable_stations(const Problem& problem) noexcept;

/// The residual of a station across the tangents of the sphere |g| = G falls into a norm row and n - 3 parity rows
/// (docs/theory.md, section 9.2). With weights L and A = (W'LW)^-1: x = A W'L (r - b), the parity part is p = r - W x -
/// b, the norm residual is (u'x - G) / sqrt(u'Au) along normal = L W A u / sqrt(u'Au), u the fitted direction; the
/// projector is L - LWAW'L + normal normal'. All but `normal` is shared by stations with the same sensors and count,
/// and kept.
class StationSolver {
 public:
  StationSolver(const Problem& problem, const Parameters& theta, double misfit_variance) noexcept;

  /// Fills `rows` to `estimate`. Skipped: no samples, or fewer than three independent rows.
  Loaded read(const Station& station) noexcept;
  /// The same, then the rest.
  Loaded solve(const Station& station) noexcept;

  int rows = 0;
  std::array<int, kCapacity> sensor{};      ///< ascending
  std::array<double, kCapacity> weight{};   ///< 1 / variance of the mean
  std::array<Vec3, kCapacity> row{};        ///< W_i
  Symmetric3 spread{};                      ///< A
  double limit_squared = 0.0;               ///< of chi^2: an outlier beyond it
  std::array<double, kCapacity> reading{};  ///< r - b [m/s^2], by row
  Vec3 estimate{};                          ///< x

  std::array<double, kCapacity> parity{};  ///< p
  std::array<double, kCapacity> normal{};
  double norm_residual = 0.0;  ///< unit variance
  double chi2 = 0.0;
  Vec3 direction{};    ///< u
  Vec3 gravity{};      ///< G u
  double along = 0.0;  ///< u'Au

  /// L - LWAW'L + normal normal', k >= l.
  double projector(int k, int l) const noexcept {
    return shared_[at(k * (k + 1) / 2 + l)] + normal[at(k)] * normal[at(l)];
  }
  /// Projector times residual.
  double projected(int k) const noexcept { return weight[at(k)] * parity[at(k)] + normal[at(k)] * norm_residual; }
  /// r - W g - b.
  double residual(int k) const noexcept { return parity[at(k)] + dot(row[at(k)], minus(estimate, gravity)); }
  /// Of the fitted direction [rad^2], both tangents together: trace of A - A u u'A / u'Au.
  double direction_variance() const noexcept;
  /// Dimension of the residual.
  int freedom() const noexcept { return rows - 2; }

 private:
  void set_rows(SensorSet delivered, std::uint32_t count) noexcept;
  void set_temperature(double temperature_degc) noexcept;
  void find_direction() noexcept;

  const Problem& problem_;
  const Parameters& theta_;
  double misfit_variance_;
  double inverse_g_;
  bool clips_ = false;  ///< some full scale is known
  SensorSet delivered_;
  std::uint32_t count_ = 0;  ///< 0: nothing is kept yet
  bool independent_ = false;
  double temperature_degc_ = 0.0;
  bool tempered_ = false;
  std::array<double, kCapacity> gain_{};    ///< sign / SF* by sensor
  std::array<double, kCapacity> offset_{};  ///< sign B* + b
  std::array<Vec3, kCapacity> map_{};       ///< A W_i L_i
  std::array<double, std::size_t{kCapacity} * (kCapacity + 1) / 2> shared_{};
};

/// Beyond this many standard deviations a station is an outlier, and beyond the other its pull is held (Huber).
/// `freedom` = 1 and 2 are the usual 95 % constants (docs/theory.md, section 9.6). A residual of more dimensions is
/// longer by nature; the outlier limit stays three times the other, for real misfit is no noise and differs from sensor
/// to sensor.
double outlier_limit(int freedom) noexcept;
double huber_limit(int freedom) noexcept;

/// Weight of a station whose residual has this squared length.
double pull_of(Loss loss, double chi2, int freedom) noexcept;

/// Adds a solved station to the sums that need no derivatives.
void note_station(const StationSolver& station, double pull, Sums& sums) noexcept;

/// Tells the outliers among the stations where the problem has a screen.
class Screening {
 public:
  explicit Screening(const Problem& problem) noexcept;
  /// True where the station is out. `solver` then holds its residual.
  bool out(const Station& station) noexcept;
  StationSolver solver;

 private:
  bool active_;
};

}  // namespace fit
}  // namespace PLUMB_ABI
}  // namespace plumb

/// The paper's own auto-calibration, kept beside the forward fit so that its method can be run, shown and
/// compared: eqs (7), (10), (11), (12). It sees gravity's length alone, so its Hessian is singular (rank 9 whatever n
/// is; calibration note 1). Departure that makes it solvable at all: the step of eq (11) is the minimum-norm step of
/// fixed rank 9 in prior-scaled parameters, and the stop rule of eq (12) has an absolute floor.
#pragma once

#include <array>

#include "plumb/calibration/calibration.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

/// Parameters of eq (3) for n sensors: n biases, n scale factors, n(n-1) misalignments.
constexpr int paper_parameters(int n) noexcept { return n * (n + 1); }

/// Up to this many sensors the paper's fit is offered (its misalignments grow as n squared).
inline constexpr int kPaperCapacity = kCapacity < 8 ? kCapacity : 8;
inline constexpr int kPaperParameters = paper_parameters(kPaperCapacity);

/// One iteration of eq (11), as Figs 4 to 10 draw it.
struct PaperIteration {
  std::array<double, kPaperParameters>
      parameter{};      ///< B_1..B_n [m/s^2], SF_1..SF_n [raw per m/s^2], m_12, m_13, ... row by row
  double cost = 0.0;    ///< E_g of eq (10) [(m/s^2)^4]
  double change = 0.0;  ///< left side of eq (12)
};

enum class PaperStep : std::uint8_t {
  minimum_norm,   ///< Gauss-Newton, pseudo-inverse of fixed rank: the default
  plain_inverse,  ///< eq (11) as printed, inverse of the full Hessian: documents what it does, for nothing else
};

struct PaperOptions {
  PaperStep step = PaperStep::minimum_norm;
  double damping = 1.0;  ///< alpha of eq (11)
  double stop = 1.5e-6;  ///< epsilon of eq (12)
  int max_iterations = 100;
};

inline constexpr int kMaxPaperIterations = 100;

/// Every iteration of a fit, the start first; `size` entries are filled.
struct PaperTrace {
  int size = 0;
  std::array<PaperIteration, kMaxPaperIterations + 1> iteration{};
};

/// A fit of the sensors `used` (three or all) by the paper's method.
struct PaperFit {
  SensorSet used;
  SensorModel model;  ///< eqs (1)-(3) with misalignments, over the nominal axes; entries of other sensors untouched
  bool converged = false;  ///< the stop rule of eq (12) was met
  int iterations = 0;
  double cost = 0.0;  ///< E_g at the end
  int rank = 0;       ///< of the prior-scaled Jacobian at the end
};

/// Fits the sensors in `used` (rank 3, at most kPaperCapacity of them) to the stations, starting from the datasheet.
/// Errors: too_few_stations, too_many_sensors, axes_rank_deficient, not_finite, out_of_range (an option).
/// A fit that did not converge is returned with `converged` false: showing that is what this room is for.
Expected<void> paper_calibrate(const Datasheet& datasheet, const GravityReference& gravity, const Station* stations,
                               int count, SensorSet used, const PaperOptions& options, PaperFit& out,
                               PaperTrace* trace = nullptr) noexcept;

/// Vector from the readings of the fitted sensors: eq (3), then eq (5) over the nominal axes of `used`.
Vec3 paper_vector(const SensorArray& nominal, const PaperFit& fit, const std::array<double, kCapacity>& raw,
                  double temperature_degc) noexcept;

/// What paper mode monitors with: the fit of all sensors and, per triple of the array, a fit of its own (step 1).
struct PaperCalibration {
  PaperFit all;
  int triples = 0;
  std::array<PaperFit, triple_count_of(kPaperCapacity)> triple{};  ///< in the order of SensorArray::triple
};

}  // namespace PLUMB_ABI
}  // namespace plumb

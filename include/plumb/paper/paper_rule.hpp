/// The paper's detection and isolation, steps 2 to 9 of its algorithm, as it is printed: a gate on the mean absolute
/// error of all sensors, then of every triple with coefficients of its own, one limit delta_F for all, the union of the
/// passing triples. Kept so that it can be run and compared; plumb's own decisions are in `isolation.hpp`. Where its
/// claims stop holding: one attitude (undetected directions, mirrors), faults below delta_F, more faults than n - 3.
#pragma once

#include <array>
#include <cstdint>

#include "plumb/detection/combination_mae.hpp"
#include "plumb/paper/paper_calibration.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

/// delta_F of the paper's drilling tests: 0.05 g0.
inline constexpr double kPaperDeltaF_mps2 = 0.05 * kG0_mps2;

/// The paper's mean absolute error over any number of samples. The sum is kept in units of kMaeUnit_mps2, so that it is
/// exact whatever the order, and a NaN counts as the largest error there is.
struct PaperMae {
  std::int64_t sum = 0;
  int samples = 0;

  void add(double error_mps2) noexcept;
  double mps2() const noexcept;  ///< 0 without samples
};

/// The fits that sensors are read with; all three must outlive it.
struct PaperFits {
  const SensorArray& nominal;
  const PaperCalibration& calibration;  ///< of all sensors and of every triple (step 1)
  const PaperFit& rest;                 ///< of those that remain after an exclusion (step 10); not sound: none

  /// The fit of exactly these sensors, null where there is no sound one.
  const PaperFit* own(SensorSet in_use) const noexcept;
};

/// Vector of the sensors in use [m/s^2], by the fit of exactly these sensors where there is one (three
/// sensors: that of their triple, step 11); else by the fit of all, least squares over those in use, without the cross
/// terms of the others: nothing that an excluded sensor says gets in.
Vec3 paper_vector_in_use(const PaperFits& fits, const std::array<double, kCapacity>& raw, double temperature_degc,
                         SensorSet in_use) noexcept;

/// Whether a fit made in flight may take over (step 10): sound, every scale and bias as near to the datasheet as an
/// initial fit must stay (FitOptions), and the length of gravity within delta_F over its stations.
bool may_replace(const PaperFit& fit, const Datasheet& datasheet, double g_mps2, double delta_f_mps2) noexcept;

/// What the paper's rule says of the pooled samples.
struct PaperFinding {
  bool detected = false;      ///< MAE of the sensors in use >= delta_F, eq (15)
  double mae_all_mps2 = 0.0;  ///< mean over the sensors in use
  int triples = 0;            ///< with a sound fit and all members in use
  int passing = 0;            ///< of them, those with MAE < delta_F
  double worst_mps2 = 0.0;    ///< largest MAE among them
  /// Mean of each triple by its own fit, in the order of SensorArray::triple; 0 for a triple that is not in use.
  std::array<double, triple_count_of(kPaperCapacity)> mae_triple_mps2{};
  SensorSet correct;   ///< union of the passing triples
  SensorSet isolated;  ///< in use, detected, and in no passing triple; empty where no triple passes
};

/// Pools samples (of one attitude or of several) and judges them together.
class PaperRule {
 public:
  void clear() noexcept { *this = PaperRule{}; }
  /// Adds one sample in which all of `in_use` delivered. The set must stay the same until `clear`.
  void add(const PaperFits& fits, double g_mps2, const std::array<double, kCapacity>& raw, double temperature_degc,
           SensorSet in_use) noexcept;
  PaperFinding finding(const PaperFits& fits, double delta_f_mps2, SensorSet in_use) const noexcept;
  int samples() const noexcept { return all_.samples; }
  double mae_all_mps2() const noexcept { return all_.mps2(); }

 private:
  PaperMae all_;
  std::array<PaperMae, triple_count_of(kPaperCapacity)> triple_{};
};

}  // namespace PLUMB_ABI
}  // namespace plumb

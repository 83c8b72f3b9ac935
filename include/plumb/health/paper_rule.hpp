/// The paper's detection and isolation, steps 2 to 9 of its algorithm, as it is printed: a gate on the mean absolute
/// error of all sensors, then of every triple with coefficients of its own, one limit delta_F for all, the union of the
/// passing triples. Kept so that it can be run and compared; plumb's own decisions are in `isolation.hpp`. Where its
/// claims stop holding: one attitude (blind directions, mirrors), faults below delta_F, more faults than n - 3.
#pragma once

#include <array>
#include <cstdint>

#include "plumb/calibration/paper_calibration.hpp"
#include "plumb/detection/combination_mae.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

/// delta_F of the paper's drilling tests: 0.05 g0.
inline constexpr double kPaperDeltaF_mps2 = 0.05 * kG0_mps2;

/// What the paper's rule says of a window.
struct PaperFinding {
  bool detected = false;      ///< MAE of the sensors in use >= delta_F, eq (15)
  double mae_all_mps2 = 0.0;  ///< eq (14) over the sensors in use
  int triples = 0;
  std::array<double, triple_count_of(kPaperCapacity)> mae_triple_mps2{};  ///< eqs (26)-(29); order of SensorArray
  int passing = 0;                                                        ///< triples in use with MAE < delta_F
  SensorSet correct;                                                      ///< union of the passing triples
  SensorSet isolated;  ///< in use, detected, and in no passing triple; empty where no triple passes
};

/// Pools samples (of one attitude or of several) and judges them together.
class PaperRule {
 public:
  /// `calibration` must outlive the rule; `in_use` are the sensors not excluded before.
  PaperRule(const SensorArray& nominal, const PaperCalibration& calibration, double g_mps2,
            double delta_f_mps2) noexcept
      : nominal_(&nominal), calibration_(&calibration), g_mps2_(g_mps2), delta_f_mps2_(delta_f_mps2) {}

  void clear() noexcept;
  /// Adds one sample's raw values. With exactly three sensors in use "all" is their triple (step 11); with more than
  /// three but not all, the least squares of their readings by the fit of all sensors.
  void add(const std::array<double, kCapacity>& raw, double temperature_degc, SensorSet in_use) noexcept;
  PaperFinding finding(SensorSet in_use) const noexcept;
  int samples() const noexcept { return samples_; }

 private:
  const SensorArray* nominal_;
  const PaperCalibration* calibration_;
  double g_mps2_;
  double delta_f_mps2_;
  std::int64_t all_sum_ = 0;  ///< units of kMaeUnit_mps2: exact whatever the order
  std::array<std::int64_t, triple_count_of(kPaperCapacity)> triple_sum_{};
  int samples_ = 0;
};

}  // namespace PLUMB_ABI
}  // namespace plumb

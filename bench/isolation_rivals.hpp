// The rules that others use, on the evidence that plumb sees: the paper's union of passing triples, the generalised
// likelihood test, exhaustive leave-m-out and the best fit. For comparison only; none of them is in the library.
#pragma once

#include <array>
#include <vector>

#include "isolation_runs.hpp"
#include "plumb/detection/isolation.hpp"

namespace plumb_bench {
namespace PLUMB_ABI {

/// One station: the single samples for the paper's mean absolute errors, their mean for the rest.
struct StationSamples {
  std::vector<plumb::Readings> sample;
  plumb::BlockEvidence block;
};

/// Sums over the stations of a trial, from which every rival answers. They are told the exact gravity and the noise,
/// and their limits hold at a rate of 1e-6 for the sums.
class Rivals {
 public:
  Rivals(const plumb::SensorArray& array, double g_mps2, int stations, int samples_per_station);
  void clear();
  void add(const StationSamples& station);
  /// Who is to blame, by that rule; empty where it cannot say or sees nothing.
  plumb::SensorSet answer(Rule rule) const;

 private:
  plumb::SensorSet union_of_triples() const;
  plumb::SensorSet greedy() const;
  plumb::SensorSet leave_out() const;
  plumb::SensorSet best_fit() const;
  double limit(int degrees_of_freedom) const { return chi2_[static_cast<std::size_t>(degrees_of_freedom)]; }

  plumb::SensorArray array_;
  plumb::GravityReference gravity_;
  plumb::TestLimits limits_;
  int stations_ = 0, samples_ = 0;
  std::vector<double> parity_, norm_;            ///< squared residuals, by the bits of a set
  std::vector<double> mae_sum_, norm_variance_;  ///< by triple; the last entry is that of all sensors
  plumb::LeastSquares all_;
  std::vector<double> chi2_;  ///< by degrees of freedom
  double mae_quantile_ = 0.0;
};

}  // namespace PLUMB_ABI
}  // namespace plumb_bench

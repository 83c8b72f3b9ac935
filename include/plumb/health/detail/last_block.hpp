/// The last block that was evidence, what it says, and what became of the ones since.
#pragma once

#include "plumb/detection/set_test.hpp"
#include "plumb/detection/stationarity.hpp"
#include "plumb/health/state.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

struct LastBlock {
  BlockEvidence evidence;
  double time_s = 0.0;                  ///< its end
  Vec3 gravity_mps2{};                  ///< of the sensors in service, output frame
  Mat3 covariance{};                    ///< of that
  double norm_error_mps2 = 0.0;         ///< its length less gravity's
  double statistic = 0.0, limit = 0.0;  ///< of the test that decided
  double noise_factor = 1.0;            ///< by which every limit of the block that ended last was widened
  double noise_correlation = 1.0;       ///< samples of it that are worth one independent one
  SensorSet usable;                     ///< delivered in every row of the block that ended last
  SensorSet calm;                       ///< and scattered by no more than noise
  SensorSet scattering;                 ///< scattered by more than noise
  bool known = false;                   ///< there is one
  bool moving = false;                  ///< the block that ended last was no evidence
  bool partial = false;       ///< a sensor in service was silent or doubted in it: no other sensor corroborates it
  Cause cause = Cause::none;  ///< of what the monitor did last

  /// What is kept of the rows of a block: which delivered, which were at rest.
  void note_rows(const BlockAccumulator& block, SensorSet delivered, const BlockNoise& noise,
                 double scatter_factor) noexcept {
    usable = delivered;
    calm = SensorSet{};
    for (int i = 0; i < kCapacity; ++i) {
      if (!usable.has(i)) continue;  // silent when the tool moved, it does not show that it rested
      if (block.size() < 2 || block.covariance(i, i) <= scatter_factor * noise.of(i)) calm = calm.with(i);
    }
  }

  static constexpr auto core() noexcept {
    return field_list(&LastBlock::known, &LastBlock::moving, &LastBlock::partial);
  }
  static constexpr auto fields() noexcept {
    using L = LastBlock;
    return field_list(&L::evidence, &L::time_s, &L::gravity_mps2, &L::covariance, &L::norm_error_mps2, &L::statistic,
                      &L::limit, &L::noise_factor, &L::noise_correlation, &L::usable, &L::calm, &L::scattering,
                      &L::known, &L::moving, &L::partial, up_to(&L::cause, kLastCause));
  }
};

}  // namespace PLUMB_ABI
}  // namespace plumb

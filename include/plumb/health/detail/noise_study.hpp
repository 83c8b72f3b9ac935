/// What the noise of the sensors is in truth, as blocks at rest show it: how many times the stated sigma, and how many
/// of the samples of a block are as good as independent. A healthy tool whose data sheet flatters it is then judged by
/// wider limits, and not called faulty.
#pragma once

#include <array>

#include "plumb/detection/combination_mae.hpp"
#include "plumb/detection/stationarity.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

/// Noise is learned as one factor for all sensors. What raises it must show in the scatter of most channels and in
/// their parity residuals: a movement of the tool does not show in parity, and one sensor that scatters is not most of
/// them. What shortens a block must show in triples of which some hold no faulty sensor. So no single sensor widens
/// the limits that it is judged by.
class NoiseStudy {
 public:
  static constexpr double kMostFactor = 3.0;  ///< what is noisier than this is no ordinary sensor
  /// Blocks over which the figures are averaged: a mean until then, after that the older ones fade.
  static constexpr double kMemoryBlocks = 64.0;
  static constexpr int kLeastWindow = 16;  ///< a shorter block does not show how smooth its noise is

  void clear() noexcept { *this = NoiseStudy{}; }
  /// One block of the sensors `used`, with their least squares and with the window of triples that ends with it. Left
  /// out, and false, where the channels scatter and their residuals do not: then the tool moves.
  bool add(const SensorArray& array, const BlockAccumulator& block, const LeastSquares& used,
           const BlockNoise& stated) noexcept;
  void add_smoothness(const SensorArray& array, const CombinationMae& window, SensorSet used) noexcept;

  /// Blocks that it rests on.
  double blocks() const noexcept { return static_cast<double>(blocks_); }
  double smooth_blocks() const noexcept { return static_cast<double>(smooth_blocks_); }  ///< the same of correlation
  /// Noise in stated sigmas, 1 .. kMostFactor; 1 until it is certain to be more.
  double factor() const noexcept;
  /// The variance of a block's mean is so many times that of `samples` independent ones, 1 .. `samples`.
  double correlation(double samples) const noexcept;

 private:
  static constexpr double kSignificance = 3.0;  ///< sigmas of its own by which the scatter must be too large
  static constexpr double kMargin = 2.0;        ///< sigmas of its own by which what was found is widened

  std::array<float, kCapacity> channel_{};  ///< variance of each channel over the stated one
  float parity_ = 0.0F;                     ///< the same of the parity residuals, all together
  float blocks_ = 0.0F;
  float freedom_ = 0.0F;     ///< degrees of freedom of the parity residuals in one block
  float smoothness_ = 0.0F;  ///< mean square successive difference over twice the variance; 1 = white
  float smooth_blocks_ = 0.0F;
  SensorSet sensors_;  ///< whose channels are in the mean

  friend struct FieldsOf;
  bool plausible() const noexcept;
  static constexpr auto fields() noexcept {
    using N = NoiseStudy;
    return field_list(per_sensor(&N::channel_), &N::parity_, &N::blocks_, &N::freedom_, &N::smoothness_,
                      &N::smooth_blocks_, &N::sensors_);
  }
};

}  // namespace PLUMB_ABI
}  // namespace plumb

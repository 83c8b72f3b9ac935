/// Means over two adjacent blocks, weighted by a triangle: with these weights the mean of a derivative is the
/// difference of the two block means over the length of a block, exactly (theorem T11), so that what skew, bandwidth
/// and lever arms do follows from sums. Blocks of four lengths (`BlockSamples`); a longer one is put together from
/// shorter ones.
#pragma once

#include <array>

#include "plumb/motion/motion_setup.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

/// Symmetric 3 x 3: xx, yy, zz, xy, xz, yz.
using Symmetric = std::array<double, 6>;

/// What a gyro says of two adjacent blocks.
struct GyroMeans {
  bool given = false;                 ///< at every sample
  Vec3 acceleration_radps2{};         ///< angular, triangle mean
  Vec3 acceleration_change_radps2{};  ///< against the pair of blocks before; where there was none, twice the
                                      ///< acceleration
  Symmetric rate_product{};           ///< triangle mean of w w'
  // What a shift in time changes: means of a derivative are differences at the edges of the blocks.
  Vec3 edge_change_radps{};          ///< rate at the end, less twice that in the middle, plus that at the beginning
  Vec3 step_change_radps{};          ///< the same of the change from sample to sample that happens there
  Symmetric product_change{};        ///< of the mean w w' from one block to the next
  double step_radps = 0.0;           ///< largest change from a sample to the next
  double bend_radps = 0.0;           ///< largest second difference of three samples in a row
  bool begun = false;                ///< no sample came before them: what the rate did there is not known
  double interpolation_radps = 0.0;  ///< what interpolation adds to a rate at most
};

/// Two adjacent blocks of one scale.
struct MotionMeans {
  int samples = 0;          ///< of one block
  double span_s = 0.0;      ///< length of one block, by the time stamps
  double time_s = 0.0;      ///< of the middle
  SensorSet usable;         ///< delivered, not clipped and below 1e4 m/s^2 at every sample
  SensorSet at_least;       ///< at full scale at every sample, above zero: the true mean is no less than the reading
  SensorSet at_most;        ///< likewise below zero: it is no more
  Readings reading_mps2{};  ///< triangle mean
  Readings slope_mps3{};    ///< triangle mean of the derivative
  Readings square_m2ps4{};  ///< triangle mean of the square
  Readings bend_mps2{};     ///< largest second difference of three samples in a row: what happens between samples
  Readings interpolation_mps2{};  ///< what interpolation adds to a sample at most, the largest of them
  std::array<GyroMeans, kGyros> gyro{};

  /// Sum of the squared weights: the variance of a mean of white noise over that of a sample.
  double noise_share() const noexcept;
};

class MotionWindow {
 public:
  MotionWindow() noexcept = default;
  MotionWindow(int sensors, int gyros, double sample_period_s, const BlockSamples& blocks = kMotionSamples) noexcept;

  /// Takes a sample in. It counts once the next one has come, which shows what happened after it. Where its time does
  /// not follow the last one by about one period, or is not finite, all begins anew.
  void add(const MotionSample& sample) noexcept;
  /// Bit s is set where a pair of blocks of scale s ended with the sample before the last.
  unsigned ended() const noexcept { return ended_; }
  /// The pair that ended last; zero samples where there was none.
  MotionMeans means(int scale) const noexcept;
  /// Forgets all samples.
  void clear() noexcept;

 private:
  /// Of the rate in one block: half-way to the sample before it and to the one after it, and the changes there; largest
  /// first and second differences.
  struct RateEdges {
    Vec3 begin{}, end{}, begin_step{}, end_step{};
    double step = 0.0, bend = 0.0;
    bool first = false;  ///< no sample came before
  };
  /// Of one block: sums of x, and of x weighted by (k + 1/2) / N.
  struct Sums {
    int count = 0;
    double time_s = 0.0;  ///< since the window began
    SensorSet usable, at_least, at_most;
    std::array<bool, kGyros> given{};
    std::array<std::array<double, 2>, kMotionCapacity> reading{};
    std::array<std::array<double, 2>, kMotionCapacity> square{};
    std::array<double, kMotionCapacity> bend{};
    std::array<double, kMotionCapacity> interpolation{};
    std::array<double, kGyros> rate_interpolation{};
    std::array<Vec3, kGyros> rate{};
    std::array<RateEdges, kGyros> edges{};
    std::array<std::array<Symmetric, 2>, kGyros> product{};
  };
  struct Scale {
    Sums filling;
    Sums last;    ///< block B once it is full
    Sums before;  ///< block A
    std::array<Vec3, kGyros> acceleration_before{};
    bool acceleration_known = false;
  };

  Sums sums_of(const MotionSample& sample) noexcept;
  void take(const Sums& sample) noexcept;
  void append(Sums& to, const Sums& part, double first_share, double part_share) const noexcept;
  void close(Scale& scale, const Sums& full) const noexcept;
  static double span_s(const Scale& scale) noexcept;
  static Vec3 acceleration(const Scale& scale, std::size_t gyro) noexcept;

  std::array<Scale, kMotionScales> scales_{};
  Sums newest_;
  std::array<double, kMotionCapacity> step_mps2_{};  ///< from the sample before the newest to it
  std::array<Vec3, kGyros> step_radps_{};            ///< likewise
  int sensors_ = 0;
  int gyros_ = 0;
  BlockSamples blocks_ = kMotionSamples;
  double period_s_ = 0.0;
  double time_s_ = 0.0;
  double origin_s_ = 0.0;      ///< of the first sample of the window
  int begun_ = 0;              ///< samples since the last gap, at most two
  bool interpolated_ = false;  ///< some sample since then was interpolated
  unsigned ended_ = 0;
  int settling_ = 0;  ///< samples during which a channel that was clipped stays out
  SensorSet clipped_;
};

}  // namespace PLUMB_ABI
}  // namespace plumb

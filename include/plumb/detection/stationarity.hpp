/// At rest or moving: blocks of samples, their scatter, and the stations they make up.
#pragma once

#include <array>

#include "plumb/array/geometry.hpp"
#include "plumb/core/config.hpp"
#include "plumb/core/sample.hpp"
#include "plumb/core/units.hpp"
#include "plumb/detection/set_test.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

/// Collects one block: means and covariances of the channels, accumulated about the first sample so
/// that nothing drifts; emptied at every block.
class BlockAccumulator {
 public:
  void clear() noexcept;
  /// Adds one set of readings; those outside `usable` are not read. `count` raw samples stand behind it.
  void add(const Readings& y_mps2, SensorSet usable, double count) noexcept {
    Differences unused{};
    add(y_mps2, usable, count, unused);
  }
  /// The same; leaves in `difference` what was added, zero for a channel that is not usable.
  void add(const Readings& y_mps2, SensorSet usable, double count, Differences& difference) noexcept;
  /// What the differences are from, for the channels of `seen`.
  const Readings& origin_mps2() const noexcept { return origin_; }
  SensorSet seen() const noexcept { return usable_; }
  int size() const noexcept { return size_; }
  /// Channels that were usable in at least half of the samples: a few dropouts do not silence a channel.
  SensorSet usable() const noexcept;
  /// Channels that were usable in every sample.
  SensorSet complete() const noexcept;
  /// N behind the mean of the scarcest channel of `of`, in raw samples.
  double samples(SensorSet of) const noexcept;
  Readings mean() const noexcept;
  /// Sample covariance of channels i and j [(m/s^2)^2]; 0 with fewer than two samples.
  double covariance(int i, int j) const noexcept;
  /// Whether the sums of the readings, and the counts, are as `add` left them: not those of the products, of which a
  /// block makes a scatter and nothing else.
  bool holds() const noexcept { return check_ == check(); }

 private:
  std::uint64_t check() const noexcept;
  void rebuild() noexcept { check_ = check(); }

  std::array<double, kCapacity> origin_{};
  std::array<Scalar, kCapacity> sum_{};
  std::array<Scalar, kCapacity*(kCapacity + 1) / 2> product_{};
  std::array<std::uint16_t, kCapacity> present_{};  ///< samples of each channel
  SensorSet usable_;                                ///< seen at all
  double inverse_count_ = 0.0;  ///< sum of 1/count: an unweighted mean is as noisy as its scarcest samples
  int size_ = 0;
  std::uint64_t check_ = 0;  ///< sum of the bits of origins, sums and counts

  friend struct FieldsOf;
  static constexpr int pairs(int sensors) noexcept { return sensors * (sensors + 1) / 2; }
  bool plausible() const noexcept;
  static constexpr auto fields() noexcept {
    using B = BlockAccumulator;
    return field_list(per_sensor(&B::origin_), per_sensor(&B::sum_), leading(&B::product_, &pairs),
                      per_sensor(within(&B::present_, 0, kWindowCapacity)), &B::usable_, &B::inverse_count_,
                      within(&B::size_, 0, kWindowCapacity), not_stored(&B::check_));
  }
};

/// What noise makes of the readings of each sensor [(m/s^2)^2].
struct BlockNoise {
  std::array<double, kCapacity> variance{};
  /// The same as the array states it. A channel that scatters by more may be noisier than its data sheet says, or move.
  std::array<double, kCapacity> stated{};
  double of(int i) const noexcept { return variance[static_cast<std::size_t>(i)]; }
  double stated_of(int i) const noexcept { return stated[static_cast<std::size_t>(i)]; }
};
/// `factor` times the stated sigma, and what rounding to steps of `resolution_mps2` adds: a twelfth of the square of a
/// step; up to a quarter where noise is less than a step and a reading may stand on the edge between two.
BlockNoise noise_of(const SensorArray& array, double factor = 1.0,
                    const std::array<float, kCapacity>& resolution_mps2 = {}) noexcept;

/// How a block looked.
struct BlockJudgement {
  bool quiet = false;
  SensorSet scattering;         ///< channels whose scatter is above their own noise limit
  SensorSet noisy;              ///< scattering ones that the others at rest contradict: a channel, not the tool, moves
  SensorSet noisy_for_certain;  ///< noisy whichever others may be faulty, up to the provisional grade and three
  BlockEvidence evidence;
};

/// What the residuals of scattering channels have shown over the last blocks. The noise of a channel at twice its sigma
/// hides in the residual of one block, which carries the noise of the others too; over a few it does not.
struct ScatterRecord {
  std::array<double, kCapacity> residual{};  ///< sum over blocks of variance / expected variance * degrees of freedom
  std::array<double, kCapacity> freedom{};   ///< degrees of freedom in it; halved beyond kMostFreedom
  std::array<double, kCapacity> own_excess{}, residual_excess{};  ///< sums of variance beyond noise [(m/s^2)^2]
  static constexpr double kMostFreedom = 512.0;

  void clear() noexcept { *this = ScatterRecord{}; }
  void forget(int i, double keep) noexcept;
  void add(int i, double ratio, double degrees, double own, double left) noexcept;

  bool plausible() const noexcept;
  static constexpr auto fields() noexcept {
    using S = ScatterRecord;
    return field_list(per_sensor(any(&S::residual)), per_sensor(&S::freedom), per_sensor(any(&S::own_excess)),
                      per_sensor(any(&S::residual_excess)));
  }
};

/// Scatter limit of a channel over its own variance: shared by n channels, the chance that any healthy
/// one exceeds it in a block of `size` samples is `rate`. 0 where a block has no scatter (size < 2).
double scatter_factor(int n, int size, double rate) noexcept;

/// Judges a finished block. A block is at rest when no channel scatters, or when the channels that
/// do not scatter have rank 3 and the residual of every scattering one against their estimate scatters
/// beyond its noise too: then it is the channel that shakes, not the tool (docs/theory.md, section 6.2). Where those at
/// rest are no more than the confirmed grade and the scattering ones have rank 3, they may all be faulty: then it
/// is not at rest. A block of one sample (a station mean) has no scatter: at rest. Only channels in `considered` are
/// judged, so that an excluded one cannot stop the evidence. `factor` comes from `scatter_factor`. With a `record` of
/// the blocks before, a channel is noisy as well where its residual scatters over all of them, and at least half of
/// its scatter is found in the residual: of a movement of the tool the others would have predicted it. `known`: a map
/// at hand, used where it is that of the channels at rest. `noise`: what is expected of the channels.
BlockJudgement judge_block(const SensorArray& array, const BlockAccumulator& block, SensorSet considered, double factor,
                           double g_mps2, const BlockNoise& noise, ScatterRecord* record = nullptr,
                           const LeastSquares* known = nullptr) noexcept;
/// The same with the noise that the array states.
BlockJudgement judge_block(const SensorArray& array, const BlockAccumulator& block, SensorSet considered, double factor,
                           double g_mps2) noexcept;

/// For a block not at rest: whether every scattering channel of `considered` does what the others of them predict,
/// so that the tool moves and no channel by itself. Where it does, `out.evidence` holds the spread of their vector.
/// With fewer than four sensors this is not known.
bool moves_together(const SensorArray& array, const BlockAccumulator& block, SensorSet considered, double factor,
                    double g_mps2, const BlockNoise& noise, BlockJudgement& out) noexcept;

/// Turns a stream of samples into stations: stretches at rest at one attitude, split by tag, by roll group or by a
/// change of direction. Serves calibration from continuous logs. The first and the last block at rest of
/// a stretch are omitted: they hold the settling and the onset of motion that noise still covers.
class StationFinder {
 public:
  struct Settings {
    int block = 32;  ///< samples per test for rest
    double restless_rate = 1e-6;
    double station_angle_rad = rad_from_deg(2.0);
    double max_gap_s = 5.0;
    int min_blocks = 2;  ///< stretches with fewer blocks left are dropped
  };
  /// `array` is the nominal one: only noise and rough direction matter here.
  StationFinder(const SensorArray& array, double g_mps2, const Settings& settings) noexcept;

  /// Feeds one sample with its readings by the nominal model; channels that did not deliver a finite
  /// value must be missing in `usable`. True where a station has ended and was written to `finished`.
  bool add(const Sample& sample, const Readings& y_mps2, SensorSet usable, Station& finished) noexcept;
  /// Ends the stream; true where a last station was written.
  bool finish(Station& finished) noexcept;

 private:
  /// One block at rest in raw units.
  struct Block {
    std::array<double, kCapacity> origin{};    ///< first raw value: sums about it do not cancel
    std::array<double, kCapacity> mean{};      ///< of raw - origin while collecting, of raw when done
    std::array<double, kCapacity> variance{};  ///< sum of squares while collecting
    SensorSet usable;
    double temperature_degc = 0.0, begin_s = 0.0, end_s = 0.0;
    std::uint32_t tag = 0, roll_group = 0, count = 0;
    Vec3 direction{};
    bool present = false;
  };
  bool block_done(Station& finished) noexcept;
  bool close(Station& finished) noexcept;
  void merge(const Block& block) noexcept;

  SensorArray array_;
  Settings settings_;
  double g_mps2_;
  double factor_;
  BlockAccumulator readings_;
  Block current_, waiting_, station_;
  double last_s_ = 0.0;
  int blocks_ = 0;
  bool settling_ = true;
  bool started_ = false;
};

}  // namespace PLUMB_ABI
}  // namespace plumb

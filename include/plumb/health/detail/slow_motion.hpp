/// A tool that turns or shakes slowly: every sensor feels the same motion, the vector of a block is that of its mean,
/// and what it may be off by until the next block is known from how far it has moved of late.
#pragma once

#include <cmath>

#include "plumb/core/angles.hpp"
#include "plumb/core/detail/fields.hpp"
#include "plumb/core/detail/flag.hpp"
#include "plumb/core/vec3.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

class SlowMotion {
 public:
  void clear() noexcept { *this = SlowMotion{}; }
  /// From here on the vector before says nothing of a turn: behind a gap, or a block that moved too much.
  void lapse() noexcept {
    known_ = false;
    now_rad_ = felt_rad_ = 0.0;
    slow_ = Flag();
  }
  /// One block, in slow motion or at rest, whose vector scattered by `rms_mps2` beyond noise.
  void add_swing(bool slow, double rms_mps2) noexcept {
    slow_ = Flag(slow);
    if (slow) {
      left_ = kMemoryBlocks;
    } else if (left_ > 0) {
      --left_;
    }
    swing_mps2_ = left_ > 0 ? std::fmax(kKept * swing_mps2_, rms_mps2) : 0.0;
  }
  /// The vector of that block, its direction known by `sigma_rad`. One more than `most_rad` from the one before is that
  /// of another attitude: the tool was brought there, and does not go on so.
  /// A turn goes on where the block scattered by half at least of what it would make of it, or where that would be less
  /// than the noise of one sample, `noise_rad`.
  /// Where there is no vector before to tell, the tool may have turned by `hidden_rad` in the block, for all that is
  /// known of it.
  void add_turn(const Vec3& x_mps2, double sigma_rad, double most_rad, double rms_rad = 1.0, double noise_rad = 0.0,
                double hidden_rad = 0.0) noexcept {
    const double apart_rad = known_ ? angle_between_rad(last_mps2_, x_mps2) : 0.0;
    const double now_rad = apart_rad <= most_rad ? apart_rad : 0.0;
    const double made_rad = now_rad / std::sqrt(12.0);
    const bool goes_on = rms_rad >= 0.5 * made_rad || made_rad <= noise_rad;
    const bool turns = slow_ || (now_rad > kSeenSigmas * sigma_rad && goes_on);
    if (turns) left_ = kMemoryBlocks;
    if (!turns) swing_mps2_ *= kKeptAtRest;
    // From a block at rest to the first block that turns throughout, the means differ by at least half of what it turns
    // by.
    const double seen_rad = turn_rad_ > 0.0 || slow_ ? now_rad : 2.0 * now_rad;
    turn_rad_ = left_ > 0 ? std::fmax((turns ? kKept : kKeptAtRest) * turn_rad_, goes_on ? seen_rad : 0.0) : 0.0;
    // A change that may be noise may also be such a half: at the end of the next block the tool is then off by three
    // times as much. What noise alone makes is taken off.
    const double felt_rad = now_rad > kSeenSigmas * sigma_rad ? 0.0 : 3.0 * now_rad - kHiddenSigmas * sigma_rad;
    felt_rad_ = std::fmax(kKeptAtRest * felt_rad_, felt_rad);
    now_rad_ = known_ ? now_rad : hidden_rad;
    last_mps2_ = x_mps2;
    known_ = true;
  }

  bool slow() const noexcept { return slow_; }  ///< the last block
  /// The vector before says whether the tool turned since.
  bool known() const noexcept { return known_; }
  /// In slow motion, and in the blocks behind it: what a block scatters by is motion, and its mean may be off by as
  /// much.
  bool lately() const noexcept { return left_ > 0; }
  /// By how much the vector turned from the block before, or may have turned where there is none.
  double now_rad() const noexcept { return std::fmax(now_rad_, felt_rad_); }
  /// Between the vector of the last block and the direction at any sample up to the end of the next: half of what the
  /// block turned by, and as much as it turns from one block to the next; 0 at rest.
  double bound_rad(double g_mps2) const noexcept {
    const double half_rad = std::fmax(std::sqrt(3.0) * swing_mps2_ / g_mps2, 0.5 * turn_rad_);
    return kMargin * (half_rad + std::fmax(turn_rad_, 2.0 * half_rad));
  }

 private:
  /// A sway is felt most in some blocks and least in others: what was felt fades by this share a block, sooner in
  /// blocks that do not turn, and is forgotten after so many of these.
  static constexpr double kKept = 0.95, kKeptAtRest = 0.7;
  static constexpr int kMemoryBlocks = 8;
  static constexpr double kSeenSigmas = 6.0;    ///< of a direction: two vectors farther apart are not those of one
  static constexpr double kHiddenSigmas = 6.0;  ///< of a direction, taken off three times a change: noise makes so much
  static constexpr double kMargin = 1.25;       ///< for the noise of both, and for a motion that grows

  Vec3 last_mps2_{};
  double now_rad_ = 0.0, felt_rad_ = 0.0, turn_rad_ = 0.0, swing_mps2_ = 0.0;
  int left_ = 0;
  bool known_ = false;
  Flag slow_;

  friend struct FieldsOf;
  bool plausible() const noexcept {
    return now_rad_ >= 0.0 && felt_rad_ >= 0.0 && turn_rad_ >= 0.0 && swing_mps2_ >= 0.0;
  }
  static constexpr auto fields() noexcept {
    using S = SlowMotion;
    return field_list(&S::last_mps2_, &S::now_rad_, &S::felt_rad_, &S::turn_rad_, &S::swing_mps2_,
                      within(&S::left_, 0, kMemoryBlocks), &S::known_, &S::slow_);
  }
};

}  // namespace PLUMB_ABI
}  // namespace plumb

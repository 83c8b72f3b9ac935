/// What the monitor remembers between an alarm and its end: which attitudes have been seen, which
/// answer has stayed unique over how many of them, how many clean ones have passed since.
#pragma once

#include <array>
#include <cstdint>

#include "plumb/core/config.hpp"
#include "plumb/core/detail/fields.hpp"
#include "plumb/core/detail/flag.hpp"
#include "plumb/core/sensor_set.hpp"
#include "plumb/core/vec3.hpp"
#include "plumb/health/monitor_config.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

/// Directions that differ from each other by at least a given angle. Kept to 3e-5 rad: that is nothing to an angle of
/// degrees, and there are four records in a monitor.
class DirectionRecord {
 public:
  static constexpr int kMax = 24;
  void clear() noexcept { size_ = 0; }
  int size() const noexcept { return size_; }
  /// Counts the direction if it differs from all on record; true where it did. A full record counts no more, and what
  /// has no length, as of sensors that all read zero, is no direction: on record it would differ from none.
  bool add(const Vec3& direction, double angle_rad) noexcept {
    const double length = norm(direction);
    if (size_ == kMax || !(length > 0.0 && length <= kLongest)) return false;
    // The cosine of an angle is at least 1 - angle^2 / 2: one below that belongs to a larger angle.
    const double surely = (1.0 - 0.5 * angle_rad * angle_rad - kRounding) * length;
    for (int k = 0; k < size_; ++k) {
      const auto& kept = direction_[static_cast<std::size_t>(k)];
      const Vec3 before = {kept[0] - kZero, kept[1] - kZero, kept[2] - kZero};
      if (dot(before, direction) < surely * norm(before)) continue;  // as most are
      if (!(angle_between_rad(before, direction) >= angle_rad)) return false;
    }
    auto& kept = direction_[static_cast<std::size_t>(size_++)];
    for (std::size_t k = 0; k < 3; ++k) kept[k] = static_cast<std::uint16_t>(direction[k] / length * kUnit + kRounded);
    return true;
  }

 private:
  static constexpr double kRounding = 1e-9;  ///< far more than it does to a cosine or to an angle

  static constexpr double kUnit = 32766.0, kZero = 32768.0, kRounded = kZero + 0.5;
  static constexpr double kLongest = 1e300;  ///< what is not finite is no direction

  int size_ = 0;
  std::array<std::array<std::uint16_t, 3>, kMax> direction_{};  ///< unit vectors times kUnit, plus kZero

  friend struct FieldsOf;
  static constexpr auto fields() noexcept {
    return field_list(within(&DirectionRecord::size_, 0, kMax),
                      counted(&DirectionRecord::direction_, &DirectionRecord::size));
  }
};

struct Episode {
  Flag open;                ///< an alarm is on record
  bool by_scatter = false;  ///< the candidate's own scatter is all that names it
  /// Sensors at most that the candidate and those provisionally excluded came to: an episode that names one more than
  /// ever before is another question.
  std::uint8_t most_suspected = 0;
  DirectionRecord stations;  ///< distinct attitudes in doubt (isolation timeout); kept without an alarm too
  int doubtful_blocks = 0;   ///< blocks in doubt at any attitude, where the timeout counts them
  SensorSet candidate;       ///< the unique confirmed answer so far
  DirectionRecord agreeing;  ///< excited stations at which it was the answer (E)
  DirectionRecord clean;     ///< excited stations that were clean since the last alarm (M)

  void clear() noexcept {
    open = by_scatter = false;
    most_suspected = 0;
    stations.clear();
    doubtful_blocks = 0;
    candidate = SensorSet{};
    agreeing.clear();
    clean.clear();
  }
  /// The isolation timeout begins anew where more sensors are suspected than before in this episode: what was doubted
  /// until now has an answer, and the next fault its own time. The number only grows, so that no more than n times.
  void note_suspected(int sensors) noexcept {
    if (sensors <= most_suspected) return;
    most_suspected = static_cast<std::uint8_t>(sensors);
    stations.clear();
    doubtful_blocks = 0;
  }
  /// The answer is taken back; how long the doubt has lasted, and how many were suspected at most, is not.
  void take_back() noexcept {
    by_scatter = false;
    candidate = SensorSet{};
    agreeing.clear();
  }
  static constexpr auto fields() noexcept {
    using E = Episode;
    return field_list(&E::open, &E::by_scatter, within(&E::most_suspected, 0, kCapacity), &E::stations,
                      within(&E::doubtful_blocks, 0, kMostIsolationTimeoutBlocks), &E::candidate, &E::agreeing,
                      &E::clean);
  }
};

/// The attitude at which blocks are being taken. Blocks of one station are not pooled: between them the tool may have
/// turned by up to the station angle, and a mean over that is no gravity vector (it rejected the truth in a test).
struct StationTrack {
  bool open = false;
  bool asked = false;     ///< a vote was taken here
  bool answered = false;  ///< and the candidate was the answer of one block at least
  std::uint32_t tag = 0;
  Vec3 direction{};      ///< of its first block; zero where that is not known well enough to tell attitudes apart
  Vec3 last{};           ///< of its last block
  int blocks = 0;        ///< counted up to kMostBlocks
  float samples = 0.0F;  ///< behind each of the readings that follow
  std::array<float, kCapacity> reading_mps2{};  ///< in its first block
  SensorSet delivered;

  static constexpr int kMostBlocks = 1000;
  void clear() noexcept { *this = StationTrack{}; }
  static constexpr auto fields() noexcept {
    using S = StationTrack;
    return field_list(&S::open, &S::asked, &S::answered, &S::tag, &S::direction, &S::last,
                      within(&S::blocks, 0, kMostBlocks), &S::samples, per_sensor(&S::reading_mps2), &S::delivered);
  }
};

}  // namespace PLUMB_ABI
}  // namespace plumb

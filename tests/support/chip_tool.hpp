/// Arrays of chips for tests of the monitor at rest, and the ways in which a chip fails.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "support/simulated_tool.hpp"

namespace plumb_test {

/// `chips` parallel triads, each one chip, then single sensors along `singles`.
inline plumb::SensorArray chip_array(int chips, const std::vector<plumb::Vec3>& singles = {}, bool stated = true) {
  std::array<plumb::SensorRow, plumb::kCapacity> rows{};
  const auto n = static_cast<int>(static_cast<std::size_t>(3 * chips) + singles.size());
  EXPECT_LE(n, plumb::kCapacity);
  for (int i = 0; i < n && i < plumb::kCapacity; ++i) {
    auto& row = rows[static_cast<std::size_t>(i)];
    row.id = plumb::make_id(("a" + std::to_string(i + 1)).c_str());
    row.sigma_mps2 = 2e-4 * plumb::kG0_mps2;
    if (i < 3 * chips) {
      row.axis[static_cast<std::size_t>(i % 3)] = 1.0;
      row.chip = static_cast<std::uint8_t>(stated ? i / 3 + 1 : 0);
    } else {
      row.axis = singles[static_cast<std::size_t>(i - 3 * chips)];
    }
  }
  const auto made = plumb::SensorArray::make(rows.data(), n);
  EXPECT_TRUE(made.has_value());
  return made ? *made : plumb::SensorArray{};
}

/// The three sensors of chip `k`, counted from 0.
inline plumb::SensorSet chip_at(int k) { return plumb::SensorSet(7U << static_cast<unsigned>(3 * k)); }

/// How a chip fails. The first four change its length at most attitudes; a turned one keeps it at all, and one that
/// hangs at what it last read keeps what that had.
enum class ChipFault { dead, stuck, biased, one_axis, turned, late, noisy, hung };
constexpr std::array<ChipFault, 8> kChipFaults = {ChipFault::dead,     ChipFault::stuck,  ChipFault::biased,
                                                  ChipFault::one_axis, ChipFault::turned, ChipFault::late,
                                                  ChipFault::noisy,    ChipFault::hung};
inline const char* to_string(ChipFault fault) {
  switch (fault) {
    case ChipFault::dead: return "dead";
    case ChipFault::stuck: return "stuck";
    case ChipFault::biased: return "biased";
    case ChipFault::turned: return "turned";
    case ChipFault::late: return "late";
    case ChipFault::noisy: return "noisy";
    case ChipFault::one_axis: return "one axis";
    case ChipFault::hung: return "hung";
  }
  return "?";
}

/// What a faulty triad reads in the place of the true vector.
class FaultyChip {
 public:
  FaultyChip() = default;
  FaultyChip(ChipFault fault, std::uint64_t seed) : fault_(fault), noise_(seed) {
    size_ = 0.03 + 0.27 * noise_.uniform();  // of gravity, or rad
    along_ = random_direction(noise_);
    axis_ = static_cast<int>(3.0 * noise_.uniform());
    held_ = plumb::scaled(random_direction(noise_), (0.6 + 0.3 * noise_.uniform()) * plumb::kG0_mps2);
  }
  /// Of one axis of the chip, whose healthy reading is `reading_mps2`; `sample` counts from when it failed.
  double read(int axis, double reading_mps2, int sample) {
    const auto a = static_cast<std::size_t>(axis);
    switch (fault_) {
      case ChipFault::dead: return 0.0;
      case ChipFault::stuck: return held_[a];
      case ChipFault::biased: return reading_mps2 + size_ * plumb::kG0_mps2 * along_[a];
      case ChipFault::noisy: return reading_mps2 + 0.02 * plumb::kG0_mps2 * noise_.normal();
      case ChipFault::one_axis: return axis == axis_ ? reading_mps2 + size_ * plumb::kG0_mps2 : reading_mps2;
      case ChipFault::turned: return turned(axis);
      case ChipFault::late: return late(axis, reading_mps2, sample);
      case ChipFault::hung:
        if (sample == 0) last_[a] = reading_mps2;
        return last_[a];
    }
    return reading_mps2;
  }
  /// The true vector of the sample, before its readings are asked for.
  void feel(const plumb::Vec3& force_mps2) { force_mps2_ = force_mps2; }

  static constexpr int kLate = 200;  ///< samples

 private:
  double turned(int axis) {
    const plumb::Vec3 across = plumb::cross(along_, force_mps2_);
    const double c = std::cos(size_), s = std::sin(size_), d = plumb::dot(along_, force_mps2_) * (1.0 - c);
    const auto a = static_cast<std::size_t>(axis);
    return c * force_mps2_[a] + s * across[a] + d * along_[a] + 2e-4 * plumb::kG0_mps2 * noise_.normal();
  }
  double late(int axis, double reading_mps2, int sample) {
    auto& past = past_[static_cast<std::size_t>(axis)];
    if (past.empty()) past.assign(kLate, reading_mps2);
    const std::size_t at = static_cast<std::size_t>(sample) % kLate;
    const double out = past[at];
    past[at] = reading_mps2;
    return out;
  }

  ChipFault fault_ = ChipFault::dead;
  Noise noise_{1};
  plumb::Vec3 along_{}, held_{}, last_{}, force_mps2_{};
  double size_ = 0.0;
  int axis_ = 0;
  std::array<std::vector<double>, 3> past_;
};

/// A validated monitor of such an array, and the chips that fail from then on.
class ChipRig {
 public:
  explicit ChipRig(const plumb::SensorArray& array, plumb::MonitorConfig config = {}, std::uint64_t seed = 1)
      : rig(array, config, seed), where_(seed + 1000) {
    rig.prove();
    begun_ = rig.monitor.verdict().state;
  }
  void fail(int chip, ChipFault fault, std::uint64_t seed) {
    faulty_[static_cast<std::size_t>(chip)] = FaultyChip(fault, seed);
    failed = failed | chip_at(chip);
    rig.distort = [this, start = -1](int i, double reading, int sample) mutable {
      if (start < 0) start = sample;
      if (!failed.has(i)) return reading;
      return faulty_[static_cast<std::size_t>(i / 3)].read(i % 3, reading, sample - start);
    };
  }
  /// Blocks at one attitude, drawn where none is given.
  const plumb::Verdict& station(int blocks) { return station(blocks, random_direction(where_)); }
  const plumb::Verdict& station(int blocks, const plumb::Vec3& direction) {
    feel(direction);
    return rig.stay(direction, blocks);
  }
  /// One block in which the whole tool shakes.
  const plumb::Verdict& shaken(double rms_mps2) {
    const plumb::Vec3 direction = random_direction(where_);
    feel(direction);
    return rig.shake(direction, rms_mps2);
  }
  plumb::HealthState begun() const { return begun_; }
  /// Whether the monitor has ever been in doubt since it was validated.
  bool detected() const {
    bool out = false;
    for (const plumb::TransitionRecord& one : rig.records)
      out = out || (one.event == plumb::HealthEvent::alarm || one.event == plumb::HealthEvent::provisional_exclusion);
    return out;
  }

  Rig rig;
  plumb::SensorSet failed;

 private:
  void feel(const plumb::Vec3& direction) {
    for (FaultyChip& one : faulty_) one.feel(plumb::scaled(direction, plumb::kG0_mps2));
  }

  std::array<FaultyChip, plumb::kCapacity / 3> faulty_;
  Noise where_;
  plumb::HealthState begun_{};
};

}  // namespace plumb_test

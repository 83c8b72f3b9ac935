/// One case of a law: a tool, who lies and how, and what a block at each station then reads. The number of the case
/// alone decides all of it: the strata are its digits, the rest comes from a stream keyed by law and number.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "laws/law_tools.hpp"

namespace plumb_test {
inline namespace PLUMB_ABI {

/// How the faulty sensors of a case lie.
enum class Lie : std::uint8_t {
  constant,      ///< a bias, log-uniform
  stuck,         ///< at one level
  random,        ///< anew at every station, within +-3 g0
  intermittent,  ///< one of the others, at every second station or so
  moving,        ///< one of the faulty at a time, another one every few stations
  drifting,      ///< a bias that grows
  scale,         ///< times a factor
  sign,          ///< reads its negative
  remount,       ///< sits on its mirror axis: gravity mirrored in the plane of two healthy ones, for each another two
  swap,          ///< the readings of two faulty ones are exchanged
  colluding,     ///< all show one false gravity, at rest in the tool or turning with it
  mirrored,      ///< all show gravity mirrored in the plane of two healthy ones
  mixed,         ///< each one by a law of its own
};
inline constexpr std::array<Lie, 13> kEveryLie = {
    Lie::constant, Lie::stuck, Lie::random,  Lie::intermittent, Lie::moving,   Lie::drifting, Lie::scale,
    Lie::sign,     Lie::swap,  Lie::remount, Lie::colluding,    Lie::mirrored, Lie::mixed};

/// A stream of its own for every case of every law.
inline TrialNoise stream_of(int law, std::uint64_t number) {
  constexpr std::uint64_t kGolden = 0x9E3779B97F4A7C15ULL;
  const auto which = static_cast<std::uint64_t>(law) + 1U;
  std::uint64_t z = number + kGolden * which;
  for (const std::uint64_t factor : {0xBF58476D1CE4E5B9ULL, 0x94D049BB133111EBULL}) z = (z ^ (z >> 31U)) * factor;
  return TrialNoise(z ^ (z >> 29U));
}

/// The digits of a case's number, one stratum after the other.
class Strata {
 public:
  explicit Strata(std::uint64_t number) : left_(number) {}
  int digit(int choices) {
    const auto base = static_cast<std::uint64_t>(choices);
    const auto out = static_cast<int>(left_ % base);
    left_ /= base;
    return out;
  }
  template <class T, std::size_t N>
  T of(const std::array<T, N>& choices) {
    return choices[static_cast<std::size_t>(digit(static_cast<int>(N)))];
  }

 private:
  std::uint64_t left_;
};

/// White noise of a block's mean, whitened, never longer than this altogether: shorter than the limit of every test
/// (4.89 and up), so that what the laws say holds for every case and not for most.
inline constexpr double kNoiseLength = 4.5;
inline std::array<double, plumb::kCapacity> bounded_noise(int n, TrialNoise& noise) {
  std::array<double, plumb::kCapacity> z{};
  double square = 2.0 * kNoiseLength * kNoiseLength;
  while (square > kNoiseLength * kNoiseLength) {
    square = 0.0;
    for (int i = 0; i < n; ++i) {
      z[slot(i)] = noise.normal();
      square += z[slot(i)] * z[slot(i)];
    }
  }
  return z;
}

class LawCase {
 public:
  double least_mps2 = kTrialSigma_mps2;  ///< of a bias
  double most_mps2 = plumb::kG0_mps2;
  double samples = kTrialSamples;  ///< behind a block's mean: the more, the more what is systematic stands out

  LawCase(const TrialTool& tool, plumb::SensorSet faulty, Lie lie, double gravity_sigmas)
      : tool_(&tool), faulty_(faulty), lie_(lie) {
    length_mps2_ = plumb::kG0_mps2 + gravity_sigmas * tool.gravity.sigma_mps2;
  }

  /// m of n sensors at random.
  static plumb::SensorSet some(int n, int m, TrialNoise& noise) {
    plumb::SensorSet out;
    while (out.size() < m) out = out.with(noise.below(n));
    return out;
  }

  void draw(TrialNoise& noise) {
    const int n = tool_->array.size();
    ghost_ = noise.direction();
    ghost_turns_ = noise.uniform() < 0.5;
    holder_ = some_faulty(noise);
    for (int i = 0; i < n; ++i) {
      Own& own = own_[slot(i)];
      constexpr Lie kLone[] = {Lie::constant, Lie::stuck, Lie::random,  Lie::drifting,
                               Lie::scale,    Lie::sign,  Lie::remount, Lie::mirrored};
      const bool of_its_own = lie_ == Lie::mixed || lie_ == Lie::intermittent || lie_ == Lie::moving;
      const Lie lone = kLone[noise.below(8)];
      own.lie = of_its_own ? lone : lie_;
      own.pillar = healthy_pair(noise);
      own.bias_mps2 = noise.sign() * noise.log_between(least_mps2, most_mps2);
      constexpr double kLevels[] = {0.0, 1.0, -1.0, 3.0, -3.0};
      const int level = noise.below(6);
      own.level_mps2 = (level < 5 ? kLevels[level] : noise.between(-1.0, 1.0)) * plumb::kG0_mps2;
      constexpr double kScales[] = {0.5, 1.1, 0.99, 1.001, 0.0, 2.0};
      own.scale = kScales[noise.below(6)];
    }
    common_pillar_ = healthy_pair(noise);
    swap_a_ = faulty_.lowest();
    swap_b_ = faulty_.without(swap_a_).lowest();
  }

  const TrialTool& tool() const { return *tool_; }
  plumb::SensorSet faulty() const { return faulty_; }
  plumb::SensorSet healthy() const { return tool_->array.all() - faulty_; }

  /// What the sensors read at a station without noise; gravity points to `direction`.
  plumb::Readings readings(const plumb::Vec3& direction, TrialNoise& noise) {
    return felt(plumb::scaled(direction, length_mps2_), noise);
  }
  /// The same under gravity and acceleration together.
  plumb::Readings felt(const plumb::Vec3& g, TrialNoise& noise) {
    if (noise.uniform() < 0.4) holder_ = some_faulty(noise);
    const bool away = lie_ == Lie::intermittent && noise.uniform() < 0.5;
    plumb::Readings y{};
    for (int i = 0; i < tool_->array.size(); ++i) {
      const bool lies = faulty_.has(i) && !away && (lie_ != Lie::moving || i == holder_);
      y[slot(i)] = lies ? lie(i, g, noise) : shows(i, g);
    }
    ++station_;
    return y;
  }
  plumb::Readings healthy_readings(const plumb::Vec3& direction) const {
    plumb::Readings y{};
    for (int i = 0; i < tool_->array.size(); ++i) y[slot(i)] = shows(i, plumb::scaled(direction, length_mps2_));
    return y;
  }
  /// Sigma of the mean of a block.
  double block_sigma(int i) const { return tool_->array.sigma_mps2(i) / std::sqrt(samples); }
  plumb::Readings with_noise(plumb::Readings y, TrialNoise& noise) const {
    const int n = tool_->array.size();
    const auto z = bounded_noise(n, noise);
    for (int i = 0; i < n; ++i) y[slot(i)] += block_sigma(i) * z[slot(i)];
    return y;
  }

 private:
  struct Own {
    Lie lie = Lie::constant;
    double bias_mps2 = 0.0, level_mps2 = 0.0, scale = 1.0;
    std::array<int, 2> pillar{};
  };

  int some_faulty(TrialNoise& noise) const {
    int i = noise.below(tool_->array.size());
    while (!faulty_.empty() && !faulty_.has(i)) i = (i + 1) % tool_->array.size();
    return i;
  }
  std::array<int, 2> healthy_pair(TrialNoise& noise) const {
    const int n = tool_->array.size();
    if (n - faulty_.size() < 2) return {0, 0};
    std::array<int, 2> out{};
    do {
      out = {noise.below(n), noise.below(n)};
    } while (out[0] == out[1] || faulty_.has(out[0]) || faulty_.has(out[1]));
    return out;
  }
  double shows(int i, const plumb::Vec3& g) const {
    return plumb::dot(tool_->row[slot(i)], g) + tool_->offset_mps2[slot(i)];
  }
  /// Gravity mirrored in the plane of two healthy axes; the two cannot tell.
  plumb::Vec3 mirrored(const plumb::Vec3& g, const std::array<int, 2>& pillar) const {
    const plumb::Vec3 across = plumb::cross(tool_->row[slot(pillar[0])], tool_->row[slot(pillar[1])]);
    const double square = plumb::dot(across, across);
    if (square < 1e-6) return g;  // parallel ones span no plane
    return plumb::minus(g, plumb::scaled(across, 2.0 * plumb::dot(g, across) / square));
  }
  plumb::Vec3 false_gravity(const plumb::Vec3& g) const {
    const double length = plumb::norm(g);
    if (!ghost_turns_) return plumb::scaled(ghost_, length);
    // Half a turn about an axis at rest in the tool.
    return plumb::minus(plumb::scaled(ghost_, 2.0 * plumb::dot(ghost_, g)), g);
  }
  double lie(int i, const plumb::Vec3& g, TrialNoise& noise) const {
    const Own& own = own_[slot(i)];
    const double truth = shows(i, g);
    switch (own.lie) {
      case Lie::constant: return truth + own.bias_mps2;
      case Lie::stuck: return own.level_mps2;
      case Lie::random: return noise.between(-3.0, 3.0) * plumb::kG0_mps2;
      case Lie::drifting: return truth + own.bias_mps2 * station_;
      case Lie::scale: return own.scale * truth;
      case Lie::sign: return -truth;
      case Lie::remount: return shows(i, mirrored(g, own.pillar));
      case Lie::swap:
        if (swap_b_ < 0) return -truth;
        return i == swap_a_ ? shows(swap_b_, g) : i == swap_b_ ? shows(swap_a_, g) : -truth;
      case Lie::colluding: return shows(i, false_gravity(g));
      case Lie::mirrored: return shows(i, mirrored(g, common_pillar_));
      case Lie::intermittent:
      case Lie::moving:
      case Lie::mixed: break;
    }
    return truth;
  }

  const TrialTool* tool_;
  plumb::SensorSet faulty_;
  Lie lie_;
  double length_mps2_ = plumb::kG0_mps2;
  plumb::Vec3 ghost_{};
  bool ghost_turns_ = false;
  int holder_ = 0, swap_a_ = -1, swap_b_ = -1, station_ = 0;
  std::array<int, 2> common_pillar_{};
  std::array<Own, plumb::kCapacity> own_{};
};

}  // namespace PLUMB_ABI
}  // namespace plumb_test

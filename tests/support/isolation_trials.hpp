/// Seeded episodes for measuring isolation: which sensors are faulty, how, and what a block at each station then reads.
/// Nothing here decides anything; tests/detection and bench/isolation_rates put the decisions to the test with it.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "plumb/array/named.hpp"
#include "plumb/calibration/calibration.hpp"
#include "plumb/core/units.hpp"
#include "plumb/detection/isolation.hpp"

namespace plumb_test {
inline namespace PLUMB_ABI {

/// splitmix64 and both halves of Box-Muller.
class TrialNoise {
 public:
  explicit TrialNoise(std::uint64_t seed) : state_(seed) {}
  double uniform() {
    state_ += 0x9E3779B97F4A7C15ULL;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30U)) * 0xBF58476D1CE4E5B9ULL;
    z = (z ^ (z >> 27U)) * 0x94D049BB133111EBULL;
    z ^= z >> 31U;
    return static_cast<double>(z >> 11U) * 0x1.0p-53;
  }
  double between(double low, double high) { return low + (high - low) * uniform(); }
  double log_between(double low, double high) { return low * std::pow(high / low, uniform()); }
  int below(int n) { return static_cast<int>(uniform() * n); }
  double sign() { return uniform() < 0.5 ? -1.0 : 1.0; }
  double normal() {
    if (have_spare_) {
      have_spare_ = false;
      return spare_;
    }
    const double u = 1.0 - uniform();
    const double a = 2.0 * plumb::kPi * uniform();
    const double r = std::sqrt(-2.0 * std::log(u));
    spare_ = r * std::sin(a);
    have_spare_ = true;
    return r * std::cos(a);
  }
  plumb::Vec3 direction() {
    const double z = between(-1.0, 1.0);
    const double a = between(0.0, 2.0 * plumb::kPi);
    const double r = std::sqrt(1.0 - z * z);
    return {r * std::cos(a), r * std::sin(a), z};
  }

 private:
  std::uint64_t state_;
  double spare_ = 0.0;
  bool have_spare_ = false;
};

inline std::size_t slot(int i) { return static_cast<std::size_t>(i); }

inline constexpr double kTrialSigma_mps2 = 5e-4 * plumb::kG0_mps2;
inline constexpr double kTrialSamples = 32.0;
/// What the gravity models of plumb claim for themselves (0.15 mg).
inline constexpr double kTrialGravitySigma_mps2 = 1.5e-4 * plumb::kG0_mps2;

/// A tool as the monitor knows it, and what its healthy sensors really read: row . g + offset, g in m/s^2.
struct TrialTool {
  plumb::SensorArray array;
  plumb::TestLimits limits;
  plumb::GravityReference gravity{plumb::kG0_mps2, kTrialGravitySigma_mps2, plumb::GravityModel::value};
  plumb::Isolation monitored;
  std::array<plumb::Vec3, plumb::kCapacity> row{};
  plumb::Readings offset_mps2{};

  void pose() {
    limits = plumb::TestLimits::from_rates(array.size(), 1e-5, 1e-6).of(array);
    monitored.pose(array, array.all());
  }
};

/// The geometries of the notes: the paper's four, Platonic where they exist, cones with and without an axis.
inline plumb::AxisList trial_axes(int n, int variant) {
  plumb::AxisList axes{};
  if (n == 4 && variant == 0) {
    plumb::paper_tetrahedron(axes);
  } else if ((n == 6 || n == 10) && variant == 0) {
    plumb::platonic(axes, n);
  } else if (n == 8 || variant == 1) {
    plumb::cone_with_axis(axes, n);
  } else {
    plumb::cone(axes, n);
  }
  return axes;
}

inline plumb::DatasheetSensor trial_sensor(int i, const plumb::Vec3& axis, double sigma_mps2) {
  plumb::DatasheetSensor s;
  s.row.id = plumb::make_id(("a" + std::to_string(i + 1)).c_str());
  s.row.axis = axis;
  s.row.sigma_mps2 = sigma_mps2;
  s.coefficients.scale = {1.0, 0.0, 0.0, 0.0};
  s.prior = {0.0115 * plumb::kG0_mps2, 0.0115, 0.0202};
  return s;
}

/// Perfectly calibrated.
inline TrialTool exact_tool(const plumb::AxisList& axes, int n, double sigma_mps2 = kTrialSigma_mps2) {
  std::vector<plumb::SensorRow> rows;
  TrialTool tool;
  for (int i = 0; i < n; ++i) {
    rows.push_back(trial_sensor(i, axes[slot(i)], sigma_mps2).row);
    tool.row[slot(i)] = axes[slot(i)];
  }
  const auto made = plumb::SensorArray::make(rows.data(), n);
  if (made) tool.array = *made;
  tool.pose();
  return tool;
}

inline TrialTool exact_tool(int n, int variant = 0, double sigma_mps2 = kTrialSigma_mps2) {
  return exact_tool(trial_axes(n, variant), n, sigma_mps2);
}

/// Calibrated by a fit over `stations` random attitudes (means of 32 samples), true parameters within 0.02 g0, 2 % and
/// 2 deg of the datasheet; the fit's own covariance is what the monitor knows. Size 0 where the fit was not accepted.
inline TrialTool fitted_tool(const plumb::AxisList& axes, int n, int stations, TrialNoise& noise,
                             double sigma_mps2 = kTrialSigma_mps2) {
  plumb::Datasheet sheet;
  sheet.size = n;
  std::array<plumb::Vec3, plumb::kCapacity> w{};
  plumb::Readings b{};
  for (int i = 0; i < n; ++i) {
    sheet.sensor[slot(i)] = trial_sensor(i, axes[slot(i)], sigma_mps2);
    plumb::Vec3 bent = axes[slot(i)];
    for (double& component : bent) component += noise.between(-0.035, 0.035);
    w[slot(i)] = plumb::scaled(bent, noise.between(0.98, 1.02) / plumb::norm(bent));
    b[slot(i)] = noise.between(-0.02, 0.02) * plumb::kG0_mps2;
  }
  std::vector<plumb::Station> seen;
  for (int k = 0; k < stations; ++k) {
    const plumb::Vec3 g = plumb::scaled(noise.direction(), plumb::kG0_mps2);
    plumb::Station s;
    s.delivered = plumb::SensorSet::first(n);
    s.temperature_degc = 25.0;
    s.count = static_cast<int>(kTrialSamples);
    for (int i = 0; i < n; ++i) {
      const double mean_noise = sigma_mps2 / std::sqrt(kTrialSamples) * noise.normal();
      s.mean[slot(i)] = plumb::dot(w[slot(i)], g) + b[slot(i)] + mean_noise;
    }
    seen.push_back(s);
  }
  TrialTool tool;
  const auto fitted = plumb::calibrate(sheet, tool.gravity, seen.data(), stations);
  if (!fitted) return tool;
  tool.array = fitted->array;
  // The model is affine at one temperature, so four of its answers are all of it.
  const auto reads = [&](const plumb::Vec3& g) {
    std::array<double, plumb::kCapacity> raw{};
    for (int i = 0; i < n; ++i) raw[slot(i)] = plumb::dot(w[slot(i)], g) + b[slot(i)];
    return fitted->model.apply(raw, 25.0, plumb::SensorSet::first(n));
  };
  tool.offset_mps2 = reads({0.0, 0.0, 0.0});
  for (std::size_t axis = 0; axis < 3; ++axis) {
    plumb::Vec3 unit{};
    unit[axis] = 1.0;
    const plumb::Readings y = reads(unit);
    for (int i = 0; i < n; ++i) tool.row[slot(i)][axis] = y[slot(i)] - tool.offset_mps2[slot(i)];
  }
  tool.pose();
  return tool;
}

inline TrialTool fitted_tool(int n, int variant, int stations, TrialNoise& noise) {
  return fitted_tool(trial_axes(n, variant), n, stations, noise);
}

/// How the faulty sensors of an episode lie.
enum class FaultLaw : std::uint8_t {
  bias,          ///< constant, log-uniform from `least` to `most`
  stuck,         ///< at 0, +-1, +-3 g0 or somewhere within +-1 g0
  random,        ///< anew at every station, within +-3 g0
  colluding,     ///< all show the same false gravity, fixed in the tool
  mirrored,      ///< all show gravity mirrored in the plane of two healthy axes, exactly, at every station
  linear,        ///< scale or sign
  drifting,      ///< a bias that grows from station to station
  intermittent,  ///< a bias that comes and goes
  mixed,         ///< every sensor by a law of its own
};
inline constexpr int kFaultLaws = 9;

class TrialEpisode {
 public:
  double least_mps2 = kTrialSigma_mps2;
  double most_mps2 = plumb::kG0_mps2;

  TrialEpisode(const TrialTool& tool, int faults, FaultLaw law, TrialNoise& noise) : TrialEpisode(tool, law) {
    draw(faults, noise);
  }
  TrialEpisode(const TrialTool& tool, int faults, FaultLaw law, double least_mps2_, double most_mps2_,
               TrialNoise& noise)
      : TrialEpisode(tool, law) {
    least_mps2 = least_mps2_;
    most_mps2 = most_mps2_;
    draw(faults, noise);
  }

  plumb::SensorSet faulty() const { return faulty_; }

  /// What every sensor reads at a station with gravity `g`, without noise; random faults are drawn anew.
  plumb::Readings readings(const plumb::Vec3& g, TrialNoise& noise) {
    plumb::Readings y{};
    const plumb::Vec3 mirror = mirrored(g);
    for (int i = 0; i < tool_->array.size(); ++i) {
      const double truth = plumb::dot(tool_->row[slot(i)], g) + tool_->offset_mps2[slot(i)];
      y[slot(i)] = faulty_.has(i) ? lie(i, truth, mirror, noise) : truth;
    }
    ++station_;
    return y;
  }

  /// The mean of a quiet block at that station.
  plumb::BlockEvidence block(const plumb::Vec3& g, TrialNoise& noise) {
    plumb::BlockEvidence out;
    out.mean_mps2 = readings(g, noise);
    out.usable = tool_->array.all();
    out.samples = kTrialSamples;
    for (int i = 0; i < tool_->array.size(); ++i) {
      out.mean_mps2[slot(i)] += tool_->array.sigma_mps2(i) / std::sqrt(kTrialSamples) * noise.normal();
    }
    return out;
  }

 private:
  TrialEpisode(const TrialTool& tool, FaultLaw law) : tool_(&tool), law_(law) {}

  void draw(int faults, TrialNoise& noise) {
    const int n = tool_->array.size();
    while (faulty_.size() < faults) faulty_ = faulty_.with(noise.below(n));
    ghost_ = plumb::scaled(noise.direction(), plumb::kG0_mps2);
    while (pillar_.size() < std::min(2, n - faults)) {
      const int i = noise.below(n);
      if (!faulty_.has(i)) pillar_ = pillar_.with(i);
    }
    for (int i = 0; i < n; ++i) {
      Lie& l = lie_[slot(i)];
      l.law = law_ == FaultLaw::mixed ? static_cast<FaultLaw>(noise.below(kFaultLaws - 1)) : law_;
      l.bias_mps2 = noise.sign() * noise.log_between(least_mps2, most_mps2);
      constexpr double kLevels[] = {0.0, 1.0, -1.0, 3.0, -3.0};
      const int level = noise.below(6);
      l.level_mps2 = (level < 5 ? kLevels[level] : noise.between(-1.0, 1.0)) * plumb::kG0_mps2;
      constexpr double kScales[] = {-1.0, 0.5, 1.1, 0.99, 1.001, 0.0};
      l.scale = kScales[noise.below(6)];
    }
  }

  plumb::Vec3 mirrored(const plumb::Vec3& g) const {
    const int j = pillar_.lowest();
    const int k = pillar_.without(j).lowest();
    if (j < 0 || k < 0) return g;
    const plumb::Vec3 across = plumb::cross(tool_->row[slot(j)], tool_->row[slot(k)]);
    const double square = plumb::dot(across, across);
    return plumb::minus(g, plumb::scaled(across, 2.0 * plumb::dot(g, across) / square));
  }

  double lie(int i, double truth, const plumb::Vec3& mirror, TrialNoise& noise) const {
    const Lie& l = lie_[slot(i)];
    const auto shows = [&](const plumb::Vec3& v) {
      return plumb::dot(tool_->row[slot(i)], v) + tool_->offset_mps2[slot(i)];
    };
    switch (l.law) {
      case FaultLaw::bias: return truth + l.bias_mps2;
      case FaultLaw::stuck: return l.level_mps2;
      case FaultLaw::random: return noise.between(-3.0, 3.0) * plumb::kG0_mps2;
      case FaultLaw::colluding: return shows(ghost_);
      case FaultLaw::mirrored: return shows(mirror);
      case FaultLaw::linear: return l.scale * truth;
      case FaultLaw::drifting: return truth + l.bias_mps2 * station_;
      case FaultLaw::intermittent: return noise.uniform() < 0.5 ? truth : truth + l.bias_mps2;
      case FaultLaw::mixed: break;
    }
    return truth;
  }

  struct Lie {
    FaultLaw law = FaultLaw::bias;
    double bias_mps2 = 0.0, level_mps2 = 0.0, scale = 1.0;
  };

  const TrialTool* tool_;
  FaultLaw law_;
  plumb::SensorSet faulty_, pillar_;
  plumb::Vec3 ghost_{};
  std::array<Lie, plumb::kCapacity> lie_{};
  int station_ = 0;
};

/// Directions of an episode: anywhere, rolling at one inclination, or creeping by a few degrees a station.
class TrialAttitudes {
 public:
  explicit TrialAttitudes(TrialNoise& noise)
      : way_(noise.below(4)), inclination_(noise.between(0.03, 1.6)), toolface_(noise.between(0.0, 6.28)) {}
  plumb::Vec3 next(TrialNoise& noise) {
    if (way_ < 2) return noise.direction();
    toolface_ += way_ == 2 ? noise.between(0.1, 3.0) : noise.between(0.02, 0.15);
    if (way_ == 3) inclination_ += noise.between(-0.05, 0.05);
    const double s = std::sin(inclination_);
    return {-s * std::sin(toolface_), -s * std::cos(toolface_), std::cos(inclination_)};
  }

 private:
  int way_;
  double inclination_, toolface_;
};

/// What became of a trial. `wrong`: a healthy sensor was named, at any station of it.
struct TrialCount {
  std::uint64_t trials = 0, correct = 0, undecided = 0, wrong = 0;
  void add(plumb::SensorSet faulty, plumb::SensorSet answer, bool blamed_healthy) {
    ++trials;
    if (blamed_healthy || !faulty.contains(answer)) {
      ++wrong;
    } else if (answer == faulty) {
      ++correct;
    } else {
      ++undecided;
    }
  }
};

/// One episode of `stations` blocks through the confirmed grade; right is the answer after the last one.
inline void strict_trial(const TrialTool& tool, TrialEpisode& episode, int stations, TrialNoise& noise,
                         TrialCount& count) {
  plumb::Isolation isolation = tool.monitored;
  plumb::IsolationAnswer answer;
  bool blamed = false;
  for (int k = 0; k < stations; ++k) {
    const plumb::Vec3 g = plumb::scaled(noise.direction(), plumb::kG0_mps2);
    answer = isolation.vote({tool.array, tool.gravity, tool.limits, episode.block(g, noise)});
    blamed = blamed || !episode.faulty().contains(answer.strict);
  }
  count.add(episode.faulty(), answer.strict, blamed);
}

/// Grades that named a healthy sensor in an episode whose faults they promise to bear.
struct Soundness {
  std::uint64_t trials = 0, votes = 0;
  std::uint64_t strict = 0, parity = 0, asserted = 0;  ///< wrong ones
  std::uint64_t strict_right = 0, parity_asked = 0, asserted_asked = 0;
};

/// One episode with at most m_strict faults of any kind, and at least `healthy` sensors without. `gravity_error` in
/// sigmas of the gravity reference.
inline void soundness_trial(const TrialTool& tool, double gravity_error, int healthy, int stations, TrialNoise& noise,
                            Soundness& out) {
  const int most = std::min(tool.monitored.confirmed_grade(), tool.array.size() - healthy);
  const int m = 1 + noise.below(most);
  const auto law = static_cast<FaultLaw>(noise.below(kFaultLaws));
  TrialEpisode episode(tool, m, law, noise);
  const double length = plumb::kG0_mps2 + gravity_error * tool.gravity.sigma_mps2;
  TrialAttitudes attitudes(noise);
  plumb::Isolation isolation = tool.monitored;
  const bool ask_parity = m <= tool.monitored.provisional_grade();
  const bool ask_asserted = m <= plumb::kScanDepth && noise.below(4) == 0;
  bool strict = false, parity = false, asserted = false;
  plumb::SensorSet last;
  for (int k = 0; k < stations; ++k) {
    const plumb::BlockEvidence block = episode.block(plumb::scaled(attitudes.next(noise), length), noise);
    const plumb::IsolationAnswer answer = isolation.vote({tool.array, tool.gravity, tool.limits, block});
    strict = strict || !episode.faulty().contains(answer.strict);
    if (ask_parity) parity = parity || !episode.faulty().contains(answer.parity);
    if (ask_asserted) {
      const plumb::FaultSetScan scan =
          isolation.scan({tool.array, tool.gravity, tool.limits, block}, tool.array.all(), m, m, {1, 4.9});
      asserted = asserted || !episode.faulty().contains(scan.asserted);
    }
    last = answer.strict;
  }
  ++out.trials;
  out.votes += static_cast<std::uint64_t>(stations);
  out.strict += strict ? 1U : 0U;
  out.parity += parity ? 1U : 0U;
  out.asserted += asserted ? 1U : 0U;
  out.strict_right += last == episode.faulty() ? 1U : 0U;
  out.parity_asked += ask_parity ? 1U : 0U;
  out.asserted_asked += ask_asserted ? 1U : 0U;
}

}  // namespace PLUMB_ABI
}  // namespace plumb_test

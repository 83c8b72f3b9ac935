/// A simulated vehicle for tests of the review: chips that read specific force with errors that a test chooses. It
/// knows nothing of the code that judges them.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "plumb/review/log_digest.hpp"
#include "plumb/review/log_review.hpp"

namespace review_flight {

using plumb::review::Axes;

/// Errors of one chip as a function of time.
struct SimulatedChip {
  std::string name;
  std::uint64_t device_id = 0;
  std::function<Axes(double time_s, Axes truth)> reads = [](double, Axes truth) { return truth; };
  double noise_mps2 = 0.02;
  double rate_hz = 100.0;
  double from_s = 0.0, to_s = 1.0e9;
};

/// Forward, right, down: at rest a chip reads (0, 0, -9.81).
struct SimulatedFlight {
  double rest_s = 10.0, motion_s = 30.0;
  double vibration_mps2 = 1.0;  ///< while it moves
  double rate_radps = 0.3;
  double gravity_mps2 = 9.81;
  bool gyro = true;
  unsigned seed = 1;
  std::vector<SimulatedChip> chips;

  Axes truth(double time_s) const {
    if (time_s < rest_s) return {0.0, 0.0, -gravity_mps2};
    const double t = time_s - rest_s;
    return {2.0 * std::sin(0.7 * t), 1.5 * std::sin(0.9 * t + 1.0), -gravity_mps2 + 1.0 * std::sin(1.3 * t)};
  }

  plumb::review::LogDigest digest(std::size_t most_blocks = plumb::review::kMostBlocks) const {
    plumb::review::LogDigester digester(most_blocks);
    std::mt19937 engine(seed);
    std::normal_distribution<double> normal;
    for (std::size_t number = 0; number < chips.size(); ++number) {
      const SimulatedChip& chip = chips[number];
      plumb::logs::ImuSource source;
      source.name = chip.name;
      source.instance = static_cast<int>(number);
      source.device_id = chip.device_id;
      digester.source(number, source);
      const double end_s = std::min(rest_s + motion_s, chip.to_s);
      const auto last = static_cast<long>((end_s - chip.from_s) * chip.rate_hz);
      for (long k = 0; k < last; ++k) {
        plumb::logs::ImuRecord record;
        record.time_s = chip.from_s + static_cast<double>(k) / chip.rate_hz;
        const bool moves = record.time_s >= rest_s;
        record.specific_force_mps2 = truth(record.time_s);
        for (double& x : record.specific_force_mps2) {
          x += chip.noise_mps2 * normal(engine) + (moves ? vibration_mps2 * normal(engine) : 0.0);
        }
        record.specific_force_mps2 = chip.reads(record.time_s, record.specific_force_mps2);
        if (gyro) record.rate_radps = {moves ? rate_radps : 0.001, 0.0, 0.0};
        record.temperature_degc = 30.0;
        digester.record(number, record);
      }
    }
    plumb::logs::LogExtent extent;
    extent.bytes = extent.read_bytes = 1000;
    return digester.take("flight", extent);
  }

  plumb::review::LogReview review() const { return plumb::review::review_log(digest()); }
};

inline SimulatedFlight with_chips(int count) {
  SimulatedFlight out;
  for (int k = 0; k < count; ++k) {
    SimulatedChip chip;
    chip.name = "IMU[" + std::to_string(k) + "]";
    chip.device_id = 1000U + static_cast<unsigned>(k);
    out.chips.push_back(chip);
  }
  return out;
}

inline std::size_t count_of(const plumb::review::LogReview& review, plumb::review::FindingCode code) {
  std::size_t out = 0;
  for (const plumb::review::Finding& finding : review.findings) out += finding.code == code ? 1U : 0U;
  return out;
}

inline const plumb::review::Finding* first_of(const plumb::review::LogReview& review, plumb::review::FindingCode code) {
  for (const plumb::review::Finding& finding : review.findings) {
    if (finding.code == code) return &finding;
  }
  return nullptr;
}

}  // namespace review_flight

#include "plumb/health/detail/freshness.hpp"

#include <algorithm>
#include <cmath>

#include "plumb/array/geometry.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

using std::size_t;

namespace {

/// In blocks, from the first sample to the last, each one period shorter than a block lasts: time stamps that jitter.
constexpr double kMovedAge = 1.25;

constexpr std::uint16_t one_more(std::uint16_t run) noexcept {
  return run < kMostConfirm ? static_cast<std::uint16_t>(run + 1) : run;
}

}  // namespace

void Freshness::measure(const SensorArray& array, const BlockAccumulator& block, const BlockNoise& expected,
                        double independent, const std::array<float, kCapacity>& resolution_mps2,
                        SensorSet noisy) noexcept {
  for (int i = 0; i < array.size(); ++i) {
    const auto a = static_cast<size_t>(i);
    const double variance = noisy.has(i) ? std::fmax(expected.of(i), block.covariance(i, i)) : expected.of(i);
    const double noise = kDepartureSigmas * std::sqrt(variance * (1.0 + 1.0 / independent));
    tolerance_mps2_[a] = static_cast<float>(noise + static_cast<double>(resolution_mps2[a]));
  }
}

void Freshness::anchor(const MonitorConfig& config, double time_s, double motion_mps2) noexcept {
  const double most_s =
      config.max_age_s == 0.0 ? std::fmax(kLeastAge_s, 2.0 * (time_s - block_begin_s_)) : config.max_age_s;
  motion_mps2_ = static_cast<float>(motion_mps2);
  most_age_s_ = static_cast<float>(most_s);
  most_samples_ = static_cast<std::uint32_t>(config.max_age_samples > 0 ? config.max_age_samples : 2 * config.window);
  samples_ = 0;
  missing_run_ = 0;
  anchored_ = true;
  departed_ = false;
}

void Freshness::anchor_moving(const MonitorConfig& config, double time_s, double motion_mps2, double trace) noexcept {
  anchor(config, time_s, motion_mps2);
  most_age_s_ = std::fmin(most_age_s_, static_cast<float>(kMovedAge * (time_s - block_begin_s_)));
  most_samples_ = std::min(most_samples_, static_cast<std::uint32_t>(config.window));
  most_away_mps2_ = motion_mps2 + kVectorSigmas * std::sqrt(trace);
}

void Freshness::note(const SensorArray& array, SensorSet in_service, SensorSet usable, const Readings& y_mps2,
                     const BlockEvidence& block) noexcept {
  count_up(samples_);
  missing_run_ = usable.contains(in_service) ? std::uint16_t{0} : one_more(missing_run_);
  compare(array, in_service, usable, y_mps2, block);
}

void Freshness::compare(const SensorArray& array, SensorSet in_service, SensorSet usable, const Readings& y_mps2,
                        const BlockEvidence& block) noexcept {
  const SensorSet compared = in_service & usable & block.usable;
  // Sensors that span no space do not feel every turn: their agreement says nothing.
  departed_ = !compared.contains(in_service) && rank_of(array, compared) < 3;
  // Any one sensor of the block may be the only one that feels the motion: where one is silent, none is allowed for.
  const float motion_mps2 = compared.contains(in_service & block.usable) ? motion_mps2_ : 0.0F;
  std::uint32_t left = compared.bits;
  for (size_t a = 0; left != 0 && a < y_mps2.size(); ++a, left >>= 1U) {
    // Written so that what is not a number has departed.
    const auto away_mps2 = static_cast<float>(y_mps2[a] - block.mean_mps2[a]);
    if ((left & 1U) != 0 && !(std::fabs(away_mps2) <= tolerance_mps2_[a] + motion_mps2)) departed_ = true;
  }
}

void Freshness::note_nothing() noexcept {
  count_up(samples_);
  missing_run_ = one_more(missing_run_);
}

void Freshness::note_gap() noexcept {
  note_nothing();
  departed_ = true;
}

bool Freshness::holds(const MonitorConfig& config, double age_s) const noexcept {
  return anchored_ && !departed_ && missing_run_ < config.missing_confirm && samples_ <= most_samples_ &&
         age_s <= static_cast<double>(most_age_s_);
}

}  // namespace PLUMB_ABI
}  // namespace plumb

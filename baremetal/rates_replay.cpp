// Redundant gyros in the place of a tool: six axes at rest, then turning; one sticks. Host and target make the same
// readings, by sums and products alone, so the recording has nothing in it.
#include "plumb/array/named.hpp"
#include "plumb/motion/rate_monitor.hpp"
#include "replay.hpp"

namespace metal {
inline namespace PLUMB_ABI {
namespace {

/// Behind the states of a monitor at rest (judge.cpp), as in motion.
constexpr std::uint64_t kInMotion = 6;
constexpr std::uint64_t kRows = 4000, kRest = 320, kStuckFrom = 2000;
constexpr std::size_t kAxes = 6, kStuck = 3;

// Static, as an instrument would have them.
plumb::RateSetup setup;
plumb::RateMonitor monitor;

bool configure(plumb::AxisList& axes) noexcept {
  plumb::cone(axes, kAxes);
  plumb::SensorRow row[kAxes];
  for (std::size_t i = 0; i < kAxes; ++i) {
    const char id[] = {'g', static_cast<char>('1' + i), '\0'};
    row[i] = {plumb::make_id(id), axes[i], 0.002};
  }
  setup.errors.fill({0.01, 0.005, 0.005, 50e-6, 1e-4});
  const plumb::Expected<plumb::SensorArray> array = plumb::SensorArray::make(row, kAxes);
  return array && monitor.configure(*array, setup).has_value();
}

void take(std::uint64_t k, const plumb::AxisList& axes, std::uint32_t& random, plumb::RateSample& s) noexcept {
  s.time_s = 0.001 * static_cast<double>(k);
  s.at_rest = k < kRest;
  const double t = s.at_rest ? 0.0 : s.time_s - 0.001 * static_cast<double>(kRest);
  const plumb::Vec3 rate_radps = {1.2 * t * (2.0 - 0.5 * t), 0.8 * t, -1.5 * t + 0.2 * t * t};
  for (std::size_t i = 0; i < kAxes; ++i) {
    random = 1664525U * random + 1013904223U;
    const double noise = 0.004 * (static_cast<double>(random >> 8U) / 16777216.0 - 0.5);
    s.rate_radps[i] = (i == kStuck && k >= kStuckFrom ? 0.0 : plumb::dot(axes[i], rate_radps)) + noise;
  }
}

void put_rate(Answers& out, const plumb::AngularRate& rate) noexcept {
  out.exact.word(static_cast<std::uint64_t>(rate.validity) << 32U | rate.used.bits);
  for (const double part : rate.rate_radps) out.exact.number(part);
  out.figures.number(rate.bound_radps);
}

void put_verdict(Answers& out, const plumb::RateVerdict& v) noexcept {
  out.exact.word(static_cast<std::uint64_t>(v.cause) << 32U | (v.alarm ? 2U : 0U) | (v.turned_at_rest ? 1U : 0U));
  out.exact.word(static_cast<std::uint64_t>(v.suspects.bits) << 32U | v.off_at_rest.bits);
  out.exact.word(static_cast<std::uint64_t>(v.isolated.bits) << 32U | v.excluded.bits);
  put_rate(out, v.sample);
  if (v.block_ended) put_rate(out, v.block);
}

/// The longest blocks that end with the sample before the last of so many.
Work work_of(std::uint64_t samples) noexcept {
  if (samples % 256U == 1U) return Work::longest_block;
  if (samples % 32U == 1U) return Work::block;
  return samples % 4U == 1U ? Work::short_block : Work::sample;
}

}  // namespace

int replay(const std::uint64_t* /*recording*/, std::size_t /*size*/, Answers& answers, WordWriter* costs,
           Clock clock) noexcept {
  plumb::AxisList axes{};
  if (!configure(axes)) return 1;
  plumb::RateSample sample;
  sample.delivered = plumb::SensorSet::first(static_cast<int>(kAxes));
  sample.force_mps2 = 9.81;
  std::uint32_t random = 1;
  for (std::uint64_t k = 0; k < kRows; ++k) {
    take(k, axes, random, sample);
    const std::uint32_t a = clock != nullptr ? clock() : 0, b = clock != nullptr ? clock() : 0;
    monitor.step(sample);
    const std::uint32_t ticks = clock != nullptr ? clock() - b : 0;
    put_verdict(answers, monitor.verdict());
    if (costs == nullptr) continue;
    costs->word(kInMotion << 8U | static_cast<std::uint64_t>(work_of(k + 1)));
    costs->word(ticks);
    costs->word(b - a);
  }
  if (monitor.verdict().excluded != plumb::SensorSet::of(static_cast<int>(kStuck))) return 4;
  return answers.exact.full() || answers.figures.full() ? 6 : 0;
}

std::size_t monitor_size() noexcept { return sizeof monitor; }

}  // namespace PLUMB_ABI
}  // namespace metal

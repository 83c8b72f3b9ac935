#include "ticks.hpp"

#include <cmath>

#include "plumb/array/named.hpp"

namespace metal {
namespace {

constexpr double kSigma_mps2 = 0.002;

bool within(int tick, int from_s, int to_s) noexcept { return tick >= from_s * 1000 && tick < to_s * 1000; }

}  // namespace

bool TickedTool::make() noexcept {
  plumb::AxisList axes{};
  plumb::SensorRow rows[4];
  plumb::paper_tetrahedron(axes);
  const char* const ids[] = {"a1", "a2", "a3", "a4"};
  for (std::size_t i = 0; i < 4; ++i) rows[i] = {plumb::make_id(ids[i]), axes[i], kSigma_mps2};
  const plumb::Expected<plumb::SensorArray> array = plumb::SensorArray::make(rows, 4);
  if (!array) return false;
  setup_.array = *array;
  setup_.model.size = 4;
  setup_.stability.fill({0.001, 0.0, 0.0, 0.0});
  for (int stand = 0; stand < kStands; ++stand) {
    const double tilt_rad = 0.3 + 0.15 * (stand % 7), turn_rad = 1.1 * stand;
    const plumb::Vec3 down = {std::sin(tilt_rad) * std::cos(turn_rad), std::sin(tilt_rad) * std::sin(turn_rad),
                              std::cos(tilt_rad)};
    for (int i = 0; i < 4; ++i) raw_[stand][i] = plumb::kG0_mps2 * plumb::dot(array->axis(i), down);
  }
  return true;
}

void TickedTool::sample(int tick, plumb::Sample& out) noexcept {
  const double* raw = raw_[tick / kTicksOfAStand % kStands];
  out.time_s = kTick_s * tick;
  out.delivered = plumb::SensorSet::first(4);
  for (int i = 0; i < 4; ++i) {
    random_ = random_ * 1664525U + 1013904223U;
    const double noise = 3.4641016151377544 * kSigma_mps2 * ((random_ >> 8U) / 16777216.0 - 0.5);
    out.raw[static_cast<std::size_t>(i)] = raw[i] + noise;
  }
  if (within(tick, 100, 300)) out.raw[1] = 0.0;
  if (within(tick, 400, 600)) out.raw[2] += 0.5;
  if (within(tick, 700, 710)) out.delivered = out.delivered.without(0);
}

int wrong_after(int tick, const plumb::Verdict& verdict) noexcept {
  const auto state = verdict.state;
  if (tick == 99999) return state == plumb::HealthState::nominal ? 0 : 1;
  if (tick == 299999) return verdict.excluded == plumb::SensorSet{}.with(1) ? 0 : 2;
  if (tick == 399999) return verdict.excluded.empty() && state == plumb::HealthState::nominal ? 0 : 3;
  if (tick == 599999) return verdict.excluded == plumb::SensorSet{}.with(2) ? 0 : 4;
  if (tick == 699999) return verdict.excluded.empty() && state == plumb::HealthState::nominal ? 0 : 5;
  if (tick == 709999) return verdict.absent == plumb::SensorSet{}.with(0) ? 0 : 6;
  if (tick == kTicks - 1) return verdict.excluded.empty() && state == plumb::HealthState::nominal ? 0 : 7;
  return 0;
}

}  // namespace metal

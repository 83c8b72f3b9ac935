/// A run of a tool of four sensors by the monitor of whichever build includes this: nothing of it is shared between two
/// builds, so that one program can hold both.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

#include "plumb/array/named.hpp"
#include "plumb/health/health_monitor.hpp"
#include "told.hpp"

namespace {

constexpr int kRunSteps = 10000;
constexpr int kFirstFault = 3000;

/// Raw values are volts: 2 V/g0 or so, an offset, and a thermometer that drifts.
inline plumb::MonitorSetup four_sensors(double sigma_mps2) {
  plumb::AxisList axes{};
  plumb::paper_tetrahedron(axes);
  std::array<plumb::SensorRow, 4> rows{};
  plumb::MonitorSetup setup;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const char id[] = {'a', static_cast<char>('1' + i), '\0'};
    rows[i] = {plumb::make_id(id), axes[i], sigma_mps2};
    const double part = static_cast<double>(i);
    setup.model.sensor[i].scale = {0.2 + 0.003 * part, 2e-5, 0.0, 0.0};
    setup.model.sensor[i].bias = {0.3 - 0.2 * part, 1e-3, 0.0, 0.0};
    setup.full_scale_raw[i] = 5.0;
    setup.resolution_raw[i] = 1e-7;
  }
  const plumb::Expected<plumb::SensorArray> array = plumb::SensorArray::make(rows.data(), 4);
  if (array) setup.array = *array;
  setup.model.size = 4;
  setup.output_frame = {0, 1, 0, 0, 0, 1, 1, 0, 0};
  return setup;
}

/// A new attitude every 4 s, 100 samples a second, turned to over 0.2 s; where it is `rough` single spikes, some as the
/// first sample of a block; a2 is dead from 30 s to 55 s, a3 is silent from 70 s on, the whole tool shakes from 60 s to
/// 62 s.
class RecordedRun {
 public:
  RecordedRun(const plumb::MonitorSetup& setup, std::uint32_t seed, bool rough)
      : setup_(&setup), random_(seed), rough_(rough) {}

  plumb::Sample sample(int k) {
    const int stand = k / 400;
    const double into = (k % 400) / 20.0, late = into < 1.0 ? into - 1.0 : 0.0;
    const double tilt_rad = 0.3 + 0.15 * ((stand + late) - 6.0 * std::floor((stand + late) / 6.0));
    const double turn_rad = 1.1 * (stand + late);
    const double shaken = rough_ && k >= 6000 && k < 6200 ? 3.0 * std::sin(0.7 * k) : 0.0;
    const plumb::Vec3 down = {std::sin(tilt_rad) * std::cos(turn_rad), std::sin(tilt_rad) * std::sin(turn_rad),
                              std::cos(tilt_rad)};
    plumb::Sample out;
    out.time_s = 0.01 * k;
    out.temperature_degc = 25.0 + 0.01 * (k / 50);
    out.delivered = setup_->array.all();
    for (int i = 0; i < 4; ++i) {
      const plumb::Vec3 axis = setup_->array.axis(i);
      const double y =
          plumb::kG0_mps2 * plumb::dot(axis, down) + shaken * axis[0] + noise() * setup_->array.sigma_mps2(i);
      const double spike = rough_ && k % 997 == 32 * (i + 1) ? 40.0 : 0.0;
      out.raw[static_cast<std::size_t>(i)] = setup_->model.scale_at(i, out.temperature_degc) *
                                             (y + spike + setup_->model.bias_at(i, out.temperature_degc));
    }
    if (k >= kFirstFault && k < 5500) out.raw[1] = 0.0;
    if (k >= 7000) out.delivered = out.delivered.without(2);
    return out;
  }

 private:
  /// Sum of four even ones: variance 1.
  double noise() {
    double sum = 0.0;
    for (int k = 0; k < 4; ++k) {
      random_ = random_ * 1664525U + 1013904223U;
      sum += (random_ >> 8U) / 16777216.0 - 0.5;
    }
    return std::sqrt(3.0) * sum;
  }
  const plumb::MonitorSetup* setup_;
  std::uint32_t random_;
  bool rough_;
};

inline single_test::Told told_by(const plumb::Verdict& v) {
  single_test::Told out;
  out.words = {static_cast<std::uint64_t>(v.state),
               static_cast<std::uint64_t>(v.cause),
               static_cast<std::uint64_t>(v.validity),
               v.qualifiers,
               v.usable,
               v.in_service.bits,
               v.excluded.bits,
               v.absent.bits,
               v.provisionally_excluded.bits,
               v.suspects.bits,
               v.noisy.bits,
               v.stuck.bits,
               v.clipped.bits,
               v.tick ? 1U : 0U,
               v.alert ? 1U : 0U,
               v.wants_rotation ? 1U : 0U,
               v.transition.sequence,
               static_cast<std::uint64_t>(v.consistent_hypotheses)};
  out.gravity_mps2 = v.gravity_mps2;
  out.latest_mps2 = v.latest_mps2;
  out.protection_rad = v.protection_level_calibrated_axes_rad;
  out.mae_mps2 = {v.mae_all_mps2, v.mae_worst_mps2};
  return out;
}

inline std::vector<single_test::Told> recorded_run(double sigma_mps2, std::uint32_t seed, bool rough) {
  const plumb::MonitorSetup setup = four_sensors(sigma_mps2);
  const auto monitor = std::make_unique<plumb::HealthMonitor>();
  std::vector<single_test::Told> out;
  if (!monitor->configure(setup)) return out;
  RecordedRun run(setup, seed, rough);
  for (int k = 0; k < kRunSteps; ++k) {
    if (k == 5800) static_cast<void>(monitor->reset(setup.config.reset_key, plumb::SensorSet::of(1)));
    out.push_back(told_by(monitor->step(run.sample(k))));
  }
  return out;
}

}  // namespace

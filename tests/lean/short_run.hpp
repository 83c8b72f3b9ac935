/// A run of a tool of four sensors by the monitor of whichever build includes this: nothing of it is shared between two
/// builds, so that one program can hold both.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

#include "plumb/array/named.hpp"
#include "plumb/core/detail/archive.hpp"
#include "plumb/health/health_monitor.hpp"

namespace {

constexpr double kSigma_mps2 = 0.002;
constexpr int kRunSteps = 9000;

/// Raw values are m/s^2 along the axes of a tetrahedron.
inline plumb::MonitorSetup four_sensors() {
  plumb::AxisList axes{};
  plumb::paper_tetrahedron(axes);
  std::array<plumb::SensorRow, 4> rows{};
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const char id[] = {'a', static_cast<char>('1' + i), '\0'};
    rows[i] = {plumb::make_id(id), axes[i], kSigma_mps2};
  }
  plumb::MonitorSetup setup;
  const plumb::Expected<plumb::SensorArray> array = plumb::SensorArray::make(rows.data(), 4);
  if (array) setup.array = *array;
  setup.model.size = 4;
  setup.config.recalibrate_after_exclusion = false;
  return setup;
}

/// A new attitude every 4 s, 100 samples a second; a2 is dead from 30 s to 55 s, a3 is silent from 70 s on.
class ShortRun {
 public:
  plumb::Sample sample(const plumb::SensorArray& array, int k) {
    const int stand = k / 400;
    const double tilt_rad = 0.3 + 0.15 * (stand % 6), turn_rad = 1.1 * stand;
    const plumb::Vec3 down = {std::sin(tilt_rad) * std::cos(turn_rad), std::sin(tilt_rad) * std::sin(turn_rad),
                              std::cos(tilt_rad)};
    plumb::Sample out;
    out.time_s = 0.01 * k;
    out.delivered = array.all();
    for (int i = 0; i < array.size(); ++i) {
      random_ = random_ * 1664525U + 1013904223U;
      const double noise = std::sqrt(12.0) * kSigma_mps2 * ((random_ >> 8U) / 16777216.0 - 0.5);
      out.raw[static_cast<std::size_t>(i)] = plumb::kG0_mps2 * plumb::dot(array.axis(i), down) + noise;
    }
    if (k >= 3000 && k < 5500) out.raw[1] = 0.0;
    if (k >= 7000) out.delivered = out.delivered.without(2);
    return out;
  }

 private:
  std::uint32_t random_ = 1;
};

/// What it says of recalibration left out: how many stations are on record is a matter of the build.
inline std::uint64_t digest_of(plumb::Verdict verdict) {
  verdict.recalibration = plumb::RecalibrationProgress{};
  plumb::ArchiveWriter out(nullptr, 0, plumb::kCapacity);
  out.put(verdict);
  return out.crc();
}

/// One number per step, and the states that were seen, as bits.
inline std::vector<std::uint64_t> short_run(unsigned& states) {
  const plumb::MonitorSetup setup = four_sensors();
  const auto monitor = std::make_unique<plumb::HealthMonitor>();
  std::vector<std::uint64_t> out;
  if (!monitor->configure(setup)) return out;
  ShortRun run;
  for (int k = 0; k < kRunSteps; ++k) {
    if (k == 6000) static_cast<void>(monitor->reset(setup.config.reset_key, plumb::SensorSet::of(1)));
    const plumb::Verdict& v = monitor->step(run.sample(setup.array, k));
    states |= 1U << static_cast<unsigned>(v.state);
    out.push_back(digest_of(v));
  }
  return out;
}

}  // namespace

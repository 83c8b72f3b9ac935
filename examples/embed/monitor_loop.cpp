// plumb inside an instrument: no file, no heap. An array built by hand, a loop of samples, and the verdict.
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>

#include "plumb/array/named.hpp"
#include "plumb/health/health_monitor.hpp"

namespace {

constexpr double kSigma_mps2 = 0.002;  // noise of one sample, 1 sigma
plumb::MonitorSetup setup;             // both are plain state, 10 and 33 kB: better static than on a small stack
plumb::HealthMonitor monitor;
std::array<std::uint8_t, plumb::HealthMonitor::snapshot_size_max()> bytes;  // yours, static

int refused(const plumb::Error& error) {
  std::printf("refused: %s; %s\n", plumb::describe(error.code), plumb::remedy(error.code));
  return 1;
}

// Stands in for the converter: a new attitude every 4 s, 100 samples a second, and a2 is dead from 30 s on.
plumb::Sample simulated(const plumb::SensorArray& array, int k) {
  static std::uint32_t random = 1;
  const int stand = k / 400;
  const double tilt_rad = 0.3 + 0.15 * (stand % 6), turn_rad = 1.1 * stand;
  const plumb::Vec3 down = {std::sin(tilt_rad) * std::cos(turn_rad), std::sin(tilt_rad) * std::sin(turn_rad),
                            std::cos(tilt_rad)};
  plumb::Sample sample;
  sample.time_s = 0.01 * k;
  sample.delivered = array.all();
  for (int i = 0; i < array.size(); ++i) {
    random = random * 1664525U + 1013904223U;  // uniform noise with the standard deviation that the array states
    const double noise = std::sqrt(12.0) * kSigma_mps2 * ((random >> 8U) / 16777216.0 - 0.5);
    sample.raw[static_cast<std::size_t>(i)] = plumb::kG0_mps2 * plumb::dot(array.axis(i), down) + noise;
  }
  if (sample.time_s >= 30.0) sample.raw[1] = 0.0;
  return sample;
}

}  // namespace

int main() {
  plumb::AxisList axes{};
  plumb::SensorRow rows[4];
  plumb::paper_tetrahedron(axes);
  const char* const ids[] = {"a1", "a2", "a3", "a4"};
  for (std::size_t i = 0; i < 4; ++i) rows[i] = {plumb::make_id(ids[i]), axes[i], kSigma_mps2};
  const plumb::Expected<plumb::SensorArray> array = plumb::SensorArray::make(rows, 4);
  if (!array) return refused(array.error());
  setup.array = *array;
  setup.model.size = 4;                          // scale 1, bias 0: the raw values are m/s^2 along the axes already
  setup.stability.fill({0.001, 0.0, 0.0, 0.0});  // drift since the calibration, 1 sigma, from the datasheet
  const plumb::Expected<void> ready = monitor.configure(setup);
  if (!ready) return refused(ready.error());
  for (int k = 0; k < 6000; ++k) {
    const plumb::Verdict& v = monitor.step(simulated(*array, k));
    if (v.transition.sequence == 0) continue;
    std::printf("%6.2f s  %s -> %s  cause %s, output %s\n", v.time_s, plumb::to_string(v.transition.from),
                plumb::to_string(v.state), plumb::to_string(v.cause), plumb::to_string(v.validity));
  }
  const plumb::Expected<std::size_t> size = monitor.snapshot(bytes.data(), bytes.size());
  if (!size) return refused(size.error());
  // write `*size` bytes to flash; the power goes and comes back; read them again
  const plumb::Expected<void> taken = monitor.restore(setup, bytes.data(), bytes.size());
  if (!taken) return refused(taken.error());
  std::printf("after a power cycle: %s\n", plumb::to_string(monitor.step(simulated(*array, 6000)).state));
}

// Samples arrive by an interrupt, the monitor runs in the loop: a ring between the two, so that a step that takes
// longer than the time between two samples loses none. Here a thread plays the interrupt; on a Cortex-M it is the timer
// (docs/embedding.md).
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <thread>

#include "plumb/array/named.hpp"
#include "plumb/health/health_monitor.hpp"
#include "sample_ring.hpp"

namespace {

constexpr int kSamples = 6000;
constexpr double kSigma_mps2 = 0.002;
plumb::MonitorSetup setup;
plumb::HealthMonitor monitor;
SampleRing<plumb::Sample, 64> ring;

int refused(const plumb::Error& error) {
  std::printf("refused: %s; %s\n", plumb::describe(error.code), plumb::remedy(error.code));
  return 1;
}

// Stands in for the converter: a new attitude every 4 s, 100 samples a second, and a2 is dead from 30 s on.
void interrupt(int k) {
  static std::uint32_t random = 1;
  const double tilt_rad = 0.3 + 0.15 * (k / 400 % 6), turn_rad = 1.1 * (k / 400);
  const plumb::Vec3 down = {std::sin(tilt_rad) * std::cos(turn_rad), std::sin(tilt_rad) * std::sin(turn_rad),
                            std::cos(tilt_rad)};
  plumb::Sample sample;
  sample.time_s = 0.01 * k;
  sample.delivered = setup.array.all();
  for (int i = 0; i < setup.array.size(); ++i) {
    random = random * 1664525U + 1013904223U;
    const double noise = std::sqrt(12.0) * kSigma_mps2 * ((random >> 8U) / 16777216.0 - 0.5);
    sample.raw[static_cast<std::size_t>(i)] = plumb::kG0_mps2 * plumb::dot(setup.array.axis(i), down) + noise;
  }
  if (sample.time_s >= 30.0) sample.raw[1] = 0.0;
  ring.put(sample);
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
  setup.model.size = 4;
  setup.stability.fill({0.001, 0.0, 0.0, 0.0});
  const plumb::Expected<void> ready = monitor.configure(setup);
  if (!ready) return refused(ready.error());
  std::thread timer([] {
    for (int k = 0; k < kSamples; ++k) {
      while (ring.waiting() == 64) std::this_thread::yield();  // a thread can wait; an interrupt drops and counts
      interrupt(k);
    }
  });
  plumb::Sample sample;
  for (int k = 0; k < kSamples;) {
    if (!ring.take(sample)) {
      std::this_thread::yield();  // here an instrument sleeps until the next interrupt
      continue;
    }
    ++k;
    const plumb::Verdict& v = monitor.step(sample);
    if (v.transition.sequence == 0) continue;
    std::printf("%6.2f s  %s -> %s  cause %s, output %s\n", v.time_s, plumb::to_string(v.transition.from),
                plumb::to_string(v.state), plumb::to_string(v.cause), plumb::to_string(v.validity));
  }
  timer.join();
  std::printf("samples lost: %u\n", static_cast<unsigned>(ring.lost()));
  return ring.lost() == 0 ? 0 : 1;
}

// What one sample costs: the whole monitor, and against it the rival in the same run: the inverse of
// every triple recomputed per sample with Eigen, which is what a straightforward reading of the paper does.
#include <benchmark/benchmark.h>

#include <Eigen/Dense>
#include <memory>
#include <random>
#include <vector>

#include "bench_array.hpp"
#include "plumb/health/health_monitor.hpp"

namespace {

using namespace plumb;
using plumb_bench::array_of;

/// Built once for 4, once for 8 and once for 16 sensors; each measures the arrays that no smaller build takes.
void sizes_of_this_build(benchmark::internal::Benchmark* b) {
  for (const int n : {4, 6, 8, 16}) {
    if (n <= kCapacity && (n > kCapacity / 2 || kCapacity == 4)) b->Arg(n);
  }
}

/// A quiet tool that changes attitude every 32 samples, prepared before the clock starts.
std::vector<Sample> quiet_stream(const SensorArray& array, int samples) {
  std::mt19937_64 engine(1);
  std::normal_distribution<double> noise;
  std::vector<Sample> out(static_cast<std::size_t>(samples));
  for (int k = 0; k < samples; ++k) {
    const double a = 0.7 * (k / 32), b = 0.3 * (k / 32);
    const Vec3 g = {std::sin(a) * std::cos(b) * kG0_mps2, std::sin(a) * std::sin(b) * kG0_mps2, std::cos(a) * kG0_mps2};
    Sample& s = out[static_cast<std::size_t>(k)];
    s.time_s = 0.01 * (k + 1);
    s.delivered = array.all();
    for (int i = 0; i < array.size(); ++i) {
      s.raw[static_cast<std::size_t>(i)] = dot(array.axis(i), g) + array.sigma_mps2(i) * noise(engine);
    }
  }
  return out;
}

void BM_MonitorStep(benchmark::State& state) {
  const int n = static_cast<int>(state.range(0));
  MonitorSetup setup;
  setup.array = array_of(n);
  setup.model.size = n;
  setup.gravity = {kG0_mps2, 1e-3, GravityModel::value};
  auto monitor = std::make_unique<HealthMonitor>();
  if (!monitor->configure(setup)) state.SkipWithError("configuration refused");
  std::vector<Sample> stream = quiet_stream(setup.array, 1 << 14);
  std::size_t k = 0;
  double offset = 0.0;
  for (auto _ : state) {
    Sample s = stream[k];
    s.time_s += offset;
    benchmark::DoNotOptimize(monitor->step(s));
    if (++k == stream.size()) {
      k = 0;
      offset += 0.01 * static_cast<double>(stream.size());
    }
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(BM_MonitorStep)->Apply(sizes_of_this_build);

void BM_EigenInversePerTriple(benchmark::State& state) {
  const int n = static_cast<int>(state.range(0));
  const SensorArray array = array_of(n);
  const std::vector<Sample> stream = quiet_stream(array, 1 << 12);
  std::size_t k = 0;
  for (auto _ : state) {
    const Sample& s = stream[k];
    double sum = 0.0;
    for (int t = 0; t < array.triple_count(); ++t) {
      Eigen::Matrix3d h;
      Eigen::Vector3d y;
      for (int r = 0; r < 3; ++r) {
        const int i = array.triple(t).sensors[static_cast<std::size_t>(r)];
        for (int c = 0; c < 3; ++c) h(r, c) = array.axis(i)[static_cast<std::size_t>(c)];
        y(r) = s.raw[static_cast<std::size_t>(i)];
      }
      sum += std::fabs((h.inverse() * y).norm() - kG0_mps2);
    }
    benchmark::DoNotOptimize(sum);
    k = k + 1 == stream.size() ? 0 : k + 1;
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(BM_EigenInversePerTriple)->Apply(sizes_of_this_build);

}  // namespace

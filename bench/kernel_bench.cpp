// The kernel: the length of gravity from every triple, and its exact window, for one sample; against the systems solved
// anew per triple and sample with Eigen, by LU and by the inverse.
#include <benchmark/benchmark.h>

#include <Eigen/Dense>
#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include "bench_array.hpp"
#include "plumb/detection/combination_mae.hpp"

namespace {

using namespace plumb;

std::vector<Readings> stream_of(const SensorArray& array) {
  std::mt19937_64 engine(1);
  std::normal_distribution<double> noise;
  std::vector<Readings> out(1 << 10);
  for (Readings& y : out) {
    for (int i = 0; i < array.size(); ++i)
      y[static_cast<std::size_t>(i)] = array.axis(i)[2] * kG0_mps2 + array.sigma_mps2(i) * noise(engine);
  }
  return out;
}

void BM_Kernel(benchmark::State& state) {
  const auto array = std::make_unique<SensorArray>(plumb_bench::array_of(kCapacity));
  const std::vector<Readings> stream = stream_of(*array);
  auto mae = std::make_unique<CombinationMae>();
  mae->configure(array->triple_count(), 32);
  std::size_t k = 0;
  for (auto _ : state) {
    mae->add(*array, stream[k], array->all(), nullptr, kG0_mps2);
    benchmark::ClobberMemory();
    k = (k + 1) % stream.size();
  }
  state.counters["ns_per_triple"] =
      benchmark::Counter(static_cast<double>(array->triple_count()) * 1e-9,
                         benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}
BENCHMARK(BM_Kernel)->Arg(kCapacity);

template <class Solve>
void per_triple(benchmark::State& state, Solve solve) {
  const auto array = std::make_unique<SensorArray>(plumb_bench::array_of(kCapacity));
  const std::vector<Readings> stream = stream_of(*array);
  std::size_t k = 0;
  for (auto _ : state) {
    double sum = 0.0;
    for (int t = 0; t < array->triple_count(); ++t) {
      Eigen::Matrix3d h;
      Eigen::Vector3d y;
      for (int r = 0; r < 3; ++r) {
        const int i = array->triple(t).sensors[static_cast<std::size_t>(r)];
        for (int c = 0; c < 3; ++c) h(r, c) = array->axis(i)[static_cast<std::size_t>(c)];
        y(r) = stream[k][static_cast<std::size_t>(i)];
      }
      sum += std::fabs(solve(h, y).norm() - kG0_mps2);
    }
    benchmark::DoNotOptimize(sum);
    k = (k + 1) % stream.size();
  }
}

void BM_KernelByEigenLU(benchmark::State& state) {
  per_triple(state, [](const Eigen::Matrix3d& h, const Eigen::Vector3d& y) {
    return Eigen::Vector3d(Eigen::PartialPivLU<Eigen::Matrix3d>(h).solve(y));
  });
}
BENCHMARK(BM_KernelByEigenLU)->Arg(kCapacity);

void BM_KernelByEigenInverse(benchmark::State& state) {
  per_triple(state,
             [](const Eigen::Matrix3d& h, const Eigen::Vector3d& y) { return Eigen::Vector3d(h.inverse() * y); });
}
BENCHMARK(BM_KernelByEigenInverse)->Arg(kCapacity);

}  // namespace

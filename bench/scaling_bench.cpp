// How the fit grows with the number of sensors n and of attitudes N; Google Benchmark prints the fitted exponents
// ("BigO"). Built for 16 sensors.
#include "calibration_bench.hpp"

#include <benchmark/benchmark.h>

namespace {

using namespace plumb;

void BM_FitByAttitudes(benchmark::State& state) {
  const int count = static_cast<int>(state.range(0));
  const plumb_bench::Problem p = plumb_bench::problem_of(4, count, 7);
  for (auto _ : state) {
    benchmark::DoNotOptimize(calibrate(p.sheet, plumb_bench::gravity(), p.stations.data(), count));
  }
  state.SetComplexityN(count);
}
BENCHMARK(BM_FitByAttitudes)->Arg(12)->Arg(24)->Arg(48)->Arg(100)->Arg(250)->Arg(500)->Arg(1000)->Complexity();

void BM_FitBySensors(benchmark::State& state) {
  const int n = static_cast<int>(state.range(0));
  const plumb_bench::Problem p = plumb_bench::problem_of(n, 100, 8);
  for (auto _ : state) {
    benchmark::DoNotOptimize(calibrate(p.sheet, plumb_bench::gravity(), p.stations.data(), 100));
  }
  state.SetComplexityN(n);
}
BENCHMARK(BM_FitBySensors)->DenseRange(3, 16)->Complexity();

}  // namespace

// How the fit grows with the number of sensors n and of attitudes N, as a table of n by N. Built for 16 sensors. Each
// line has the exponents over the lines so far: of N at its n, of n at its N. The last N of an n and the last n of an N
// have them whole.
#include <benchmark/benchmark.h>

#include <map>

#include "calibration_bench.hpp"
#include "growth.hpp"

namespace {

using namespace plumb;

void BM_Fit(benchmark::State& state) {
  static std::map<int, plumb_bench::Growth> by_attitudes, by_sensors;
  const int n = static_cast<int>(state.range(0)), count = static_cast<int>(state.range(1));
  const plumb_bench::Problem p = plumb_bench::problem_of(n, count, 7);
  const plumb_bench::Stopwatch watch;
  for (auto _ : state) {
    benchmark::DoNotOptimize(calibrate(p.sheet, plumb_bench::gravity(), p.stations.data(), count));
  }
  const double seconds = watch.seconds_each(state);
  by_attitudes[n].set(count, seconds);
  by_sensors[count].set(n, seconds);
  state.counters["exponent_of_N"] = by_attitudes[n].exponent();
  state.counters["exponent_of_n"] = by_sensors[count].exponent();
}
BENCHMARK(BM_Fit)
    ->ArgNames({"n", "N"})
    ->ArgsProduct({benchmark::CreateDenseRange(3, 16, 1), {12, 24, 48, 100, 250, 500, 1000}})
    ->Unit(benchmark::kMicrosecond)
    ->MinTime(0.1);

}  // namespace

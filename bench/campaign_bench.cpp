// What one scenario of a campaign costs: 8 stations of 32 samples, drawn, generated, stepped and judged.
// campaign_parts_bench.cpp measures the parts of it.
#include <benchmark/benchmark.h>

#include <memory>
#include <string>

#include "campaign_bench.hpp"
#include "plumb/campaign/campaign_file.hpp"
#include "plumb/campaign/kernel.hpp"
#include "plumb/campaign/tally.hpp"
#include "plumb/scenario/random.hpp"

using namespace plumb::campaign;

Plan plumb_bench::campaign_plan(int sensors, const std::string& fault) {
  const std::string tool = sensors == 4 ? "geometry = \"tetrahedron\"\n"
                                        : "geometry = \"cone\"\nsensors = " + std::to_string(sensors) + "\n";
  const auto file = parse_campaign_text(
      "scenarios = 1\n[[tool]]\n" + tool + "noise = \"0.2 mg0\"\n[[fault]]\nspec = \"" + fault + "\"\n", "bench");
  return file ? file->plan : Plan{};
}

namespace {

void play(benchmark::State& state, const char* fault) {
  const Plan plan = plumb_bench::campaign_plan(static_cast<int>(state.range(0)), fault);
  auto kernel = make_kernel(plan);
  if (!kernel) {
    state.SkipWithError(kernel.error().c_str());
    return;
  }
  const auto outcome = std::make_unique<Outcome>();
  Tally tally(plan);
  std::uint64_t number = 0;
  for (auto _ : state) {
    const Spec spec = spec_of(plan, number++);
    (*kernel)->play(spec, *outcome);
    tally.add(plan, spec, *outcome);
  }
  state.SetItemsProcessed(state.iterations());
}

void BM_CampaignHealthy(benchmark::State& state) { play(state, "none"); }
BENCHMARK(BM_CampaignHealthy)->Arg(4)->Arg(6)->Arg(8);

void BM_CampaignBias(benchmark::State& state) { play(state, "bias=50mg0"); }
BENCHMARK(BM_CampaignBias)->Arg(4)->Arg(6)->Arg(8);

/// The noise of one scenario of four sensors.
void BM_CampaignNoise(benchmark::State& state) {
  std::uint64_t seed = 0;
  double noise[256];
  for (auto _ : state) {
    ++seed;
    for (std::uint32_t sensor = 0; sensor < 4; ++sensor) {
      plumb::scenario::Stream(seed, plumb::scenario::Purpose::noise, sensor).normals(0, 256, noise);
      benchmark::DoNotOptimize(noise[255]);
    }
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(BM_CampaignNoise);

}  // namespace

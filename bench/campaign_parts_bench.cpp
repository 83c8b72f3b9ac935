// Where the time of one scenario goes, part by part: four sensors, 8 stations of 32 samples, with the kernel for four.
// BM_CampaignHealthy and BM_CampaignBias (campaign_bench.cpp) measure all of it in one pass.
#include <benchmark/benchmark.h>

#include <memory>
#include <string>
#include <vector>

#include "campaign_bench.hpp"
#include "player.hpp"
#include "plumb/campaign/tally.hpp"

namespace {

using namespace plumb;
using campaign::Outcome;
using campaign::Plan;
using campaign::Spec;

constexpr int kSensors = 4;
/// So many scenarios in turn, so that none is learnt by heart.
constexpr std::uint64_t kScenarios = 64;

const char* fault_of(const benchmark::State& state) { return state.range(0) == 0 ? "none" : "bias=50mg0"; }

/// A monitor that has earned its trust, as every scenario finds it.
class Trusted {
 public:
  explicit Trusted(const Plan& plan) : monitor(std::make_unique<HealthMonitor>()) {
    const auto setup = campaign_kernel::setup_of(plan, 0);
    if (!setup || !monitor->configure(*setup)) return;
    campaign_kernel::Generator generator(plan);
    const Spec trust = campaign_kernel::trust_spec(plan, 0);
    generator.lay(trust, 0.0);
    Sample sample;
    for (int row = 0; row < generator.rows(); ++row) {
      generator.sample(row, sample);
      monitor->step(sample);
    }
    sound = monitor->verdict().state == HealthState::nominal;
  }
  std::unique_ptr<HealthMonitor> monitor;
  bool sound = false;
};

/// The samples of kScenarios scenarios, one after the other.
std::vector<Sample> samples_of(const Plan& plan) {
  campaign_kernel::Generator generator(plan);
  std::vector<Sample> out;
  Sample sample;
  for (std::uint64_t number = 0; number < kScenarios; ++number) {
    const Spec spec = campaign::spec_of(plan, number);
    generator.lay(spec, campaign_kernel::start_s(plan));
    for (int row = 0; row < generator.rows(); ++row) {
      generator.sample(row, sample);
      out.push_back(sample);
    }
  }
  return out;
}

/// Drawing what happens, noise, attitudes, faults: all samples of a scenario.
void BM_ScenarioGenerate(benchmark::State& state) {
  const Plan plan = plumb_bench::campaign_plan(kSensors, fault_of(state));
  campaign_kernel::Generator generator(plan);
  const double from_s = campaign_kernel::start_s(plan);
  std::uint64_t number = 0;
  Sample sample;
  for (auto _ : state) {
    const Spec spec = campaign::spec_of(plan, number++);
    generator.lay(spec, from_s);
    for (int row = 0; row < generator.rows(); ++row) {
      generator.sample(row, sample);
      benchmark::DoNotOptimize(sample);
    }
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(BM_ScenarioGenerate)->ArgName("fault")->Arg(0)->Arg(1);

/// Putting the monitor back to its start and stepping it through samples that are there.
void BM_ScenarioStep(benchmark::State& state) {
  const Plan plan = plumb_bench::campaign_plan(kSensors, fault_of(state));
  const Trusted trusted(plan);
  if (!trusted.sound) state.SkipWithError("the monitor does not earn its trust");
  const std::vector<Sample> samples = samples_of(plan);
  const std::size_t rows = samples.size() / kScenarios;
  const auto monitor = std::make_unique<HealthMonitor>();
  std::size_t scenario = 0;
  for (auto _ : state) {
    *monitor = *trusted.monitor;
    const Sample* sample = &samples[scenario * rows];
    for (std::size_t row = 0; row < rows; ++row) benchmark::DoNotOptimize(monitor->step(sample[row]));
    scenario = (scenario + 1) % kScenarios;
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(BM_ScenarioStep)->ArgName("fault")->Arg(0)->Arg(1);

/// Judging the verdicts of a scenario and counting what became of it.
void BM_ScenarioJudge(benchmark::State& state) {
  const Plan plan = plumb_bench::campaign_plan(kSensors, fault_of(state));
  const Trusted trusted(plan);
  if (!trusted.sound) state.SkipWithError("the monitor does not earn its trust");
  const Spec spec = campaign::spec_of(plan, 0);
  campaign_kernel::Generator generator(plan);
  generator.lay(spec, campaign_kernel::start_s(plan));
  std::vector<Verdict> verdicts;
  Sample sample;
  for (int row = 0; row < generator.rows(); ++row) {
    generator.sample(row, sample);
    verdicts.push_back(trusted.monitor->step(sample));
  }
  campaign::Tally tally(plan);
  const auto outcome = std::make_unique<Outcome>();
  for (auto _ : state) {
    campaign_kernel::Judge judge;
    judge.begin(plan, spec, *outcome);
    for (int row = 0; row < generator.rows(); ++row) {
      judge.look(verdicts[static_cast<std::size_t>(row)], row, generator.truth(row / plan.samples));
    }
    judge.end(verdicts.back());
    tally.add(plan, spec, *outcome);
    benchmark::DoNotOptimize(tally);
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(BM_ScenarioJudge)->ArgName("fault")->Arg(0)->Arg(1);

}  // namespace

// The transition table's dispatch alone against Boost.MSM: the same events, the same states in the end.
#include <benchmark/benchmark.h>

#include <array>
#include <memory>
#include <random>
#include <vector>

#include "dispatch_rival.hpp"
#include "pairs.hpp"
#include "plumb/health/transition_table.hpp"

namespace {

using namespace plumb;
using plumb_bench::facts_at;

static_assert(sizeof(Mode) == 1, "the state is one byte");

using Facts = std::array<std::array<TargetFacts, kEventCount>, kModeCount>;

constexpr Facts all_facts() {
  Facts out{};
  for (std::size_t m = 0; m < kModeCount; ++m) {
    for (std::size_t e = 0; e < kEventCount; ++e)
      out[m][e] = facts_at(static_cast<Mode>(m), static_cast<HealthEvent>(e));
  }
  return out;
}
constexpr Facts kFacts = all_facts();

Mode dispatch(Mode mode, HealthEvent event) noexcept {
  return resolve(mode, cell_of(mode, event).target,
                 kFacts[static_cast<std::size_t>(mode)][static_cast<std::size_t>(event)]);
}

/// Any events, but for those that cannot come where the machine is (nothing happens in their place), and half of those
/// in `failed` are resets.
std::vector<HealthEvent> stream_of_events() {
  std::mt19937_64 engine(7);
  std::vector<HealthEvent> events(1 << 12);
  Mode mode = Mode::initial;
  for (HealthEvent& event : events) {
    const std::uint64_t drawn = engine();
    event = static_cast<HealthEvent>(drawn % kEventCount);
    if (mode == Mode::failed && (drawn >> 32U) % 2 == 0) event = HealthEvent::reset;
    if (mode == Mode::initial && (drawn >> 32U) % 2 == 0) event = HealthEvent::fit_accepted;
    if (cell_of(mode, event).kind == CellKind::impossible) event = HealthEvent::none;
    mode = dispatch(mode, event);
  }
  return events;
}

Mode run(Mode mode, const std::vector<HealthEvent>& events) noexcept {
  for (const HealthEvent event : events) mode = dispatch(mode, event);
  return mode;
}

/// Both go through the same states, event by event, and every state is among them.
bool agree(const std::vector<HealthEvent>& events) {
  plumb_bench::MsmMachine rival;
  Mode mode = Mode::initial;
  unsigned seen = 0;
  for (const HealthEvent event : events) {
    mode = dispatch(mode, event);
    seen |= 1U << static_cast<unsigned>(mode);
    if (rival.run(&event, 1) != mode) return false;
  }
  return (seen | 1U << static_cast<unsigned>(Mode::initial)) == (1U << kModeCount) - 1U;
}

void BM_Dispatch(benchmark::State& state) {
  const std::vector<HealthEvent> events = stream_of_events();
  if (!agree(events)) state.SkipWithError("the machines differ");
  Mode mode = Mode::initial;
  for (auto _ : state) benchmark::DoNotOptimize(mode = run(mode, events));
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(events.size()));
  state.counters["bytes"] = sizeof mode;
}
BENCHMARK(BM_Dispatch);

void BM_DispatchByBoostMsm(benchmark::State& state) {
  const std::vector<HealthEvent> events = stream_of_events();
  plumb_bench::MsmMachine rival;
  for (auto _ : state) benchmark::DoNotOptimize(rival.run(events.data(), events.size()));
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(events.size()));
  state.counters["bytes"] = static_cast<double>(plumb_bench::MsmMachine::size());
}
BENCHMARK(BM_DispatchByBoostMsm);

plumb_bench::Contest contest() {
  const auto events = std::make_shared<std::vector<HealthEvent>>(stream_of_events());
  if (!agree(*events)) return {};
  const auto rival = std::make_shared<plumb_bench::MsmMachine>();
  return {[events](std::size_t count) {
            Mode mode = Mode::initial;
            for (std::size_t k = 0; k < count; ++k) benchmark::DoNotOptimize(mode = run(mode, *events));
          },
          [events, rival](std::size_t count) {
            for (std::size_t k = 0; k < count; ++k)
              benchmark::DoNotOptimize(rival->run(events->data(), events->size()));
          },
          static_cast<double>(events->size())};
}
const plumb_bench::Enrolled kDispatch{{"one event through the table", "Boost.MSM", 3.0, contest}};

}  // namespace

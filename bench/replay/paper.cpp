// The paper's monitor on tools of four to six sensors.
#include <fmt/format.h>

#include <memory>

#include "fixed_cases.hpp"
#include "plan.hpp"
#include "player.hpp"
#include "plumb/paper/paper_monitor.hpp"
#include "plumb/scenario/library.hpp"

namespace plumb_replay {
inline namespace PLUMB_ABI {

using namespace plumb;

namespace {

constexpr int kPaperCases = 12;

void play_paper(int number, const Stage& stage) {
  Draws draws(7, static_cast<std::uint64_t>(number));
  const Datasheet datasheet = draw_datasheet(number % 6 == 5 ? 6 : 4 + number % 2, draws);
  const scenario::Tool tool = scenario::draw_tool(datasheet, draws.seed());
  const auto setup = std::make_unique<PaperSetup>();
  setup->base.gravity = {kG0_mps2, 1e-4 * kG0_mps2, GravityModel::value};
  const std::vector<Station> stations = draw_stations(tool, 48, draws.seed());
  const auto fit = calibrate(datasheet, setup->base.gravity, stations.data(), static_cast<int>(stations.size()));
  const auto paper = paper_calibrate_all(datasheet, setup->base.gravity, stations.data(),
                                         static_cast<int>(stations.size()), {}, setup->paper);
  scenario::Scenario world = scenario::drilling_run(tool, draws.seed(), {scenario::dead_at_station(number % 4, 9)});
  world.attitudes = scenario::RandomStations{40};
  auto simulator = scenario::Simulator::make(world);
  if (!fit || !paper || !simulator) return stage.coverage.met("case", "not playable");
  setup->base.model = fit->model;
  setup->base.array = fit->array;
  setup->base.config.mode = MonitorMode::paper;
  setup->base.config.isolation_stations = 1 + number % 4;
  setup->datasheet = datasheet;
  const auto monitor = std::make_unique<PaperMonitor>();
  const Expected<void> configured = monitor->configure(*setup);
  stage.coverage.met("case", configured ? "played" : "setup refused");
  stage.trace.in(Part::inputs);
  tell_setup(stage.trace, setup->base);
  Meeting meeting;
  std::uint64_t row = 0;
  for (Sample sample; simulator->next(sample); ++row) {
    stage.trace.at(row, sample.time_s);
    stage.trace.in(Part::inputs);
    tell_sample(stage.trace, sample, datasheet.size);
    if (row == stage.perturbed_row) perturb(sample);
    if (row == 9000) static_cast<void>(monitor->reset(setup->base.config.reset_key, setup->base.array.all()));
    const Verdict& v = monitor->step(sample);
    stage.trace.in(Part::verdicts);
    tell_verdict(stage.trace, v, datasheet.size);
    stage.trace.in(Part::events);
    if (v.transition.sequence != 0) tell_record(stage.trace, v.transition);
    meeting.note(stage.coverage, v);
  }
}

}  // namespace
}  // namespace PLUMB_ABI

std::vector<FixedCase> paper_cases() {
  std::vector<FixedCase> out;
  for (int k = 0; k < kPaperCases; ++k) {
    out.push_back({fmt::format("paper-{:02}", k), [k](const Stage& stage) { play_paper(k, stage); }});
  }
  return out;
}

}  // namespace plumb_replay

// The demo's drills and its drilling run, by several seeds, and the paper's monitor on tools of four to six sensors.
#include <fmt/format.h>

#include <memory>

#include "fixed_cases.hpp"
#include "plan.hpp"
#include "player.hpp"
#include "plumb/io/scenario_file.hpp"
#include "plumb/paper/paper_monitor.hpp"
#include "plumb/scenario/library.hpp"

namespace plumb_replay {
inline namespace PLUMB_ABI {

using namespace plumb;

namespace {

constexpr int kSeeds = 4;
constexpr int kPaperCases = 12;

/// The stations of the demo's stand: 48 random attitudes.
std::unique_ptr<Calibration> calibrated(const scenario::Tool& tool, const GravityReference& gravity,
                                        std::uint64_t seed) {
  const std::vector<Station> stations = draw_stations(tool, 48, seed);
  const auto fit = calibrate(tool.datasheet, gravity, stations.data(), static_cast<int>(stations.size()));
  return fit ? std::make_unique<Calibration>(*fit) : nullptr;
}

struct Drilled {
  scenario::Tool tool;
  scenario::Drill drill;
  std::string array_text;
};

Drilled drilled(int which, std::uint64_t seed) {
  Drilled out;
  if (which == 1) {
    out.tool = scenario::hexad_tool(seed);
    out.drill = scenario::drill_b(out.tool, seed);
    out.array_text = io::hexad_array_text(out.drill.scenario.gravity_mps2);
    return out;
  }
  out.tool = scenario::paper_tool(seed);
  if (which == 0) out.drill = scenario::drill_a(out.tool, seed);
  if (which == 2) out.drill.scenario = scenario::drilling_run(out.tool, seed, {scenario::dead_at_station(1, 6)});
  out.array_text = io::paper_array_text(out.drill.scenario.gravity_mps2);
  return out;
}

void make_due(const std::vector<scenario::HostRequest>& requests, std::size_t& made, double time_s, Player& player) {
  for (; made < requests.size() && requests[made].time_s <= time_s; ++made) {
    const scenario::HostRequest& request = requests[made];
    if (request.kind == scenario::HostRequest::Kind::recalibrate) {
      player.recalibrate();
    } else {
      player.reset(request.key, request.sensors);
    }
  }
}

void play_drill(int which, std::uint64_t seed, const Stage& stage) {
  const Drilled it = drilled(which, seed);
  const auto file = io::parse_array_text(it.array_text, "array.toml");
  auto simulator = scenario::Simulator::make(it.drill.scenario);
  if (!file || !simulator) return stage.coverage.met("case", "not playable");
  const auto fit = calibrated(it.tool, file->gravity, seed);
  if (!fit) return stage.coverage.met("case", "not playable");
  const auto setup = std::make_unique<MonitorSetup>();
  setup->model = fit->model;
  setup->array = fit->array;
  setup->gravity = file->gravity;
  setup->config = file->monitor;
  for (std::size_t i = 0; i < static_cast<std::size_t>(file->datasheet.size); ++i) {
    setup->full_scale_raw[i] = file->datasheet.sensor[i].full_scale_raw;
    setup->resolution_raw[i] = file->datasheet.sensor[i].resolution_raw;
  }
  Player player(stage, *setup);
  stage.coverage.met("case", player.configure() ? "played" : "setup refused");
  std::size_t made = 0;
  for (Sample sample; simulator->next(sample);) {
    make_due(it.drill.requests, made, sample.time_s, player);
    player.step(sample);
  }
  player.finish();
}

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

std::vector<FixedCase> drill_cases() {
  constexpr const char* kNames[] = {"drill-a", "drill-b", "drilling"};
  std::vector<FixedCase> out;
  for (int which = 0; which < 3; ++which) {
    for (int seed = 1; seed <= kSeeds; ++seed) {
      out.push_back({fmt::format("{}-seed{}", kNames[which], seed), [which, seed](const Stage& stage) {
                       play_drill(which, static_cast<std::uint64_t>(seed), stage);
                     }});
    }
  }
  return out;
}

std::vector<FixedCase> paper_cases() {
  std::vector<FixedCase> out;
  for (int k = 0; k < kPaperCases; ++k) {
    out.push_back({fmt::format("paper-{:02}", k), [k](const Stage& stage) { play_paper(k, stage); }});
  }
  return out;
}

}  // namespace plumb_replay

// The demo's drills and its drilling run, by several seeds.
#include <fmt/format.h>

#include <memory>

#include "fixed_cases.hpp"
#include "plan.hpp"
#include "player.hpp"
#include "plumb/io/scenario_file.hpp"
#include "plumb/scenario/library.hpp"

namespace plumb_replay {
inline namespace PLUMB_ABI {

using namespace plumb;

namespace {

constexpr int kSeeds = 4;

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

}  // namespace plumb_replay

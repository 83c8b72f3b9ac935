// Writes the run that host and target play: metal_record SENSORS FILE [plain]. A tool of 4, 6 or 8 sensors is
// calibrated on a simulated stand and then led through every state, with what its host asks on the way; plain: without
// recalibrations and power cycles, for builds that have none.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "plumb/array/named.hpp"
#include "plumb/calibration/calibration.hpp"
#include "plumb/scenario/library.hpp"
#include "recording.hpp"

namespace {

using namespace plumb;
using metal::Request;

constexpr std::uint64_t kSeed = 7;
constexpr int kStations = 70;  // of 3 s each

Datasheet octad_datasheet() {
  AxisList axes{};
  cone(axes, 8);
  Datasheet datasheet = scenario::hexad_datasheet();
  datasheet.size = 8;
  const char* const ids[] = {"a1", "a2", "a3", "a4", "a5", "a6", "a7", "a8"};
  for (std::size_t i = 0; i < 8; ++i) {
    datasheet.sensor[i] = datasheet.sensor[0];
    datasheet.sensor[i].row.id = make_id(ids[i]);
    datasheet.sensor[i].row.axis = axes[i];
  }
  return datasheet;
}

scenario::Tool tool_of(int sensors) {
  if (sensors == 4) return scenario::paper_tool(kSeed);
  if (sensors == 6) return scenario::hexad_tool(kSeed);
  return scenario::draw_tool(octad_datasheet(), kSeed);
}

/// Means of the tagged stations.
std::vector<Station> stations_of(scenario::Simulator& run, int sensors) {
  std::vector<Station> out;
  Sample s;
  while (run.next(s)) {
    if (out.empty() || out.back().tag != s.station) {
      out.emplace_back();
      out.back().tag = s.station;
      out.back().delivered = SensorSet::first(sensors);
      out.back().temperature_degc = s.temperature_degc;
    }
    Station& station = out.back();
    ++station.count;
    for (std::size_t i = 0; i < static_cast<std::size_t>(sensors); ++i) {
      station.mean[i] += (s.raw[i] - station.mean[i]) / station.count;
    }
  }
  return out;
}

scenario::Fault fault(scenario::FaultKind kind, int sensor, double station, double stations, double magnitude) {
  scenario::Fault out;
  out.kind = kind;
  out.sensor = sensor;
  out.clock = scenario::Clock::station;
  out.onset = station;
  out.duration = stations;
  out.magnitude = magnitude;
  return out;
}

/// Random attitudes, shaken between them. A recalibration and an offer while all is well; then a2 dies, a3 stands at
/// 3 V, a1 loses rows, and after a reset a2 is back.
scenario::Scenario story(const scenario::Tool& tool) {
  scenario::Scenario s = scenario::drilling_run(tool, kSeed);
  s.attitudes = scenario::RandomStations{kStations};
  s.faults = {fault(scenario::FaultKind::stuck_level, 1, 40, 18, 0.0),
              fault(scenario::FaultKind::stuck_level, 2, 48, 8, 3.0),
              fault(scenario::FaultKind::missing, 0, 66, 2, 1.0)};
  return s;
}

struct Asked {
  double time_s;
  Request request;
  std::uint64_t argument;
};

constexpr Asked kAsked[] = {
    {10.37, Request::power_cycle, 0}, {20.0, Request::recalibrate, 0},
    {40.0, Request::forged, 0},                                          // with a recalibration under way
    {85.0, Request::offer, 0},        {130.0, Request::power_cycle, 0},  // with a doubt under way
    {176.0, Request::reset, 0x6},                                        // a2 and a3
    {190.0, Request::recalibrate, 0},
};

void put_head(metal::WordWriter& out, const Calibration& calibration, const Datasheet& datasheet, std::uint64_t rows) {
  const auto n = static_cast<std::size_t>(datasheet.size);
  out.word(metal::kMagic);
  out.word(n);
  out.word(rows);
  for (std::size_t i = 0; i < n; ++i) {
    for (const double v : calibration.array.axis(static_cast<int>(i))) out.number(v);
    out.number(calibration.array.sigma_mps2(static_cast<int>(i)));
  }
  auto setup = std::make_unique<MonitorSetup>();
  setup->model = calibration.model;
  setup->gravity = GravityReference{};
  setup->config.temperature_min_degc = calibration.report.temperature_min_degc;
  setup->config.temperature_max_degc = calibration.report.temperature_max_degc;
  for (std::size_t i = 0; i < n; ++i) {
    setup->full_scale_raw[i] = datasheet.sensor[i].full_scale_raw;
    setup->resolution_raw[i] = datasheet.sensor[i].resolution_raw;
  }
  const RowUncertainty uncertainty = calibration.array.uncertainty();
  metal::transfer_setup(out, *setup, uncertainty, n);
}

void put_rows(metal::WordWriter& out, scenario::Simulator& run, std::size_t n, bool plain) {
  std::size_t next = 0;
  Sample s;
  while (run.next(s)) {
    const bool due = next < std::size(kAsked) && s.time_s >= kAsked[next].time_s;
    Asked asked = due ? kAsked[next++] : Asked{0.0, Request::none, 0};
    if (plain && asked.request != Request::reset) asked = {0.0, Request::none, 0};
    out.number(s.time_s);
    out.number(s.temperature_degc);
    out.word(s.delivered.bits);
    out.word(static_cast<std::uint64_t>(asked.request));
    out.word(asked.argument);
    for (std::size_t i = 0; i < n; ++i) out.number(s.raw[i]);
  }
}

int refused(const char* what) {
  std::fprintf(stderr, "metal_record: %s\n", what);
  return 1;
}

}  // namespace

int main(int argc, char** argv) {
  const int sensors = argc == 3 || argc == 4 ? std::atoi(argv[1]) : 0;
  const bool plain = argc == 4 && std::string(argv[3]) == "plain";
  if ((sensors != 4 && sensors != 6 && sensors != 8) || plain != (argc == 4)) {
    return refused("usage: metal_record 4|6|8 FILE [plain]");
  }
  const scenario::Tool tool = tool_of(sensors);
  auto stand = scenario::Simulator::make(scenario::calibration_run(tool, kSeed));
  auto run = scenario::Simulator::make(story(tool));
  if (!stand) return refused(stand.error().c_str());
  if (!run) return refused(run.error().c_str());
  const std::vector<Station> stations = stations_of(*stand, sensors);
  const Expected<Calibration> calibration =
      calibrate(tool.datasheet, GravityReference{}, stations.data(), static_cast<int>(stations.size()));
  if (!calibration) return refused(describe(calibration.error().code));
  std::uint64_t rows = 0;
  Sample s;
  while (run->next(s)) ++rows;
  run->rewind();
  const auto n = static_cast<std::size_t>(sensors);
  std::vector<std::uint64_t> words(4096 + static_cast<std::size_t>(rows) * (5 + n));
  metal::WordWriter out(words.data() + 1, words.size() - 1);
  put_head(out, *calibration, tool.datasheet, rows);
  put_rows(out, *run, n, plain);
  if (out.full()) return refused("more words than room");
  words[0] = out.used();
  std::ofstream file(argv[2], std::ios::binary);
  file.write(reinterpret_cast<const char*>(words.data()), static_cast<std::streamsize>((out.used() + 1) * 8));
  file.close();
  return file ? 0 : refused("the file could not be written");
}

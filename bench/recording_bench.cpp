// The Xsens recording: finding its static stretches and fitting them, against the time it takes to read the file.
// Skipped where the recording is absent (../shared/data, or PLUMB_DATA_DIR).
#include <benchmark/benchmark.h>

#include <cstdlib>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "growth.hpp"
#include "plumb/calibration/calibration.hpp"
#include "plumb/detection/stationarity.hpp"
#include "plumb/io/array_file.hpp"
#include "plumb/io/log_reader.hpp"

namespace {

using namespace plumb;

std::string recording() {
  const char* given = std::getenv("PLUMB_DATA_DIR");
  return (given != nullptr ? std::string(given) : std::string(PLUMB_SOURCE_DIR) + "/../shared/data") +
         "/imutk_xsens_full.csv";
}

struct Loaded {
  bool present = false;
  io::ArrayFile file;
  std::vector<Sample> samples;
};

const Loaded& loaded() {
  static const Loaded once = [] {
    Loaded out;
    if (!std::ifstream(recording())) return out;
    auto file = io::read_array_file(std::string(PLUMB_SOURCE_DIR) + "/examples/xsens.toml");
    if (!file) return out;
    auto log = io::read_log(recording(), *file, io::BadRowPolicy::stop);
    if (!log) return out;
    out.present = true;
    out.file = *file;
    out.samples = log->samples;
    return out;
  }();
  return once;
}

bool absent(benchmark::State& state) {
  if (!loaded().present) state.SkipWithError("imutk_xsens_full.csv is not there");
  return !loaded().present;
}

void BM_XsensReadCsv(benchmark::State& state) {
  if (absent(state)) return;
  for (auto _ : state) benchmark::DoNotOptimize(io::read_log(recording(), loaded().file, io::BadRowPolicy::stop));
}
BENCHMARK(BM_XsensReadCsv)->Unit(benchmark::kMillisecond);

/// The first part of the recording, in percent: time has to grow with the length, that is with an exponent of 1.
void BM_XsensDetectAndFit(benchmark::State& state) {
  if (absent(state)) return;
  static plumb_bench::Growth growth;
  const Loaded& data = loaded();
  StationFinder::Settings settings;
  settings.block = data.file.monitor.window;
  const SensorModel model = data.file.datasheet.model();
  const std::size_t length = data.samples.size() * static_cast<std::size_t>(state.range(0)) / 100;
  int stations_found = 0;
  const plumb_bench::Stopwatch watch;
  for (auto _ : state) {
    const auto finder = std::make_unique<StationFinder>(data.file.array, data.file.gravity.g_mps2, settings);
    std::vector<Station> stations;
    Station station;
    for (std::size_t k = 0; k < length; ++k) {
      const Sample& s = data.samples[k];
      if (finder->add(s, model.apply(s.raw, s.temperature_degc, s.delivered), s.delivered, station)) {
        stations.push_back(station);
      }
    }
    if (finder->finish(station)) stations.push_back(station);
    benchmark::DoNotOptimize(
        calibrate(data.file.datasheet, data.file.gravity, stations.data(), static_cast<int>(stations.size())));
    stations_found = static_cast<int>(stations.size());
  }
  growth.set(static_cast<double>(length), watch.seconds_each(state));
  state.counters["stations"] = stations_found;
  state.counters["exponent"] = growth.exponent();
}
BENCHMARK(BM_XsensDetectAndFit)->Unit(benchmark::kMillisecond)->Arg(25)->Arg(50)->Arg(75)->Arg(100);

}  // namespace

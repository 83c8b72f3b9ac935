#include "plumb/study/survey.hpp"

#include <utility>

namespace plumb {
inline namespace PLUMB_ABI {
namespace study {

scenario::Scenario survey_run(const scenario::Tool& tool, std::uint64_t seed, Part part, int attitudes, int samples) {
  scenario::Scenario out;
  out.tool = tool;
  out.attitudes = scenario::RandomStations{attitudes};
  out.dwell_s = samples / out.rate_hz;
  out.record_motion = false;
  out.tag_stations = true;
  out.seed = scenario::derive_seed(seed, static_cast<std::uint64_t>(part));
  return out;
}

StudyExpected<Survey> record(const scenario::Scenario& scenario) {
  auto simulator = scenario::Simulator::make(scenario);
  if (!simulator) return tl::unexpected<std::string>(simulator.error());
  Survey out;
  Sample sample;
  std::uint32_t tag = 0;
  while (simulator->next(sample)) {
    if (sample.station == 0) continue;
    if (sample.station != tag) out.attitude.emplace_back();
    tag = sample.station;
    out.attitude.back().push_back(sample);
  }
  return out;
}

std::vector<Station> stations_of(const Survey& survey) {
  std::vector<Station> out;
  for (const std::vector<Sample>& samples : survey.attitude) {
    Station station;
    const Sample& first = samples.front();
    station.delivered = first.delivered;
    station.tag = first.station;
    station.begin_s = first.time_s;
    station.end_s = samples.back().time_s;
    station.count = static_cast<std::uint32_t>(samples.size());
    const auto n = static_cast<double>(samples.size());
    // About the first sample, so that the sums do not cancel.
    for (const Sample& sample : samples) {
      station.temperature_degc += sample.temperature_degc / n;
      for (std::size_t i = 0; i < station.mean.size(); ++i) station.mean[i] += (sample.raw[i] - first.raw[i]) / n;
    }
    for (std::size_t i = 0; i < station.mean.size(); ++i) station.mean[i] += first.raw[i];
    out.push_back(station);
  }
  return out;
}

}  // namespace study
}  // namespace PLUMB_ABI
}  // namespace plumb

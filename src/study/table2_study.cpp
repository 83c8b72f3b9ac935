#include "plumb/study/table2_study.hpp"

#include "plumb/scenario/library.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace study {
namespace {

/// Healthy blocks may now and then lie above the fraction of the limit that counts as clean; a healthy tool needs 3 to
/// 8 attitudes, and a monitor that has not validated it after these has a reason.
constexpr int kProvingAttitudes = 40;
/// Between two attitudes: longer than a sample, shorter than the gap that empties the windows.
constexpr double kMove_s = 1.0;

SensorSet named(const Verdict& verdict) noexcept { return verdict.excluded | verdict.provisionally_excluded; }

}  // namespace

int Table2Study::same_verdicts() const noexcept {
  int count = 0;
  for (const Table2Result& r : result) count += r.same_verdict ? 1 : 0;
  return count;
}

std::vector<Sample> ProvenMonitor::continued(std::vector<Sample> samples, int station) const {
  const double begin_s = samples.empty() ? 0.0 : samples.front().time_s;
  const double length_s = samples.empty() ? 0.0 : samples.back().time_s - begin_s;
  const double offset_s = last_time_s + kMove_s + station * (length_s + kMove_s) - begin_s;
  for (Sample& sample : samples) {
    sample.time_s += offset_s;
    sample.station = last_station + 1U + static_cast<std::uint32_t>(station);
  }
  return samples;
}

StudyExpected<ProvenMonitor> proven_monitor(const Fits& fits, const scenario::Tool& tool, std::uint64_t seed) {
  auto setup = std::make_unique<MonitorSetup>();
  setup->model = fits.own->model;
  setup->array = fits.own->array;
  setup->gravity = study_gravity();
  setup->config.window = kBlock;
  setup->config.temperature_min_degc = fits.own->report.temperature_min_degc;
  setup->config.temperature_max_degc = fits.own->report.temperature_max_degc;
  for (int i = 0; i < fits.datasheet.size; ++i) {
    const auto s = static_cast<std::size_t>(i);
    setup->full_scale_raw[s] = fits.datasheet.sensor[s].full_scale_raw;
  }
  ProvenMonitor out;
  out.monitor = std::make_unique<HealthMonitor>();
  const plumb::Expected<void> configured = out.monitor->configure(*setup);
  if (!configured) return tl::unexpected<std::string>(std::string("the monitor: ") + describe(configured.error().code));
  const StudyExpected<Survey> healthy = record(survey_run(tool, seed, Part::proving, kProvingAttitudes, kBlock));
  if (!healthy) return tl::unexpected<std::string>(healthy.error());
  for (const std::vector<Sample>& samples : healthy->attitude) {
    for (const Sample& sample : samples) out.monitor->step(sample);
    out.last_time_s = samples.back().time_s;
    out.last_station = samples.back().station;
    if (out.monitor->verdict().state == HealthState::nominal) return out;
  }
  return tl::unexpected<std::string>(
      "the monitor did not validate a healthy tool. Remedy: report this as a defect of plumb");
}

StudyExpected<Table2Study> table2_study(const Fits& fits, const scenario::Tool& tool, std::uint64_t seed, RandomLaw law,
                                        int attitudes) {
  const StudyExpected<Survey> healthy = record(survey_run(tool, seed, Part::faults, attitudes, kBlock));
  if (!healthy) return tl::unexpected<std::string>(healthy.error());
  const StudyExpected<ProvenMonitor> proven = proven_monitor(fits, tool, seed);
  if (!proven) return tl::unexpected<std::string>(proven.error());
  const std::uint64_t levels = scenario::derive_seed(seed, static_cast<std::uint64_t>(Part::faults));
  auto monitor = std::make_unique<HealthMonitor>();
  Table2Study out;
  const PaperFit no_rest;
  const PaperFits read_by{fits.nominal, *fits.paper, no_rest};
  for (std::size_t e = 0; e < kTable2.size(); ++e) {
    const Table2Row& printed = kTable2[e];
    Table2Result& result = out.result[e];
    PaperRule rule;
    *monitor = *proven->monitor;
    for (std::size_t a = 0; a < healthy->attitude.size(); ++a) {
      const std::uint64_t draw = scenario::derive_seed(levels, a * kTable2.size() + e);
      const StudyExpected<std::vector<Sample>> samples =
          with_fault(tool, printed, law, draw, proven->continued(healthy->attitude[a], static_cast<int>(a)));
      if (!samples) return tl::unexpected<std::string>(samples.error());
      for (const Sample& sample : *samples) {
        rule.add(read_by, study_gravity().g_mps2, sample.raw, sample.temperature_degc, fits.nominal.all());
        result.ever_named = result.ever_named | named(monitor->step(sample));
      }
      const Verdict& verdict = monitor->verdict();
      if (result.named_after == 0 && !result.ever_named.empty()) result.named_after = static_cast<int>(a) + 1;
      const bool faulty_in_use = !(printed.faulty & verdict.in_service).empty();
      const bool unsuspected = verdict.state != HealthState::suspect && verdict.validity == Validity::valid;
      if (faulty_in_use && unsuspected) ++result.silent;
    }
    result.finding = rule.finding(read_by, kPaperDeltaF_mps2, fits.nominal.all());
    result.same_verdict = result.finding.detected == printed.detected && result.finding.isolated == printed.isolated;
    result.state = monitor->verdict().state;
    result.excluded = named(monitor->verdict());
  }
  return out;
}

StudyExpected<Proportion> all_verdicts_as_printed(std::uint64_t seed, int tools) {
  std::uint64_t equal = 0;
  constexpr std::uint64_t kFirstTool = 200;
  for (int k = 0; k < tools; ++k) {
    const std::uint64_t own_seed = scenario::derive_seed(seed, kFirstTool + static_cast<std::uint64_t>(k));
    const scenario::Tool tool = scenario::paper_tool(own_seed);
    const StudyExpected<std::vector<Station>> stations = calibration_stations(tool, own_seed);
    if (!stations) return tl::unexpected<std::string>(stations.error());
    const StudyExpected<Fits> fits = fit_both(tool.datasheet, *stations);
    if (!fits) return tl::unexpected<std::string>(fits.error());
    const StudyExpected<Table2Study> study = table2_study(*fits, tool, own_seed);
    if (!study) return tl::unexpected<std::string>(study.error());
    if (study->same_verdicts() == kExperiments) ++equal;
  }
  return proportion(equal, static_cast<std::uint64_t>(tools));
}

}  // namespace study
}  // namespace PLUMB_ABI
}  // namespace plumb

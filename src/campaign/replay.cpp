#include "plumb/campaign/replay.hpp"

#include <chrono>
#include <cmath>
#include <memory>

#include "kernel/player.hpp"
#include "plumb/io/scenario_file.hpp"
#include "plumb/scenario/count_text.hpp"
#include "plumb/scenario/fault_text.hpp"

namespace plumb {
namespace campaign {
namespace {

using std::size_t;

/// To so many significant digits, in mg0 where the size is an acceleration.
double rounded(double value, double unit, int digits) {
  const double size = value / unit;
  if (size == 0.0 || !std::isfinite(size)) return value;
  const double step = std::pow(10.0, std::floor(std::log10(std::fabs(size))) - (digits - 1));
  return std::round(size / step) * step * unit;
}

double unit_of(int kind) {
  switch (static_cast<scenario::FaultKind>(kind)) {
    case scenario::FaultKind::bias_step:
    case scenario::FaultKind::noise:
    case scenario::FaultKind::spikes:
    case scenario::FaultKind::chatter: return 1e-3 * kG0_mps2;
    default: return 1.0;
  }
}

/// The simpler scenarios next to one, the simplest first.
std::vector<Spec> simpler(const Spec& spec) {
  std::vector<Spec> out;
  const auto with = [&out, &spec](auto change) {
    Spec one = spec;
    change(one);
    out.push_back(one);
  };
  for (int left_out = 0; spec.faults > 1 && left_out < spec.faults; ++left_out) {
    with([left_out](Spec& one) {
      for (int k = left_out; k + 1 < one.faults; ++k)
        one.fault[static_cast<size_t>(k)] = one.fault[static_cast<size_t>(k + 1)];
      --one.faults;
    });
  }
  for (int stations = 1; stations < spec.stations; ++stations) with([stations](Spec& one) { one.stations = stations; });
  if (spec.gravity_sigmas != 0.0) with([](Spec& one) { one.gravity_sigmas = 0.0; });
  if (spec.calibration_mps2 != 0.0) with([](Spec& one) { one.calibration_mps2 = 0.0; });
  for (int k = 0; k < spec.faults; ++k) {
    const auto a = static_cast<size_t>(k);
    if (spec.fault[a].onset_station > 1.0) with([a](Spec& one) { one.fault[a].onset_station = 1.0; });
    for (int digits = 1; digits <= 3; ++digits) {
      const double round = rounded(spec.fault[a].magnitude, unit_of(spec.fault[a].kind), digits);
      if (round == spec.fault[a].magnitude) break;
      with([a, round](Spec& one) { one.fault[a].magnitude = round; });
    }
  }
  return out;
}

/// As an array file would say it: volts, at the scale of the plan's tools.
std::string array_toml(const Plan& plan, const ToolPlan& tool) {
  std::string text = "name = \"" + tool.name + "\"\n[gravity]\nmodel = \"value\"\nvalue = \"" +
                     io::shortest(plan.gravity_mps2) + " m/s^2\"\nsigma = \"" + io::shortest(plan.gravity_sigma_mps2) +
                     " m/s^2\"\n[input]\ntime = \"t_s\"\nstation = \"station\"\nreads = \"gravity\"\nunit = \"V\"\n";
  for (int i = 0; i < tool.sensors; ++i) {
    const auto a = static_cast<size_t>(i);
    const std::string id = "a" + std::to_string(i + 1);
    text += "[[sensor]]\nid = \"" + id + "\"\ncolumn = \"" + id + "\"\nscale = \"3 V/g0\"\naxis = [" +
            io::shortest(tool.axis[a][0]) + ", " + io::shortest(tool.axis[a][1]) + ", " +
            io::shortest(tool.axis[a][2]) + "]\nnoise = \"" + io::shortest(tool.sigma_mps2[a]) + " m/s^2\"\n";
    if (tool.resolution_raw > 0.0) text += "resolution = \"" + io::shortest(tool.resolution_raw) + " V\"\n";
    const std::array<double, 4>& s = tool.stability[a];
    text += io::stability_toml({s[0], s[1], s[2], s[3]});
  }
  return text;
}

/// Of the faults of a scenario as much as the judge has to know.
Spec told_of(const scenario::Scenario& scenario, const Plan& plan, int tool) {
  Spec spec;
  spec.tool = tool;
  const auto* list = std::get_if<scenario::DirectionList>(&scenario.attitudes);
  spec.stations = list == nullptr ? plan.stations : static_cast<int>(list->directions.size());
  for (const scenario::Fault& fault : scenario.faults) {
    if (spec.faults == kMostFaults) break;
    SpecFault& one = spec.fault[static_cast<size_t>(spec.faults++)];
    one.kind = static_cast<int>(fault.kind);
    one.sensor = fault.sensor;
    one.onset_station = fault.onset;
    one.magnitude = fault.magnitude;
  }
  return spec;
}

/// Plays a scenario through the monitor; `look` sees every verdict with its row and what gravity really was.
template <class Look>
tl::expected<void, std::string> play(HealthMonitor& monitor, const scenario::Scenario& scenario,
                                     std::vector<std::int64_t>* step_ns, Look look) {
  using Clock = std::chrono::steady_clock;
  auto simulator = scenario::Simulator::make(scenario);
  if (!simulator) return tl::unexpected<std::string>(simulator.error());
  const Vec3 turn_rad = campaign_kernel::common_turn_rad(scenario.tool);
  Sample sample;
  for (int row = 0; simulator->next(sample); ++row) {
    const Vec3& felt = simulator->truth().gravity_mps2;
    const Clock::time_point begin = step_ns == nullptr ? Clock::time_point() : Clock::now();
    const Verdict& verdict = monitor.step(sample);
    if (step_ns != nullptr)
      step_ns->push_back(std::chrono::duration_cast<std::chrono::nanoseconds>(Clock::now() - begin).count());
    look(verdict, row, minus(felt, cross(turn_rad, felt)));
  }
  return {};
}

}  // namespace

bool fails(const Plan& plan, Count what, const Outcome& outcome) noexcept {
  switch (what) {
    case Count::wrong_exclusion: return outcome.wrong_exclusion();
    case Count::misleading: return outcome.misleading(plan.alert_limit_rad);
    case Count::beyond_protection: return outcome.beyond_protection();
    case Count::wrong_provisional_exclusion: return outcome.wrong_provisional_exclusion();
    default: return false;
  }
}

Spec shrunk(const Plan& plan, Kernel& kernel, const Spec& spec, Count what) {
  const auto outcome = std::make_unique<Outcome>();
  Spec best = spec;
  constexpr int kRounds = 20;  // every one leaves something out; this is more than there is
  for (int round = 0; round < kRounds; ++round) {
    bool found = false;
    for (const Spec& one : simpler(best)) {
      kernel.play(one, *outcome);
      if (!fails(plan, what, *outcome)) continue;
      best = one;
      found = true;
      break;
    }
    if (!found) break;
  }
  return best;
}

scenario::Scenario scenario_of(const Plan& plan, const Spec& spec) {
  return campaign_kernel::scenario_of(plan, spec, campaign_kernel::start_s(plan));
}

std::string case_text(const Plan& plan, const Spec& spec) {
  const ToolPlan& tool = plan.tools[static_cast<size_t>(spec.tool)];
  io::ScenarioFile file;
  file.name = plan.name + " " + std::to_string(spec.number);
  auto array = io::parse_array_text(array_toml(plan, tool), "case.toml");
  if (!array) return "# " + array.error().text() + "\n";
  file.array = *std::move(array);
  file.array_inline = true;
  file.scenario = scenario_of(plan, spec);
  return io::scenario_text(file);
}

tl::expected<Outcome, std::string> replay(const Plan& plan, int tool, const scenario::Scenario& scenario,
                                          const std::function<void(const Verdict&)>& look,
                                          std::vector<std::int64_t>* step_ns) {
  const auto monitor = std::make_unique<HealthMonitor>();
  const Expected<MonitorSetup> setup = campaign_kernel::setup_of(plan, tool);
  if (!setup || !monitor->configure(*setup)) return tl::unexpected<std::string>("the monitor cannot be configured");
  if (plan.start == Start::validated) {
    const Spec trust = campaign_kernel::trust_spec(plan, tool);
    const auto done = play(*monitor, campaign_kernel::scenario_of(plan, trust, 0.0), step_ns,
                           [](const Verdict&, int, const Vec3&) {});
    if (!done) return tl::unexpected<std::string>(done.error());
  }
  Outcome outcome;
  campaign_kernel::Judge judge;
  judge.begin(plan, told_of(scenario, plan, tool), outcome);
  const auto done = play(*monitor, scenario, step_ns, [&](const Verdict& verdict, int row, const Vec3& truth) {
    judge.look(verdict, row, truth);
    look(verdict);
  });
  if (!done) return tl::unexpected<std::string>(done.error());
  judge.end(monitor->verdict());
  return outcome;
}

std::string sentence_of(const Plan& plan, const Spec& spec) {
  scenario::FaultContext context;
  context.datasheet = campaign_kernel::datasheet_of(plan.tools[static_cast<size_t>(spec.tool)]);
  if (plan.magnetic) {
    // Readings in units of the field, sensors by number: a plan keeps no names.
    context.vector = scenario::FaultContext::Vector::magnetic;
    context.raw = scenario::FaultContext::Raw::acceleration;
    context.base_per_raw = 1.0 / plan.tools[static_cast<size_t>(spec.tool)].volt_per_mps2;
    for (int i = 0; i < context.datasheet.size; ++i)
      context.datasheet.sensor[static_cast<size_t>(i)].row.id = make_id(("m" + std::to_string(i + 1)).c_str());
  }
  std::string text = count_text(context.datasheet.size, "sensor") + " (" +
                     plan.tools[static_cast<size_t>(spec.tool)].name + "), " + count_text(spec.stations, "station") +
                     ": ";
  if (spec.faults == 0) text += "no fault";
  for (int k = 0; k < spec.faults; ++k) {
    const scenario::Fault fault = campaign_kernel::fault_of(spec.fault[static_cast<size_t>(k)]);
    text += (k == 0 ? "" : "; ") + scenario::describe(fault, context);
  }
  if (spec.gravity_sigmas != 0.0)
    text += std::string(plan.magnetic ? "; the true field" : "; true gravity") +
            " differs from the configured value by " + io::shortest(spec.gravity_sigmas) + " sigma";
  return text + ".";
}

}  // namespace campaign
}  // namespace plumb

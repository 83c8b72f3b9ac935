#include "plan.hpp"

#include <cmath>
#include <string>

#include "plumb/scenario/catalogue.hpp"
#include "plumb/scenario/library.hpp"

namespace plumb_replay {
inline namespace PLUMB_ABI {

using namespace plumb;

namespace {

constexpr double kMilligee_mps2 = 1e-3 * kG0_mps2;
constexpr double kRate_hz = 100.0;

std::size_t slot(int i) { return static_cast<std::size_t>(i); }

bool needs_fit(Situation situation) {
  return situation == Situation::recalibrate || situation == Situation::policy || situation == Situation::offer_good ||
         situation == Situation::offer_wrong || situation == Situation::offer_and_ask;
}

bool is_long(Situation situation) {
  return needs_fit(situation) || situation == Situation::first_calibration || situation == Situation::reset;
}

/// What the monitor knows of the tool: the tool itself, a fit, or the datasheet alone.
void draw_knowledge(const Datasheet& datasheet, Draws& draws, Coverage& coverage, Plan& plan) {
  MonitorSetup& setup = plan.setup;
  setup.gravity = {kG0_mps2, 1e-4 * kG0_mps2, GravityModel::value};
  plan.scenario.tool = scenario::draw_tool(datasheet, draws.seed());
  if (plan.situation == Situation::first_calibration) {
    coverage.met("knowledge", set_datasheet(datasheet, setup) ? "datasheet" : "none");
    return;
  }
  if (needs_fit(plan.situation) || draws.one_in(3)) {
    const auto stations = draw_stations(plan.scenario.tool, 28, draws.seed());
    const auto others = draw_stations(plan.scenario.tool, 40, draws.seed());
    const auto fit = calibrate(datasheet, setup.gravity, stations.data(), static_cast<int>(stations.size()));
    if (fit) {
      const auto other = calibrate(datasheet, setup.gravity, others.data(), static_cast<int>(others.size()));
      setup.model = fit->model;
      setup.array = fit->array;
      plan.has_other = other.has_value();
      if (other) plan.other_model = other->model;
      if (other) plan.other_array = other->array;
      coverage.met("knowledge", "fit");
      return;
    }
    coverage.met("knowledge", "fit refused");
  }
  plan.scenario.tool = scenario::perfect_tool(datasheet);
  setup.model = datasheet.model();
  if (const auto array = datasheet.array()) setup.array = *array;
  coverage.met("knowledge", "exact");
}

void draw_walk(Draws& draws, int stations, Coverage& coverage, scenario::Scenario& world) {
  switch (draws.below(6)) {
    case 0: {
      scenario::RollTest roll;
      roll.inclination_rad = rad_from_deg(draws.between(2.0, 90.0));
      roll.stations = stations;
      world.attitudes = roll;
      return coverage.met("walk", "rolling");
    }
    case 1: {
      scenario::DrillingPath path;
      path.stations = stations;
      path.toolface_jitter_rad = draws.between(0.0, 0.5);
      world.attitudes = path;
      return coverage.met("walk", "drilling");
    }
    case 2: {  // small turns and large ones, some stations twice
      scenario::DirectionList list;
      list.directions.push_back(draws.direction());
      for (int k = 1; k < stations; ++k) {
        const double step = draws.one_in(3) ? 0.01 : 0.2;
        const Vec3 near = plus(list.directions.back(), draws.vector(step, step));
        const Vec3 next = draws.one_in(4) ? draws.direction() : scaled(near, 1.0 / norm(near));
        list.directions.push_back(draws.one_in(5) ? list.directions.back() : next);
      }
      world.attitudes = list;
      return coverage.met("walk", "listed");
    }
    default: world.attitudes = scenario::RandomStations{stations}; return coverage.met("walk", "random");
  }
}

void draw_world(Draws& draws, Coverage& coverage, Plan& plan) {
  scenario::Scenario& world = plan.scenario;
  const int window = plan.setup.config.window;
  const int stations = is_long(plan.situation) ? 38 + draws.below(8) : 14 + draws.below(12);
  draw_walk(draws, stations, coverage, world);
  world.seed = draws.seed();
  world.rate_hz = draws.one_in(8) ? 25.0 : kRate_hz;
  int rows = window * (1 + draws.below(3));
  if (draws.one_in(3)) rows += draws.below(window + 1);
  world.dwell_s = (rows < 2 ? 2 : rows) / world.rate_hz;
  world.record_motion = draws.one_in(2);
  world.move_s = world.record_motion ? draws.between(0.1, 0.5) : draws.between(0.5, 2.0);
  if (draws.one_in(8)) world.move_s = world.record_motion ? 0.5 : 6.0;  // a gap
  if (draws.one_in(3)) world.vibration_mps2 = draws.between(0.0, 0.1) * kG0_mps2;
  if (draws.one_in(8)) world.rest_vibration_mps2 = draws.between(0.3, 4.0) * scenario::kPaperNoise_mps2;
  world.tag_stations = draws.one_in(6);
  world.noise.white = draws.any_of({1.0, 1.0, 1.0, 0.5, 0.0, 1.3, 2.0});
  world.noise.quantise = !draws.one_in(4);
  if (draws.one_in(3)) world.gravity_mps2 = kG0_mps2 * (1.0 + 1e-4 * draws.between(-3.0, 3.0));
  if (draws.one_in(8)) world.gravity_mps2 = kG0_mps2 * (1.0 + 1e-3 * draws.between(-8.0, 8.0));
  if (draws.one_in(5)) world.temperature = {draws.between(-10.0, 60.0), draws.between(-0.3, 0.3)};
  if (draws.one_in(8)) world.depth = {draws.between(10.0, 30.0), 8.4e-7, 0.03};
}

/// The sizes of a kind that is drawn freely; the catalogue's defaults are played beside.
void draw_size(int n, Draws& draws, scenario::Fault& fault) {
  using scenario::FaultKind;
  const double decades = draws.either_sign(0.0, 3.0);
  const double off_mps2 = std::copysign(std::pow(10.0, std::fabs(decades)), decades) * kMilligee_mps2;
  fault.magnitude = off_mps2;
  switch (fault.kind) {
    case FaultKind::drift: fault.magnitude = 0.02 * off_mps2; break;
    case FaultKind::scale_change: fault.magnitude = 1.0 + off_mps2 / kG0_mps2; break;
    case FaultKind::stuck_last: fault.magnitude = 0.0; break;
    case FaultKind::noise: fault.magnitude = std::fabs(off_mps2); break;
    case FaultKind::spikes: fault.upper = 0.02; break;
    case FaultKind::chatter: fault.upper = draws.between(0.2, 3.0); break;
    case FaultKind::warm_up: fault.upper = draws.between(1.0, 20.0); break;
    case FaultKind::missing: fault.magnitude = draws.between(0.02, 1.0); break;
    case FaultKind::late:
    case FaultKind::slow: fault.magnitude = 2.0 + draws.below(40); break;
    case FaultKind::random_level: fault.upper = off_mps2 + kMilligee_mps2; break;
    case FaultKind::coarse: fault.magnitude = draws.between(1.0, 100.0) * scenario::kPaperResolution_V; break;
    case FaultKind::drop: fault.magnitude = draws.between(0.02, 0.9); break;
    case FaultKind::mirror:
      fault.magnitude = (fault.sensor + 1) % n;
      fault.upper = (fault.sensor + 2) % n;
      break;
    default: break;
  }
}

scenario::Fault draw_fault(int n, int stations, Draws& draws) {
  using scenario::FaultKind;
  scenario::Fault fault;
  constexpr FaultKind kKinds[] = {
      FaultKind::bias_step,    FaultKind::stuck_level, FaultKind::stuck_last,   FaultKind::drift,   FaultKind::noise,
      FaultKind::scale_change, FaultKind::spikes,      FaultKind::chatter,      FaultKind::warm_up, FaultKind::missing,
      FaultKind::late,         FaultKind::slow,        FaultKind::random_level, FaultKind::coarse,  FaultKind::mirror,
      FaultKind::drop,         FaultKind::repeat,      FaultKind::swap};
  fault.kind = draws.any_of(kKinds);
  fault.sensor = draws.below(n);
  fault.clock = scenario::Clock::station;
  fault.onset = 1.0 + draws.below(stations);
  if (draws.one_in(3)) fault.duration = 1.0 + draws.below(12);
  draw_size(n, draws, fault);
  if (scenario::needs_whole_log(fault.kind)) fault.sensor = scenario::kWholeLog;
  return fault;
}

void draw_faults(const CaseNumber& number, const Datasheet& datasheet, Draws& draws, Coverage& coverage, Plan& plan) {
  const int choice = number.fault();
  const int onset = plan.situation == Situation::first_calibration && draws.one_in(2) ? 30 : 3 + draws.below(9);
  std::vector<scenario::Fault>& faults = plan.scenario.faults;
  if (choice < kFaultChoices - 2) {
    scenario::FaultContext context;
    context.datasheet = datasheet;
    const scenario::CatalogueEntry& entry = scenario::catalogue()[slot(choice)];
    scenario::CatalogueOptions options;
    options.sensor = draws.below(number.sensors());
    options.clock = scenario::Clock::station;
    options.onset = entry.from_power_on && draws.one_in(2) ? 1 : onset;
    if (draws.one_in(3)) options.duration = 2 + draws.below(8);
    if (auto made = scenario::faults_of(entry, options, context)) faults = *std::move(made);
  }
  const bool drawn = choice == kFaultChoices - 1;
  const bool healthy = choice == kFaultChoices - 2;
  int more = drawn ? 1 + draws.below(3) : draws.one_in(4) ? 1 : 0;
  if (plan.situation == Situation::reset) more += 2;  // or there is nothing to leave
  if (healthy) more = 0;
  for (int k = 0; k < more; ++k) {
    const scenario::Fault fault = draw_fault(number.sensors(), 24, draws);
    if (scenario::check(fault, number.sensors())) faults.push_back(fault);
  }
  coverage.met("fault", fault_name(choice));
  for (const scenario::Fault& fault : faults) coverage.met("fault kind", to_string(fault.kind));
}

void draw_settings(Draws& draws, MonitorConfig& config) {
  config.alarm_form = draws.one_in(2) ? AlarmForm::average_tool : AlarmForm::every_tool;
  if (draws.one_in(3)) config.delta_f_mps2 = draws.between(1.0, 20.0) * kMilligee_mps2;
  if (draws.one_in(3)) config.triple_false_alarm_rate = 1e-6;
  if (draws.one_in(3)) config.false_alarm_rate = draws.any_of({1e-9, 1e-3, 1e-2});
  if (draws.one_in(3)) config.integrity_risk = draws.any_of({1e-3, 1e-9});
  if (draws.one_in(3)) config.fault_prior = draws.any_of({1e-2, 1e-6});
  config.isolation_stations = 1 + draws.below(5);
  config.passed_blocks = 1 + draws.below(5);
  config.forget_blocks = 1 + draws.below(5);
  config.probation_stations = 1 + draws.below(6);
  config.missing_confirm = 1 + draws.below(20);
  if (draws.one_in(3)) config.max_age_s = draws.between(0.5, 5.0);
  if (draws.one_in(3)) config.max_age_samples = 40 + draws.below(200);
  config.max_gap_s = draws.any_of({0.3, 5.0, 60.0});
  config.alert_limit_rad = rad_from_deg(draws.between(0.05, 3.0));
}

void draw_config(Draws& draws, Plan& plan) {
  MonitorConfig& config = plan.setup.config;
  config.window = kCapacity > 8 && draws.one_in(8) ? 64 : draws.any_of({16, 16, 32, 32, 8, 12});
  if (draws.one_in(6)) config.temperature_min_degc = 0.0;
  if (draws.one_in(6)) config.temperature_max_degc = 50.0;
  if (draws.one_in(4)) config.isolation_timeout = 2 + draws.below(8);
  if (draws.one_in(6)) config.isolation_timeout_blocks = 8 + draws.below(30);
  if (draws.one_in(6)) draw_settings(draws, config);
  plan.power_cycles = draws.one_in(5);
}

void draw_stability(Draws& draws, Plan& plan) {
  const int n = plan.setup.array.size();
  const int stated = draws.one_in(4) ? n - 1 : n;
  for (int i = 0; i < stated; ++i) {
    plan.setup.stability[slot(i)] = {draws.between(0.0, 1.0) * kMilligee_mps2, 1e-3 * kMilligee_mps2,
                                     0.01 * kMilligee_mps2, draws.one_in(2) ? 0.1 * kMilligee_mps2 : 0.0};
  }
  plan.setup.days_since_calibration = draws.between(0.0, 400.0);
  plan.scenario.noise.instability = {draws.between(0.0, 0.5) * kMilligee_mps2, 20.0, 0.02 * kMilligee_mps2};
  plan.scenario.temperature = {25.0, draws.between(-0.5, 0.5)};
}

/// What belongs to the situation alone.
void draw_situation(Draws& draws, Plan& plan) {
  MonitorSetup& setup = plan.setup;
  switch (plan.situation) {
    case Situation::reset:
      setup.config.isolation_timeout = 2 + draws.below(3);
      setup.config.isolation_timeout_blocks = 6 + draws.below(10);
      break;
    case Situation::policy: setup.config.recalibrate_after_exclusion = true; break;
    case Situation::bound:
      setup.config.acceleration_bound_mps2 = draws.any_of({0.5, 2.0, 20.0}) * kMilligee_mps2;
      plan.push_mps2 = draws.vector(0.0, 1.5 * setup.config.acceleration_bound_mps2);
      break;
    case Situation::asserted:
      setup.config.assumed_faults = draws.below(4);
      setup.config.isolation_timeout = 1 + draws.below(6);
      break;
    case Situation::stability: draw_stability(draws, plan); break;
    case Situation::settings: draw_settings(draws, setup.config); break;
    case Situation::means:
      plan.samples_per_row = 16;
      setup.config.window = draws.any_of({1, 1, 2, 4});
      setup.config.max_gap_s = 100.0;
      break;
    case Situation::turning:
      plan.scenario.turning = {draws.either_sign(0.005, 3.0), draws.direction(), 3.0, draws.between(5.0, 15.0)};
      setup.lever_arms_known = draws.one_in(2);
      for (int i = 0; i < setup.array.size(); ++i) {
        setup.lever_arm_m[slot(i)] = plan.scenario.tool.lever_arm_m[slot(i)] = draws.vector(0.05, 0.05);
      }
      break;
    default: break;
  }
  if (draws.one_in(8)) setup.output_frame = {0, 1, 0, -1, 0, 0, 0, 0, 1};
}

}  // namespace

bool make_plan(const CaseNumber& number, Draws& draws, Coverage& coverage, Plan& plan) {
  plan.situation = number.situation();
  coverage.met("situation", to_string(plan.situation));
  const Datasheet datasheet = draw_datasheet(number.sensors(), draws);
  draw_knowledge(datasheet, draws, coverage, plan);
  for (int i = 0; i < datasheet.size; ++i) {
    plan.setup.full_scale_raw[slot(i)] = datasheet.sensor[slot(i)].full_scale_raw;
    plan.setup.resolution_raw[slot(i)] = draws.one_in(4) ? 0.0 : datasheet.sensor[slot(i)].resolution_raw;
  }
  draw_config(draws, plan);
  draw_world(draws, coverage, plan);
  draw_situation(draws, plan);
  draw_faults(number, datasheet, draws, coverage, plan);
  return plan.setup.array.size() == number.sensors();
}

}  // namespace PLUMB_ABI
}  // namespace plumb_replay

#include "flight_run.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "plumb/core/detail/archive.hpp"
#include "plumb/core/units.hpp"
#include "plumb/findings/detection_sizes.hpp"
#include "plumb/health/motion_link.hpp"
#include "plumb/io/hash.hpp"
#include "plumb/session/flight_sheet.hpp"

namespace plumb_web {

using namespace plumb;
using scenario::Flight;
using scenario::FlightKind;
using scenario::FlightSpec;

namespace {

constexpr double kFlightNoise_mps2 = 0.02;
constexpr double kFlightRange_g0 = 16.0;
constexpr double kLongest_s = 30.0;
constexpr int kFlightGyros = 2;
constexpr double kFlightTemperature_degc = 25.0;
/// A channel counts as clipped from this share of full scale on (docs/array-file.md).
constexpr double kClipShare = 0.995;

std::size_t slot(int i) { return static_cast<std::size_t>(i); }

/// Sensors of 16 g0 over the same 5 V and 16 bits.
Make flight_make() {
  Make out = paper_make();
  out.scale_per_mps2 = out.full_scale_raw / (kFlightRange_g0 * kG0_mps2);
  out.reads = Reads::specific_force;
  return out;
}

/// The fastest turn that a monitor is told of each kind of flight.
double rate_bound_radps(FlightKind kind) {
  switch (kind) {
    case FlightKind::drone: return 8.0;
    case FlightKind::drilling: return 25.0;
    case FlightKind::car: return 2.0;
    case FlightKind::launch: return 6.0;
  }
  return 0.0;
}

/// Units sit 20 mm from the middle, spread over the directions; the axes of a chip 1 mm from its place.
std::vector<Vec3> arms_of(const SensorArray& array) {
  const SensorUnits& units = array.units();
  std::vector<Vec3> out;
  for (int i = 0; i < array.size(); ++i) {
    const Vec3 place = scaled(findings::spread_direction(units.of(i), units.size()), 0.02);
    out.push_back(units.grouped() ? plus(place, scaled(array.axis(i), 0.001)) : place);
  }
  return out;
}

/// What a data sheet would state: bounds of healthy errors, wider than those that the flight draws from.
MotionSetup setup_of_flight(const std::vector<Vec3>& arms, FlightKind kind) {
  MotionSetup out;
  for (std::size_t i = 0; i < arms.size(); ++i) {
    out.lever_arm_m[i] = arms[i];
    out.errors[i] = {1e-3, 70e-6, 2e-5, 1e-3, 1.5e-3, 1e-3 * kG0_mps2};
  }
  out.gyros = kFlightGyros;
  out.gyro = {0.01, 0.01, rad_from_deg(0.35), rad_from_deg(0.1), 20e-6};
  out.rate_bound_radps = rate_bound_radps(kind);
  return out;
}

std::optional<FlightKind> kind_of(const std::string& motion) {
  for (int k = 0; k < scenario::kFlightKinds; ++k) {
    if (motion == to_string(static_cast<FlightKind>(k))) return static_cast<FlightKind>(k);
  }
  return std::nullopt;
}

/// Errors are drawn within what the monitor is told, as `plumb simulate --flight` draws them from an array file.
FlightSpec spec_of(const FlightPlan& plan, FlightKind kind, const SensorArray& array, const std::vector<Vec3>& arms,
                   std::uint64_t seed) {
  FlightSpec out;
  out.kind = kind;
  out.rate_hz = 1.0 / plan.setup.sample_period_s;
  out.seed = seed;
  out.lever_arm_m = arms;
  for (int i = 0; i < array.size(); ++i) out.axis.push_back(array.axis(i));
  out.noise_mps2 = kFlightNoise_mps2;
  out.full_scale_mps2 = session::flight_full_scale_mps2(plan.datasheet, out.full_scale_mps2);
  out.box = session::flight_errors_within(plan.setup.errors[0], plan.setup.gyro, out.bandwidth_hz);
  out.gyros = plan.setup.gyros;
  out.gyro_noise_radps = plan.setup.gyro.noise_radps;
  return out;
}

/// What is no reading, or none at all.
bool may_silence(const scenario::Fault& fault) {
  return fault.kind == scenario::FaultKind::missing || fault.kind == scenario::FaultKind::pattern;
}

tl::unexpected<std::string> refused_by(const Error& error) {
  return tl::unexpected<std::string>(std::string(describe(error.code)) + ". Remedy: " + remedy(error.code));
}

}  // namespace

const char* to_string(FlightEvent event) noexcept {
  switch (event) {
    case FlightEvent::alarm: return "alarm";
    case FlightEvent::isolated: return "isolated";
    case FlightEvent::excluded: return "provisionally_excluded";
    case FlightEvent::quiet: return "quiet_again";
  }
  return "unknown";
}

FlightRun::FlightRun(FlightPlan plan, const SensorArray& array, Flight flight, scenario::Injector injector,
                     std::vector<std::string> words)
    : plan_(std::move(plan)),
      model_(plan_.datasheet.model()),
      array_(array),
      flight_(std::move(flight)),
      injector_(std::move(injector)),
      words_(std::move(words)),
      px4_(array, plan_.spec.rate_hz),
      all_(least_squares(array, array.all())),
      rows_(static_cast<std::uint64_t>(std::llround(plan_.spec.rate_hz * plan_.duration_s))),
      digest_(io::kFnvStart) {}

tl::expected<std::unique_ptr<FlightRun>, std::string> FlightRun::make(const json& scene, const AxisList& axes,
                                                                      const ChipList& chips, int n) {
  const std::optional<FlightKind> kind = kind_of(motion_of(scene));
  if (!kind)
    return tl::unexpected<std::string>(
        "\"" + motion_of(scene) + "\" is no motion. Remedy: choose stations, roll, drone, drilling, car or launch");
  FlightPlan plan;
  plan.datasheet = datasheet_of(axes, chips, n, kFlightNoise_mps2, flight_make());
  const Expected<SensorArray> array = plan.datasheet.array();
  if (!array) return refused_by(array.error());
  tl::expected<SceneFaults, std::string> faults = faults_of(scene, plan.datasheet);
  if (!faults) return tl::unexpected<std::string>(faults.error());
  plan.faults = faults->faults;
  const std::vector<Vec3> arms = arms_of(*array);
  plan.setup = setup_of_flight(arms, *kind);
  plan.spec = spec_of(plan, *kind, *array, arms, seed_of(scene, "seed", 3.0));
  const double duration_s = number(scene, "duration_s", 6.0);
  plan.duration_s = duration_s > 0.0 && duration_s < kLongest_s ? duration_s : kLongest_s;
  tl::expected<Flight, std::string> flight = Flight::make(plan.spec);
  if (!flight) return tl::unexpected<std::string>(flight.error());
  tl::expected<scenario::Injector, std::string> injector =
      scenario::Injector::make(plan.datasheet, plan.datasheet.model(), plan.faults, plan.spec.seed);
  if (!injector) return tl::unexpected<std::string>(injector.error());
  std::unique_ptr<FlightRun> out(
      new FlightRun(std::move(plan), *array, *std::move(flight), *std::move(injector), std::move(faults->words)));
  const Expected<void> configured = out->configure();
  if (!configured) return refused_by(configured.error());
  return out;
}

/// A flight is too short for the attitudes that a calibration takes, so that of the monitor at rest nothing comes but
/// which channels are lost and back. It is left out where none can be: calibrating itself, it takes ten times as long
/// as all else in a step.
Expected<void> FlightRun::configure() {
  Expected<void> done = monitor_->configure(array_, plan_.setup);
  if (!done || std::none_of(plan_.faults.begin(), plan_.faults.end(), may_silence)) return done;
  auto setup = std::make_unique<MonitorSetup>();
  setup->config.alert_frame = AlertFrame::calibrated_axes;
  setup->lever_arm_m = plan_.setup.lever_arm_m;
  setup->lever_arms_known = true;
  rest_ = std::make_unique<HealthMonitor>();
  done = set_datasheet(plan_.datasheet, *setup);
  return done ? rest_->configure(*setup) : done;
}

/// Before the step in motion, with what that found by the row before (as `session::MotionWatch` has it).
void FlightRun::step_at_rest(Sample sample, const MotionSample& row) {
  sample.temperature_degc = kFlightTemperature_degc;                                    // the log has no column for it
  (void)rest_->set_rotation({norm(row.rate_radps[0]) > 0.0, true, row.rate_radps[0]});  // a finite one
  rest_->set_motion(motion_finding(monitor_->verdict()));
  if (settles_motion(rest_->step(sample))) monitor_->forget();
  monitor_->set_in_service(in_service());
}

/// As `plumb monitor` reads the row of a log.
MotionSample FlightRun::moved(const Sample& sample, const scenario::FlightSample& flown) const {
  MotionSample out;
  out.time_s = flown.time_s;
  const Readings down = model_.without_misalignment(sample.raw, kFlightTemperature_degc, sample.delivered);
  for (int i = 0; i < array_.size(); ++i) {
    if (!sample.delivered.has(i) || !std::isfinite(down[slot(i)])) continue;
    out.reading_mps2[slot(i)] = -down[slot(i)];  // of gravity: in motion the force
    out.delivered = out.delivered.with(i);
    if (std::fabs(sample.raw[slot(i)]) >= kClipShare * plan_.datasheet.sensor[slot(i)].full_scale_raw)
      out.clipped = out.clipped.with(i);
  }
  for (std::size_t g = 0; g < kFlightGyros; ++g) {
    out.rate_radps[g] = flown.rate_radps[g];
    out.rate_given[g] = true;
  }
  return out;
}

bool FlightRun::next(Record& record) {
  if (row_ == rows_) return false;
  const scenario::FlightSample flown = flight_.next();
  Sample sample = session::flight_sample(plan_.datasheet, model_, kFlightTemperature_degc, flown);
  const SensorSet faulty = injector_.apply(sample);
  const MotionSample row = moved(sample, flown);
  if (rest_) step_at_rest(sample, row);
  monitor_->step(row);
  px4_.step(row.reading_mps2, row.delivered);
  truth_ = {truth_[1], truth_[2], flown.specific_force_mps2};
  hash(monitor_->verdict());
  tell(flown, faulty, row.reading_mps2, record);
  ++row_;
  return true;
}

void FlightRun::tell(const scenario::FlightSample& flown, SensorSet faulty, const Readings& y, Record& record) {
  const MotionVerdict& v = monitor_->verdict();
  const SpecificForce& force = v.sample;
  record.set(At::time_s, flown.time_s);
  record.set(At::station, 0);
  record.set(At::moving, 1);
  record.set(At::validity, force.validity);
  record.set(At::cause, v.cause);
  record.set(At::in_service, in_service() - v.excluded);
  record.set(At::absent, rest_ ? rest_->verdict().absent : SensorSet());
  record.set(At::provisionally_excluded, v.excluded);
  record.set(At::excluded, SensorSet());
  record.set(At::suspects, v.isolated | v.suspects);
  record.set(At::faulty, faulty);
  record.set(At::alert, v.alarm);
  record.set(At::isolated, v.isolated);
  tell_event(record);
  const Vec3 mean = scaled(plus(truth_[0], truth_[1]), 0.5);  // that of which the monitor speaks now
  record.set(At::told_x, force.validity == ForceValidity::none ? Vec3{} : force.force_mps2);
  record.set(At::true_x, mean);
  record.set(At::hypotheses, v.least_faults);
  if (row_ > 2 && force.validity != ForceValidity::none) {
    record.set(At::force_error_mps2, norm(minus(force.force_mps2, mean)));
    record.set(At::force_bound_mps2, force.bound_mps2);
    record.set(At::protection_rad, std::asin(std::fmin(1.0, force.bound_mps2 / norm(force.force_mps2))));
  }
  record.set(At::plain_force_mps2, norm(minus(all_.estimate(y), flown.specific_force_mps2)));
  record.set(At::px4_selector, px4_.selector());
  record.set(At::px4_voter, px4_.voter());
  record.set(At::px4_in_use, px4_.in_use());
  if (!px4_.units().empty()) record.set(At::px4_force_mps2, norm(minus(px4_.vector(), flown.specific_force_mps2)));
}

/// The motion monitor has no states; as the page colours them: nothing found, an alarm, somebody named.
void FlightRun::tell_event(Record& record) {
  const MotionVerdict& v = monitor_->verdict();
  const SensorSet named = v.isolated | v.excluded;
  const int state = !named.empty() ? 2 : v.alarm ? 1 : 0;
  record.set(At::state, state);
  record.set(At::event, -1);
  record.set(At::event_sensors, 0);
  if (state != state_ || named != told_ || !(v.excluded - excluded_).empty()) {
    const FlightEvent event = !(v.excluded - excluded_).empty() ? FlightEvent::excluded
                              : state == 2                      ? FlightEvent::isolated
                              : state == 1                      ? FlightEvent::alarm
                                                                : FlightEvent::quiet;
    record.set(At::event, event);
    record.set(At::from, state_);
    record.set(At::to, state);
    record.set(At::event_sensors, event == FlightEvent::excluded ? v.excluded : named);
  }
  state_ = state;
  told_ = named;
  excluded_ = v.excluded;
}

void FlightRun::hash(const MotionVerdict& v) {
  const auto add = [this](auto value) {
    const std::uint64_t bits = archive_detail::bits_of(value);
    digest_ = io::fnv1a(&bits, sizeof bits, digest_);
  };
  for (const SpecificForce* force : {&v.sample, &v.block}) {
    for (const double x : force->force_mps2) add(x);
    for (const double x : force->covariance_m2ps4) add(x);
    add(force->bound_mps2);
    add(static_cast<std::uint32_t>(force->validity));
    add(force->used.bits);
  }
  for (const SensorSet set :
       {v.rejected, v.suspects, v.isolated, v.excluded, in_service(), px4_.selector(), px4_.voter()})
    add(set.bits);
  add(static_cast<std::uint32_t>(v.least_faults));
  add(static_cast<std::uint32_t>(v.cause));
}

}  // namespace plumb_web

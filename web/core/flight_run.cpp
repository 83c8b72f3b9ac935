#include "flight_run.hpp"

#include <cmath>
#include <utility>

#include "plumb/core/detail/archive.hpp"
#include "plumb/core/units.hpp"
#include "plumb/findings/detection_sizes.hpp"
#include "plumb/io/hash.hpp"

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

FlightRun::FlightRun(const Datasheet& datasheet, const SensorArray& array, Flight flight, scenario::Injector injector,
                     SceneFaults faults)
    : model_(datasheet.model()),
      array_(array),
      flight_(std::move(flight)),
      injector_(std::move(injector)),
      words_(std::move(faults.words)),
      px4_(array, kRate_hz),
      all_(least_squares(array, array.all())),
      full_scale_mps2_(0.999 * kFlightRange_g0 * kG0_mps2),
      digest_(io::kFnvStart) {}

tl::expected<std::unique_ptr<FlightRun>, std::string> FlightRun::make(const json& scene, const AxisList& axes,
                                                                      const ChipList& chips, int n) {
  FlightSpec spec;
  bool known = false;
  for (int k = 0; k < scenario::kFlightKinds; ++k) {
    if (motion_of(scene) != to_string(static_cast<FlightKind>(k))) continue;
    spec.kind = static_cast<FlightKind>(k);
    known = true;
  }
  if (!known)
    return tl::unexpected<std::string>(
        "\"" + motion_of(scene) + "\" is no motion. Remedy: choose stations, roll, drone, drilling, car or launch");
  const Datasheet datasheet = datasheet_of(axes, chips, n, kFlightNoise_mps2, flight_make());
  const Expected<SensorArray> array = datasheet.array();
  if (!array) return refused_by(array.error());
  tl::expected<SceneFaults, std::string> faults = faults_of(scene, datasheet);
  if (!faults) return tl::unexpected<std::string>(faults.error());
  spec.lever_arm_m = arms_of(*array);
  for (int i = 0; i < n; ++i) spec.axis.push_back(array->axis(i));
  spec.seed = seed_of(scene, "seed", 3.0);
  spec.noise_mps2 = kFlightNoise_mps2;
  spec.full_scale_mps2 = kFlightRange_g0 * kG0_mps2;
  spec.gyros = kFlightGyros;
  tl::expected<Flight, std::string> flight = Flight::make(spec);
  if (!flight) return tl::unexpected<std::string>(flight.error());
  tl::expected<scenario::Injector, std::string> injector =
      scenario::Injector::make(datasheet, datasheet.model(), faults->faults, spec.seed);
  if (!injector) return tl::unexpected<std::string>(injector.error());
  std::unique_ptr<FlightRun> out(
      new FlightRun(datasheet, *array, *std::move(flight), *std::move(injector), *std::move(faults)));
  const double duration_s = number(scene, "duration_s", 6.0);
  out->rows_ =
      static_cast<std::uint64_t>(kRate_hz * (duration_s > 0.0 && duration_s < kLongest_s ? duration_s : kLongest_s));
  const Expected<void> configured = out->monitor_->configure(*array, setup_of_flight(spec.lever_arm_m, spec.kind));
  if (!configured) return refused_by(configured.error());
  return out;
}

bool FlightRun::next(Record& record) {
  if (row_ == rows_) return false;
  const scenario::FlightSample flown = flight_.next();
  Sample sample;
  sample.time_s = flown.time_s;
  sample.delivered = array_.all();
  sample.temperature_degc = 25.0;
  for (int i = 0; i < array_.size(); ++i) {
    const Make make = flight_make();
    const double raw = make.scale_per_mps2 * flown.reading_mps2[slot(i)];
    sample.raw[slot(i)] = make.resolution_raw * std::nearbyint(raw / make.resolution_raw);
  }
  const SensorSet faulty = injector_.apply(sample);
  MotionSample moved;
  moved.time_s = flown.time_s;
  moved.delivered = sample.delivered & array_.all();
  const Readings down = model_.apply(sample.raw, sample.temperature_degc, moved.delivered);
  for (std::size_t i = 0; i < down.size(); ++i) moved.reading_mps2[i] = -down[i];  // of gravity: in motion the force
  for (int i = 0; i < array_.size(); ++i) {
    if (std::fabs(moved.reading_mps2[slot(i)]) >= full_scale_mps2_) moved.clipped = moved.clipped.with(i);
  }
  for (std::size_t g = 0; g < kFlightGyros; ++g) {
    moved.rate_radps[g] = flown.rate_radps[g];
    moved.rate_given[g] = true;
  }
  monitor_->step(moved);
  px4_.step(moved.reading_mps2, moved.delivered);
  truth_ = {truth_[1], truth_[2], flown.specific_force_mps2};
  hash(monitor_->verdict());
  tell(flown, faulty, moved.reading_mps2, record);
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
  record.set(At::in_service, array_.all() - v.excluded);
  record.set(At::provisionally_excluded, v.excluded);
  record.set(At::excluded, SensorSet());
  record.set(At::suspects, v.isolated | v.suspects);
  record.set(At::faulty, faulty);
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
  for (const SensorSet set : {v.rejected, v.suspects, v.isolated, v.excluded, px4_.selector(), px4_.voter()})
    add(set.bits);
  add(static_cast<std::uint32_t>(v.least_faults));
  add(static_cast<std::uint32_t>(v.cause));
}

}  // namespace plumb_web

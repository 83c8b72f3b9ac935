// The second view of the page: a tool in a scenario, the monitor that watches it, and what is really the case.
#include <cmath>
#include <limits>

#include "explorer.hpp"
#include "plumb/array/geometry.hpp"
#include "plumb/calibration/calibration.hpp"
#include "plumb/core/detail/archive.hpp"
#include "plumb/core/units.hpp"
#include "plumb/detection/stationarity.hpp"
#include "plumb/findings/best_turn.hpp"
#include "plumb/io/hash.hpp"
#include "plumb/io/json_fields.hpp"
#include "plumb/scenario/fault_text.hpp"
#include "plumb/scenario/library.hpp"
#include "reading.hpp"

namespace plumb_web {

using namespace plumb;

namespace {

constexpr int kMostStations = 200;
constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();

std::size_t slot(int i) { return static_cast<std::size_t>(i); }

/// Sensors of the paper's kind along these axes: what the array file says that the page offers.
Datasheet datasheet_of(const AxisList& axes, int n, double noise_mps2) {
  Datasheet out;
  out.size = n;
  out.reads = Reads::gravity;
  for (int i = 0; i < n; ++i) {
    DatasheetSensor& sensor = out.sensor[slot(i)];
    sensor.row.id = make_id(("a" + std::to_string(i + 1)).c_str());
    const double length = norm(axes[slot(i)]);
    sensor.row.axis = std::fabs(length - 1.0) > 1e-9 ? scaled(axes[slot(i)], 1.0 / length) : axes[slot(i)];
    sensor.row.sigma_mps2 = noise_mps2;
    sensor.coefficients.scale[0] = scenario::kPaperScale_VpMps2;
    sensor.full_scale_raw = scenario::kPaperFullScale_V;
    sensor.resolution_raw = scenario::kPaperResolution_V;
  }
  return out;
}

/// The stations of the stand, found as `plumb calibrate` finds them in its log.
std::vector<Station> stations_of(const scenario::Tool& tool, const SensorArray& array, const GravityReference& gravity,
                                 std::uint64_t seed) {
  std::vector<Station> out;
  auto stand = scenario::Simulator::make(scenario::calibration_run(tool, seed));
  if (!stand) return out;
  const SensorModel model = tool.datasheet.model();
  const MonitorConfig config;
  StationFinder::Settings settings;
  settings.station_angle_rad = config.station_angle_rad;
  settings.max_gap_s = config.max_gap_s;
  const auto finder = std::make_unique<StationFinder>(array, gravity.g_mps2, settings);
  Station finished;
  for (Sample sample; stand->next(sample);) {
    const SensorSet usable = sample.delivered & array.all();
    const Readings y = model.apply(sample.raw, sample.temperature_degc, usable);
    if (finder->add(sample, y, usable, finished)) out.push_back(finished);
  }
  if (finder->finish(finished)) out.push_back(finished);
  return out;
}

scenario::Scenario scenario_of(const json& scene, const scenario::Tool& tool) {
  scenario::Scenario out = scenario::drilling_run(tool, 1);
  scenario::DrillingPath path;
  const double stations = number(scene, "stations", 14.0);
  path.stations = stations >= 1.0 && stations <= kMostStations ? static_cast<int>(stations) : kMostStations;
  path.first.inclination_rad = rad_from_deg(number(scene, "inclination_deg", 20.0));
  path.build_rad = rad_from_deg(number(scene, "build_deg", 1.5));
  path.toolface_step_rad = rad_from_deg(number(scene, "toolface_step_deg", 137.5));
  out.attitudes = path;
  out.dwell_s = number(scene, "dwell_s", 2.0);
  out.move_s = number(scene, "move_s", 1.0);
  out.vibration_mps2 = number(scene, "vibration_mps2", 0.1 * kG0_mps2);
  out.seed = static_cast<std::uint64_t>(std::fabs(number(scene, "seed", 3.0)));
  return out;
}

std::unique_ptr<MonitorSetup> setup_of(const Datasheet& datasheet, const Calibration& fit,
                                       const GravityReference& gravity) {
  auto out = std::make_unique<MonitorSetup>();
  out->model = fit.model;
  out->array = fit.array;
  out->gravity = gravity;
  out->config.alert_frame = AlertFrame::calibrated_axes;
  out->config.temperature_min_degc = fit.report.temperature_min_degc;
  out->config.temperature_max_degc = fit.report.temperature_max_degc;
  for (int i = 0; i < datasheet.size; ++i) {
    out->full_scale_raw[slot(i)] = datasheet.sensor[slot(i)].full_scale_raw;
    out->resolution_raw[slot(i)] = datasheet.sensor[slot(i)].resolution_raw;
  }
  return out;
}

Mat3 turn_of(const scenario::Tool& tool) {
  findings::BestTurn best;
  for (int i = 0; i < tool.datasheet.size; ++i) {
    best.add(tool.datasheet.sensor[slot(i)].row.axis, tool.axes[slot(i)]);
  }
  const findings::Turn turn = best.find(findings::Hand::kept);
  Mat3 out{};
  for (std::size_t r = 0; r < 3; ++r) {
    for (std::size_t c = 0; c < 3; ++c) out[3 * r + c] = turn[r][c];
  }
  return out;
}

/// Every scalar of a verdict into one sum.
class Digest {
 public:
  Digest(std::uint64_t start, int sensors) noexcept : sum_(start), sensors_(sensors) {}
  int sensors() const noexcept { return sensors_; }
  void fail() noexcept {}
  template <class T>
  void done(const T&) noexcept {}
  template <class T, class Check>
  void scalar(const T& value, const Check&) noexcept {
    const std::uint64_t bits = archive_detail::bits_of(value);
    sum_ = io::fnv1a(&bits, sizeof bits, sum_);
  }
  std::uint64_t sum() const noexcept { return sum_; }

 private:
  std::uint64_t sum_;
  int sensors_;
};

/// Whether the vector of the verdict is about this sample's attitude.
bool is_current(const Verdict& v, const scenario::Truth& truth) {
  return !truth.moving && v.validity >= Validity::unconfirmed && norm(v.gravity_mps2) > 0.0;
}

double bits_of(SensorSet set) { return static_cast<double>(set.bits); }

/// The entries of `record_names` but for the last ones, of the sensors.
constexpr int kCommonFigures = 42;

}  // namespace

const std::vector<std::string>& record_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> out = {"time_s",
                                    "station",
                                    "moving",
                                    "state",
                                    "validity",
                                    "cause",
                                    "qualifiers",
                                    "decided_by",
                                    "statistic",
                                    "limit",
                                    "in_service",
                                    "provisionally_excluded",
                                    "excluded",
                                    "absent",
                                    "suspects",
                                    "faulty",
                                    "event",
                                    "from",
                                    "to",
                                    "event_cause",
                                    "event_sensors",
                                    "error_rad",
                                    "plain_rad",
                                    "protection_rad",
                                    "told_x",
                                    "told_y",
                                    "told_z",
                                    "true_x",
                                    "true_y",
                                    "true_z",
                                    "hypotheses",
                                    "on_record",
                                    "parity",
                                    "parity_limit",
                                    "mae_mps2",
                                    "mae_limit_mps2",
                                    "norm_error",
                                    "wants_turn",
                                    "confirmed_grade",
                                    "provisional_grade",
                                    "tick",
                                    "alert"};
    for (int i = 1; i <= kCapacity; ++i) out.push_back("minimum_faults_" + std::to_string(i));
    return out;
  }();
  return names;
}

std::string Play::begin(const std::string& scene_text) {
  *this = Play();
  digest_ = io::kFnvStart;
  const json scene = json::parse(scene_text, nullptr, false);
  AxisList axes{};
  const int n = scene.is_object() ? read_axes(scene, axes) : 0;
  if (n == 0) return refusal(axes_wanted());
  const GravityReference gravity;
  const Datasheet datasheet = datasheet_of(axes, n, number(scene, "noise_mps2", scenario::kPaperNoise_mps2));
  const Expected<SensorArray> nominal = datasheet.array();
  if (!nominal) return refused(nominal.error());
  const auto seed_of = [&scene](const char* key) {
    return static_cast<std::uint64_t>(std::fabs(number(scene, key, 1.0)));
  };
  const scenario::Tool tool = scenario::draw_tool(datasheet, seed_of("truth_seed"));
  const std::vector<Station> stations = stations_of(tool, *nominal, gravity, seed_of("stand_seed"));
  const auto fit = calibrate(datasheet, gravity, stations.data(), static_cast<int>(stations.size()));
  if (!fit) return refused(fit.error());
  scenario::Scenario world = scenario_of(scene, tool);
  scenario::FaultContext context;
  context.datasheet = datasheet;
  io::Json told = io::Json::array();
  for (const std::string& text : texts(scene, "faults")) {
    const auto faults = scenario::parse_faults(text, context);
    if (!faults) return refusal(text + ": " + faults.error());
    for (const scenario::Fault& fault : *faults) {
      told.push_back(scenario::describe(fault, context));
      world.faults.push_back(fault);
    }
  }
  std::vector<scenario::HostRequest> requests;
  for (const std::string& text : texts(scene, "requests")) {
    const auto request = scenario::parse_host_request(text, *nominal);
    if (!request) return refusal(text + ": " + request.error());
    requests.push_back(*request);
  }
  host_ = scenario::Host(requests);
  auto simulator = scenario::Simulator::make(world);
  if (!simulator) return refusal(simulator.error());
  simulator_ = std::make_unique<scenario::Simulator>(*std::move(simulator));
  turn_ = turn_of(tool);
  setup_ = setup_of(datasheet, *fit, gravity);
  monitor_ = std::make_unique<HealthMonitor>();
  const Expected<void> configured = monitor_->configure(*setup_);
  if (!configured) return refused(configured.error());
  io::Json out = io::object({{"samples", static_cast<double>(simulator_->size())},
                             {"duration_s", simulator_->duration_s()},
                             {"stations", static_cast<double>(simulator_->directions().size())}});
  out["faults"] = std::move(told);
  return out.dump();
}

int Play::run(int samples) {
  int done = 0;
  for (Sample sample; done < samples && simulator_ && simulator_->next(sample); ++done) {
    host_.before(sample.time_s, *monitor_);
    monitor_->step(sample);
    record(sample);
  }
  return done;
}

void Play::record(const Sample& sample) {
  const Verdict& v = monitor_->verdict();
  Digest digest(digest_, monitor_->array().size());
  transfer(digest, v, AnyBits{});
  digest_ = digest.sum();
  const scenario::Truth& truth = simulator_->truth();
  const Vec3 down = times(turn_, truth.gravity_mps2);
  const TransitionRecord& event = v.transition;
  const bool changed = event.sequence != 0;
  const SensorSet usable = sample.delivered & setup_->array.all();
  const Readings y = setup_->model.apply(sample.raw, sample.temperature_degc, usable);
  const LeastSquares plain = least_squares(setup_->array, setup_->array.all());
  const auto number_of = [](auto value) { return static_cast<double>(value); };
  const double figures[kCommonFigures] = {
      sample.time_s,
      number_of(truth.station),
      truth.moving ? 1.0 : 0.0,
      number_of(v.state),
      number_of(v.validity),
      number_of(v.cause),
      number_of(v.qualifiers),
      number_of(v.decided_by),
      v.statistic,
      v.limit,
      bits_of(v.in_service),
      bits_of(v.provisionally_excluded),
      bits_of(v.excluded),
      bits_of(v.absent),
      bits_of(v.suspects),
      bits_of(truth.faulty),
      changed ? number_of(event.event) : -1.0,
      changed ? number_of(event.from) : -1.0,
      changed ? number_of(event.to) : -1.0,
      changed ? number_of(event.cause) : -1.0,
      changed ? bits_of(event.sensors) : 0.0,
      is_current(v, truth) ? angle_between_rad(v.gravity_mps2, down) : kNothing,
      truth.moving || usable != setup_->array.all() ? kNothing : angle_between_rad(plain.estimate(y), down),
      v.protection_available ? v.protection_level_calibrated_axes_rad : kNothing,
      v.gravity_mps2[0],
      v.gravity_mps2[1],
      v.gravity_mps2[2],
      down[0],
      down[1],
      down[2],
      number_of(v.consistent_hypotheses),
      number_of(v.stations_on_record),
      v.parity,
      v.parity_limit,
      v.mae_worst_mps2,
      v.mae_worst_limit_mps2,
      v.norm_error_mps2,
      v.wants_rotation ? 1.0 : 0.0,
      number_of(v.confirmed_grade),
      number_of(v.provisional_grade),
      v.tick ? 1.0 : 0.0,
      v.alert ? 1.0 : 0.0,
  };
  records_.insert(records_.end(), figures, figures + kCommonFigures);
  for (const std::uint8_t faults : v.minimum_faults) records_.push_back(static_cast<double>(faults));
}

}  // namespace plumb_web

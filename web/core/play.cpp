// The second view of the page: a tool in a scenario, the monitor that watches it, and what is really the case.
#include <cmath>

#include "explorer.hpp"
#include "flight_run.hpp"
#include "plumb/array/geometry.hpp"
#include "plumb/calibration/calibration.hpp"
#include "plumb/core/detail/archive.hpp"
#include "plumb/io/hash.hpp"
#include "plumb/io/json_fields.hpp"
#include "plumb/scenario/library.hpp"
#include "rivals.hpp"
#include "scene.hpp"

namespace plumb_web {

using namespace plumb;

namespace {

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

io::Json list_of(const std::vector<std::string>& words) {
  io::Json out = io::Json::array();
  for (const std::string& one : words) out.push_back(one);
  return out;
}

io::Json units_json(const std::vector<SensorSet>& units) {
  io::Json out = io::Json::array();
  for (const SensorSet unit : units) out.push_back(unit.bits);
  return out;
}

}  // namespace

/// One run from station to station, or of a roll test.
class StationRun {
 public:
  StationRun(scenario::Simulator simulator, std::unique_ptr<MonitorSetup> setup,
             std::vector<scenario::HostRequest> requests, const Datasheet& datasheet,
             const std::vector<Station>& stations)
      : simulator_(std::move(simulator)),
        setup_(std::move(setup)),
        host_(std::move(requests)),
        turn_(turn_of(simulator_.scenario().tool)),
        all_(least_squares(setup_->array, setup_->array.all())),
        paper_(datasheet, *setup_, stations),
        px4_(setup_->array, simulator_.scenario().rate_hz) {}

  Expected<void> configure() { return monitor_->configure(*setup_); }
  const scenario::Simulator& simulator() const { return simulator_; }
  const PaperBeside& paper() const { return paper_; }
  const Px4Beside& px4() const { return px4_; }
  std::uint64_t digest() const { return digest_; }

  bool next(Record& record) {
    Sample sample;
    if (!simulator_.next(sample)) return false;
    host_.before(sample.time_s, *monitor_);
    monitor_->step(sample);
    const SensorSet usable = sample.delivered & setup_->array.all();
    const Readings y = setup_->model.apply(sample.raw, sample.temperature_degc, usable);
    paper_.step(sample);
    px4_.step(y, usable);
    hash();
    tell(sample, record);
    tell_direction(y, usable, record);
    tell_rivals(record);
    return true;
  }

 private:
  void hash() {
    Digest digest(digest_, monitor_->array().size());
    transfer(digest, monitor_->verdict(), AnyBits{});
    for (const SensorSet blamed : {px4_.selector(), px4_.voter()}) digest.scalar(blamed.bits, AnyBits{});
    digest_ = digest.sum();
  }
  void tell(const Sample& sample, Record& record) const;
  void tell_direction(const Readings& y, SensorSet usable, Record& record) const;
  void tell_rivals(Record& record) const;
  Vec3 down() const { return times(turn_, simulator_.truth().gravity_mps2); }

  scenario::Simulator simulator_;
  std::unique_ptr<MonitorSetup> setup_;
  std::unique_ptr<HealthMonitor> monitor_ = std::make_unique<HealthMonitor>();
  scenario::Host host_;
  Mat3 turn_;  ///< from the frame of the housing into that of the nominal axes
  LeastSquares all_;
  PaperBeside paper_;
  Px4Beside px4_;
  std::uint64_t digest_ = io::kFnvStart;
};

void StationRun::tell(const Sample& sample, Record& record) const {
  const Verdict& v = monitor_->verdict();
  const TransitionRecord& event = v.transition;
  const bool changed = event.sequence != 0;
  record.set(At::time_s, sample.time_s);
  record.set(At::station, simulator_.truth().station);
  record.set(At::moving, simulator_.truth().moving);
  record.set(At::faulty, simulator_.truth().faulty);
  record.set(At::state, v.state);
  record.set(At::validity, v.validity);
  record.set(At::cause, v.cause);
  record.set(At::qualifiers, v.qualifiers);
  record.set(At::decided_by, v.decided_by);
  record.set(At::statistic, v.statistic);
  record.set(At::limit, v.limit);
  record.set(At::in_service, v.in_service);
  record.set(At::provisionally_excluded, v.provisionally_excluded);
  record.set(At::excluded, v.excluded);
  record.set(At::absent, v.absent);
  record.set(At::suspects, v.suspects);
  record.set(At::event, changed ? static_cast<int>(event.event) : -1);
  record.set(At::from, changed ? static_cast<int>(event.from) : -1);
  record.set(At::to, changed ? static_cast<int>(event.to) : -1);
  record.set(At::event_cause, changed ? static_cast<int>(event.cause) : -1);
  record.set(At::event_sensors, changed ? event.sensors : SensorSet());
  record.set(At::hypotheses, v.consistent_hypotheses);
  record.set(At::on_record, v.stations_on_record);
  record.set(At::parity, v.parity);
  record.set(At::parity_limit, v.parity_limit);
  record.set(At::mae_mps2, v.mae_worst_mps2);
  record.set(At::mae_limit_mps2, v.mae_worst_limit_mps2);
  record.set(At::norm_error, v.norm_error_mps2);
  record.set(At::wants_turn, v.wants_rotation);
  record.set(At::confirmed_grade, v.confirmed_grade);
  record.set(At::provisional_grade, v.provisional_grade);
  record.set(At::tick, v.tick);
  record.set(At::alert, v.alert);
  for (std::size_t i = 0; i < v.minimum_faults.size(); ++i) record.minimum_faults(i, v.minimum_faults[i]);
}

void StationRun::tell_direction(const Readings& y, SensorSet usable, Record& record) const {
  const Verdict& v = monitor_->verdict();
  const scenario::Truth& truth = simulator_.truth();
  record.set(At::told_x, v.gravity_mps2);
  record.set(At::true_x, down());
  if (is_current(v, truth)) record.set(At::error_rad, angle_between_rad(v.gravity_mps2, down()));
  if (v.protection_available) record.set(At::protection_rad, v.protection_level_calibrated_axes_rad);
  if (!truth.moving && usable == setup_->array.all())
    record.set(At::plain_rad, angle_between_rad(all_.estimate(y), down()));
}

void StationRun::tell_rivals(Record& record) const {
  const scenario::Truth& truth = simulator_.truth();
  if (paper_.absent().empty()) {
    const Verdict& v = paper_.verdict();
    record.set(At::paper_state, v.state);
    record.set(At::paper_validity, v.validity);
    record.set(At::paper_out, v.excluded | v.provisionally_excluded);
    record.set(At::paper_suspects, v.suspects);
    record.set(At::paper_statistic, v.mae_all_mps2);
    if (is_current(v, truth)) record.set(At::paper_error_rad, angle_between_rad(paper_.down(), down()));
  }
  if (px4_.units().empty()) return;
  record.set(At::px4_selector, px4_.selector());
  record.set(At::px4_voter, px4_.voter());
  record.set(At::px4_in_use, px4_.in_use());
  if (!truth.moving) record.set(At::px4_error_rad, angle_between_rad(px4_.vector(), down()));
}

Play::Play() = default;
Play::~Play() = default;

const scenario::Simulator* Play::world() const noexcept { return stations_ ? &stations_->simulator() : nullptr; }

std::string Play::begin(const std::string& scene_text) {
  stations_.reset();
  flight_.reset();
  records_.clear();
  const json scene = json::parse(scene_text, nullptr, false);
  AxisList axes{};
  const int n = scene.is_object() ? read_axes(scene, axes) : 0;
  if (n == 0) return refusal(axes_wanted());
  const std::string motion = motion_of(scene);
  return motion == "stations" || motion == "roll" ? begin_stations(scene, axes, n) : begin_flight(scene, axes, n);
}

std::string Play::begin_stations(const json& scene, const AxisList& axes, int n) {
  const GravityReference gravity;
  const Datasheet datasheet =
      datasheet_of(axes, read_chips(scene), n, number(scene, "noise_mps2", scenario::kPaperNoise_mps2), paper_make());
  const Expected<SensorArray> nominal = datasheet.array();
  if (!nominal) return refused(nominal.error());
  const scenario::Tool tool = scenario::draw_tool(datasheet, seed_of(scene, "truth_seed", 1.0));
  stand_seed_ = seed_of(scene, "stand_seed", 1.0);
  requests_ = texts(scene, "requests");
  const std::vector<Station> stations = stations_of(tool, *nominal, gravity, stand_seed_);
  const auto fit = calibrate(datasheet, gravity, stations.data(), static_cast<int>(stations.size()));
  if (!fit) return refused(fit.error());
  scenario::Scenario world = world_of(scene, tool);
  tl::expected<SceneFaults, std::string> faults = faults_of(scene, datasheet);
  if (!faults) return refusal(faults.error());
  world.faults = faults->faults;
  tl::expected<std::vector<scenario::HostRequest>, std::string> requests = requests_of(scene, *nominal);
  if (!requests) return refusal(requests.error());
  auto simulator = scenario::Simulator::make(std::move(world));
  if (!simulator) return refusal(simulator.error());
  auto run = std::make_unique<StationRun>(*std::move(simulator), setup_of(datasheet, *fit, gravity),
                                          *std::move(requests), datasheet, stations);
  const Expected<void> configured = run->configure();
  if (!configured) return refused(configured.error());
  stations_ = std::move(run);
  const scenario::Simulator& plays = stations_->simulator();
  io::Json out = io::object({{"samples", static_cast<double>(plays.size())},
                             {"duration_s", plays.duration_s()},
                             {"stations", static_cast<double>(plays.directions().size())},
                             {"paper_absent", stations_->paper().absent()}});
  out["faults"] = list_of(faults->words);
  out["px4_units"] = units_json(stations_->px4().units());
  return out.dump();
}

std::string Play::begin_flight(const json& scene, const AxisList& axes, int n) {
  tl::expected<std::unique_ptr<FlightRun>, std::string> flight = FlightRun::make(scene, axes, read_chips(scene), n);
  if (!flight) return refusal(flight.error());
  flight_ = *std::move(flight);
  io::Json out = io::object({{"samples", static_cast<double>(flight_->samples())},
                             {"duration_s", flight_->duration_s()},
                             {"stations", 0.0},
                             {"paper_absent", "it judges at rest only"}});
  out["faults"] = list_of(flight_->faults());
  out["px4_units"] = units_json(flight_->px4().units());
  return out.dump();
}

int Play::run(int samples) {
  for (int done = 0; done < samples; ++done) {
    Record record;
    const bool stepped = stations_ ? stations_->next(record) : flight_ && flight_->next(record);
    if (!stepped) return done;
    record.append_to(records_);
  }
  return samples;
}

std::uint64_t Play::digest() const noexcept {
  return stations_ ? stations_->digest() : flight_ ? flight_->digest() : io::kFnvStart;
}

}  // namespace plumb_web

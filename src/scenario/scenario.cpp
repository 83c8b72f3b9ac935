#include "plumb/scenario/scenario.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "plumb/scenario/count_text.hpp"
#include "plumb/scenario/portable_math.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace scenario {
namespace {

constexpr double kMaxRows = 1e12;

tl::unexpected<std::string> refuse(std::string why) { return tl::unexpected<std::string>(std::move(why)); }

/// Also false for NaN.
bool within(double value, double low, double high) noexcept { return value >= low && value <= high; }

std::uint64_t rows_of(double time_s, double rate_hz) noexcept {
  return static_cast<std::uint64_t>(std::floor(time_s * rate_hz + 0.5));
}

/// Empty where all is well.
std::string surroundings_wrong(const Scenario& s) {
  const InstabilityLaw& wander = s.noise.instability;
  if (!within(s.rest_vibration_mps2, 0.0, 1e6)) {
    return "the vibration at rest is not usable. Remedy: give its rms in m/s^2";
  }
  if (!within(wander.sigma_mps2, 0.0, 1e6) || !within(wander.walk_mps2, 0.0, 1e6)) {
    return "the bias instability is negative or not finite. Remedy: give 1 sigma in m/s^2, 0 for none";
  }
  if (!within(wander.correlation_s, 1e-9, 1e12)) {
    return "the correlation time is not above zero. Remedy: give it in seconds, as in 100";
  }
  const Turning& turning = s.turning;
  if (!within(turning.rate_radps, -1e5, 1e5) || !std::isfinite(turning.from_s) ||
      !(turning.until_s >= turning.from_s)) {
    return "the rotation is not usable. Remedy: give a rate in rad/s and an end that is not before its begin";
  }
  if (!within(norm(turning.axis), 1.0 - 1e-6, 1.0 + 1e-6)) {
    return "the axis of rotation is not of unit length. Remedy: divide it by its length";
  }
  const Interference& beside = s.interference;
  if (!within(norm(beside.field_mps2), 0.0, 1e6) || !std::isfinite(beside.from_s) ||
      !(beside.until_s >= beside.from_s)) {
    return "the interference is not usable. Remedy: give a finite field and an end that is not before its begin";
  }
  if (!within(s.dip_rad, -0.5 * kPi, 0.5 * kPi)) {
    return "the dip is not usable. Remedy: give the angle of the field below the horizon, -90 to 90 deg";
  }
  if (!within(s.depth.station_spacing_m, -1e6, 1e6) || !within(s.depth.gravity_per_s2, -1.0, 1.0) ||
      !within(s.depth.heat_degc_per_m, -1e3, 1e3)) {
    return "the depth is not usable. Remedy: give the stand in m, gravity in m/s^2 and heat in degC per m";
  }
  return {};
}

std::string numbers_wrong(const Scenario& s) {
  if (!within(s.rate_hz, 1e-6, 1e9)) return "the sample rate is not usable. Remedy: give it in Hz, as in 100";
  if (!within(s.dwell_s, 0.0, 1e9) || !within(s.move_s, 0.0, 1e9)) {
    return "dwell or motion time is negative or not finite. Remedy: give both in seconds";
  }
  if (s.dwell_s * s.rate_hz < 0.5)
    return "the dwell time is shorter than one sample. Remedy: raise the dwell time or the sample rate";
  if ((s.dwell_s + s.move_s) * s.rate_hz > kMaxRows) return "too many samples. Remedy: lower the times or the rate";
  if (!within(s.gravity_mps2, 0.0, 1e3)) return "gravity is not usable. Remedy: give it in m/s^2, as in 9.81";
  if (!within(s.vibration_mps2, 0.0, 1e6)) return "the vibration is not usable. Remedy: give its rms in m/s^2";
  if (!within(s.noise.white, 0.0, 1e6)) return "the noise factor is negative or not finite. Remedy: give 1 or 0";
  if (!within(s.start_s, -1e12, 1e12)) return "the start time is not usable. Remedy: give it in seconds";
  if (!within(s.temperature.start_degc, -273.15, 1e4) || !within(s.temperature.rate_degc_per_s, -1e3, 1e3)) {
    return "the temperature is not usable. Remedy: give degC and degC per second";
  }
  return surroundings_wrong(s);
}

std::string tool_wrong(const Tool& tool) {
  if (tool.datasheet.size < 3 || tool.datasheet.size > kCapacity || tool.model.size != tool.datasheet.size) {
    return "the tool has " + count_text(tool.datasheet.size, "sensor") + ". Remedy: give it 3 to " +
           std::to_string(kCapacity) + ", the same number in datasheet and model";
  }
  for (int i = 0; i < tool.datasheet.size; ++i) {
    const Vec3& arm = tool.lever_arm_m[static_cast<std::size_t>(i)];
    if (within(arm[0], -1e3, 1e3) && within(arm[1], -1e3, 1e3) && within(arm[2], -1e3, 1e3)) continue;
    return "a lever arm is not usable. Remedy: give it in m, in the tool frame";
  }
  if (!tool.model.raw_from(Readings{}, tool.datasheet.sensor[0].coefficients.reference_degc)) {
    return "the cross-axis matrix of the tool cannot be inverted. Remedy: keep its entries well below 1";
  }
  return {};
}

/// Stations of like inclination (of z against down) get a number in the order of their first, others 0.
std::vector<std::uint32_t> roll_groups_of(const std::vector<Vec3>& directions) {
  constexpr double kSame = 1e-9;
  std::vector<std::size_t> order(directions.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&directions](std::size_t a, std::size_t b) { return directions[a][2] < directions[b][2]; });
  // First the lowest station of each run of alike ones, then numbers in the order of those.
  std::vector<std::size_t> first(directions.size(), directions.size());
  for (std::size_t k = 0; k < order.size();) {
    std::size_t end = k + 1;
    while (end < order.size() && directions[order[end]][2] - directions[order[k]][2] <= kSame) ++end;
    const std::size_t least = *std::min_element(order.begin() + static_cast<std::ptrdiff_t>(k),
                                                order.begin() + static_cast<std::ptrdiff_t>(end));
    if (end - k > 1) {
      for (std::size_t m = k; m < end; ++m) first[order[m]] = least;
    }
    k = end;
  }
  std::vector<std::uint32_t> group(directions.size(), 0U);
  std::uint32_t groups = 0;
  for (std::size_t k = 0; k < first.size(); ++k) {
    if (first[k] == k) group[k] = ++groups;
    if (first[k] < k) group[k] = group[first[k]];
  }
  return group;
}

std::uint64_t noise_seed(const Scenario& s) noexcept { return s.part == 0 ? s.seed : derive_seed(s.seed, s.part); }

}  // namespace

tl::expected<Simulator, std::string> Simulator::make(Scenario scenario) {
  std::string wrong = numbers_wrong(scenario);
  if (wrong.empty()) wrong = tool_wrong(scenario.tool);
  if (!wrong.empty()) return refuse(std::move(wrong));
  auto directions = directions_of(scenario.attitudes, scenario.seed);
  if (!directions) return refuse(directions.error());
  // Faults of direction mean the true axes.
  Datasheet real = scenario.tool.datasheet;
  for (std::size_t i = 0; i < static_cast<std::size_t>(real.size); ++i) real.sensor[i].row.axis = scenario.tool.axes[i];
  auto injector = Injector::make(real, scenario.tool.model, scenario.faults, noise_seed(scenario), scenario.noise);
  if (!injector) return refuse(injector.error());
  return Simulator(std::move(scenario), std::move(*directions), std::move(*injector));
}

Simulator::Simulator(Scenario scenario, std::vector<Vec3> directions, Injector injector)
    : scenario_(std::move(scenario)),
      directions_(std::move(directions)),
      vibration_(scenario_.seed, Purpose::vibration),
      injector_(std::move(injector)),
      delivery_(scenario_.faults, scenario_.seed),
      dwell_rows_(std::max<std::uint64_t>(1, rows_of(scenario_.dwell_s, scenario_.rate_hz))),
      move_rows_(rows_of(scenario_.move_s, scenario_.rate_hz)) {
  if (scenario_.tag_stations && scenario_.tag_rolls) roll_group_ = roll_groups_of(directions_);
  for (std::size_t k = 0; k + 1 < directions_.size(); ++k) passages_.emplace_back(directions_[k], directions_[k + 1]);
  if (scenario_.sensed != Sensed::gravity) headings_ = Headings(scenario_.attitudes, directions_, scenario_.seed);
  for (int i = 0; i < scenario_.tool.datasheet.size; ++i) {
    noise_.emplace_back(noise_seed(scenario_), Purpose::noise, static_cast<std::uint32_t>(i));
  }
  const std::uint64_t stations = directions_.size();
  if (scenario_.noise.instability.any()) {
    const std::uint64_t ticks = stations * (dwell_rows_ + move_rows_);
    for (int i = 0; i < scenario_.tool.datasheet.size; ++i) {
      instability_.emplace_back(scenario_.noise.instability, ticks, 1.0 / scenario_.rate_hz, noise_seed(scenario_), i);
    }
  }
  rows_ = stations * dwell_rows_ + (scenario_.record_motion ? (stations - 1) * move_rows_ : 0);
  remember_onsets();
}

double Simulator::duration_s() const noexcept { return place_of(rows_ - 1).moment.time_s - scenario_.start_s; }

bool Simulator::next(Sample& sample) {
  if (!delivery_.any()) {
    if (cursor_ >= rows_) return false;
    row_ = cursor_++;
    sample = at(row_, &truth_);
    return true;
  }
  Delivery::Parcel parcel;
  while (!delivery_.pop(parcel)) {
    if (cursor_ > rows_) return false;
    if (cursor_ == rows_) {
      delivery_.finish();
    } else {
      delivery_.push(at(cursor_), place_of(cursor_).moment);
    }
    ++cursor_;
  }
  row_ = parcel.row;
  at(row_, &truth_);
  sample = parcel.sample;
  return true;
}

void Simulator::rewind() {
  cursor_ = 0;
  delivery_ = Delivery(scenario_.faults, scenario_.seed);
}

class Simulator::Healthy final : public Injector::Past {
 public:
  explicit Healthy(const Simulator& simulator) noexcept : simulator_(&simulator) {}
  double raw(int sensor, std::uint64_t row) const noexcept override {
    const Place place = simulator_->place_of(row);
    return simulator_->healthy(place, simulator_->truth_at(place)).raw[static_cast<std::size_t>(sensor)];
  }

 private:
  const Simulator* simulator_;
};

Sample Simulator::at(std::uint64_t row, Truth* truth) const noexcept {
  const Place place = place_of(row);
  Truth real = truth_at(place);
  Sample sample = healthy(place, real);
  real.faulty = injector_.inject(sample, place.moment, Healthy(*this));
  if (truth != nullptr) *truth = real;
  return sample;
}

Simulator::Place Simulator::place_of(std::uint64_t row) const noexcept {
  // Without recorded motion the rows skip it, but time does not.
  const std::uint64_t period = dwell_rows_ + move_rows_;
  const std::uint64_t stride = scenario_.record_motion ? period : dwell_rows_;
  const std::uint64_t station = row / stride;
  const std::uint64_t within_station = row % stride;
  Place place;
  place.moment.row = row;
  place.moment.station = station + 1;
  place.tick = station * period + within_station;
  place.moment.time_s = scenario_.start_s + static_cast<double>(place.tick) / scenario_.rate_hz;
  place.moving = within_station >= dwell_rows_;
  if (place.moving) {
    const std::uint64_t step = within_station - dwell_rows_ + 1;
    place.part = static_cast<double>(step) / static_cast<double>(move_rows_ + 1);
  }
  return place;
}

Truth Simulator::truth_at(const Place& place) const noexcept {
  const auto station = static_cast<std::size_t>(place.moment.station - 1);
  Vec3 down = place.moving ? passages_[station].at(place.part) : directions_[station];
  Truth truth;
  const Turning& turning = scenario_.turning;
  if (turning.rate_radps != 0.0) {
    down = seen_from_turned(down, turning.axis, turning.angle_rad(place.moment.time_s));
    if (turning.at_work(place.moment.time_s)) truth.rate_radps = scaled(turning.axis, turning.rate_radps);
  }
  truth.depth_m = scenario_.depth.station_spacing_m * (static_cast<double>(station) + place.part);
  truth.gravity_mps2 = scaled(down, scenario_.gravity_mps2 + scenario_.depth.gravity_per_s2 * truth.depth_m);
  truth.station = static_cast<std::uint32_t>(place.moment.station);
  truth.moving = place.moving;
  if (scenario_.sensed == Sensed::magnetic) feel_field(place, down, truth);
  if (scenario_.sensed == Sensed::rate) feel_rate(place, truth);
  const double rms_mps2 = place.moving ? scenario_.vibration_mps2 : scenario_.rest_vibration_mps2;
  if (rms_mps2 > 0.0) truth.body_acceleration_mps2 = vibration(vibration_, place.moment.row, rms_mps2);
  return truth;
}

void Simulator::feel_field(const Place& place, const Vec3& down, Truth& truth) const noexcept {
  const Scenario& s = scenario_;
  Vec3 north = headings_.north(static_cast<std::size_t>(place.moment.station - 1), place.part);
  if (s.turning.rate_radps != 0.0)
    north = seen_from_turned(north, s.turning.axis, s.turning.angle_rad(place.moment.time_s));
  const SinCos dip = portable_sincos(s.dip_rad);
  const double length = norm(truth.gravity_mps2);
  truth.gravity_mps2 = plus(scaled(north, length * dip.cos), scaled(down, length * dip.sin));
  const Interference& beside = s.interference;
  if (!(place.moment.time_s >= beside.from_s && place.moment.time_s < beside.until_s)) return;
  const Vec3& b = beside.field_mps2;
  const Vec3 seen =
      beside.of_tool ? b : plus(plus(scaled(north, b[0]), scaled(cross(down, north), b[1])), scaled(down, b[2]));
  truth.gravity_mps2 = plus(truth.gravity_mps2, seen);
}

void Simulator::feel_rate(const Place& place, Truth& truth) const noexcept {
  const Turning& turning = scenario_.turning;
  const double move_s = static_cast<double>(move_rows_ + 1) / scenario_.rate_hz;
  Vec3 rate = headings_.rate_radps(static_cast<std::size_t>(place.moment.station - 1), place.part, move_s);
  if (turning.rate_radps != 0.0) rate = seen_from_turned(rate, turning.axis, turning.angle_rad(place.moment.time_s));
  truth.rate_radps = plus(rate, truth.rate_radps);
  truth.gravity_mps2 = {};
}

Sample Simulator::healthy(const Place& place, const Truth& truth) const noexcept {
  const Tool& tool = scenario_.tool;
  // An accelerometer cannot tell gravity from the body accelerating the other way.
  const bool rate = scenario_.sensed == Sensed::rate;
  const Vec3 felt = rate ? truth.rate_radps : minus(truth.gravity_mps2, truth.body_acceleration_mps2);
  const bool turns = scenario_.sensed == Sensed::gravity && dot(truth.rate_radps, truth.rate_radps) > 0.0;
  Readings accel_mps2{};
  for (int i = 0; i < tool.datasheet.size; ++i) {
    const auto s = static_cast<std::size_t>(i);
    accel_mps2[s] = dot(tool.axes[s], felt);
    if (turns) {
      const Vec3 inward = cross(truth.rate_radps, cross(truth.rate_radps, tool.lever_arm_m[s]));
      accel_mps2[s] -= dot(tool.axes[s], inward);
    }
    if (!instability_.empty()) accel_mps2[s] += instability_[s].at(place.tick);
    const double sigma_mps2 = scenario_.noise.white * tool.datasheet.sensor[s].row.sigma_mps2;
    if (sigma_mps2 > 0.0) accel_mps2[s] += sigma_mps2 * noise_[s].normal(place.moment.row);
  }
  Sample sample;
  sample.time_s = place.moment.time_s;
  sample.temperature_degc = scenario_.temperature.at(place.moment.time_s - scenario_.start_s) +
                            scenario_.depth.heat_degc_per_m * truth.depth_m;
  sample.delivered = SensorSet::first(tool.datasheet.size);
  sample.station = scenario_.tag_stations && !place.moving ? truth.station : 0;
  if (!roll_group_.empty() && !place.moving)
    sample.roll_group = roll_group_[static_cast<std::size_t>(place.moment.station - 1)];
  const auto raw = tool.model.raw_from(accel_mps2, sample.temperature_degc);
  if (!raw) return sample;  // refused by `make`: the cross-axis matrix does not depend on temperature
  for (int i = 0; i < tool.datasheet.size; ++i) {
    const auto s = static_cast<std::size_t>(i);
    sample.raw[s] = digitised((*raw)[s], tool.datasheet.sensor[s], scenario_.noise);
  }
  return sample;
}

/// Gives every fault its memory beforehand, so that `at` may jump. A fault that is stuck at its last
/// value needs the row before its onset, faults that began earlier included: hence in order of onset.
void Simulator::remember_onsets() noexcept {
  struct Onset {
    std::uint64_t row;
    int fault;
  };
  const std::vector<Fault>& faults = injector_.faults();
  std::vector<Onset> onsets;
  for (std::size_t k = 0; k < faults.size(); ++k) {
    std::uint64_t low = 0;  // the first row at or after onset: rows are ordered on every clock
    std::uint64_t high = rows_;
    while (low < high) {
      const std::uint64_t middle = low + (high - low) / 2;
      if (has_begun(faults[k], place_of(middle).moment)) {
        high = middle;
      } else {
        low = middle + 1;
      }
    }
    if (low < rows_) onsets.push_back({low, static_cast<int>(k)});
  }
  std::stable_sort(onsets.begin(), onsets.end(), [](const Onset& a, const Onset& b) { return a.row < b.row; });
  for (const Onset& onset : onsets) {
    const Fault& fault = faults[static_cast<std::size_t>(onset.fault)];
    const Place place = place_of(onset.row);
    FaultMemory memory;
    memory.begun = true;
    memory.begun_s = fault.clock == Clock::time && onset.row > 0 ? fault.onset : place.moment.time_s;
    memory.has_last = fault.sensor != kWholeLog;
    if (!memory.has_last) {
      injector_.remember(onset.fault, memory);
      continue;
    }
    const Sample last = onset.row > 0 ? at(onset.row - 1) : healthy(place, truth_at(place));
    memory.last_raw = last.raw[static_cast<std::size_t>(fault.sensor)];
    injector_.remember(onset.fault, memory);
  }
}

}  // namespace scenario
}  // namespace PLUMB_ABI
}  // namespace plumb

#include "flight_gyros.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "plumb/scenario/random.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace session {
namespace {

using scenario::Purpose;
using scenario::Stream;

/// Sub-streams of a flight, behind all that its own sensors and gyros have: a block of them for each group.
constexpr std::uint32_t kFirstGroup = 0x400000, kPerGroup = 0x1000, kGroupNoise = 0x800;

/// A vector at right angles to a unit vector, and of unit length.
Vec3 across_of(const Vec3& u) {
  const Vec3 other = std::fabs(u[0]) < 0.6 ? Vec3{1.0, 0.0, 0.0} : Vec3{0.0, 1.0, 0.0};
  const Vec3 out = cross(u, other);
  return scaled(out, 1.0 / norm(out));
}

}  // namespace

io::FileExpected<FlightGyros> FlightGyros::make(const io::ArrayFile& group, const std::vector<scenario::Fault>& faults,
                                                std::uint64_t seed, std::uint32_t number) {
  if (group.field != io::FieldKind::rate)
    return tl::unexpected<io::FileError>(io::FileError{
        group.path, 0, "group", "\"" + group.group + "\" senses a magnetic field, and a flight has none",
        "fly an array file without this group, or write a scenario with array = \"...\"", io::ExitCode::invalid_input});
  tl::expected<scenario::Injector, std::string> injector = scenario::Injector::make(
      group.datasheet, group.datasheet.model(), faults, scenario::derive_seed(seed, number + 1));
  if (!injector)
    return tl::unexpected<io::FileError>(io::FileError{"--fault", 0, "", injector.error(), "", io::ExitCode::usage});
  FlightGyros out(group, *std::move(injector));
  out.seed_ = seed;
  out.sub_ = kFirstGroup + number * kPerGroup;
  for (int i = 0; i < group.array.size(); ++i) out.axis_.push_back(out.drawn(i));
  return out;
}

FlightGyros::Axis FlightGyros::drawn(int sensor) const {
  const Stream draw(seed_, Purpose::flight, sub_ + static_cast<std::uint32_t>(sensor));
  const RateErrors& e = group_->rate.errors[static_cast<std::size_t>(sensor)];
  const Vec3& nominal = group_->array.axis(sensor);
  const Vec3 one = across_of(nominal), other = cross(nominal, one);
  const double turn_rad = draw.uniform(0, 0.0, e.axis_rad), about = draw.uniform(1, 0.0, 2.0 * kPi);
  const Vec3 aside = plus(scaled(one, std::cos(about)), scaled(other, std::sin(about)));
  Axis out;
  out.axis = plus(scaled(nominal, std::cos(turn_rad)), scaled(aside, std::sin(turn_rad)));
  out.scale = 1.0 + draw.uniform(2, -e.scale, e.scale);
  out.bias_radps = draw.uniform(3, -e.bias_radps, e.bias_radps);
  out.lag_s = draw.uniform(4, -e.lag_s, e.lag_s);
  out.per_force_s_per_m = scaled(draw.direction(5), draw.uniform(6, 0.0, e.g_sensitivity_s_per_m));
  out.noise_radps = group_->array.sigma_mps2(sensor);
  return out;
}

double FlightGyros::raw_of(int sensor, double rate_radps) const {
  const double temperature_degc = group_->input.default_temperature_degc;
  const DatasheetSensor& sheet = group_->datasheet.sensor[static_cast<std::size_t>(sensor)];
  double raw = model_.scale_at(sensor, temperature_degc) * (rate_radps + model_.bias_at(sensor, temperature_degc));
  if (sheet.full_scale_raw > 0.0) raw = std::clamp(raw, -sheet.full_scale_raw, sheet.full_scale_raw);
  return sheet.resolution_raw > 0.0 ? sheet.resolution_raw * std::nearbyint(raw / sheet.resolution_raw) : raw;
}

Sample FlightGyros::next(const scenario::FlightSample& flown, SensorSet& faulty) {
  const double step_s = flown.time_s - last_s_;
  const Vec3 slope =
      row_ > 0 && step_s > 0.0 ? scaled(minus(flown.true_rate_radps, last_radps_), 1.0 / step_s) : Vec3{};
  Sample out;
  out.time_s = flown.time_s;
  out.delivered = group_->array.all();
  out.temperature_degc = group_->input.default_temperature_degc;
  for (std::size_t k = 0; k < axis_.size(); ++k) {
    const Axis& one = axis_[k];
    const int sensor = static_cast<int>(k);
    const Stream noise(seed_, Purpose::flight, sub_ + kGroupNoise + static_cast<std::uint32_t>(k));
    const Vec3 rate_radps = minus(flown.true_rate_radps, scaled(slope, one.lag_s));
    out.raw[k] = raw_of(sensor, one.scale * dot(one.axis, rate_radps) + one.bias_radps +
                                    dot(one.per_force_s_per_m, flown.specific_force_mps2) +
                                    one.noise_radps * noise.normal(row_));
  }
  last_radps_ = flown.true_rate_radps;
  last_s_ = flown.time_s;
  ++row_;
  faulty = injector_.apply(out);
  return out;
}

}  // namespace session
}  // namespace PLUMB_ABI
}  // namespace plumb

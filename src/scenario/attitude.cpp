#include "plumb/scenario/attitude.hpp"
#include "plumb/scenario/count_text.hpp"

#include <algorithm>
#include <cmath>

#include "plumb/scenario/portable_math.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace scenario {
namespace {

using Directions = tl::expected<std::vector<Vec3>, std::string>;

constexpr double kUnitTolerance = 1e-6;
constexpr int kMaxStations = 1000000;
/// Beyond this the reduction of portable_sincos loses digits.
constexpr double kMaxAngle_rad = 1e6;

tl::unexpected<std::string> refuse(const std::string& why) { return tl::unexpected<std::string>(why); }

bool angle_ok(double angle_rad) noexcept { return std::abs(angle_rad) <= kMaxAngle_rad; }  // false for NaN

bool is_unit(const Vec3& v) noexcept { return std::abs(norm(v) - 1.0) <= kUnitTolerance; }

bool count_ok(int stations) noexcept { return stations >= 1 && stations <= kMaxStations; }

tl::unexpected<std::string> refuse_count(int stations) {
  return refuse("an attitude law with " + count_text(stations, "station") + ". Remedy: give 1 to " +
                std::to_string(kMaxStations) + " stations");
}

tl::unexpected<std::string> refuse_angle() {
  return refuse("an angle of the attitude law is not a finite number of ordinary size. Remedy: give it in rad");
}

struct Lay {
  std::uint64_t seed;

  Directions operator()(const FixedAttitude& law) const { return (*this)(DirectionList{{law.direction}}); }

  Directions operator()(const DirectionList& law) const {
    if (law.directions.empty()) return refuse_count(0);
    for (std::size_t k = 0; k < law.directions.size(); ++k) {
      if (!is_unit(law.directions[k])) {
        return refuse("gravity direction " + std::to_string(k + 1) + " has length " +
                      std::to_string(norm(law.directions[k])) + ". Remedy: divide it by its length");
      }
    }
    return law.directions;
  }

  Directions operator()(const RandomStations& law) const {
    if (!count_ok(law.stations)) return refuse_count(law.stations);
    const Stream stream(seed, Purpose::attitude);
    std::vector<Vec3> directions;
    for (int k = 0; k < law.stations; ++k) directions.push_back(stream.direction(static_cast<std::uint64_t>(k)));
    return directions;
  }

  Directions operator()(const RollTest& law) const {
    if (!count_ok(law.stations)) return refuse_count(law.stations);
    if (!angle_ok(law.inclination_rad) || !angle_ok(law.first_toolface_rad)) return refuse_angle();
    std::vector<Vec3> directions;
    for (int k = 0; k < law.stations; ++k) {
      const double toolface_rad = law.first_toolface_rad + 2.0 * kPi * k / law.stations;
      directions.push_back(gravity_direction({law.inclination_rad, 0.0, toolface_rad}));
    }
    return directions;
  }

  Directions operator()(const DrillingPath& law) const {
    if (!count_ok(law.stations)) return refuse_count(law.stations);
    const double reach = law.stations;
    if (!angle_ok(law.first.inclination_rad) || !angle_ok(law.first.toolface_rad) || !angle_ok(law.build_rad * reach) ||
        !angle_ok(law.toolface_step_rad * reach) || !angle_ok(law.toolface_jitter_rad)) {
      return refuse_angle();
    }
    const Stream stream(seed, Purpose::attitude);
    std::vector<Vec3> directions;
    for (int k = 0; k < law.stations; ++k) directions.push_back(gravity_direction(attitude_at(law, k, stream)));
    return directions;
  }
};

}  // namespace

Vec3 gravity_direction(const Attitude& attitude) noexcept {
  const SinCos inclination = portable_sincos(attitude.inclination_rad);
  const SinCos toolface = portable_sincos(attitude.toolface_rad);
  return {-inclination.sin * toolface.sin, -inclination.sin * toolface.cos, inclination.cos};
}

Attitude attitude_at(const DrillingPath& path, int station, const Stream& stream) noexcept {
  const double jitter_rad =
      stream.uniform(static_cast<std::uint64_t>(station), -path.toolface_jitter_rad, path.toolface_jitter_rad);
  return {path.first.inclination_rad + path.build_rad * station, path.first.azimuth_rad + path.turn_rad * station,
          path.first.toolface_rad + path.toolface_step_rad * station + jitter_rad};
}

Directions directions_of(const AttitudeLaw& law, std::uint64_t seed) { return std::visit(Lay{seed}, law); }

double Turning::angle_rad(double time_s) const noexcept {
  return rate_radps * (std::min(std::max(time_s, from_s), until_s) - from_s);
}

Vec3 seen_from_turned(const Vec3& vector, const Vec3& axis, double angle_rad) noexcept {
  // Whole turns first: sine and cosine are good to 1e6 rad only.
  const double turns = std::floor(angle_rad / (2.0 * kPi));
  const SinCos turn = portable_sincos(angle_rad - turns * (2.0 * kPi));
  const Vec3 along = scaled(axis, dot(axis, vector) * (1.0 - turn.cos));
  return plus(plus(scaled(vector, turn.cos), scaled(cross(vector, axis), turn.sin)), along);
}

Vec3 perpendicular_to(const Vec3& unit) noexcept {
  // Cross with the coordinate axis that lies furthest away: never near zero.
  const double x = std::abs(unit[0]);
  const double y = std::abs(unit[1]);
  const double z = std::abs(unit[2]);
  Vec3 helper = {1.0, 0.0, 0.0};
  if (y < x && y <= z) helper = {0.0, 1.0, 0.0};
  if (z < x && z < y) helper = {0.0, 0.0, 1.0};
  const Vec3 v = cross(unit, helper);
  return scaled(v, 1.0 / norm(v));
}

Passage::Passage(const Vec3& from, const Vec3& to) noexcept : from_(from), across_(perpendicular_to(from)) {
  const double cosine = dot(from, to);
  const Vec3 sideways = minus(to, scaled(from, cosine));
  const double sine = norm(sideways);
  if (sine > 1e-9) across_ = scaled(sideways, 1.0 / sine);
  angle_rad_ = portable_angle(cosine, sine);
}

Vec3 Passage::at(double part) const noexcept {
  const SinCos turn = portable_sincos(angle_rad_ * smooth(part));
  return plus(scaled(from_, turn.cos), scaled(across_, turn.sin));
}

}  // namespace scenario
}  // namespace PLUMB_ABI
}  // namespace plumb

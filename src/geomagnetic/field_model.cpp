#include "plumb/geomagnetic/field_model.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string_view>

#include "ellipsoid.hpp"
#include "legendre.hpp"
#include "plumb/core/units.hpp"
#include "plumb/io/date.hpp"
#include "plumb/io/printable.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace geomagnetic {
namespace {

constexpr double kReferenceRadius_m = 6371200.0;
constexpr double kNanotesla = 1e-9;
constexpr double kBlackout_tesla = 2000e-9;
constexpr double kCaution_tesla = 6000e-9;
constexpr double kGridFrom_deg = 55.0;

tl::unexpected<io::FileError> refuse(const char* field, std::string what, std::string remedy) {
  return tl::unexpected<io::FileError>(
      io::FileError{"", 0, field, std::move(what), std::move(remedy), io::ExitCode::invalid_input});
}

io::FileExpected<void> check(const FieldModel& model, const Place& place, double year) {
  const std::string name = io::printable_line(model.name);
  if (!std::isfinite(year) || year < model.first_year || year > model.last_year)
    return refuse("date",
                  fmt::format("{:.3f} is outside of {}, which holds from {:.1f} to {:.1f}", year, name,
                              model.first_year, model.last_year),
                  "give coefficients that hold at the date of the survey (a file in the form of WMM.COF), or state the "
                  "field as values with their uncertainties");
  if (!(std::fabs(place.latitude_deg) <= 90.0))
    return refuse("latitude", fmt::format("{} deg is no latitude", place.latitude_deg),
                  "give degrees from -90 to 90, north positive");
  if (!(place.longitude_deg >= -180.0 && place.longitude_deg <= 360.0))
    return refuse("longitude", fmt::format("{} deg is no longitude", place.longitude_deg),
                  "give degrees from -180 to 180 or from 0 to 360, east positive");
  if (!(place.height_m >= kLowest_m && place.height_m <= kHighest_m))
    return refuse("height", fmt::format("{} m is outside of {:.0f} to {:.0f} m", place.height_m, kLowest_m, kHighest_m),
                  "give metres above the WGS84 ellipsoid, below it negative");
  return {};
}

struct Coefficients {
  std::array<double, kCoefficientCount> g{}, h{};
};

/// Gradient of the potential in geocentric axes north, east, down [nT]: WMM report, equations (10) to (12).
Vec3 gradient_nt(const Coefficients& of, const LegendreTable& p, const Geocentric& at) noexcept {
  std::array<Direction, kMaxDegree + 1> turn{};
  for (int m = 0; m <= kMaxDegree; ++m)
    turn[static_cast<std::size_t>(m)] = {std::sin(m * at.longitude_rad), std::cos(m * at.longitude_rad)};
  Vec3 out{};
  const double ratio = kReferenceRadius_m / at.radius_m;
  double power = ratio * ratio;
  for (int n = 1; n <= kMaxDegree; ++n) {
    power *= ratio;
    for (int m = 0; m <= n; ++m) {
      const std::size_t k = coefficient_index(n, m);
      const Direction& t = turn[static_cast<std::size_t>(m)];
      const double along = of.g[k] * t.cosine + of.h[k] * t.sine;
      out[0] += power * along * p.slope[k];
      out[1] += power * m * (of.g[k] * t.sine - of.h[k] * t.cosine) * p.over_sine[k];
      out[2] -= power * (n + 1) * along * p.value[k];
    }
  }
  return out;
}

/// From geocentric to geodetic axes: equation (17), by sine and cosine of the difference of the two latitudes.
Vec3 geodetic_axes(const Vec3& v, const Geocentric& at, const Direction& latitude) noexcept {
  const double sine = at.cos_colatitude * latitude.cosine - at.sin_colatitude * latitude.sine;
  const double cosine = at.sin_colatitude * latitude.cosine + at.cos_colatitude * latitude.sine;
  return {v[0] * cosine - v[2] * sine, v[1], v[0] * sine + v[2] * cosine};
}

FieldElements elements_of(const Vec3& ned_tesla) noexcept {
  FieldElements out;
  out.ned_tesla = ned_tesla;
  out.horizontal_tesla = std::hypot(ned_tesla[0], ned_tesla[1]);
  out.total_tesla = std::hypot(out.horizontal_tesla, ned_tesla[2]);
  out.dip_rad = std::atan2(ned_tesla[2], out.horizontal_tesla);
  out.declination_rad = std::atan2(ned_tesla[1], ned_tesla[0]);
  return out;
}

/// Equation (19). Where the horizontal field vanishes its direction has no rate: 0.
FieldElements rates_of(const FieldElements& at, const Vec3& v) noexcept {
  FieldElements out;
  out.ned_tesla = v;
  const Vec3& b = at.ned_tesla;
  const double h = at.horizontal_tesla, f = at.total_tesla;
  if (h > 0.0) {
    out.horizontal_tesla = (b[0] * v[0] + b[1] * v[1]) / h;
    out.declination_rad = (b[0] * v[1] - b[1] * v[0]) / (h * h);
  }
  if (f > 0.0) {
    out.total_tesla = dot(b, v) / f;
    out.dip_rad = (h * v[2] - b[2] * out.horizontal_tesla) / (f * f);
  }
  return out;
}

double wrapped_rad(double angle_rad) noexcept { return std::remainder(angle_rad, 2.0 * kPi); }

}  // namespace

const char* to_string(FieldZone zone) noexcept {
  switch (zone) {
    case FieldZone::usual: return "usual";
    case FieldZone::caution: return "caution zone";
    case FieldZone::blackout: return "blackout zone";
  }
  return "?";
}

io::FileExpected<EarthField> field_at(const FieldModel& model, const Place& place, double year) {
  if (const io::FileExpected<void> fits = check(model, place, year); !fits)
    return tl::unexpected<io::FileError>(fits.error());
  const double years = year - model.epoch_year;
  Coefficients now, change;
  for (std::size_t k = 0; k < kCoefficientCount; ++k) {
    change.g[k] = model.g_nt_per_year[k];
    change.h[k] = model.h_nt_per_year[k];
    now.g[k] = model.g_nt[k] + years * change.g[k];
    now.h[k] = model.h_nt[k] + years * change.h[k];
  }
  const Geocentric at = geocentric_of(place);
  const LegendreTable p = legendre_table(at.cos_colatitude, at.sin_colatitude);
  const Direction latitude = direction_of_deg(place.latitude_deg);
  EarthField out;
  out.place = place;
  out.year = year;
  out.model = model.name;
  out.value = elements_of(scaled(geodetic_axes(gradient_nt(now, p, at), at, latitude), kNanotesla));
  out.per_year = rates_of(out.value, scaled(geodetic_axes(gradient_nt(change, p, at), at, latitude), kNanotesla));
  out.north_undefined = std::fabs(place.latitude_deg) == 90.0;
  out.below_stated_height = place.height_m < kLowestStated_m;
  if (std::fabs(place.latitude_deg) >= kGridFrom_deg) {
    out.has_grid_variation = true;
    const double longitude_rad = rad_from_deg(place.longitude_deg);
    out.grid_variation_rad =
        wrapped_rad(out.value.declination_rad + (place.latitude_deg > 0.0 ? -longitude_rad : longitude_rad));
  }
  if (out.value.horizontal_tesla < kBlackout_tesla)
    out.zone = FieldZone::blackout;
  else if (out.value.horizontal_tesla < kCaution_tesla)
    out.zone = FieldZone::caution;
  return out;
}

io::FileExpected<double> decimal_year(std::string_view date) {
  const io::FileExpected<int> day = io::day_number(date);
  if (!day) return tl::unexpected<io::FileError>(day.error());
  const int year = (date[0] - '0') * 1000 + (date[1] - '0') * 100 + (date[2] - '0') * 10 + (date[3] - '0');
  const io::FileExpected<int> first = io::day_number(fmt::format("{:04d}-01-01", year));
  const bool leap = (year % 4 == 0 && year % 100 != 0) || year % 400 == 0;
  return year + static_cast<double>(*day - *first) / (leap ? 366.0 : 365.0);
}

}  // namespace geomagnetic
}  // namespace PLUMB_ABI
}  // namespace plumb

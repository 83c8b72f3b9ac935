#include "plumb/gravity/gravity.hpp"

#include <cmath>
#include <cstddef>
#include <limits>

namespace plumb {
inline namespace PLUMB_ABI {
namespace {

/// Fields as `Error::index` names them.
enum Field : int { kLatitude = 0, kElevation = 1, kDepth = 2, kDensity = 3, kThickness = 4, kSigma = 5 };
constexpr int kValue = 0;  // of given_gravity and table_gravity

// WGS84 (docs/theory.md, section 1.3).
constexpr double kEquator_mps2 = 9.7803253359;
constexpr double kSomigliana = 0.00193185265241;
constexpr double kEccentricity2 = 0.00669437999013;
constexpr double kSemiMajor_m = 6378137.0;
constexpr double kFlattening = 1.0 / 298.257223563;
constexpr double kCentrifugal = 0.00344978650684;

/// 4 pi G, twice the pull of a slab: rock passed no longer pulls down and now pulls up [m/s^2 per kg/m^2].
constexpr double kPrey = 4.0 * kPi * 6.67430e-11;
constexpr double kPaperEarthRadius_m = 6371000.0;
constexpr double kMaxSigma_mps2 = 0.1;
constexpr double kAnything = std::numeric_limits<double>::max();

Error check_range(double value, int field, double low, double high) noexcept {
  if (!std::isfinite(value)) return Error{Errc::not_finite, field, value, 0.0};
  if (value < low) return Error{Errc::out_of_range, field, value, low};
  if (value > high) return Error{Errc::out_of_range, field, value, high};
  return Error{};
}

/// The first of the errors that is one.
template <std::size_t N>
Error first_of(const std::array<Error, N>& errors) noexcept {
  for (const Error& e : errors) {
    if (e.code != Errc::ok) return e;
  }
  return Error{};
}

Error check_layers(const NormalGravityInput& in) noexcept {
  const int most = static_cast<int>(in.layers.size());
  if (in.layer_count < 0 || in.layer_count > most) {
    return Error{Errc::out_of_range, kThickness, static_cast<double>(in.layer_count), static_cast<double>(most)};
  }
  for (int i = 0; i < in.layer_count; ++i) {
    const DensityLayer& layer = in.layers[static_cast<std::size_t>(i)];
    // Any thickness below Earth's radius: layers may go on beneath the deepest tool.
    const Error e = first_of<2>({check_range(layer.density_kgpm3, kDensity, 900.0, 3500.0),
                                 check_range(layer.thickness_m, kThickness, 0.0, kSemiMajor_m)});
    if (e.code != Errc::ok) return e;
  }
  return Error{};
}

/// Mass per area between the wellhead and the tool [kg/m^2].
double column_above(const NormalGravityInput& in) noexcept {
  if (in.layer_count == 0) return DensityLayer{}.density_kgpm3 * in.depth_m;
  double left_m = in.depth_m;
  double mass = 0.0;
  for (int i = 0; i < in.layer_count; ++i) {
    const DensityLayer& layer = in.layers[static_cast<std::size_t>(i)];
    const bool last = i + 1 == in.layer_count;
    const double through_m = last || layer.thickness_m > left_m ? left_m : layer.thickness_m;
    mass += layer.density_kgpm3 * through_m;
    left_m -= through_m;
  }
  return mass;
}

/// Normal gravity on the ellipsoid, carried to height h (negative below) through empty space.
double free_air(double latitude_deg, double height_m) noexcept {
  const double sine = std::sin(rad_from_deg(latitude_deg));
  const double sine2 = sine * sine;
  const double surface = kEquator_mps2 * (1.0 + kSomigliana * sine2) / std::sqrt(1.0 - kEccentricity2 * sine2);
  const double ratio = height_m / kSemiMajor_m;
  const double linear = 1.0 + kFlattening + kCentrifugal - 2.0 * kFlattening * sine2;
  return surface * (1.0 - 2.0 * ratio * linear + 3.0 * ratio * ratio);
}

}  // namespace

const char* to_string(GravityModel model) noexcept {
  switch (model) {
    case GravityModel::normal: return "normal";
    case GravityModel::paper: return "paper";
    case GravityModel::value: return "value";
    case GravityModel::table: return "table";
    case GravityModel::magnetic: return "magnetic";
  }
  return "unknown";
}

bool GravityReference::plausible() const noexcept {
  return (model == GravityModel::magnetic ? given_field(g_mps2, sigma_mps2) : given_gravity(g_mps2, sigma_mps2))
      .has_value();
}

Expected<GravityReference> normal_gravity(const NormalGravityInput& in) noexcept {
  const Error e = first_of<5>({check_range(in.latitude_deg, kLatitude, -90.0, 90.0),
                               check_range(in.elevation_m, kElevation, -500.0, 9000.0),
                               check_range(in.depth_m, kDepth, 0.0, 15000.0), check_layers(in),
                               check_range(in.sigma_mps2, kSigma, 0.0, kMaxSigma_mps2)});
  if (e.code != Errc::ok) return tl::unexpected<Error>(e);
  const double g = free_air(in.latitude_deg, in.elevation_m - in.depth_m) - kPrey * column_above(in);
  return GravityReference{g, in.sigma_mps2, GravityModel::normal};
}

Expected<GravityReference> paper_gravity(double latitude_deg, double depth_m, double sigma_mps2) noexcept {
  const Error e =
      first_of<3>({check_range(latitude_deg, kLatitude, -90.0, 90.0), check_range(depth_m, kDepth, 0.0, 15000.0),
                   check_range(sigma_mps2, kSigma, 0.0, kMaxSigma_mps2)});
  if (e.code != Errc::ok) return tl::unexpected<Error>(e);
  const double sine = std::sin(rad_from_deg(latitude_deg));
  const double sine_twice = std::sin(2.0 * rad_from_deg(latitude_deg));
  const double surface = 9.780327 * (1.0 + 0.0053024 * sine * sine - 0.0000058 * sine_twice * sine_twice);
  const double g = (kPaperEarthRadius_m - depth_m) / kPaperEarthRadius_m * surface;
  return GravityReference{g, sigma_mps2, GravityModel::paper};
}

Expected<GravityReference> given_gravity(double g_mps2, double sigma_mps2) noexcept {
  const Error e =
      first_of<2>({check_range(g_mps2, kValue, 9.5, 10.2), check_range(sigma_mps2, kSigma, 0.0, kMaxSigma_mps2)});
  if (e.code != Errc::ok) return tl::unexpected<Error>(e);
  return GravityReference{g_mps2, sigma_mps2, GravityModel::value};
}

Expected<GravityReference> given_field(double length, double sigma) noexcept {
  const Error e = first_of<2>(
      {check_range(length, kValue, kLeastField, kMostField), check_range(sigma, kSigma, 0.0, kMaxSigma_mps2)});
  if (e.code != Errc::ok) return tl::unexpected<Error>(e);
  return GravityReference{length, sigma, GravityModel::magnetic};
}

Expected<GravityReference> table_gravity(const double* depth_m, const double* g_mps2, int count, double at_depth_m,
                                         double sigma_mps2) noexcept {
  if (depth_m == nullptr || g_mps2 == nullptr || count < 1) return fail(Errc::out_of_range, kDepth, count, 1.0);
  // The whole table is checked, not only the rows in use: a bad row must not wait for the depth that meets it.
  for (int i = 0; i < count; ++i) {
    const Error e = first_of<2>(
        {check_range(depth_m[i], kDepth, -kAnything, kAnything), check_range(g_mps2[i], kValue, 9.5, 10.2)});
    if (e.code != Errc::ok) return tl::unexpected<Error>(e);
    if (i > 0 && !(depth_m[i] > depth_m[i - 1])) return fail(Errc::out_of_range, kDepth, depth_m[i], depth_m[i - 1]);
  }
  const Error e = first_of<2>({check_range(at_depth_m, kDepth, depth_m[0], depth_m[count - 1]),
                               check_range(sigma_mps2, kSigma, 0.0, kMaxSigma_mps2)});
  if (e.code != Errc::ok) return tl::unexpected<Error>(e);
  int above = 0;
  while (above + 2 < count && at_depth_m > depth_m[above + 1]) ++above;
  const int below = above + 1 < count ? above + 1 : above;
  const double span = depth_m[below] - depth_m[above];
  const double share = span > 0.0 ? (at_depth_m - depth_m[above]) / span : 0.0;
  const double g = g_mps2[above] * (1.0 - share) + g_mps2[below] * share;
  return GravityReference{g, sigma_mps2, GravityModel::table};
}

}  // namespace PLUMB_ABI
}  // namespace plumb

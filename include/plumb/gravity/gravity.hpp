/// How large is gravity here, and how sure are we.
#pragma once

#include <array>
#include <cstdint>

#include "plumb/core/config.hpp"
#include "plumb/core/detail/fields.hpp"
#include "plumb/core/error.hpp"
#include "plumb/core/units.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

/// Default 1-sigma of a gravity model [m/s^2]: 0.15 mg (anomaly, density and latitude, docs/theory.md, section 1.3).
inline constexpr double kDefaultGravitySigma_mps2 = 0.15e-3 * kG0_mps2;

/// `magnetic`: not gravity, but the Earth's magnetic field in units of 4 uT, which the same code serves.
enum class GravityModel : std::uint8_t { normal, paper, value, table, magnetic };
const char* to_string(GravityModel model) noexcept;

/// Length of gravity at the tool, with its uncertainty.
struct GravityReference {
  double g_mps2 = kG0_mps2;
  double sigma_mps2 = kDefaultGravitySigma_mps2;
  GravityModel model = GravityModel::value;

  /// Numbers that a monitor can work with.
  bool plausible() const noexcept;
  static constexpr auto fields() noexcept {
    return field_list(&GravityReference::g_mps2, &GravityReference::sigma_mps2,
                      up_to(&GravityReference::model, GravityModel::magnetic));
  }
};

/// A layer of rock or water above the tool, from the surface down.
struct DensityLayer {
  double thickness_m = 0.0;
  double density_kgpm3 = 2670.0;
};

struct NormalGravityInput {
  double latitude_deg = 0.0;  ///< geodetic, -90 .. 90
  double elevation_m = 0.0;   ///< of the wellhead above mean sea level, -500 .. 9000
  double depth_m = 0.0;       ///< of the tool below the wellhead, 0 .. 15000
  std::array<DensityLayer, 8> layers{};
  int layer_count = 0;  ///< 0: one layer of 2670 kg/m^3; the last layer goes on for ever
  double sigma_mps2 = kDefaultGravitySigma_mps2;
};

/// Somigliana on WGS84, second-order free air for elevation, Prey (0.3086 - 0.0839 rho mGal/m) through
/// the layers for depth. Departure from the paper's formula for depth, which has the wrong
/// sign in the crust: gravity rises down to where the rock above is denser than 3.68 g/cm^3.
/// Errors: out_of_range with index 0 latitude, 1 elevation, 2 depth, 3 density, 4 thickness, 5 sigma;
/// not_finite with the same index.
Expected<GravityReference> normal_gravity(const NormalGravityInput& in) noexcept;

/// Paper eq (8), then eq (9) with R_e = 6371000 m: kept for paper mode.
Expected<GravityReference> paper_gravity(double latitude_deg, double depth_m,
                                         double sigma_mps2 = kDefaultGravitySigma_mps2) noexcept;

/// A value that the user states. Errors: out_of_range outside 9.5 .. 10.2 m/s^2 (index 0) or a
/// sigma below 0 or above 0.1 m/s^2 (index 5).
Expected<GravityReference> given_gravity(double g_mps2, double sigma_mps2) noexcept;

inline constexpr double kLeastField = 5.0, kMostField = 17.5;  ///< 20 and 70 uT

/// Of a magnetic field, both in units of 4 uT. Errors: as `given_gravity`, outside of `kLeastField` to `kMostField`.
Expected<GravityReference> given_field(double length, double sigma) noexcept;

/// Piecewise linear in depth; depths strictly increasing; outside the table: out_of_range (index 2).
Expected<GravityReference> table_gravity(const double* depth_m, const double* g_mps2, int count, double at_depth_m,
                                         double sigma_mps2) noexcept;

}  // namespace PLUMB_ABI
}  // namespace plumb

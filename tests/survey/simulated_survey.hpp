/// Stations of a tool whose attitude is known: the equations of SPE 67616 the other way round.
#pragma once

#include <cmath>
#include <vector>

#include "plumb/core/units.hpp"
#include "plumb/survey/terms.hpp"

namespace simulated_survey {

struct Truth {
  double inclination_rad = 0.0, azimuth_rad = 0.0, toolface_rad = 0.0;
};

struct World {
  double g_mps2 = 9.81, field_tesla = 50e-6, dip_rad = 1.25;
};

inline plumb::survey::Measurement station_of(const Truth& t, const World& w, double md_m = 0.0) {
  const double si = std::sin(t.inclination_rad), ci = std::cos(t.inclination_rad);
  const double sa = std::sin(t.azimuth_rad), ca = std::cos(t.azimuth_rad);
  const double st = std::sin(t.toolface_rad), ct = std::cos(t.toolface_rad);
  const double bn = w.field_tesla * std::cos(w.dip_rad), bd = w.field_tesla * std::sin(w.dip_rad);
  plumb::survey::Measurement out;
  out.md_m = md_m;
  out.gravity_mps2 = {-w.g_mps2 * si * st, -w.g_mps2 * si * ct, w.g_mps2 * ci};
  out.field_tesla = {(bn * ci * ca - bd * si) * st + bn * sa * ct, (bn * ci * ca - bd * si) * ct - bn * sa * st,
                     bn * si * ca + bd * ci};
  return out;
}

inline plumb::survey::Reference reference_of(const World& w) {
  plumb::survey::Reference out;
  out.gravity.g_mps2 = w.g_mps2;
  out.gravity.sigma_mps2 = 1.5e-3;
  out.field.source = "stated";
  out.field.total_tesla = w.field_tesla;
  out.field.dip_rad = w.dip_rad;
  out.field.total_tesla_sigma = {130e-9, 0.0};
  out.field.dip_rad_sigma = {plumb::rad_from_deg(0.2), 0.0};
  out.field.declination_known = true;
  out.field.declination_rad = plumb::rad_from_deg(-4.0);
  out.field.declination_rad_sigma = {plumb::rad_from_deg(0.4), 0.0};
  return out;
}

/// Down, then round to the horizontal on 60 degrees.
inline std::vector<plumb::survey::ReferencedStation> bent_hole(int stations = 20) {
  std::vector<plumb::survey::ReferencedStation> out;
  for (int k = 0; k < stations; ++k) {
    const double inclination_deg = k < 3 ? 0.0 : 85.0 * (k - 2) / (stations - 3);
    plumb::survey::Measurement m = station_of(
        {plumb::rad_from_deg(inclination_deg), plumb::rad_from_deg(60.0), 1.7 * k}, World{}, 1000.0 + 30.0 * k);
    m.random = plumb::survey::independent_covariance(1e-3, 20e-9);
    out.push_back({m, reference_of(World{})});
  }
  return out;
}

}  // namespace simulated_survey

// One station of a survey: the azimuth with its protection level, and nothing where the field is disturbed.
#include <cstdio>

#include "plumb/survey/checks.hpp"

int main() {
  using namespace plumb;
  survey::Measurement station;  // axes: z down the hole, x and y across
  station.gravity_mps2 = {-4.577, -1.141, 8.616};
  station.field_tesla = {-28.31e-6, -18.99e-6, 37.60e-6};
  station.random = survey::independent_covariance(1e-3, 20e-9);  // noise of the means
  survey::Reference reference;                                   // or geomagnetic::field_at and normal_gravity
  reference.gravity.g_mps2 = 9.8227;
  reference.field = *geomagnetic::stated_reference({50750.0, 130.0, 72.4, 0.2, true, -0.6, 0.4});
  for (const double casing_tesla : {0.0, 2500e-9}) {
    station.field_tesla[1] += casing_tesla;
    const survey::SurveyStation s = survey::judge_station(station, reference, {});
    if (s.true_azimuth)
      std::printf("%s: azimuth %.1f deg from true north, within %.1f deg but for 1 in 10000\n", to_string(s.status),
                  deg_from_rad(s.true_azimuth->angle.rad),
                  deg_from_rad(survey::protection_level_rad(s.true_azimuth->angle, 1e-4)));
    else
      std::printf("%s: %s\n", to_string(s.status), s.true_azimuth.error().text().c_str());
  }
}

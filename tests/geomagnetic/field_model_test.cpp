// The field against the values that NOAA publishes, and against mathematics of another kind.
#include "plumb/geomagnetic/field_model.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "plumb/core/units.hpp"
#include "wmm_values.hpp"

namespace field_model_test {
namespace {

using namespace plumb;
using namespace plumb::geomagnetic;

constexpr double kNt = 1e9;

TEST(FieldModel, IsThatOfThePublishedValues) {
  for (const wmm_values::Row& row : wmm_values::kRows) {
    const auto field = field_at(wmm2025(), {row.latitude_deg, row.longitude_deg, 1000.0 * row.height_km}, row.year);
    ASSERT_TRUE(field.has_value()) << field.error().text();
    const FieldElements& at = field->value;
    // Published to 1e-6 nT, by a program whose rounding is its own: 3e-4 nT was measured.
    EXPECT_NEAR(at.ned_tesla[0] * kNt, row.x_nt, 1e-3);
    EXPECT_NEAR(at.ned_tesla[1] * kNt, row.y_nt, 1e-3);
    EXPECT_NEAR(at.ned_tesla[2] * kNt, row.z_nt, 1e-3);
    EXPECT_NEAR(at.horizontal_tesla * kNt, row.h_nt, 1e-3);
    EXPECT_NEAR(at.total_tesla * kNt, row.f_nt, 1e-3);
    EXPECT_NEAR(deg_from_rad(at.dip_rad), row.dip_deg, 0.00501);
    EXPECT_NEAR(deg_from_rad(at.declination_rad), row.declination_deg, 0.00501);
  }
}

/// Another way: the potential in long double from Rodrigues' formula, differentiated by differences along the axes.
struct Potential {
  std::vector<std::vector<std::vector<long double>>> derivative;  ///< [n][m]: coefficients of the m-th derivative
  Potential() {
    for (int n = 0; n <= kMaxDegree; ++n) {
      std::vector<long double> p(2 * static_cast<std::size_t>(n) + 1, 0.0L);  // (x^2 - 1)^n / (2^n n!)
      long double binomial = 1.0L, scale = 1.0L;
      for (int k = 1; k <= n; ++k) scale *= 2.0L * static_cast<long double>(k);
      for (int k = 0; k <= n; ++k) {
        p[2 * static_cast<std::size_t>(n - k)] = (k % 2 == 0 ? 1.0L : -1.0L) * binomial / scale;
        binomial = binomial * static_cast<long double>(n - k) / static_cast<long double>(k + 1);
      }
      for (int k = 0; k < n; ++k) p = derived(p);
      std::vector<std::vector<long double>> of_degree;
      for (int m = 0; m <= n; ++m) {
        of_degree.push_back(p);
        p = derived(p);
      }
      derivative.push_back(of_degree);
    }
  }
  static std::vector<long double> derived(const std::vector<long double>& p) {
    std::vector<long double> out(p.size() > 1 ? p.size() - 1 : 1, 0.0L);
    for (std::size_t k = 1; k < p.size(); ++k) out[k - 1] = static_cast<long double>(k) * p[k];
    return out;
  }
  long double legendre(int n, int m, long double x, long double sine) const {
    const auto& p = derivative[static_cast<std::size_t>(n)][static_cast<std::size_t>(m)];
    long double value = 0.0L;
    for (std::size_t k = p.size(); k-- > 0;) value = value * x + p[k];
    long double factor = m == 0 ? 1.0L : 2.0L;
    for (int k = n - m + 1; k <= n + m; ++k) factor /= static_cast<long double>(k);
    return std::sqrt(factor) * std::pow(sine, static_cast<long double>(m)) * value;
  }
  /// V [nT m] at a point of the Earth's frame.
  long double at(const FieldModel& model, const std::array<long double, 3>& p, double year) const {
    const long double rho = std::hypot(p[0], p[1]), r = std::hypot(rho, p[2]), longitude = std::atan2(p[1], p[0]);
    const long double a = 6371200.0L, t = static_cast<long double>(year - model.epoch_year);
    long double sum = 0.0L;
    for (int n = 1; n <= kMaxDegree; ++n) {
      for (int m = 0; m <= n; ++m) {
        const std::size_t k = coefficient_index(n, m);
        const long double g =
            static_cast<long double>(model.g_nt[k]) + t * static_cast<long double>(model.g_nt_per_year[k]);
        const long double h =
            static_cast<long double>(model.h_nt[k]) + t * static_cast<long double>(model.h_nt_per_year[k]);
        const long double turn = static_cast<long double>(m) * longitude;
        sum += a * std::pow(a / r, static_cast<long double>(n + 1)) * (g * std::cos(turn) + h * std::sin(turn)) *
               legendre(n, m, p[2] / r, rho / r);
      }
    }
    return sum;
  }
};

struct Axes {
  std::array<long double, 3> point;
  std::array<std::array<long double, 3>, 3> ned;
};

Axes axes_of(const Place& place) {
  const long double rad = std::acos(-1.0L) / 180.0L;
  const long double p = rad * static_cast<long double>(place.latitude_deg),
                    l = rad * static_cast<long double>(place.longitude_deg);
  const long double a = 6378137.0L, f = 1.0L / 298.257223563L, e2 = f * (2.0L - f),
                    h = static_cast<long double>(place.height_m);
  const long double n = a / std::sqrt(1.0L - e2 * std::sin(p) * std::sin(p));
  return {
      {(n + h) * std::cos(p) * std::cos(l), (n + h) * std::cos(p) * std::sin(l), (n * (1.0L - e2) + h) * std::sin(p)},
      {{{-std::sin(p) * std::cos(l), -std::sin(p) * std::sin(l), std::cos(p)},
        {-std::sin(l), std::cos(l), 0.0L},
        {-std::cos(p) * std::cos(l), -std::cos(p) * std::sin(l), -std::sin(p)}}}};
}

std::array<long double, 3> moved(const Axes& axes, std::size_t axis, long double step_m) {
  std::array<long double, 3> out = axes.point;
  for (std::size_t k = 0; k < 3; ++k) out[k] += step_m * axes.ned[axis][k];
  return out;
}

rc::Gen<Place> any_place() {
  // Poles, the equator and both limits of the height among them.
  return rc::gen::map(rc::gen::tuple(rc::gen::inRange(-9000, 9001), rc::gen::inRange(-18000, 36001),
                                     rc::gen::inRange(-15, 851), rc::gen::inRange(0, 8)),
                      [](const std::tuple<int, int, int, int>& t) {
                        Place out{std::get<0>(t) / 100.0, std::get<1>(t) / 100.0, 1000.0 * std::get<2>(t)};
                        if (std::get<3>(t) == 0) out.latitude_deg = out.latitude_deg < 0.0 ? -90.0 : 90.0;
                        if (std::get<3>(t) == 1) out.latitude_deg = 0.0;
                        if (std::get<3>(t) == 2) out.latitude_deg = out.latitude_deg < 0.0 ? -89.9999 : 89.9999;
                        return out;
                      });
}

double any_year() { return 2025.0 + *rc::gen::inRange(0, 51) / 10.0; }

RC_GTEST_PROP(FieldModelLaw, IsTheGradientOfThePotential, ()) {
  static const Potential potential;
  const Place place = *any_place();
  const double year = any_year();
  const auto field = field_at(wmm2025(), place, year);
  RC_ASSERT(field.has_value());
  const Axes axes = axes_of(place);
  const long double step_m = 100.0L;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto slope = [&](long double s) {
      return (potential.at(wmm2025(), moved(axes, axis, s), year) -
              potential.at(wmm2025(), moved(axes, axis, -s), year)) /
             (2.0L * s);
    };
    const long double gradient = -(4.0L * slope(step_m) - slope(2.0L * step_m)) / 3.0L;
    RC_ASSERT(std::fabs(static_cast<double>(gradient) - field->value.ned_tesla[axis] * kNt) < 2e-5);
  }
}

/// The field at a point of the Earth's frame, in that frame.
std::array<double, 3> field_there(const std::array<long double, 3>& p, double year) {
  // Bowring by iteration, independent of the library's.
  const double a = 6378137.0, f = 1.0 / 298.257223563, e2 = f * (2.0 - f);
  const double rho = std::hypot(static_cast<double>(p[0]), static_cast<double>(p[1])), z = static_cast<double>(p[2]);
  double latitude = std::atan2(z, rho * (1.0 - e2)), height = 0.0;
  for (int pass = 0; pass < 50; ++pass) {
    const double n = a / std::sqrt(1.0 - e2 * std::sin(latitude) * std::sin(latitude));
    height = rho * std::cos(latitude) + z * std::sin(latitude) - a * a / n;
    latitude = std::atan2(z + e2 * n * std::sin(latitude), rho);
  }
  const Place place{deg_from_rad(latitude),
                    deg_from_rad(std::atan2(static_cast<double>(p[1]), static_cast<double>(p[0]))), height};
  const auto field = field_at(wmm2025(), place, year);
  RC_ASSERT(field.has_value());
  const Axes axes = axes_of(place);
  std::array<double, 3> out{};
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t axis = 0; axis < 3; ++axis)
      out[k] += field->value.ned_tesla[axis] * kNt * static_cast<double>(axes.ned[axis][k]);
  }
  return out;
}

RC_GTEST_PROP(FieldModelLaw, HasNeitherDivergenceNorCurl, ()) {
  Place place = *any_place();
  place.height_m = std::fmin(800e3, std::fmax(-12e3, place.height_m));
  place.latitude_deg = std::fmin(89.0, std::fmax(-89.0, place.latitude_deg));
  const double year = any_year(), step_m = 2000.0;
  const Axes axes = axes_of(place);
  std::array<std::array<double, 3>, 3> slope{};  // [of component][along axis], both of the Earth's frame
  for (std::size_t along = 0; along < 3; ++along) {
    std::array<long double, 3> ahead = axes.point, behind = axes.point;
    ahead[along] += static_cast<long double>(step_m);
    behind[along] -= static_cast<long double>(step_m);
    const auto a = field_there(ahead, year), b = field_there(behind, year);
    for (std::size_t k = 0; k < 3; ++k) slope[k][along] = (a[k] - b[k]) / (2.0 * step_m);
  }
  // A field of 50 000 nT changes by 0.02 nT a metre. Of degree n, differences over h = 2 km to either side err by
  // (h n / 6371 km)^2 / 6 of their part: 2.4e-6 at degree 12.
  RC_ASSERT(std::fabs(slope[0][0] + slope[1][1] + slope[2][2]) < 1e-7);
  RC_ASSERT(std::fabs(slope[0][1] - slope[1][0]) < 1e-7);
  RC_ASSERT(std::fabs(slope[0][2] - slope[2][0]) < 1e-7);
  RC_ASSERT(std::fabs(slope[1][2] - slope[2][1]) < 1e-7);
}

RC_GTEST_PROP(FieldModelLaw, RatesAreThoseOfAYear, ()) {
  const Place place = *any_place();
  const double year = 2026.0 + *rc::gen::inRange(0, 31) / 10.0;
  const auto now = field_at(wmm2025(), place, year), later = field_at(wmm2025(), place, year + 0.01),
             before = field_at(wmm2025(), place, year - 0.01);
  RC_ASSERT(now && later && before);
  for (std::size_t k = 0; k < 3; ++k)
    RC_ASSERT(std::fabs((later->value.ned_tesla[k] - before->value.ned_tesla[k]) / 0.02 - now->per_year.ned_tesla[k]) *
                  kNt <
              1e-6);
  const auto slope = [&](double FieldElements::*e) { return (later->value.*e - before->value.*e) / 0.02; };
  RC_ASSERT(std::fabs(slope(&FieldElements::total_tesla) - now->per_year.total_tesla) * kNt < 1e-3);
  if (now->value.horizontal_tesla * kNt > 3000.0) {
    RC_ASSERT(std::fabs(slope(&FieldElements::horizontal_tesla) - now->per_year.horizontal_tesla) * kNt < 1e-2);
    RC_ASSERT(std::fabs(slope(&FieldElements::dip_rad) - now->per_year.dip_rad) < 1e-6);
    RC_ASSERT(std::fabs(std::remainder(later->value.declination_rad - before->value.declination_rad, 2.0 * kPi) / 0.02 -
                        now->per_year.declination_rad) < 1e-6);
  }
}

TEST(FieldModel, IsOneFieldFromEverySideOfAPole) {
  for (const double pole_deg : {90.0, -90.0}) {
    const auto zero = field_at(wmm2025(), {pole_deg, 0.0, 0.0}, 2027.0);
    ASSERT_TRUE(zero.has_value());
    EXPECT_TRUE(zero->north_undefined);
    for (const double longitude_deg : {-170.0, -90.0, 33.0, 180.0, 300.0}) {
      const auto field = field_at(wmm2025(), {pole_deg, longitude_deg, 0.0}, 2027.0);
      const auto near = field_at(wmm2025(), {pole_deg * (1.0 - 1e-12), longitude_deg, 0.0}, 2027.0);
      ASSERT_TRUE(field && near);
      EXPECT_FALSE(near->north_undefined);
      EXPECT_NEAR(field->value.horizontal_tesla, zero->value.horizontal_tesla, 1e-19);
      EXPECT_NEAR(field->value.ned_tesla[2], zero->value.ned_tesla[2], 1e-19);
      EXPECT_NEAR(std::remainder(field->grid_variation_rad - zero->grid_variation_rad, 2.0 * kPi), 0.0, 1e-9);
      for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(field->value.ned_tesla[k], near->value.ned_tesla[k], 1e-16);
    }
  }
}

TEST(FieldModel, GridVariationIsDeclinationLessLongitudeInTheNorth) {
  const auto north = field_at(wmm2025(), {80.0, 30.0, 0.0}, 2025.0),
             south = field_at(wmm2025(), {-80.0, 240.0, 0.0}, 2025.0),
             between = field_at(wmm2025(), {54.9, 30.0, 0.0}, 2025.0);
  ASSERT_TRUE(north && south && between);
  EXPECT_NEAR(north->grid_variation_rad, north->value.declination_rad - rad_from_deg(30.0), 1e-12);
  EXPECT_NEAR(std::remainder(south->grid_variation_rad - south->value.declination_rad - rad_from_deg(240.0), 2.0 * kPi),
              0.0, 1e-12);
  EXPECT_FALSE(between->has_grid_variation);
}

TEST(FieldModel, NamesTheZonesOfAWeakHorizontalField) {
  const auto usual = field_at(wmm2025(), {60.0, 2.0, 0.0}, 2025.0),
             caution = field_at(wmm2025(), {80.0, 0.0, 0.0}, 2025.0),
             blackout = field_at(wmm2025(), {86.0, 140.0, 0.0}, 2025.0);
  ASSERT_TRUE(usual && caution && blackout);
  EXPECT_EQ(usual->zone, FieldZone::usual);
  EXPECT_EQ(blackout->zone, FieldZone::blackout);
  EXPECT_STREQ(to_string(blackout->zone), "blackout zone");
  EXPECT_EQ(caution->zone == FieldZone::caution, caution->value.horizontal_tesla * kNt < 6000.0);
}

// Negative: REQ-234
TEST(FieldModel, RefusesWhatItDoesNotHoldFor) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  const Place home{60.0, 2.0, 0.0};
  for (const double year : {2024.999, 2030.001, 0.0, nan, inf, -inf}) {
    const auto field = field_at(wmm2025(), home, year);
    ASSERT_FALSE(field.has_value()) << year;
    EXPECT_EQ(field.error().field, "date");
    EXPECT_NE(field.error().what.find("holds from 2025.0 to 2030.0"), std::string::npos);
    EXPECT_FALSE(field.error().remedy.empty());
  }
  EXPECT_TRUE(field_at(wmm2025(), home, 2025.0).has_value());
  EXPECT_TRUE(field_at(wmm2025(), home, 2030.0).has_value());
  const Place wrong[] = {{90.001, 0, 0}, {-91, 0, 0},    {nan, 0, 0},    {0, -180.1, 0}, {0, 360.1, 0},
                         {0, nan, 0},    {0, 0, -15001}, {0, 0, 850001}, {0, 0, inf}};
  for (const Place& place : wrong) EXPECT_FALSE(field_at(wmm2025(), place, 2026.0).has_value());
  EXPECT_TRUE(field_at(wmm2025(), {0.0, 0.0, -3000.0}, 2026.0)->below_stated_height);
  EXPECT_FALSE(field_at(wmm2025(), {0.0, 0.0, -1000.0}, 2026.0)->below_stated_height);
}

TEST(FieldModel, DatesAreDecimalYears) {
  EXPECT_DOUBLE_EQ(*decimal_year("2025-01-01"), 2025.0);
  EXPECT_DOUBLE_EQ(*decimal_year("2026-03-31"), 2026.0 + 89.0 / 365.0);
  EXPECT_DOUBLE_EQ(*decimal_year("2028-12-31"), 2028.0 + 365.0 / 366.0);
  EXPECT_FALSE(decimal_year("2026-02-30").has_value());
  EXPECT_FALSE(decimal_year("31.3.2026").has_value());
  EXPECT_FALSE(decimal_year("").has_value());
}

}  // namespace
}  // namespace field_model_test

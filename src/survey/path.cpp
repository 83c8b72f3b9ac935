#include "plumb/survey/path.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "plumb/core/units.hpp"
#include "plumb/core/vec3.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace survey {
namespace {

constexpr double kNearlyStraight_rad = 0.01;
constexpr double kBack_rad = 0.5 * kPi - 5e-7;
constexpr double kVerticalEnough_rad = rad_from_deg(5.0);

tl::unexpected<io::FileError> refuse(const PathStation& at, std::string what, std::string remedy) {
  return tl::unexpected<io::FileError>(io::FileError{"", 0, fmt::format("station at {:.2f} m", at.md_m),
                                                     std::move(what), std::move(remedy), io::ExitCode::invalid_input});
}

io::FileExpected<void> check(const PathStation& at, const PathStation* before) {
  if (!std::isfinite(at.md_m) || !std::isfinite(at.inclination_rad) ||
      (at.azimuth_known && !std::isfinite(at.azimuth_rad)))
    return refuse(at, "a number of it is not finite", "leave the station out");
  if (at.inclination_rad < 0.0 || at.inclination_rad > kPi)
    return refuse(at, fmt::format("an inclination of {:.3f} deg", deg_from_rad(at.inclination_rad)),
                  "inclinations are 0 to 180 deg");
  const double from_vertical = std::min(at.inclination_rad, kPi - at.inclination_rad);
  if (!at.azimuth_known && from_vertical > kVerticalEnough_rad)
    return refuse(at, fmt::format("has no azimuth, and is {:.2f} deg from vertical", deg_from_rad(from_vertical)),
                  "leave the station out, or survey it again");
  if (before != nullptr && !(at.md_m > before->md_m))
    return refuse(at, fmt::format("does not lie below the station before it, at {:.2f} m", before->md_m),
                  "sort the stations by measured depth and keep one of each");
  return {};
}

/// Half the dogleg. A station without azimuth is vertical.
double half_dogleg_rad(const PathStation& a, const PathStation& b) {
  const auto sine = [](const PathStation& s) { return s.azimuth_known ? std::sin(s.inclination_rad) : 0.0; };
  const auto inclination = [](const PathStation& s) {
    return s.azimuth_known ? s.inclination_rad : (s.inclination_rad < 0.5 * kPi ? 0.0 : kPi);
  };
  const double i = std::sin(0.5 * (inclination(b) - inclination(a)));
  const double turn = a.azimuth_known && b.azimuth_known ? std::sin(0.5 * (b.azimuth_rad - a.azimuth_rad)) : 0.0;
  return std::asin(std::sqrt(std::min(1.0, i * i + sine(a) * sine(b) * turn * turn)));
}

Vec3 tangent(const PathStation& s) {
  if (!s.azimuth_known) return {0.0, 0.0, s.inclination_rad < 0.5 * kPi ? 1.0 : -1.0};
  const double sine = std::sin(s.inclination_rad);
  return {sine * std::cos(s.azimuth_rad), sine * std::sin(s.azimuth_rad), std::cos(s.inclination_rad)};
}

/// tan(x) / x
double ratio_factor(double x) {
  if (x > kNearlyStraight_rad) return std::tan(x) / x;
  const double x2 = x * x;
  return 1.0 + x2 * (1.0 / 3.0 + x2 * (2.0 / 15.0 + x2 * (17.0 / 315.0)));
}

}  // namespace

io::FileExpected<std::vector<PathPoint>> minimum_curvature(const std::vector<PathStation>& stations) {
  if (stations.empty()) return refuse(PathStation{}, "there is no station", "give one at least");
  std::vector<PathPoint> out;
  out.reserve(stations.size());
  for (std::size_t k = 0; k < stations.size(); ++k) {
    const PathStation& at = stations[k];
    const PathStation* const before = k > 0 ? &stations[k - 1] : nullptr;
    if (const io::FileExpected<void> fits = check(at, before); !fits)
      return tl::unexpected<io::FileError>(fits.error());
    if (before == nullptr) {
      out.push_back({at.md_m, 0.0, 0.0, at.md_m, 0.0, 0.0});
      continue;
    }
    const double half = half_dogleg_rad(*before, at);
    if (half > kBack_rad)
      return refuse(at, "points against the station before it: a dogleg of 180 deg",
                    "one of the two is wrong: leave it out");
    const double length_m = at.md_m - before->md_m;
    const Vec3 step = scaled(plus(tangent(*before), tangent(at)), 0.5 * length_m * ratio_factor(half));
    const PathPoint& last = out.back();
    out.push_back({at.md_m, last.north_m + step[0], last.east_m + step[1], last.tvd_m + step[2], 2.0 * half,
                   deg_from_rad(2.0 * half) * 30.0 / length_m});
  }
  return out;
}

}  // namespace survey
}  // namespace PLUMB_ABI
}  // namespace plumb

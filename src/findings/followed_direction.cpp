#include "plumb/findings/followed_direction.hpp"

#include <cmath>

namespace plumb {
inline namespace PLUMB_ABI {
namespace findings {
namespace {

/// Where the temperature is so nearly a linear function of one component of the direction, over enough stations.
constexpr double kFollows = 0.99;
constexpr double kFollowStations = 6.0;

}  // namespace

FollowedDirection followed_direction(int order, const std::vector<Station>& stations,
                                     const std::vector<SeenAttitude>& attitudes) {
  FollowedDirection out;
  if (order < 1) return out;
  for (std::size_t p = 0; p < 3; ++p) {
    double n = 0.0, x = 0.0, t = 0.0, xx = 0.0, tt = 0.0, xt = 0.0;
    for (std::size_t k = 0; k < stations.size(); ++k) {
      const Vec3& u = attitudes[k].direction;
      if (!(norm(u) > 0.0)) continue;
      const double degc = stations[k].temperature_degc - stations.front().temperature_degc;
      n += 1.0;
      x += u[p];
      t += degc;
      xx += u[p] * u[p];
      tt += degc * degc;
      xt += u[p] * degc;
    }
    const double spread = std::sqrt((n * xx - x * x) * (n * tt - t * t));
    const double r = n >= kFollowStations && spread > 0.0 ? (n * xt - x * t) / spread : 0.0;
    if (std::fabs(r) > std::fmax(kFollows, std::fabs(out.correlation))) out = {"xyz"[p], r};
  }
  return out;
}

}  // namespace findings
}  // namespace PLUMB_ABI
}  // namespace plumb

/// Tools that are wired otherwise than their array file says, and mounted some degrees off it: drawn so that a fit
/// takes the axes behind the channels for those of the file.
#pragma once

#include <optional>
#include <string>
#include <utility>

#include "plumb/array/named.hpp"
#include "plumb/core/units.hpp"
#include "plumb/findings/unseen_wiring.hpp"
#include "support/simulated_tool.hpp"

namespace plumb_test {
inline namespace PLUMB_ABI {

inline plumb::SensorArray array_of_axes(const plumb::AxisList& axes, int n) {
  std::array<plumb::SensorRow, plumb::kCapacity> rows{};
  for (int i = 0; i < n; ++i) {
    const auto a = static_cast<std::size_t>(i);
    rows[a].id = plumb::make_id(("a" + std::to_string(i + 1)).c_str());
    rows[a].axis = axes[a];
    rows[a].sigma_mps2 = 1e-3;
  }
  return *plumb::SensorArray::make(rows.data(), n);
}

/// Largest angle between where two turns take one of the unit vectors.
inline double apart_rad(const plumb::Mat3& a, const plumb::Mat3& b) {
  double out = 0.0;
  for (const plumb::Vec3& e : {plumb::Vec3{1, 0, 0}, plumb::Vec3{0, 1, 0}, plumb::Vec3{0, 0, 1}})
    out = std::fmax(out, plumb::angle_between_rad(plumb::times(a, e), plumb::times(b, e)));
  return out;
}

inline plumb::Vec3 moved_by(const plumb::Vec3& axis, double most_deg, Noise& noise) {
  const plumb::Vec3 out = plumb::plus(axis, plumb::scaled(random_direction(noise), plumb::rad_from_deg(most_deg)));
  return plumb::scaled(out, 1.0 / plumb::norm(out));
}

struct RewiredTool {
  plumb::SensorArray nominal;  ///< what the array file says
  plumb::SensorArray fitted;   ///< the axes behind the channels, turned as near to those as they go
  plumb::Mat3 turn{};          ///< where down is d, the tool shows turn * d

  bool is_listed(const std::vector<plumb::findings::UnseenWiring>& wirings) const {
    for (const plumb::findings::UnseenWiring& one : wirings) {
      if (apart_rad(one.turn, turn) < plumb::rad_from_deg(12.0)) return true;
    }
    return false;
  }
};

/// n sensors about a cone, mounted up to 5 deg off and wired at random. Nothing where a fit refuses what that shows, or
/// where it turns the vector by less than 12 deg.
inline std::optional<RewiredTool> draw_rewired(int n, Noise& noise) {
  plumb::AxisList axes{}, bent{};
  plumb::cone(axes, n);
  for (std::size_t i = 0; i < static_cast<std::size_t>(n); ++i) {
    axes[i] = moved_by(axes[i], 20.0, noise);
    bent[i] = moved_by(axes[i], 5.0, noise);
  }
  RewiredTool out{array_of_axes(axes, n), {}, {}};
  const plumb::SensorArray mounted = array_of_axes(bent, n);
  plumb::Wiring wiring = plumb::Wiring::correct();
  for (int i = n - 1; i > 0; --i)
    std::swap(wiring.source[static_cast<std::size_t>(i)],
              wiring.source[static_cast<std::size_t>(noise.uniform() * (i + 1))]);
  const auto turn = plumb::findings::unseen_turn(mounted, out.nominal, wiring, plumb::kPi);
  if (!turn || apart_rad(*turn, plumb::io::kIdentity3) < plumb::rad_from_deg(12.0)) return std::nullopt;
  for (int i = 0; i < n; ++i) {
    const auto a = static_cast<std::size_t>(i);
    bent[a] = plumb::times(*turn, mounted.axis(wiring.source[a]));
    if (plumb::angle_between_rad(bent[a], axes[a]) > plumb::findings::kUnseenAxis_rad) return std::nullopt;
  }
  out.fitted = array_of_axes(bent, n);
  out.turn = *turn;
  return out;
}

}  // namespace PLUMB_ABI
}  // namespace plumb_test

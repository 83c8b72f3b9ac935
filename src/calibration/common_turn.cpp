/// The common rotation that roll groups asked for, against what the nominal axes know of it.
#include <cmath>

#include "fit_report.hpp"
#include "plumb/numeric/hypotenuse.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

using numbers::at;

namespace fit {
namespace {

/// Axes are known no better than this, frozen ones included: a weight must be finite.
constexpr double kSurest_rad = 1e-6;

/// How each fitted axis is turned from its nominal one (axis times angle, across the nominal axis), and its weight.
struct Turns {
  int size = 0;
  std::array<Vec3, kCapacity> nominal{}, turn{};
  std::array<double, kCapacity> weight{};
};

Turns turns_of(const Datasheet& datasheet, const Parameters& theta) noexcept {
  Turns out;
  out.size = datasheet.size;
  for (int i = 0; i < datasheet.size; ++i) {
    const DatasheetSensor& s = datasheet.sensor[at(i)];
    const Vec3 w = row_of(theta, i), across = cross(s.row.axis, w);
    const double sine = norm(across), sigma = std::fmax(s.prior.axis_rad, kSurest_rad);
    out.nominal[at(i)] = s.row.axis;
    out.weight[at(i)] = 1.0 / (sigma * sigma);
    if (sine > 0.0) out.turn[at(i)] = scaled(across, std::atan2(sine, dot(s.row.axis, w)) / sine);
  }
  return out;
}

/// Part of a common turn that an axis feels.
Vec3 felt(const Vec3& turn, const Vec3& axis) noexcept { return minus(turn, scaled(axis, dot(axis, turn))); }

/// Normal equations of the common turn: `weight` is the inverse of its covariance.
struct TurnSums {
  Symmetric3 weight{};
  Vec3 moment{};
};

TurnSums sums_of(const Turns& t, int left_out) noexcept {
  TurnSums out;
  for (int i = 0; i < t.size; ++i) {
    if (i == left_out) continue;
    const double w = t.weight[at(i)];
    for (const std::size_t diagonal : {0U, 3U, 5U}) out.weight[diagonal] += w;
    add_outer(out.weight, t.nominal[at(i)], -w);
    out.moment = plus(out.moment, scaled(t.turn[at(i)], w));
  }
  return out;
}

/// What the priors of the axes say of what is left once all are turned back; `left_out` has no say.
double chi2_after(const Turns& t, const Vec3& common, int left_out) noexcept {
  double sum = 0.0;
  for (int i = 0; i < t.size; ++i) {
    if (i == left_out) continue;
    const Vec3 rest = minus(t.turn[at(i)], felt(common, t.nominal[at(i)]));
    sum += t.weight[at(i)] * dot(rest, rest);
  }
  return sum;
}

/// The sensor whose own axis, off alone, explains the turns better than a common one; -1 where none does. Both
/// explanations have two numbers more than a rotation about the roll axis, which is not observable.
int lone_axis(const Turns& t, const Vec3& roll_axis, const Vec3& common) noexcept {
  double least = chi2_after(t, common, -1);
  int best = -1;
  for (int i = 0; i < t.size; ++i) {
    const TurnSums others = sums_of(t, i);
    const double weight = dot(roll_axis, times(others.weight, roll_axis));
    const Vec3 about = scaled(roll_axis, weight > 0.0 ? dot(roll_axis, others.moment) / weight : 0.0);
    const double chi2 = chi2_after(t, about, i);
    if (chi2 < least) {
      least = chi2;
      best = i;
    }
  }
  return best;
}

}  // namespace

CommonTurn common_turn(const Datasheet& datasheet, const Vec3& roll_axis, const Parameters& theta) noexcept {
  CommonTurn out;
  const Turns turns = turns_of(datasheet, theta);
  const TurnSums sums = sums_of(turns, -1);
  const Vec3 common = solve(sums.weight, sums.moment);
  const Vec3 across = cross(roll_axis, std::fabs(roll_axis[0]) < 0.7 ? Vec3{1, 0, 0} : Vec3{0, 1, 0});
  const Vec3 first = scaled(across, 1.0 / norm(across));
  const Vec3 second = cross(roll_axis, first);
  // Covariance of the two parts across the roll axis, whatever the third is.
  const Vec3 spread_first = solve(sums.weight, first), spread_second = solve(sums.weight, second);
  const double a = dot(first, spread_first), b = dot(first, spread_second), c = dot(second, spread_second);
  const double determinant = a * c - b * b;
  if (!(determinant > 0.0)) return out;  // axes that lie along one line know nothing of it
  const double x = dot(common, first), y = dot(common, second);
  out.rad = hypotenuse(x, y);
  const double squared_sigmas = (c * x * x - 2.0 * b * x * y + a * y * y) / determinant;
  out.sigma_rad = squared_sigmas > 0.0 ? out.rad / std::sqrt(squared_sigmas) : std::sqrt(0.5 * (a + c));
  out.sensor = lone_axis(turns, roll_axis, common);
  return out;
}

}  // namespace fit
}  // namespace PLUMB_ABI
}  // namespace plumb

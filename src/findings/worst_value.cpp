#include "plumb/findings/worst_value.hpp"

#include <cmath>

#include "plumb/array/geometry.hpp"
#include "plumb/findings/best_turn.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace findings {
namespace {

/// Angle of the axis of sensor i from its nominal one once the others lie on theirs as well as one rotation or mirror
/// allows, and the largest angle among those others.
struct AxisShift {
  double own_rad = 0.0;
  double others_rad = 0.0;
};

AxisShift axis_shift(const SensorArray& fitted, const SensorArray& nominal, int i) {
  BestTurn best;
  for (int k = 0; k < nominal.size(); ++k) {
    if (k != i) best.add(nominal.axis(k), fitted.axis(k));
  }
  // Mirrors too: to gravity a tool and its mirror image are the same, and a sensor of the wrong sign may lead to it.
  const Turn turn = best.find(Hand::free);
  AxisShift out;
  for (int k = 0; k < nominal.size(); ++k) {
    const double angle = angle_between_rad(turned(turn, fitted.axis(k)), nominal.axis(k));
    if (k == i) out.own_rad = angle;
    if (k != i) out.others_rad = std::fmax(out.others_rad, angle);
  }
  return out;
}

/// The sensor without which the axes of all others fit theirs best; -1 with three sensors, whose axes always tell only
/// of each other.
int odd_axis(const SensorArray& fitted, const SensorArray& nominal) {
  int best = -1;
  for (int i = 0; i < nominal.size() && nominal.size() > 3; ++i) {
    if (best < 0 || axis_shift(fitted, nominal, i).others_rad < axis_shift(fitted, nominal, best).others_rad) best = i;
  }
  return best;
}

}  // namespace

WorstValue worst_value(const io::ArrayFile& array, const Calibration& fit, const FitOptions& bound) {
  using Of = WorstValue::Of;
  const int odd = odd_axis(fit.array, array.array);
  double most = 1.0;
  WorstValue out;
  const auto take = [&most, &out](double excess, const WorstValue& value) {
    if (!(excess > most)) return;
    most = excess;
    out = value;
  };
  for (int i = 0; i < array.array.size(); ++i) {
    const auto a = static_cast<std::size_t>(i);
    const SensorCoefficients& now = fit.model.sensor[a];
    const SensorCoefficients& then = array.datasheet.sensor[a].coefficients;
    const double ratio = now.scale[0] / then.scale[0];
    const double shift_rad = i == odd  ? axis_shift(fit.array, array.array, i).own_rad
                             : odd < 0 ? angle_between_rad(fit.array.axis(i), array.array.axis(i))
                                       : 0.0;
    const double bias_mps2 = now.bias[0] * ratio - then.bias[0];
    const double bias_bound = bound.max_bias_sigmas * array.datasheet.sensor[a].prior.bias_mps2;
    take((std::fmax(ratio, 1.0 / ratio) - 1.0) / bound.max_scale_change, {Of::scale, i, ratio, bound.max_scale_change});
    take(shift_rad / bound.max_axis_change_rad, {Of::axis, i, shift_rad, bound.max_axis_change_rad});
    take(std::fabs(bias_mps2) / bias_bound, {Of::bias, i, bias_mps2, bias_bound});
  }
  return out;
}

}  // namespace findings
}  // namespace PLUMB_ABI
}  // namespace plumb

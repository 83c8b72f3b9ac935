#include "temperature_model.hpp"

#include <cmath>
#include <limits>

#include "plumb/core/detail/numbers.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

using numbers::at;
using numbers::kInfinity;

namespace fit {
namespace {

/// Chebyshev amplitude, over the span, of a coefficient of the k-th power: T_k leads with 2^(k-1).
double amplitude(double coefficient, double half_width, int k) noexcept {
  double out = coefficient * half_width;
  for (int power = 1; power < k; ++power) out *= 0.5 * half_width;
  return out;
}

/// The value that the datasheet states holds at T_C; at the middle of the span it is known as well as that and the
/// change up to there.
double widened(double sigma, const Cubic& by_order, int order, double tau) noexcept {
  const Cubic t = chebyshev_values(std::fmin(std::fmax(tau, -1.0), 1.0));
  double variance = sigma * sigma;
  for (int k = 1; k <= order; ++k) variance += by_order[at(k)] * by_order[at(k)] * t[at(k)] * t[at(k)];
  return std::sqrt(variance);
}

double sum_of(const Cubic& c, const Cubic& t) noexcept { return c[0] * t[0] + c[1] * t[1] + c[2] * t[2] + c[3] * t[3]; }

}  // namespace

Joint::Joint(const Datasheet& nominal_sheet, const ChebyshevSpan& use, int highest_order) noexcept
    : datasheet(nominal_sheet),
      use_degc(use),
      order(highest_order),
      sign(nominal_sheet.reads == Reads::gravity ? 1.0 : -1.0),
      sheet(nominal_sheet),
      nominal(),
      roots() {
  nominal.theta = datasheet_parameters(nominal_sheet);
  const double half = use.half_width();
  for (int i = 0; i < nominal_sheet.size; ++i) {
    DatasheetSensor& s = sheet.sensor[at(i)];
    const double reference = s.coefficients.reference_degc;
    Cubic scale = chebyshev_from_powers(s.coefficients.scale, use, reference);
    const double mean = scale[0];
    for (double& c : scale) c = mean != 0.0 ? c / mean : kInfinity;  // which no station survives
    Cubic bias = chebyshev_from_powers(s.coefficients.bias, use, reference);
    for (double& c : bias) c *= sign;
    nominal.scale[at(i)] = scale;
    nominal.bias[at(i)] = bias;
    s.coefficients.scale = {mean, 0.0, 0.0, 0.0};
    s.coefficients.bias = {};
    s.full_scale_raw = 0.0;  // judged on what was recorded, not on what it is reduced to
    for (int j = 1; j <= order; ++j) {
      scale_sigma[at(i)][at(j)] = amplitude(s.prior.scale_t[at(j - 1)], half, j);
      bias_sigma[at(i)][at(j)] = amplitude(s.prior.bias_t_mps2[at(j - 1)], half, j);
    }
    s.prior.scale = widened(s.prior.scale, scale_sigma[at(i)], order, use.scaled(reference));
    s.prior.bias_mps2 = widened(s.prior.bias_mps2, bias_sigma[at(i)], order, use.scaled(reference));
  }
  roots = prior_roots(sheet);
}

Station reduced(const Joint& joint, const JointState& state, const Station& station) noexcept {
  Station out = station;
  out.delivered = usable_channels(joint.datasheet, station);
  out.roll_group = 0;
  const Cubic t = chebyshev_values(joint.use_degc.scaled(station.temperature_degc));
  for (int i = 0; i < joint.sensors(); ++i) {
    const double mean = joint.sheet.sensor[at(i)].coefficients.scale[0];
    const double offset = joint.sign * mean * sum_of(state.bias[at(i)], t);
    const double scale = sum_of(state.scale[at(i)], t);
    out.mean[at(i)] = scale != 0.0 ? station.mean[at(i)] / scale - offset : kInfinity;
  }
  return out;
}

void reduce_all(const Joint& joint, const JointState& state, const Station* stations, int count, Station* to) noexcept {
  for (int k = 0; k < count; ++k) {
    const bool out = to[k].count == 0;
    to[k] = reduced(joint, state, stations[k]);
    if (out) to[k].count = 0;
  }
}

JointVector joint_prior_units(const Joint& joint, const JointState& state) noexcept {
  const Parameters x = prior_units(joint.sheet, state.theta);
  JointVector out{};
  const int per = joint.per_sensor();
  for (int i = 0; i < joint.sensors(); ++i) {
    for (int p = 0; p < 4; ++p) out[at(per * i + p)] = x[at(4 * i + p)];
    for (int j = 1; j <= joint.order; ++j) {
      const std::size_t k = at(per * i + 2 + 2 * j), a = at(i), o = at(j);
      out[k] = (state.scale[a][o] - joint.nominal.scale[a][o]) / joint.scale_sigma[a][o];
      out[k + 1] = (state.bias[a][o] - joint.nominal.bias[a][o]) / joint.bias_sigma[a][o];
    }
  }
  return out;
}

void add_terms(const Joint& joint, const JointVector& step, JointState& state) noexcept {
  const int per = joint.per_sensor();
  for (int i = 0; i < joint.sensors(); ++i) {
    for (int j = 1; j <= joint.order; ++j) {
      const std::size_t k = at(per * i + 2 + 2 * j), a = at(i), o = at(j);
      state.scale[a][o] += joint.scale_sigma[a][o] * step[k];
      state.bias[a][o] += joint.bias_sigma[a][o] * step[k + 1];
    }
  }
}

Datasheet with_polynomials(const Joint& joint, const JointState& state) noexcept {
  Datasheet out = joint.datasheet;
  for (int i = 0; i < joint.sensors(); ++i) {
    SensorCoefficients& c = out.sensor[at(i)].coefficients;
    Cubic scale = state.scale[at(i)], bias = state.bias[at(i)];
    for (double& term : scale) term *= joint.sheet.sensor[at(i)].coefficients.scale[0];
    for (double& term : bias) term *= joint.sign;
    c.scale = powers_from_chebyshev(scale, joint.use_degc, c.reference_degc);
    c.bias = powers_from_chebyshev(bias, joint.use_degc, c.reference_degc);
  }
  return out;
}

}  // namespace fit
}  // namespace PLUMB_ABI
}  // namespace plumb

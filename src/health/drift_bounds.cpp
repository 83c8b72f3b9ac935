#include "plumb/health/detail/drift_bounds.hpp"

#include <cmath>

#include "plumb/core/detail/numbers.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

using numbers::at;

namespace {

/// Of a scale, relative: beyond what any drift sigma that a configuration may name lets pass (three times 0.1).
constexpr double kMostChange = 0.5;

/// Not fmax, for which a NaN is no number: here it breaks every bound.
double larger_or_nan(double a, double b) noexcept { return std::isnan(a) || b <= a ? a : b; }

}  // namespace

void CoefficientChange::write(SensorSet sensors, SensorModel& model) const noexcept {
  for (int i = 0; i < model.size; ++i) {
    if (!sensors.has(i)) continue;
    SensorCoefficients& c = model.sensor[at(i)];
    c.bias[0] += shift_mps2[at(i)];
    for (std::size_t k = 0; k < 4; ++k) {
      c.scale[k] *= length[at(i)];
      c.bias[k] /= length[at(i)];
    }
  }
}

RowChange CoefficientChange::on_rows(SensorSet sensors, const SensorArray& array) const noexcept {
  RowChange change;
  for (int i = 0; i < array.size(); ++i) {
    if (!sensors.has(i)) continue;
    for (int p = 0; p < 3; ++p) change.of[at(4 * i + p)] = (length[at(i)] - 1.0) * array.axis(i)[at(p)];
    change.of[at(4 * i + 3)] = shift_mps2[at(i)];
  }
  return change;
}

void RowChange::doubt(const SensorArray& array, RowUncertainty& uncertainty) const noexcept {
  for (int a = 0; a < 4 * array.size(); ++a) {
    for (int b = 0; b <= a; ++b) uncertainty.covariance[at(a * (a + 1) / 2 + b)] += of[at(a)] * of[at(b)];
  }
}

void DriftBounds::begin(const SensorModel& commissioning, const std::array<DriftSigmas, kCapacity>& drift) noexcept {
  drift_ = drift;
  commission(commissioning);
  adopted_s_ = 0.0;
  adopted_ = false;
}

void DriftBounds::commission(const SensorModel& model) noexcept {
  for (int i = 0; i < kCapacity; ++i) {
    scale_[at(i)] = model.sensor[at(i)].scale[0];
    bias_mps2_[at(i)] = model.sensor[at(i)].bias[0];
  }
}

void DriftBounds::note_adoption(double time_s, bool in_flight) noexcept {
  adopted_s_ = time_s;
  adopted_ = adopted_ || in_flight;
}

double DriftBounds::sigmas_off(int i, double scale_ratio, double bias_change_mps2) const noexcept {
  return larger_or_nan(std::fabs(scale_ratio - 1.0) / sigma(i).scale, std::fabs(bias_change_mps2) / sigma(i).bias_mps2);
}

Error DriftBounds::check(const CoefficientChange& change, SensorSet sensors, const SensorModel& model,
                         double time_s) const noexcept {
  for (int i = 0; i < model.size; ++i) {
    const double stretch = std::fabs(change.length[at(i)] - 1.0);
    if (sensors.has(i) && !(stretch <= kMostChange)) return Error{Errc::implausible, i, stretch, kMostChange};
  }
  SensorModel next = model;
  change.write(sensors, next);
  double last = kLastSigmas;
  if (adopted_) {
    const double hours = (time_s - adopted_s_) / 3600.0;
    last = std::fmin(last, kSigmasPerHour * std::fmax(hours, kLeastHours));
  }
  for (int i = 0; i < model.size; ++i) {
    if (!sensors.has(i)) continue;
    const SensorCoefficients& to = next.sensor[at(i)];
    const SensorCoefficients& from = model.sensor[at(i)];
    const double since_last = sigmas_off(i, to.scale[0] / from.scale[0], to.bias[0] - from.bias[0]);
    const double since_commissioning = sigmas_off(i, to.scale[0] / scale_[at(i)], to.bias[0] - bias_mps2_[at(i)]);
    if (!(since_last <= last)) return Error{Errc::implausible, i, since_last, last};
    if (!(since_commissioning <= kCommissioningSigmas))
      return Error{Errc::implausible, i, since_commissioning, kCommissioningSigmas};
  }
  return Error{};
}

bool DriftBounds::allow(const SensorModel& model) const noexcept {
  for (int i = 0; i < model.size; ++i) {
    const SensorCoefficients& c = model.sensor[at(i)];
    const double off = sigmas_off(i, c.scale[0] / scale_[at(i)], c.bias[0] - bias_mps2_[at(i)]);
    if (!(off <= kCommissioningSigmas)) return false;
  }
  return true;
}

SensorModel DriftBounds::commissioned(const SensorModel& like) const noexcept {
  SensorModel out = like;
  for (int i = 0; i < out.size; ++i) {
    out.sensor[at(i)].scale[0] = scale_[at(i)];
    out.sensor[at(i)].bias[0] = bias_mps2_[at(i)];
  }
  return out;
}

bool DriftBounds::commissioned_as(const SensorModel& model) const noexcept {
  for (int i = 0; i < model.size; ++i) {
    const SensorCoefficients& c = model.sensor[at(i)];
    if (scale_[at(i)] != c.scale[0] || bias_mps2_[at(i)] != c.bias[0]) return false;
  }
  return true;
}

}  // namespace PLUMB_ABI
}  // namespace plumb

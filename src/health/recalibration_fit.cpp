// The shadow fit: what it is made from, and what it must show before it is believed.
#include <cmath>

#include "plumb/health/held_axis.hpp"
#include "plumb/health/recalibration.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

namespace {

constexpr std::size_t at(int i) noexcept { return static_cast<std::size_t>(i); }

/// Bias and scale of a sensor are observed where the stations, not the drift sigma, give at least this share.
constexpr double kLeastDataShare = 0.75;
/// How seldom the residuals of a good fit may be so large. A refusal costs time only.
constexpr double kLeastProbability = 1e-4;
/// Of a scale, relative: beyond what any drift sigma that a configuration may name lets pass (three times 0.1).
constexpr double kMostChange = 0.5;

/// Not fmax, for which a NaN is no number: here it breaks every bound.
double larger(double a, double b) noexcept { return std::isnan(a) || b <= a ? a : b; }

}  // namespace

/// The fit knows the fitted sensors only, in the order of the array; the noise of a row of its datasheet is that of a
/// station.
StationList Recalibration::fit_stations() const noexcept {
  return {store_.data(), store_.size(), sensors_, StationStore::kHeldOutStride};
}

/// 1 sigma of a station's reading that biases and scales cannot explain: noise and misfit, drawn anew at every station,
/// and what the held axis leaves. All stations weigh as the shortest: more noise is feigned than there is, at the
/// others.
Recalibration::ReadingError Recalibration::reading_error(const SensorArray& array, const GravityReference& gravity,
                                                         int i) const noexcept {
  double samples = 0.0;
  for (int k = 0; k < store_.size(); ++k) {
    const double n = store_.station(k).samples;
    if (samples == 0.0 || n < samples) samples = n;
  }
  const Vec3& h = array.axis(i);
  const RowUncertainty& u = array.uncertainty();
  double across = 0.0;  // trace of (1 - hh') C (1 - hh')
  for (int p = 0; p < 3; ++p) {
    for (int q = 0; q < 3; ++q) {
      const int a = 4 * i + (p > q ? p : q), b = 4 * i + (p > q ? q : p);
      across += ((p == q ? 1.0 : 0.0) - h[at(p)] * h[at(q)]) * u.covariance[at(a * (a + 1) / 2 + b)];
    }
  }
  const double misfit = u.misfit_mps2[at(i)];
  const double sigma = array.sigma_mps2(i);
  const double mean_square = gravity.g_mps2 * gravity.g_mps2 / 3.0;  // of a component of gravity over the sphere
  ReadingError out;
  out.noise_mps2_sq = sigma * sigma / std::fmax(samples, 1.0) + misfit * misfit;
  out.total_mps2_sq = out.noise_mps2_sq + (first() ? 0.0 : std::fmax(across, 0.0) * mean_square);
  return out;
}

Datasheet Recalibration::datasheet(const InForce& in_force) const noexcept {
  Datasheet out;
  out.reads = in_force.model.reads;
  for (int i = 0; i < in_force.array.size(); ++i) {
    if (!sensors_.has(i)) continue;
    DatasheetSensor& sensor = out.sensor[at(out.size++)];
    sensor.row = in_force.array.row(i);
    sensor.row.sigma_mps2 = std::sqrt(reading_error(in_force.array, in_force.gravity, i).total_mps2_sq);
    sensor.coefficients = in_force.model.sensor[at(i)];
    sensor.prior =
        first() ? prior_in(in_force.array, i) : Prior{drift_[at(i)].bias_mps2, drift_[at(i)].scale, 0.0, {}, {}};
  }
  return out;
}

bool Recalibration::uncertainty_of_fit(const SensorArray& array, const GravityReference& gravity, RowUncertainty& out,
                                       SensorSet& lacking) const noexcept {
  HeldAxisFit fit;
  fit.sensors = sensors_;
  fit.station = store_.data();
  fit.count = store_.size();
  fit.left_out = offered() ? 0 : StationStore::kHeldOutStride;
  fit.inflation = inflation_;
  fit.noise_share = 0.0;
  for (int i = 0; i < array.size(); ++i) {
    if (!sensors_.has(i)) continue;
    const ReadingError error = reading_error(array, gravity, i);
    fit.sigma_mps2[at(i)] = std::sqrt(error.total_mps2_sq);
    fit.noise_share = std::fmax(fit.noise_share, error.noise_mps2_sq / error.total_mps2_sq);
    fit.prior[at(i)] = {drift_[at(i)].bias_mps2, drift_[at(i)].scale};
  }
  std::array<double, kCapacity> data_share{};
  if (!held_axis_uncertainty(array, gravity, fit, out, data_share)) return false;
  lacking = SensorSet{};
  for (int i = 0; i < array.size(); ++i) {
    if (sensors_.has(i) && !(data_share[at(i)] >= kLeastDataShare)) lacking = lacking.with(i);
  }
  return true;
}

/// Do the attitudes on record tell bias from scale for every sensor? If not, which sensors ask for others.
[[gnu::noinline]] bool Recalibration::ready(const InForce& in_force) noexcept {
  untried_ = false;
  inflation_ = 1.0;
  if (first()) return attitudes_suffice(in_force.array);
  RowUncertainty uncertainty;
  return uncertainty_of_fit(in_force.array, in_force.gravity, uncertainty, lacking_) && lacking_.empty();
}

/// Takes the fitted figures over; `ok` where the fit itself is sound.
[[gnu::noinline]] Error Recalibration::read_fit(const InForce& in_force) noexcept {
  HeldFit report;
  Error error = calibrator_.finish_held(fit_stations(), report);
  const int needed = 2 * sensors_.size();
  if (error.code != Errc::ok) {
    error.index = -1;  // counted among the fitted sensors only
    return error;
  }
  if (report.rank < needed) {
    return Error{Errc::unobservable, -1, static_cast<double>(report.rank), static_cast<double>(needed)};
  }
  inflation_ = std::fmax(1.0, report.chi2_per_freedom());
  int row = 0;
  for (int i = 0; i < kCapacity; ++i) {
    if (!sensors_.has(i)) continue;
    const SensorCoefficients& old = in_force.model.sensor[at(i)];
    const double length = report.length[at(row)];
    const double bias_mps2 = (old.bias[0] + report.bias_mps2[at(row++)]) / length;
    length_[at(i)] = old.scale[0] * length / old.scale[0];
    shift_mps2_[at(i)] = bias_mps2 * length_[at(i)] - old.bias[0];
  }
  if (!(report.p_value >= kLeastProbability)) {
    return Error{Errc::poor_fit, -1, report.p_value, kLeastProbability};
  }
  return Error{};
}

void Recalibration::write_coefficients(SensorModel& model) const noexcept {
  for (int i = 0; i < model.size; ++i) {
    if (!sensors_.has(i)) continue;
    SensorCoefficients& c = model.sensor[at(i)];
    c.bias[0] += shift_mps2_[at(i)];
    for (std::size_t k = 0; k < 4; ++k) {
      c.scale[k] *= length_[at(i)];
      c.bias[k] /= length_[at(i)];
    }
  }
}

bool Recalibration::uncertainty_after(const SensorArray& array, const GravityReference& gravity,
                                      RowUncertainty& out) const noexcept {
  if (offered()) {
    uncertainty_of_offer(array, out);
    return true;
  }
  SensorSet lacking;
  return uncertainty_of_fit(array, gravity, out, lacking);
}

/// If the old coefficients were right after all, the new ones err by exactly the change: scale along the axis, and
/// bias.
Recalibration::Change Recalibration::whole_change(const SensorArray& array) const noexcept {
  Change change{};
  for (int i = 0; i < array.size(); ++i) {
    if (!sensors_.has(i)) continue;
    for (int p = 0; p < 3; ++p) change[at(4 * i + p)] = (length_[at(i)] - 1.0) * array.axis(i)[at(p)];
    change[at(4 * i + 3)] = shift_mps2_[at(i)];
  }
  return change;
}

void Recalibration::add_change(const SensorArray& array, const Change& change, RowUncertainty& uncertainty) noexcept {
  for (int a = 0; a < 4 * array.size(); ++a) {
    for (int b = 0; b <= a; ++b) uncertainty.covariance[at(a * (a + 1) / 2 + b)] += change[at(a)] * change[at(b)];
  }
}

/// Bounds on the change of bias and scale, each in its drift sigma. A length that was read back is tried before it is
/// divided by.
Error Recalibration::check_bounds(const SensorModel& model, double time_s) const noexcept {
  for (int i = 0; i < model.size; ++i) {
    const double change = std::fabs(length_[at(i)] - 1.0);
    if (sensors_.has(i) && !(change <= kMostChange)) return Error{Errc::implausible, i, change, kMostChange};
  }
  SensorModel next = model;
  write_coefficients(next);
  double last = kLastSigmas;
  if (adopted_) {
    const double hours = (time_s - adopted_s_) / 3600.0;
    last = std::fmin(last, kSigmasPerHour * std::fmax(hours, kLeastHours));
  }
  for (int i = 0; i < model.size; ++i) {
    if (!sensors_.has(i)) continue;
    const SensorCoefficients& to = next.sensor[at(i)];
    const SensorCoefficients& from = model.sensor[at(i)];
    const double since_last = larger(std::fabs(to.scale[0] / from.scale[0] - 1.0) / drift_[at(i)].scale,
                                     std::fabs(to.bias[0] - from.bias[0]) / drift_[at(i)].bias_mps2);
    const double since_commissioning =
        larger(std::fabs(to.scale[0] / commissioned_scale_[at(i)] - 1.0) / drift_[at(i)].scale,
               std::fabs(to.bias[0] - commissioned_bias_mps2_[at(i)]) / drift_[at(i)].bias_mps2);
    if (!(since_last <= last)) return Error{Errc::implausible, i, since_last, last};
    if (!(since_commissioning <= kCommissioningSigmas)) {
      return Error{Errc::implausible, i, since_commissioning, kCommissioningSigmas};
    }
  }
  return Error{};
}

SensorModel Recalibration::commissioned(const SensorModel& like) const noexcept {
  SensorModel out = like;
  for (int i = 0; i < out.size; ++i) {
    out.sensor[at(i)].scale[0] = commissioned_scale_[at(i)];
    out.sensor[at(i)].bias[0] = commissioned_bias_mps2_[at(i)];
  }
  return out;
}

bool Recalibration::commissioned_as(const SensorModel& model) const noexcept {
  for (int i = 0; i < model.size; ++i) {
    const SensorCoefficients& c = model.sensor[at(i)];
    if (commissioned_scale_[at(i)] != c.scale[0] || commissioned_bias_mps2_[at(i)] != c.bias[0]) return false;
  }
  return true;
}

/// In force can only be what the bounds have let pass.
bool Recalibration::coefficients_are_plausible(const SensorModel& model) const noexcept {
  for (int i = 0; i < model.size; ++i) {
    const SensorCoefficients& c = model.sensor[at(i)];
    const double scale = std::fabs(c.scale[0] / commissioned_scale_[at(i)] - 1.0) / drift_[at(i)].scale;
    const double bias = std::fabs(c.bias[0] - commissioned_bias_mps2_[at(i)]) / drift_[at(i)].bias_mps2;
    if (!(scale <= kCommissioningSigmas && bias <= kCommissioningSigmas)) return false;
  }
  return true;
}

[[gnu::noinline]] Error Recalibration::check_fit(const InForce& in_force) const noexcept {
  RowUncertainty uncertainty;
  if (!uncertainty_after(in_force.array, in_force.gravity, uncertainty)) return Error{Errc::diverged, -1};
  return try_stations(in_force, uncertainty);
}

[[gnu::noinline]] Error Recalibration::try_stations(const InForce& in_force,
                                                    const RowUncertainty& uncertainty) const noexcept {
  SensorModel model = in_force.model;
  write_coefficients(model);
  return check_stations({model, in_force.array, in_force.gravity, in_force.limits}, uncertainty);
}

/// Every station against the new calibration, by the tests and limits of the monitor: those of the fit, and those
/// that were held out of it (property S20).
Error Recalibration::check_stations(const InForce& candidate, const RowUncertainty& uncertainty) const noexcept {
  int proofs = 0;
  for (int k = 0; k < store_.size(); ++k) {
    const StationMean& station = store_.station(k);
    BlockEvidence evidence;
    evidence.mean_mps2 = candidate.model.apply(station.raw, station.temperature_degc, sensors_);
    evidence.usable = sensors_;
    evidence.samples = station.samples;
    const SetTest test =
        test_set(candidate.array, uncertainty, candidate.gravity, candidate.limits, evidence, sensors_);
    const bool held_out = is_proof(k);
    const Errc code = held_out ? Errc::not_confirmed : Errc::poor_fit;
    if (!test.tested) return Error{code, k};
    const double parity_limit = test.parity_rows > 0 ? test.parity_alarm_limit(candidate.limits) : 0.0;
    if (!(test.parity <= parity_limit)) return Error{code, k, test.parity, parity_limit};
    const double norm_limit = test.norm_alarm_limit(candidate.limits);
    if (!(std::fabs(test.norm) <= norm_limit)) return Error{code, k, std::fabs(test.norm), norm_limit};
    if (held_out) ++proofs;
  }
  // Whatever is collected elsewhere: no fit is accepted on its own stations alone.
  if (proofs < kHeldOutNeeded) return Error{Errc::too_few_stations, -1, 1.0 * proofs, 1.0 * kHeldOutNeeded};
  return Error{};
}

Recalibration::Outcome Recalibration::judge(const InForce& in_force, double time_s) noexcept {
  if (first()) return judge_first(in_force);
  Error error = offered() ? Error{} : read_fit(in_force);
  if (error.code == Errc::ok) error = check_bounds(in_force.model, time_s);
  if (error.code == Errc::ok) error = check_fit(in_force);
  if (error.code == Errc::ok) {
    phase_ = RecalibrationPhase::accepted;
    return Outcome::accepted;
  }
  stop();  // nor are its stations tried again
  refusal_ = error;
  return Outcome::rejected;
}

}  // namespace PLUMB_ABI
}  // namespace plumb

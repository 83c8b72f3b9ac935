// A fit in flight: what it is made from, and what it must show before it is believed.
#include <cmath>

#include "plumb/core/detail/numbers.hpp"
#include "plumb/health/detail/held_axis.hpp"
#include "plumb/numeric/tails.hpp"
#include "recalibration_kinds.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

using numbers::at;

namespace {

/// What the fit cannot explain is a reason to refuse it; nothing is asked of the axes.
[[gnu::noinline]] FitOptions held_axes() noexcept {
  FitOptions out;
  out.estimate_misfit = false;
  out.require_full_rank = false;
  return out;
}

}  // namespace

bool Recalibration::InFlight::uncertainty(const Recalibration& r, const SensorArray& array,
                                          const GravityReference& gravity, int held_out, RowUncertainty& out,
                                          SensorSet& lacking) noexcept {
  HeldAxisFit fit;
  fit.sensors = r.sensors_;
  fit.station = r.store_.data();
  fit.count = r.store_.size();
  fit.left_out = held_out;
  fit.inflation = r.inflation_;
  fit.noise_share = 0.0;
  for (int i = 0; i < array.size(); ++i) {
    if (!r.sensors_.has(i)) continue;
    const ReadingError error = r.reading_error(array, gravity, i);
    fit.sigma_mps2[at(i)] = std::sqrt(error.total_mps2_sq);
    fit.noise_share = std::fmax(fit.noise_share, error.noise_mps2_sq / error.total_mps2_sq);
    fit.prior[at(i)] = {r.bounds_.sigma(i).bias_mps2, r.bounds_.sigma(i).scale};
  }
  std::array<double, kCapacity> data_share{};
  if (!held_axis_uncertainty(array, gravity, fit, out, data_share)) return false;
  lacking = SensorSet{};
  for (int i = 0; i < array.size(); ++i) {
    if (r.sensors_.has(i) && !(data_share[at(i)] >= kLeastDataShare)) lacking = lacking.with(i);
  }
  return true;
}

[[gnu::noinline]] bool Recalibration::InFlight::ready(Recalibration& r, const InForce& in_force,
                                                      int held_out) noexcept {
  r.untried_ = false;
  r.inflation_ = 1.0;
  RowUncertainty left;
  return uncertainty(r, in_force.array, in_force.gravity, held_out, left, r.lacking_) && r.lacking_.empty();
}

Recalibration::Outcome Recalibration::InFlight::collect(Recalibration& r, const InForce& in_force, double) noexcept {
  if (r.untried_ && r.store_.size() >= stations_due(r) && ready(r, in_force, StationStore::kHeldOutStride))
    r.begin_fit(in_force, held_axes());
  return Outcome::none;
}

void Recalibration::InFlight::iterate(Recalibration& r) noexcept { r.calibrator_.iterate_held(r.fit_stations()); }

/// Takes the fitted figures over; `ok` where the fit itself is sound.
[[gnu::noinline]] Error Recalibration::InFlight::read_fit(Recalibration& r, const InForce& in_force) noexcept {
  HeldFit report;
  Error error = r.calibrator_.finish_held(r.fit_stations(), report);
  const int needed = 2 * r.sensors_.size();
  if (error.code != Errc::ok) {
    error.index = -1;  // counted among the fitted sensors only
    return error;
  }
  if (report.rank < needed)
    return Error{Errc::unobservable, -1, static_cast<double>(report.rank), static_cast<double>(needed)};
  constexpr double kBeyond = 0.01;  // of fits that err more than limits allow for
  const double wider = estimated_sigma_widening(report.chi2, report.degrees_of_freedom, kBeyond, needed);
  r.inflation_ = std::fmax(1.0, report.chi2_per_freedom()) * wider * wider;
  int row = 0;
  for (int i = 0; i < kCapacity; ++i) {
    if (!r.sensors_.has(i)) continue;
    const SensorCoefficients& old = in_force.model.sensor[at(i)];
    const double length = report.length[at(row)];
    const double bias_mps2 = (old.bias[0] + report.bias_mps2[at(row++)]) / length;
    r.change_.length[at(i)] = old.scale[0] * length / old.scale[0];
    r.change_.shift_mps2[at(i)] = bias_mps2 * r.change_.length[at(i)] - old.bias[0];
  }
  if (!(report.p_value >= kLeastProbability)) return Error{Errc::poor_fit, -1, report.p_value, kLeastProbability};
  return Error{};
}

[[gnu::noinline]] Error Recalibration::InFlight::try_fit(const Recalibration& r, const InForce& in_force) noexcept {
  RowUncertainty left;
  SensorSet lacking;
  if (!uncertainty(r, in_force.array, in_force.gravity, StationStore::kHeldOutStride, left, lacking))
    return Error{Errc::diverged, -1};
  return r.try_change(in_force, left);
}

Recalibration::Outcome Recalibration::InFlight::judge(Recalibration& r, const InForce& in_force,
                                                      double time_s) noexcept {
  Error error = read_fit(r, in_force);
  if (error.code == Errc::ok) error = r.check_bounds(in_force.model, time_s);
  if (error.code == Errc::ok) error = try_fit(r, in_force);
  return error.code == Errc::ok ? r.accept() : r.reject(error);
}

void Recalibration::InFlight::apply(Recalibration& r, const Adoption& into) noexcept {
  RowUncertainty left;
  SensorSet lacking;
  if (!uncertainty(r, into.array, into.gravity, StationStore::kHeldOutStride, left, lacking))
    left = into.array.uncertainty();
  if (into.doubted) r.change_.on_rows(r.sensors_, into.array).doubt(into.array, left);
  r.adopt_change(into, left);
}

bool Recalibration::InFlight::resume(Recalibration& r, const InForce& in_force) noexcept {
  if (r.phase_ == RecalibrationPhase::idle || r.phase_ == RecalibrationPhase::collecting) return true;
  if (!r.stations_suffice()) return false;
  if (r.phase_ == RecalibrationPhase::accepted) return r.change_is_sound(in_force.model);
  // Gravity may have been set since the fit began.
  r.calibrator_.resume(r.datasheet({in_force.model, in_force.array, r.calibrator_.gravity(), in_force.limits}),
                       held_axes());
  return true;
}

}  // namespace PLUMB_ABI
}  // namespace plumb

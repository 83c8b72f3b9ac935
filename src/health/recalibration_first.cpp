// The first calibration of a monitor that was given none: when it is tried, and what it must show before it is
// believed. A fit that is not corroborated is refused, whatever it costs in stations: before it there is no output at
// all, after it there is.
#include <cmath>

#include "plumb/calibration/acceptance.hpp"
#include "plumb/calibration/observability.hpp"
#include "plumb/core/detail/numbers.hpp"
#include "recalibration_kinds.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

using numbers::at;

namespace {

/// The nine harmonics of gravity that its length sees need nine directions ...
constexpr int kHarmonicDirections = 9;
/// ... and so many more, so that the residuals can contradict the fit. Three sensors have nothing but the length.
constexpr int kSpare = 4, kSpareOfThree = 6;
/// A sensor along whose axis gravity has changed by less than this part of it is the first to ask for more.
constexpr double kLeastSpan = 1.0;

/// Nothing is held, and a station unlike the others is a tool that has changed.
[[gnu::noinline]] FitOptions free_axes() noexcept {
  FitOptions out;
  out.estimate_misfit = false;
  out.require_full_rank = true;
  out.max_outlier_share = 0.0;
  out.max_bias_sigmas = Recalibration::kFirstSigmas;
  return out;
}

/// The k-th of a set; -1 where it has none.
int member(SensorSet set, int k) noexcept {
  for (; k > 0; --k) set = set.without(set.lowest());
  return set.lowest();
}

}  // namespace

int Recalibration::first_stations_needed(int n) noexcept {
  const int fitted = kHarmonicDirections + (n > 3 ? kSpare : kSpareOfThree);
  int needed = kHeldOutNeeded * StationStore::kHeldOutStride;
  while (needed - needed / StationStore::kHeldOutStride < fitted) ++needed;
  return needed;
}

/// Do the directions of the fit tell the parameters apart? If not, which sensors ask for others.
bool Recalibration::First::attitudes_suffice(Recalibration& r, const SensorArray& array) noexcept {
  std::array<Vec3, StationStore::kMax> direction{};
  int count = 0;
  for (int k = 0; k < r.store_.size(); ++k) {
    if (!StationStore::held_out(k)) direction[at(count++)] = r.store_.station(k).direction;
  }
  r.lacking_ = SensorSet{};
  if (excitation_of(direction.data(), count) >= kFirstExcitation) return true;
  for (int i = 0; i < array.size(); ++i) {
    if (!r.sensors_.has(i)) continue;
    double low = 1.0, high = -1.0;
    for (int k = 0; k < count; ++k) {
      const double along = dot(array.axis(i), direction[at(k)]);
      low = std::fmin(low, along);
      high = std::fmax(high, along);
    }
    if (!(high - low >= kLeastSpan)) r.lacking_ = r.lacking_.with(i);
  }
  if (r.lacking_.empty()) r.lacking_ = r.sensors_;
  return false;
}

Error Recalibration::off_datasheet(const SensorModel& datasheet, const SensorArray& uncertain, const SensorModel& model,
                                   const SensorArray& array, SensorSet sensors) noexcept {
  for (int i = 0; i < array.size(); ++i) {
    if (!sensors.has(i)) continue;
    const Prior prior = prior_in(uncertain, i);
    const SensorCoefficients &was = datasheet.sensor[at(i)], &now = model.sensor[at(i)];
    const double length = now.scale[0] / was.scale[0];
    const std::array<double, 3> sigmas = {std::fabs(now.bias[0] * length - was.bias[0]) / prior.bias_mps2,
                                          std::fabs(length - 1.0) / prior.scale,
                                          angle_between_rad(array.axis(i), uncertain.axis(i)) / prior.axis_rad};
    for (const double off : sigmas) {
      if (!(off <= kFirstSigmas)) return Error{Errc::implausible, i, off, kFirstSigmas};
    }
  }
  return Error{};
}

/// What the report alone tells: does every parameter stand on the stations, are the residuals noise?
Error Recalibration::First::check_figures(Recalibration& r, const FitReport& report) noexcept {
  double least = 1.0;
  for (int p = 0; p < 4 * r.sensors_.size(); ++p) {
    const double share = report.data_share[at(p)];
    if (!(share >= kLeastDataShare)) r.lacking_ = r.lacking_.with(member(r.sensors_, p / 4));
    least = std::fmin(least, share);
  }
  if (!r.lacking_.empty()) return Error{Errc::unobservable, r.lacking_.lowest(), least, kLeastDataShare};
  if (!(report.p_value >= kLeastProbability)) return Error{Errc::poor_fit, -1, report.p_value, kLeastProbability};
  return Error{};
}

int Recalibration::First::copy_stations(const Recalibration& r, Stations& out) noexcept {
  const StationList list = r.fit_stations();
  for (int k = 0; k < list.size(); ++k) out[at(k)] = list[k];
  return list.size();
}

[[gnu::noinline]] Recalibration::Outcome Recalibration::First::collect(Recalibration& r, const InForce& in_force,
                                                                       double) noexcept {
  if (!r.untried_ || r.store_.size() < stations_due(r)) return Outcome::none;
  r.untried_ = false;
  r.inflation_ = 1.0;
  if (attitudes_suffice(r, in_force.array)) r.begin_fit(in_force, free_axes());
  return Outcome::none;
}

/// Axes that are free need room that held ones do not.
[[gnu::noinline]] void Recalibration::First::iterate(Recalibration& r) noexcept {
  Stations stations;
  r.calibrator_.iterate(stations.data(), copy_stations(r, stations));
}

/// The stations are needed until there is a fit, and no longer.
[[gnu::noinline]] Expected<Calibration> Recalibration::First::finish(const Recalibration& r) noexcept {
  Stations stations;
  const int count = copy_stations(r, stations);
  return r.calibrator_.finish(stations.data(), count);
}

namespace {

/// Writes a full fit over `sensors` into model and array; false, and nothing is written, where its axes are none.
bool install(const Calibration& fit, SensorSet sensors, SensorModel& model, SensorArray& array) noexcept {
  std::array<SensorRow, kCapacity> rows{};
  std::array<int, kCapacity> fitted{};
  std::array<double, kCapacity> length{};
  fitted.fill(-1);
  int count = 0;
  for (int i = 0; i < array.size(); ++i) {
    rows[at(i)] = array.row(i);
    length[at(i)] = 1.0;
    if (!sensors.has(i)) continue;
    fitted[at(i)] = count++;
    const int k = fitted[at(i)];
    length[at(i)] = fit.model.sensor[at(k)].scale[0] / model.sensor[at(i)].scale[0];
    rows[at(i)].axis = fit.array.axis(k);
    rows[at(i)].sigma_mps2 /= length[at(i)];
  }
  if (!array.set_rows(rows.data())) return false;
  RowUncertainty out = array.uncertainty();
  const RowUncertainty& found = fit.array.uncertainty();
  const auto packed = [](int a, int b) { return at(a * (a + 1) / 2 + b); };  // b <= a, and so are those fitted
  for (int a = 0; a < 4 * array.size(); ++a) {
    for (int b = 0; b <= a; ++b) {
      const int i = fitted[at(a / 4)], j = fitted[at(b / 4)];
      if (i >= 0 && j >= 0) {
        out.covariance[packed(a, b)] = found.covariance[packed(4 * i + a % 4, 4 * j + b % 4)];
      } else if (i >= 0 || j >= 0) {
        out.covariance[packed(a, b)] = 0.0;
      }
    }
  }
  out.common_scale = found.common_scale;
  for (int i = 0; i < array.size(); ++i) {
    if (fitted[at(i)] < 0) continue;
    out.misfit_mps2[at(i)] /= length[at(i)];
    model.sensor[at(i)] = fit.model.sensor[at(fitted[at(i)])];
  }
  array.set_uncertainty(out);
  return true;
}

}  // namespace

[[gnu::noinline]] Error Recalibration::First::try_fit(const Recalibration& r, const InForce& in_force,
                                                      const Calibration& fit) noexcept {
  SensorModel model = in_force.model;
  SensorArray array = in_force.array;
  if (!install(fit, r.sensors_, model, array)) return Error{Errc::diverged, -1};
  const Error error = off_datasheet(in_force.model, in_force.array, model, array, r.sensors_);
  if (error.code != Errc::ok) return error;
  return r.check_stations({model, array, in_force.gravity, in_force.limits}, array.uncertainty());
}

[[gnu::noinline]] Error Recalibration::First::check(Recalibration& r, const InForce& in_force) noexcept {
  r.lacking_ = SensorSet{};
  const Expected<Calibration> fit = finish(r);
  if (!fit) {
    Error error = fit.error();
    const bool names_sensor = error.code == Errc::implausible || error.code == Errc::poor_fit;
    error.index = names_sensor && error.index >= 0 ? member(r.sensors_, error.index) : -1;
    return error;
  }
  Error error = check_figures(r, fit->report);
  if (error.code != Errc::ok) return error;
  // A wrong length of gravity goes into all scales alike.
  error = plumb::judge(r.datasheet(in_force), in_force.gravity, *fit, HoldOut{}, OddSensor{}).error;
  return error.code != Errc::ok ? error : try_fit(r, in_force, *fit);
}

[[gnu::noinline]] Recalibration::Outcome Recalibration::First::judge(Recalibration& r, const InForce& in_force,
                                                                     double) noexcept {
  const Error error = check(r, in_force);
  r.refusal_ = error;
  if (error.code == Errc::ok) return r.accept();
  r.phase_ = RecalibrationPhase::collecting;
  r.untried_ = false;
  const bool more_would_help = error.code == Errc::unobservable;
  if (more_would_help && r.lacking_.empty()) r.lacking_ = r.sensors_;
  if (!more_would_help) r.forget();  // one of its stations, or all, may hold what is wrong
  return Outcome::rejected;
}

[[gnu::noinline]] void Recalibration::First::apply(Recalibration& r, const Adoption& into) noexcept {
  const Expected<Calibration> fit = finish(r);
  r.first_ = !(fit && install(*fit, r.sensors_, into.model, into.array));
  if (!r.first_) {
    r.bounds_.commission(into.model);
    r.bounds_.note_adoption(into.time_s, false);
  }
  r.stop();
}

[[gnu::noinline]] bool Recalibration::First::resume(Recalibration& r, const InForce& in_force) noexcept {
  if (r.offered() || r.adopted()) return false;
  if (r.phase_ == RecalibrationPhase::idle || r.phase_ == RecalibrationPhase::collecting) return true;
  if (!r.stations_suffice()) return false;
  r.calibrator_.resume(r.datasheet(in_force), free_axes());
  return r.phase_ == RecalibrationPhase::fitting || check(r, in_force).code == Errc::ok;
}

}  // namespace PLUMB_ABI
}  // namespace plumb

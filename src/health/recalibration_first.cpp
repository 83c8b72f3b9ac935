// The first calibration of a monitor that was given none: when it is tried, and what it must show before it is
// believed. A fit that cannot be trusted is refused, whatever it costs in stations: before it there is no output at
// all, after it there is.
#include <cmath>

#include "plumb/calibration/acceptance.hpp"
#include "plumb/calibration/observability.hpp"
#include "plumb/health/recalibration.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

namespace {

constexpr std::size_t at(int i) noexcept { return static_cast<std::size_t>(i); }

/// The nine harmonics of gravity that its length sees need nine directions ...
constexpr int kHarmonicDirections = 9;
/// ... and so many more, so that the residuals can contradict the fit. Three sensors have nothing but the length.
constexpr int kSpare = 4, kSpareOfThree = 6;
/// A sensor along whose axis gravity has changed by less than this part of it is the first to ask for more.
constexpr double kLeastSpan = 1.0;
/// Every parameter is known so much better than from the datasheet: half its sigma.
constexpr double kLeastDataShare = 0.75;
/// How seldom the residuals of a good fit may be so large.
constexpr double kLeastProbability = 1e-4;

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
bool Recalibration::attitudes_suffice(const SensorArray& array) noexcept {
  std::array<Vec3, StationStore::kMax> direction{};
  int count = 0;
  for (int k = 0; k < store_.size(); ++k) {
    if (!StationStore::held_out(k)) direction[at(count++)] = store_.station(k).direction;
  }
  lacking_ = SensorSet{};
  if (excitation_of(direction.data(), count) >= kFirstExcitation) return true;
  for (int i = 0; i < array.size(); ++i) {
    if (!sensors_.has(i)) continue;
    double low = 1.0, high = -1.0;
    for (int k = 0; k < count; ++k) {
      const double along = dot(array.axis(i), direction[at(k)]);
      low = std::fmin(low, along);
      high = std::fmax(high, along);
    }
    if (!(high - low >= kLeastSpan)) lacking_ = lacking_.with(i);
  }
  if (lacking_.empty()) lacking_ = sensors_;
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
Error Recalibration::check_figures(const FitReport& report) noexcept {
  double least = 1.0;
  for (int p = 0; p < 4 * sensors_.size(); ++p) {
    const double share = report.data_share[at(p)];
    if (!(share >= kLeastDataShare)) lacking_ = lacking_.with(member(sensors_, p / 4));
    least = std::fmin(least, share);
  }
  if (!lacking_.empty()) return Error{Errc::unobservable, lacking_.lowest(), least, kLeastDataShare};
  if (!(report.p_value >= kLeastProbability)) return Error{Errc::poor_fit, -1, report.p_value, kLeastProbability};
  return Error{};
}

int Recalibration::copy_stations(Stations& out) const noexcept {
  const StationList list = fit_stations();
  for (int k = 0; k < list.size(); ++k) out[at(k)] = list[k];
  return list.size();
}

/// Axes that are free need room that held ones do not.
[[gnu::noinline]] void Recalibration::iterate_first() noexcept {
  Stations stations;
  calibrator_.iterate(stations.data(), copy_stations(stations));
}

/// The stations are needed until there is a fit, and no longer.
[[gnu::noinline]] Expected<Calibration> Recalibration::finish_first() const noexcept {
  Stations stations;
  const int count = copy_stations(stations);
  return calibrator_.finish(stations.data(), count);
}

[[gnu::noinline]] Error Recalibration::try_first(const InForce& in_force, const Calibration& fit) const noexcept {
  SensorModel model = in_force.model;
  SensorArray array = in_force.array;
  if (!install(fit, model, array)) return Error{Errc::diverged, -1};
  const Error error = off_datasheet(in_force.model, in_force.array, model, array, sensors_);
  if (error.code != Errc::ok) return error;
  return check_stations({model, array, in_force.gravity, in_force.limits}, array.uncertainty());
}

[[gnu::noinline]] Error Recalibration::check_first(const InForce& in_force) noexcept {
  lacking_ = SensorSet{};
  const Expected<Calibration> fit = finish_first();
  if (!fit) {
    Error error = fit.error();
    const bool names_sensor = error.code == Errc::implausible || error.code == Errc::poor_fit;
    error.index = names_sensor && error.index >= 0 ? member(sensors_, error.index) : -1;
    return error;
  }
  Error error = check_figures(fit->report);
  if (error.code != Errc::ok) return error;
  // A wrong length of gravity goes into all scales alike.
  error = plumb::judge(datasheet(in_force), in_force.gravity, *fit, HoldOut{}, OddSensor{}).error;
  return error.code != Errc::ok ? error : try_first(in_force, *fit);
}

Recalibration::Outcome Recalibration::judge_first(const InForce& in_force) noexcept {
  const Error error = check_first(in_force);
  if (error.code == Errc::ok) {
    refusal_ = Error{};
    phase_ = RecalibrationPhase::accepted;
    return Outcome::accepted;
  }
  refusal_ = error;
  phase_ = RecalibrationPhase::collecting;
  untried_ = false;
  const bool more_would_help = error.code == Errc::unobservable;
  if (more_would_help && lacking_.empty()) lacking_ = sensors_;
  if (!more_would_help) forget();  // one of its stations, or all, may hold what is wrong
  return Outcome::rejected;
}

/// Writes a full fit over `sensors_` into model and array; false, and nothing is written, where its axes are none.
bool Recalibration::install(const Calibration& fit, SensorModel& model, SensorArray& array) const noexcept {
  std::array<SensorRow, kCapacity> rows{};
  std::array<int, kCapacity> fitted{};
  std::array<double, kCapacity> length{};
  fitted.fill(-1);
  int count = 0;
  for (int i = 0; i < array.size(); ++i) {
    rows[at(i)] = array.row(i);
    length[at(i)] = 1.0;
    if (!sensors_.has(i)) continue;
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
  for (int i = 0; i < array.size(); ++i) {
    if (fitted[at(i)] < 0) continue;
    out.misfit_mps2[at(i)] /= length[at(i)];
    model.sensor[at(i)] = fit.model.sensor[at(fitted[at(i)])];
  }
  array.set_uncertainty(out);
  return true;
}

[[gnu::noinline]] void Recalibration::apply_first(SensorModel& model, SensorArray& array, double time_s) noexcept {
  const Expected<Calibration> fit = finish_first();
  first_ = !(fit && install(*fit, model, array));
  if (!first_) {
    commission(model);
    adopted_s_ = time_s;
  }
  stop();
}

bool Recalibration::resume_first(const InForce& in_force) noexcept {
  if (offered() || adopted_) return false;
  if (phase_ == RecalibrationPhase::idle || phase_ == RecalibrationPhase::collecting) return true;
  if (sensors_.size() < 3 || store_.size() < stations_due()) return false;
  calibrator_.resume(datasheet(in_force), options());
  return phase_ == RecalibrationPhase::fitting || check_first(in_force).code == Errc::ok;
}

}  // namespace PLUMB_ABI
}  // namespace plumb

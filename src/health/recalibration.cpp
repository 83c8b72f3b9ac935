// The order of events of a recalibration: collect, fit one iteration a step, judge, hand over.
#include "plumb/health/recalibration.hpp"

#include <cmath>
#include <limits>
#include <type_traits>

namespace plumb {
inline namespace PLUMB_ABI {

static_assert(std::is_trivially_copyable<Recalibration>::value, "a copy is an assignment");

namespace {

constexpr std::size_t at(int i) noexcept { return static_cast<std::size_t>(i); }

/// Stations beyond those that determine the parameters, so that the residuals can contradict the fit.
constexpr int kSpareStations = 4;

}  // namespace

FitOptions Recalibration::options() const noexcept {
  FitOptions out;
  out.estimate_misfit = false;      // what the fit cannot explain is a reason to refuse it
  out.require_full_rank = first();  // in flight nothing is asked of the axes
  if (first()) {
    out.max_outlier_share = 0.0;  // a station unlike the others is a tool that has changed
    out.max_bias_sigmas = kFirstSigmas;
  }
  return out;
}

const char* to_string(RecalibrationPhase phase) noexcept {
  switch (phase) {
    case RecalibrationPhase::idle: return "idle";
    case RecalibrationPhase::collecting: return "collecting";
    case RecalibrationPhase::fitting: return "fitting";
    case RecalibrationPhase::accepted: return "accepted";
  }
  return "?";
}

void Recalibration::configure(const SensorModel& commissioning, const std::array<DriftSigmas, kCapacity>& drift,
                              double same_attitude_rad, bool first) noexcept {
  store_ = StationStore(same_attitude_rad);
  drift_ = drift;
  commission(commissioning);
  length_.fill(0.0);
  shift_mps2_.fill(0.0);
  inflation_ = 1.0;
  sensors_ = SensorSet{};
  adopted_ = false;
  first_ = first;
  adopted_s_ = 0.0;
  iterations_ = 0;
  refusal_ = Error{};
  offered_s_ = 0.0;
  stop();
}

void Recalibration::commission(const SensorModel& model) noexcept {
  for (int i = 0; i < kCapacity; ++i) {
    commissioned_scale_[at(i)] = model.sensor[at(i)].scale[0];
    commissioned_bias_mps2_[at(i)] = model.sensor[at(i)].bias[0];
  }
}

void Recalibration::add_block(const StationMean& block, bool station_begins) noexcept {
  if (phase_ == RecalibrationPhase::fitting || phase_ == RecalibrationPhase::accepted) return;
  const std::uint32_t before = store_.entries();
  if (station_begins) store_.end_station();
  store_.add_block(block);
  untried_ = untried_ || store_.entries() != before;
}

void Recalibration::forget() noexcept {
  store_.clear();
  lacking_ = SensorSet{};
  untried_ = false;
  if (phase_ != RecalibrationPhase::idle) phase_ = RecalibrationPhase::collecting;
}

void Recalibration::start(SensorSet sensors) noexcept {
  sensors_ = sensors;
  lacking_ = SensorSet{};
  refusal_ = Error{};
  untried_ = true;
  phase_ = RecalibrationPhase::collecting;
  if (offered()) store_.clear();  // the host may have made it from what was seen until now
}

void Recalibration::stop() noexcept {
  forget();
  phase_ = RecalibrationPhase::idle;
  offered_sensors_ = 0;
}

int Recalibration::stations_needed(int n) noexcept {
  // A station tells n - 2 figures, two parameters a sensor are asked for.
  const int rows = n > 3 ? n - 2 : 1;
  const int fitted = (2 * n + rows - 1) / rows + kSpareStations;  // at most 10, for three sensors
  int needed = kHeldOutNeeded * StationStore::kHeldOutStride;
  while (needed - needed / StationStore::kHeldOutStride < fitted) ++needed;
  return needed;
}

/// Not inlined, like all that needs much room: what is on the stack of one would be under the others too.
[[gnu::noinline]] void Recalibration::begin_fit(const InForce& in_force) noexcept {
  calibrator_ = Calibrator(datasheet(in_force), in_force.gravity, options());
  phase_ = RecalibrationPhase::fitting;
}

Recalibration::Outcome Recalibration::step(const InForce& in_force, double time_s) noexcept {
  if (!kRecalibrates) return Outcome::none;
  switch (phase_) {
    // A refusal is a level, too: an event that ranks before it must not leave a recalibration without a fit.
    case RecalibrationPhase::idle: return refusal_.code == Errc::ok ? Outcome::none : Outcome::rejected;
    case RecalibrationPhase::accepted: return Outcome::accepted;
    case RecalibrationPhase::collecting:
      if (offered()) return examine_offer(in_force, time_s);
      if (untried_ && store_.size() >= stations_due() && ready(in_force)) {
        begin_fit(in_force);
      }
      return Outcome::none;
    case RecalibrationPhase::fitting: break;
  }
  if (calibrator_.done()) return judge(in_force, time_s);
  if (first()) {
    iterate_first();
  } else {
    calibrator_.iterate_held(fit_stations());
  }
  ++iterations_;
  return Outcome::none;
}

[[gnu::noinline]] void Recalibration::doubt_change(const SensorArray& array, bool whole,
                                                   RowUncertainty& uncertainty) const noexcept {
  const Change change = whole_change(array);
  add_change(array, whole ? change : unseen_by_parity(array, change), uncertainty);
}

void Recalibration::apply(SensorModel& model, SensorArray& array, const GravityReference& gravity, double time_s,
                          bool doubted) noexcept {
  if (!kRecalibrates || phase_ != RecalibrationPhase::accepted) return;
  if (first()) return apply_first(model, array, time_s);
  RowUncertainty uncertainty;
  if (!uncertainty_after(array, gravity, uncertainty)) uncertainty = array.uncertainty();
  if (doubted || offered()) doubt_change(array, doubted, uncertainty);
  array.set_uncertainty(uncertainty);
  write_coefficients(model);
  adopted_ = true;
  adopted_s_ = time_s;
  stop();
}

bool Recalibration::resume(const InForce& in_force) noexcept {
  if (first()) return resume_first(in_force);
  if (first_ || !coefficients_are_plausible(in_force.model)) return false;
  if (!kRecalibrates) return phase_ == RecalibrationPhase::idle && offered_sensors_ == 0;
  if (offered() && !offer_is_plausible(in_force)) return false;
  switch (phase_) {
    case RecalibrationPhase::idle:
    case RecalibrationPhase::collecting: return true;
    case RecalibrationPhase::fitting:
    case RecalibrationPhase::accepted: break;
  }
  if (sensors_.size() < 3 || store_.size() < stations_due()) return false;
  if (phase_ == RecalibrationPhase::accepted) {
    const double any_time_s = std::numeric_limits<double>::infinity();
    return check_bounds(in_force.model, any_time_s).code == Errc::ok && std::isfinite(inflation_) && inflation_ >= 1.0;
  }
  // Gravity may have been set since the fit began.
  calibrator_.resume(datasheet({in_force.model, in_force.array, calibrator_.gravity(), in_force.limits}), options());
  return true;
}

/// The attitude that is farthest from all on record, among those along the axes in question and the faces,
/// edges and corners of a cube: enough of them for any number of stations that is asked for.
Vec3 Recalibration::wanted_direction(const SensorArray& array) const noexcept {
  const SensorSet asked = lacking_.empty() ? sensors_ : lacking_;
  Vec3 best{};
  double least = 2.0;
  const auto offer = [&](const Vec3& candidate) {
    // Those held out count: a second visit to such an attitude would be held out again. So do those that wait: who
    // follows what is asked for would stand still until the next has been entered.
    const double nearest = store_.nearest_cosine(candidate);
    if (nearest < least) {
      least = nearest;
      best = candidate;
    }
  };
  for (int i = 0; i < array.size(); ++i) {
    if (!asked.has(i)) continue;
    offer(array.axis(i));
    offer(scaled(array.axis(i), -1.0));
  }
  for (int k = 0; k < 27; ++k) {
    const int x = k % 3 - 1, y = k / 3 % 3 - 1, z = k / 9 - 1;
    const Vec3 corner = {1.0 * x, 1.0 * y, 1.0 * z};
    const double length = norm(corner);
    if (length > 0.0) offer(scaled(corner, 1.0 / length));
  }
  return best;
}

RecalibrationProgress Recalibration::progress(const SensorArray& array) const noexcept {
  RecalibrationProgress out;
  out.phase = phase_;
  out.offered = offered();
  out.stations = offered() ? 0 : store_.fit_count();
  out.held_out = offered() ? store_.size() : store_.held_out_count();
  out.last_refusal = refusal_;
  if (phase_ != RecalibrationPhase::collecting) return out;
  const int missing = stations_due() - store_.size();
  out.lacking = lacking_;
  out.stations_wanted = missing > 0 ? missing : lacking_.empty() ? 0 : 1;
  if (out.stations_wanted > 0) out.wanted_direction = wanted_direction(array);
  return out;
}

}  // namespace PLUMB_ABI
}  // namespace plumb

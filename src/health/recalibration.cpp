// The order of events of a recalibration: collect, fit one iteration a step, judge, hand over.
#include "plumb/health/recalibration.hpp"

#include <cmath>
#include <limits>
#include <type_traits>

#include "plumb/core/detail/numbers.hpp"
#include "recalibration_kinds.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

using numbers::at;

static_assert(std::is_trivially_copyable<Recalibration>::value, "a copy is an assignment");

namespace {

/// Stations beyond those that determine the parameters, so that the residuals can contradict the fit.
constexpr int kSpareStations = 4;

}  // namespace

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
  bounds_.begin(commissioning, drift);
  change_ = CoefficientChange{};
  inflation_ = 1.0;
  sensors_ = SensorSet{};
  first_ = first;
  iterations_ = 0;
  refusal_ = Error{};
  stop();
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
  offer_.clear();
}

int Recalibration::stations_needed(int n) noexcept {
  // A station tells n - 2 figures, two parameters a sensor are asked for.
  const int rows = n > 3 ? n - 2 : 1;
  const int fitted = (2 * n + rows - 1) / rows + kSpareStations;  // at most 10, for three sensors
  int needed = kHeldOutNeeded * StationStore::kHeldOutStride;
  while (needed - needed / StationStore::kHeldOutStride < fitted) ++needed;
  return needed;
}

int Recalibration::stations_due() const noexcept {
  return by_kind([this](auto kind) { return kind.stations_due(*this); });
}

StationList Recalibration::fit_stations() const noexcept {
  return {store_.data(), store_.size(), sensors_, StationStore::kHeldOutStride};
}

/// 1 sigma of a station's reading that the fit cannot explain: noise and misfit, drawn anew at every station, and what
/// a held axis leaves. All stations weigh as the shortest: more noise is feigned than there is, at the others.
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
  const bool held = by_parameters([](auto kind) { return decltype(kind)::kHoldsAxes; });
  ReadingError out;
  out.noise_mps2_sq = sigma * sigma / std::fmax(samples, 1.0) + misfit * misfit;
  out.total_mps2_sq = out.noise_mps2_sq + (held ? std::fmax(across, 0.0) * mean_square : 0.0);
  return out;
}

/// The fit knows the fitted sensors only, in the order of the array; the noise of a row of its datasheet is that of a
/// station.
Datasheet Recalibration::datasheet(const InForce& in_force) const noexcept {
  Datasheet out;
  out.reads = in_force.model.reads;
  for (int i = 0; i < in_force.array.size(); ++i) {
    if (!sensors_.has(i)) continue;
    DatasheetSensor& sensor = out.sensor[at(out.size++)];
    sensor.row = in_force.array.row(i);
    sensor.row.sigma_mps2 = std::sqrt(reading_error(in_force.array, in_force.gravity, i).total_mps2_sq);
    sensor.coefficients = in_force.model.sensor[at(i)];
    sensor.prior = by_parameters([&](auto kind) { return kind.prior(*this, in_force.array, i); });
  }
  return out;
}

/// Not inlined, like all that needs much room: what is on the stack of one would be under the others too.
[[gnu::noinline]] void Recalibration::begin_fit(const InForce& in_force, const FitOptions& options) noexcept {
  calibrator_ = Calibrator(datasheet(in_force), in_force.gravity, options);
  phase_ = RecalibrationPhase::fitting;
}

Recalibration::Outcome Recalibration::step(const InForce& in_force, double time_s) noexcept {
  if (!kRecalibrates) return Outcome::none;
  switch (phase_) {
    // A refusal is a level, too: an event that ranks before it must not leave a recalibration without a fit.
    case RecalibrationPhase::idle: return refusal_.code == Errc::ok ? Outcome::none : Outcome::rejected;
    case RecalibrationPhase::accepted: return Outcome::accepted;
    case RecalibrationPhase::collecting:
      return by_kind([&](auto kind) { return kind.collect(*this, in_force, time_s); });
    case RecalibrationPhase::fitting: break;
  }
  if (calibrator_.done()) return by_kind([&](auto kind) { return kind.judge(*this, in_force, time_s); });
  by_kind([&](auto kind) { kind.iterate(*this); });
  ++iterations_;
  return Outcome::none;
}

Recalibration::Outcome Recalibration::accept() noexcept {
  phase_ = RecalibrationPhase::accepted;
  return Outcome::accepted;
}

Recalibration::Outcome Recalibration::reject(const Error& why) noexcept {
  stop();  // nor are its stations tried again
  refusal_ = why;
  return Outcome::rejected;
}

[[gnu::noinline]] Error Recalibration::try_change(const InForce& in_force,
                                                  const RowUncertainty& uncertainty) const noexcept {
  SensorModel model = in_force.model;
  change_.write(sensors_, model);
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
    const bool proof = by_kind([k](auto kind) { return kind.proves(k); });
    const Errc code = proof ? Errc::not_confirmed : Errc::poor_fit;
    if (!test.tested) return Error{code, k};
    const double parity_limit = test.parity_rows > 0 ? test.parity_alarm_limit(candidate.limits) : 0.0;
    if (!(test.parity <= parity_limit)) return Error{code, k, test.parity, parity_limit};
    const double norm_limit = test.norm_alarm_limit(candidate.limits);
    if (!(std::fabs(test.norm) <= norm_limit)) return Error{code, k, std::fabs(test.norm), norm_limit};
    if (proof) ++proofs;
  }
  // Whatever is collected elsewhere: no fit is accepted on its own stations alone.
  if (proofs < kHeldOutNeeded) return Error{Errc::too_few_stations, -1, 1.0 * proofs, 1.0 * kHeldOutNeeded};
  return Error{};
}

void Recalibration::apply(SensorModel& model, SensorArray& array, const GravityReference& gravity, double time_s,
                          bool doubted) noexcept {
  if (!kRecalibrates || phase_ != RecalibrationPhase::accepted) return;
  const Adoption into = {model, array, gravity, time_s, doubted};
  by_kind([&](auto kind) { kind.apply(*this, into); });
}

void Recalibration::adopt_change(const Adoption& into, const RowUncertainty& uncertainty) noexcept {
  into.array.set_uncertainty(uncertainty);
  change_.write(sensors_, into.model);
  bounds_.note_adoption(into.time_s, true);
  stop();
}

bool Recalibration::change_is_sound(const SensorModel& model) const noexcept {
  const double any_time_s = std::numeric_limits<double>::infinity();
  return check_bounds(model, any_time_s).code == Errc::ok && std::isfinite(inflation_) && inflation_ >= 1.0;
}

bool Recalibration::resume(const InForce& in_force) noexcept {
  if (!first() && (first_ || !bounds_.allow(in_force.model))) return false;
  if (!kRecalibrates) return phase_ == RecalibrationPhase::idle && !offer_.any();
  return by_kind([&](auto kind) { return kind.resume(*this, in_force); });
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

// A calibration that the host brings: when it is tried, and what becomes of it.
#include "plumb/array/geometry.hpp"
#include "plumb/core/detail/numbers.hpp"
#include "recalibration_kinds.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

using numbers::at;

namespace {

/// Of a change, the part that moves the vector and leaves the readings in agreement, whatever the attitude. The
/// stations know it by the length alone, within the bound on gravity and on the calibration, and an offer may be wrong
/// about its sigmas.
void keep_unseen_by_parity(SensorSet sensors, const SensorArray& array, RowChange& change) noexcept {
  const LeastSquares map = least_squares(array, sensors);
  if (!map.valid) return;
  for (int p = 0; p < 4; ++p) {
    Readings readings{};
    for (int i = 0; i < array.size(); ++i) readings[at(i)] = change.of[at(4 * i + p)];
    const Vec3 x = map.estimate(readings);
    for (int i = 0; i < array.size(); ++i) change.of[at(4 * i + p)] = sensors.has(i) ? dot(array.axis(i), x) : 0.0;
  }
}

}  // namespace

Expected<void> Recalibration::offer(const InForce& in_force, const SensorModel& model, const SensorArray& array,
                                    SensorSet sensors, double time_s) noexcept {
  // Between two fits neither means anything yet.
  sensors_ = sensors;
  inflation_ = 1.0;
  Error error = offer_.read(in_force.model, in_force.array, model, array, sensors, bounds_, change_);
  if (error.code == Errc::ok) error = check_bounds(in_force.model, time_s);
  if (error.code != Errc::ok) return tl::unexpected<Error>(error);
  offer_.take(array.size(), time_s);
  return {};
}

void Recalibration::withdraw_offer() noexcept {
  if (!offered() || phase_ != RecalibrationPhase::idle) return;
  offer_.clear();
  refusal_ = Error{Errc::wrong_state};
}

/// The stations are waited for until they move gravity along every axis.
Recalibration::Outcome Recalibration::Offered::collect(Recalibration& r, const InForce& in_force,
                                                       double time_s) noexcept {
  if (r.untried_ && r.store_.size() >= kOfferStations && ready(r, in_force, 0)) return judge(r, in_force, time_s);
  if (!r.offer_.lapsed(time_s)) return Outcome::none;
  return r.reject(Error{Errc::too_few_stations, -1, 1.0 * r.store_.size(), 1.0 * kOfferStations});
}

[[gnu::noinline]] Error Recalibration::Offered::try_offer(const Recalibration& r, const InForce& in_force) noexcept {
  RowUncertainty left;
  r.offer_.uncertainty(in_force.array, r.sensors_, left);
  return r.try_change(in_force, left);
}

Recalibration::Outcome Recalibration::Offered::judge(Recalibration& r, const InForce& in_force,
                                                     double time_s) noexcept {
  Error error = r.check_bounds(in_force.model, time_s);
  if (error.code == Errc::ok) error = try_offer(r, in_force);
  return error.code == Errc::ok ? r.accept() : r.reject(error);
}

void Recalibration::Offered::apply(Recalibration& r, const Adoption& into) noexcept {
  RowUncertainty left;
  r.offer_.uncertainty(into.array, r.sensors_, left);
  RowChange doubtful = r.change_.on_rows(r.sensors_, into.array);
  if (!into.doubted) keep_unseen_by_parity(r.sensors_, into.array, doubtful);
  doubtful.doubt(into.array, left);
  r.adopt_change(into, left);
}

bool Recalibration::Offered::resume(Recalibration& r, const InForce& in_force) noexcept {
  return !r.fitting() && r.offer_.plausible(in_force.array.size(), r.sensors_, r.bounds_) &&
         r.change_is_sound(in_force.model) && (r.phase_ != RecalibrationPhase::accepted || r.stations_suffice());
}

}  // namespace PLUMB_ABI
}  // namespace plumb

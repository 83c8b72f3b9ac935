#include "plumb/core/error.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

// Neither switch has a default, so that -Wswitch names a code that was added without its text.

const char* describe(Errc code) noexcept {
  switch (code) {
    case Errc::ok: return "no error";
    case Errc::too_few_sensors: return "fewer than three sensors";
    case Errc::too_many_sensors: return "more sensors than this build holds";
    case Errc::axis_not_unit: return "axis is not of unit length";
    case Errc::axes_rank_deficient: return "axes lie in one plane and cannot determine a vector";
    case Errc::duplicate_id: return "sensor id is used twice";
    case Errc::empty_id: return "sensor id is empty";
    case Errc::sigma_not_positive: return "noise sigma is not positive";
    case Errc::not_finite: return "value is not a finite number";
    case Errc::out_of_range: return "value is outside its range";
    case Errc::range_too_small: return "full scale is below gravity plus margin";
    case Errc::too_few_stations: return "too few stations";
    case Errc::unobservable: return "the stations do not determine every parameter";
    case Errc::diverged: return "the fit did not converge";
    case Errc::implausible: return "a fitted parameter is outside its physical bound";
    case Errc::poor_fit: return "the residual is larger than the noise allows";
    case Errc::not_calibrated: return "no calibration has been accepted";
    case Errc::wrong_key: return "the reset key does not match";
    case Errc::not_invertible: return "the cross-axis matrix is singular";
    case Errc::wrong_mode: return "the settings have the mode of the other monitor class";
    case Errc::wrong_state: return "the monitor cannot take this request in its present state";
    case Errc::not_confirmed: return "a station held out of the fit contradicts the fit";
    case Errc::not_unique: return "too many sensors: the paper's parameters are not unique for this number";
    case Errc::too_few_levels: return "too few temperatures for polynomials of this order";
    case Errc::implausible_gravity: return "gravity or its sigma is outside the range of the Earth's surface and wells";
    case Errc::buffer_too_small: return "the memory given is too small for a snapshot";
    case Errc::snapshot_truncated: return "the snapshot ends too early";
    case Errc::snapshot_damaged: return "the data are damaged or are not a snapshot";
    case Errc::snapshot_older: return "the snapshot was written by an older version of plumb";
    case Errc::snapshot_newer: return "the snapshot was written by a newer version of plumb";
    case Errc::snapshot_capacity: return "the snapshot was written by a build for another number of sensors";
    case Errc::snapshot_foreign: return "the snapshot belongs to another configuration, array or calibration";
    case Errc::snapshot_implausible: return "the snapshot holds contradictory values";
    case Errc::frame_not_orthogonal: return "the output frame is not orthogonal (rows of unit length, at right angles)";
    case Errc::may_accelerate: return "an acceleration bound is set, but a calibration fit needs a tool at rest";
  }
  return "unknown error code";
}

const char* remedy(Errc code) noexcept {
  switch (code) {
    case Errc::ok: return "nothing to do";
    case Errc::too_few_sensors: return "give at least three sensors";
    case Errc::too_many_sensors: return "give fewer sensors or link the build of a larger capacity";
    case Errc::axis_not_unit: return "divide the axis by its length";
    case Errc::axes_rank_deficient: return "turn at least one axis out of the plane of the others";
    case Errc::duplicate_id: return "give every sensor an id of its own";
    case Errc::empty_id: return "give the sensor an id of 1 to 15 characters";
    case Errc::sigma_not_positive: return "give the 1-sigma noise of one sample in m/s^2, larger than zero";
    case Errc::not_finite: return "replace the NaN or infinity by a number";
    case Errc::out_of_range: return "give a value inside the stated bound, in the stated unit";
    case Errc::range_too_small:
      return "use a sensor whose full scale exceeds gravity plus margin, or correct full_scale";
    case Errc::too_few_stations: return "record more stations at other attitudes";
    case Errc::unobservable: return "add stations at the attitudes that the fit report names";
    case Errc::diverged: return "check units, signs and axes of the datasheet values, and the stations for motion";
    case Errc::implausible: return "check the wiring, unit and axis of the named sensor";
    case Errc::poor_fit: return "look for motion, a faulty sensor or a wrong gravity value in the stations";
    case Errc::not_calibrated: return "run a calibration or load an accepted one";
    case Errc::wrong_key: return "use the reset key of the configuration";
    case Errc::not_invertible: return "correct the misalignment terms: they give two sensors the same axis";
    case Errc::wrong_mode: return "use PaperMonitor for mode \"paper\", HealthMonitor for mode \"plumb\"";
    case Errc::wrong_state:
      return "repeat the request in the state nominal, isolated or degraded, without an active alarm";
    case Errc::not_confirmed:
      return "look for a sensor that changed while the stations were collected, then collect stations again";
    case Errc::not_unique: return "use the common-frame form: axis, scale and bias of each sensor";
    case Errc::too_few_levels: return "record the attitudes at more temperatures, or fit a lower order";
    case Errc::implausible_gravity: return "give 9.5 to 10.2 m/s^2 with a sigma of 0 to 0.1 m/s^2";
    case Errc::buffer_too_small: return "give at least HealthMonitor::snapshot_size_max() bytes";
    case Errc::snapshot_truncated: return "give all bytes of the snapshot; start without history if they are lost";
    case Errc::snapshot_damaged:
      return "keep two snapshots in turn and restore the other one, or start without history";
    case Errc::snapshot_older: return "start without history, then write a new snapshot";
    case Errc::snapshot_newer: return "use the version of plumb that wrote it, or start without history";
    case Errc::snapshot_capacity: return "use the build that wrote it, or start without history";
    case Errc::snapshot_foreign:
      return "restore the snapshot of this tool with these settings, or start without history";
    case Errc::snapshot_implausible: return "start without history, and find out what changed the snapshot";
    case Errc::frame_not_orthogonal:
      return "give rows of unit length at right angles; use the identity for the tool frame";
    case Errc::may_accelerate:
      return "hold the tool still and configure it without an acceleration bound, or load a calibration made at rest";
  }
  return "report this code as a defect of plumb";
}

}  // namespace PLUMB_ABI
}  // namespace plumb

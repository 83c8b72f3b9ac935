#include "plumb/report/words.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace report {

namespace {

const char* about_calibration(HealthEvent event) {
  switch (event) {
    case HealthEvent::recalibrate: return "the sensors in service are being calibrated anew";
    case HealthEvent::fit_accepted: return "the new calibration is accepted: trust must be earned with it";
    case HealthEvent::fit_rejected: return "the new calibration is refused: the old one stays in force";
    default: return "about a new calibration";
  }
}

}  // namespace

std::string sensor_names(SensorSet set, const SensorArray& array, const char* none) {
  std::string out;
  for (int i = 0; i < array.size(); ++i) {
    if (!set.has(i)) continue;
    if (!out.empty()) out += ", ";
    out += array.row(i).id.data();
  }
  return out.empty() ? none : out;
}

std::string explain(Cause cause, Grade grade, HealthEvent event) {
  switch (cause) {
    case Cause::none: return "no reason on record";
    case Cause::power_on: return "just switched on: trust must be earned at several attitudes";
    case Cause::parity: return "the sensors contradict one another";
    case Cause::norm: return "the length of the vector is not gravity's, and no spare sensor can say why";
    case Cause::mae: return "a group of sensors measures the wrong length of gravity";
    case Cause::reference: return "the sensors agree, but not on the length of gravity: nobody is accused";
    case Cause::moving: return "the tool moves: evidence is suspended";
    case Cause::isolated_fault:
      return grade == Grade::parity ? "the sensor named is set aside, the rest must prove itself"
                                    : "one explanation is left: the sensor named is faulty and excluded";
    case Cause::contradiction: return "no explanation is left";
    case Cause::channel_lost: return "a channel delivers no usable value any more";
    case Cause::channel_back: return "a lost channel delivers again; it is not used yet";
    case Cause::temperature: return "outside the calibrated temperature span";
    case Cause::patience: return "enough stations seen, and still no answer";
    case Cause::calibration: return about_calibration(event);
    case Cause::probation: return "an excluded sensor has agreed with the others for long enough";
    case Cause::host_request: return "asked for by the operator";
    case Cause::time_fault: return "time did not increase: the sample was refused";
    case Cause::gap: return "a gap in the data: the evidence starts afresh";
    case Cause::clean: return "block after block agrees within its limits: trust is earned";
    case Cause::noisy: return "a sensor is noisy while the others are quiet";
    case Cause::stuck: return "a sensor repeats one value while the others show a change";
    case Cause::clipped: return "a sensor is at full scale where the others see no reason for it";
    case Cause::rotating: return "the tool turns: what its sensors feel of that is not known";
    case Cause::inhibited: return "the host froze exclusion and recalibration";
    case Cause::released: return "the host let exclusion and recalibration go on";
    case Cause::common_scale: return "gravity or a common scale is off: the direction is usable";
    case Cause::common_bias: return "the sensors share a bias: the direction is not usable";
    case Cause::snapshot_refused: return "switched on without its history: the snapshot offered was of no use";
    case Cause::calibration_contradicted:
      return "the first attitudes contradict what the calibration says of its own errors: recalibrate";
    case Cause::memory: return "the monitor's storage changed by itself: configure or restore it";
  }
  return "?";
}

const char* meaning(HealthState state) noexcept {
  switch (state) {
    case HealthState::nominal: return "all sensors agree; every one is in use";
    case HealthState::suspect: return "a limit was crossed, or trust is not yet earned; the output is unconfirmed";
    case HealthState::isolated: return "a faulty sensor is excluded; the rest can still check one another";
    case HealthState::degraded_3_sensor:
      return "no sensor can be spared any more: a further fault could not be located, with three left perhaps not seen";
    case HealthState::recalibrating: return "the coefficients are being estimated anew";
    case HealthState::failed: return "too few sensors, or no bound on the error: the output must not be used";
  }
  return "?";
}

const char* meaning(Validity validity) noexcept {
  switch (validity) {
    case Validity::valid: return "may be used";
    case Validity::degraded: return "may be used, unchecked by any spare sensor";
    case Validity::unconfirmed: return "do not rely on it yet";
    case Validity::held: return "an older value, from before the tool moved";
    case Validity::invalid: return "must not be used";
  }
  return "?";
}

}  // namespace report
}  // namespace PLUMB_ABI
}  // namespace plumb

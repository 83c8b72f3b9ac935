#include "plumb/render/words.hpp"

#include "plumb/io/file_error.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {

namespace {

const char* about_calibration(HealthEvent event) {
  switch (event) {
    case HealthEvent::recalibrate: return "recalibration of the sensors in service has started";
    case HealthEvent::fit_accepted:
      return "new calibration accepted. Not yet validated: hold the tool still in at least two orientations";
    case HealthEvent::fit_rejected: return "the new calibration was refused: the old one stays in use";
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

std::string listed(const std::vector<std::string>& names) {
  std::string out;
  for (std::size_t k = 0; k < names.size(); ++k) {
    if (k > 0) out += k + 1 == names.size() ? " and " : ", ";
    out += names[k];
  }
  return out;
}

std::string measure_noise_words(const io::ArrayFile& array) {
  return "plumb noise STILL.csv --array " + io::shell_word(array.path) +
         " measures it from a log of the tool at rest and prints the lines to declare";
}

std::string explain(Cause cause, Grade grade, HealthEvent event) {
  switch (cause) {
    case Cause::none: return "no reason on record";
    case Cause::power_on: return "power on. Not yet validated: hold the tool still in at least two orientations";
    case Cause::parity: return "the sensors disagree with one another";
    case Cause::norm: return "the length of the vector differs from gravity; three sensors cannot isolate the cause";
    case Cause::mae: return "a group of three sensors measures a wrong length of gravity";
    case Cause::norm_mismatch: return "the sensors agree, but the length differs from gravity; no sensor is suspected";
    case Cause::moving: return "the tool moves: blocks in motion are not tested";
    case Cause::isolated_fault:
      return grade == Grade::provisional
                 ? "the named sensor is provisionally excluded; the others must still be validated"
                 : "one consistent hypothesis is left: the named sensor is faulty and "
                   "excluded";
    case Cause::no_consistent_hypothesis: return "no consistent hypothesis";
    case Cause::channel_lost: return "a channel stopped delivering usable values";
    case Cause::channel_back: return "a lost channel delivers again; it is not used yet";
    case Cause::temperature: return "outside the calibrated temperature span";
    case Cause::isolation_timeout: return "the fault could not be isolated in time";
    case Cause::calibration: return about_calibration(event);
    case Cause::probation: return "the sensor agreed with the others and is back in service";
    case Cause::host_request: return "requested by the host";
    case Cause::time_fault: return "time did not increase: the sample was refused";
    case Cause::gap: return "a gap in the data: the block starts again";
    case Cause::passed_block: return "consistency check passed on consecutive blocks";
    case Cause::noisy: return "a sensor scatters while the others are at rest";
    case Cause::stuck: return "a sensor repeats one value while the others show a change";
    case Cause::clipped: return "a sensor is at full scale although the others predict less";
    case Cause::rotating: return "the tool rotates at an unknown rate: its effect on the sensors is unknown";
    case Cause::inhibited: return "the host inhibited exclusion and recalibration";
    case Cause::released: return "the host allowed exclusion and recalibration again";
    case Cause::common_scale: return "the gravity value or a common scale factor is wrong: the direction is usable";
    case Cause::common_bias: return "the sensors share a bias: the direction is not usable";
    case Cause::snapshot_refused: return "started without history: the snapshot was refused";
    case Cause::calibration_contradicted:
      return "the first attitudes contradict the uncertainty of the calibration: calibrate again";
    case Cause::parity_in_motion: return "the sensors disagree with one another while the tool moves";
    case Cause::memory:
      return "the memory of the monitor was corrupted: configure the monitor again or restore a snapshot";
  }
  return "?";
}

std::string explain(const verification::NamedEvent& event, const SensorArray& array) {
  const SensorSet scatters = event.noisy | (event.cause == Cause::noisy ? event.sensors : SensorSet());
  std::string out = explain(event.cause, event.grade, event.event);
  if (!scatters.empty())
    out = (event.cause == Cause::noisy ? "" : out + "; ") + sensor_names(scatters, array) +
          (scatters.size() == 1 ? " scatters" : " scatter") + " while the others are at rest";
  if (!event.stuck.empty()) out += "; stuck: " + sensor_names(event.stuck, array);
  if (!event.clipped.empty())
    out += "; at full scale although the others predict less: " + sensor_names(event.clipped, array);
  return out;
}

const char* meaning(HealthState state) noexcept {
  switch (state) {
    case HealthState::nominal: return "all sensors agree and are in use";
    case HealthState::suspect: return "a limit was exceeded, or the sensors are not yet validated";
    case HealthState::isolated: return "a faulty sensor is excluded; the rest can still check one another";
    case HealthState::degraded_3_sensor:
      return "no redundancy left: a further fault cannot be isolated, and with three sensors it may not be detected";
    case HealthState::recalibrating: return "new coefficients are being estimated";
    case HealthState::failed: return "too few sensors, or no bound on the error: the output must not be used";
  }
  return "?";
}

const char* meaning(Validity validity) noexcept {
  switch (validity) {
    case Validity::valid: return "may be used";
    case Validity::degraded: return "may be used, without redundancy";
    case Validity::unconfirmed: return "do not rely on it yet";
    case Validity::held: return "an older value, from before the tool moved";
    case Validity::invalid: return "must not be used";
  }
  return "?";
}

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb

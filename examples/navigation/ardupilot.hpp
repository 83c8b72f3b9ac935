// plumb's verdict in motion for ArduPilot. Its consumers ask AP_InertialSensor: a lane of EKF3 takes the accelerometer
// of its own instance while use_accel(i) says so (healthy, and INS_USE set), else the first usable one; the arming
// checks want all of them healthy. What takes an instance out at run time is kill_imu(i), which takes its gyro too
// (AP_INERTIALSENSOR_KILL_IMU_ENABLED). EK3_AFFINITY and the lane's error score know nothing of accelerometers.
#pragma once

#include <array>

#include "in_flight.hpp"

namespace plumb_ardupilot {

/// Takes faulty instances out and gives them back when they are told to be healthy; in between, and for who is under
/// suspicion, nothing changes. `killed`: those that this function took out, bit i the instance i; what a pilot's switch
/// took out stays out. Returns the new mask. ArduPilot keeps the last usable instance, faulty or not: look at
/// use_accel(i) after its next update().
template <class InertialSensor, std::size_t N>
std::uint8_t apply(InertialSensor& ins, std::uint8_t killed, const plumb::MotionVerdict& v,
                   const std::array<plumb::SensorSet, N>& imus) {
  static_assert(N <= 8, "the mask has eight bits");
  for (std::size_t i = 0; i < N; ++i) {
    const plumb_flight::Told told = plumb_flight::told(v, imus[i]);
    const std::uint8_t bit = static_cast<std::uint8_t>(1U << i);
    if (told == plumb_flight::Told::faulty) {
      ins.kill_imu(static_cast<std::uint8_t>(i), true);
      killed = static_cast<std::uint8_t>(killed | bit);
    } else if (told == plumb_flight::Told::healthy && (killed & bit) != 0) {
      ins.kill_imu(static_cast<std::uint8_t>(i), false);
      killed = static_cast<std::uint8_t>(killed & ~bit);
    }
  }
  return killed;
}

/// The auxiliary authorisation of AP_Arming, `id` from get_aux_auth_id(): passed only while every instance is healthy.
template <class Arming, std::size_t N>
void authorise(Arming& arming, std::uint8_t id, const plumb::MotionVerdict& v,
               const std::array<plumb::SensorSet, N>& imus) {
  bool healthy = N > 0, faulty = false;
  for (const plumb::SensorSet axes : imus) {
    healthy = healthy && plumb_flight::told(v, axes) == plumb_flight::Told::healthy;
    faulty = faulty || plumb_flight::told(v, axes) == plumb_flight::Told::faulty;
  }
  if (healthy) return arming.set_aux_auth_passed(id);
  const bool why = v.cause != plumb::MotionCause::none;
  arming.set_aux_auth_failed(id, faulty ? "accelerometer isolated" : why ? to_string(v.cause) : "no bounded force");
}

/// The force as the accelerometer of an external IMU (AP_ExternalAHRS::ins_data_message_t, for handle_external); gyro
/// and temperature are yours. False: do not hand it over. ArduPilot stamps it on arrival: its age, 1.5 samples, is
/// lost.
template <class InsData>
bool fill(InsData& out, const plumb::MotionVerdict& v) {
  if (plumb_flight::told(v) != plumb_flight::Told::healthy) return false;
  out.accel.x = static_cast<float>(v.sample.force_mps2[0]);
  out.accel.y = static_cast<float>(v.sample.force_mps2[1]);
  out.accel.z = static_cast<float>(v.sample.force_mps2[2]);
  return true;
}

}  // namespace plumb_ardupilot

// What three autopilots are told of the drone's chips, as one line of text: the chip that PX4 flies on and those that
// it is told are healthy, the accelerometers that ArduPilot's lanes read, the health bit of MAVLink. Here the second
// chip, which fails, has the highest priority, so that it is flown until then.
#pragma once

#include <string>

#include "ardupilot.hpp"
#include "drone.hpp"
#include "mavlink.hpp"
#include "px4_flight.hpp"
#include "px4_imu.hpp"
#include "strapdown.hpp"
#include "stub/ardupilot_ins.hpp"
#include "stub/mavlink_messages.hpp"
#include "stub/px4_messages.hpp"

class Autopilots {
 public:
  std::string step(const plumb::MotionSample& sample, const plumb::MotionVerdict& v) {
    for (std::size_t c = 0; c < kChips; ++c) {
      const double* reading_mps2 = &sample.reading_mps2[3 * c];
      recent_[c].add(sample.time_s, {reading_mps2[0], reading_mps2[1], reading_mps2[2]});
      if (v.sample.span_s > 0.0) chips_[c].specific_force_mps2 = recent_[c].at(v.sample.time_s);
    }
    plumb_px4::fill(status_, differences_mps2_, v, chips_);
    plumb_px4::select(selection_, status_);
    velocities_ += plumb_px4::fill(imu_, v.sample) ? 1 : 0;
    killed_ = plumb_ardupilot::apply(ins_, killed_, v, imus_);
    ins_.update();
    plumb_mavlink::fill(sys_status_, v, plumb::SensorSet::first(kSensors));
    return line();
  }
  int velocities() const { return velocities_; }

 private:
  std::string line() const {
    std::string healthy, lanes;
    for (std::uint8_t c = 0; c < kChips; ++c) {
      healthy += status_.accel_healthy[c] ? std::to_string(c + 1) : "-";
      lanes += std::to_string((ins_.use_accel(c) ? c : ins_.get_first_usable_accel()) + 1);
    }
    return "  " + std::to_string(selection_.accel_device_id) + "      " + healthy + "           " + lanes + "        " +
           (sys_status_.onboard_control_sensors_health != 0 ? "yes" : "no");
  }

  std::array<plumb_px4::Instance, 4> chips_{
      {{1, 50, sensors_of(0), {}}, {2, 75, sensors_of(1), {}}, {3, 50, sensors_of(2), {}}, {}}};
  std::array<plumb::SensorSet, kChips> imus_{sensors_of(0), sensors_of(1), sensors_of(2)};
  std::array<Recent, kChips> recent_;
  plumb_px4::Differences differences_mps2_{};
  sensors_status_imu_s status_{};
  sensor_selection_s selection_{};
  vehicle_imu_s imu_{};
  AP_InertialSensor ins_{kChips};
  std::uint8_t killed_ = 0;
  mavlink_sys_status_t sys_status_{};
  int velocities_ = 0;
};

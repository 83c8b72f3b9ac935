// Stand-ins for what the adapter uses of ArduPilot's AP_InertialSensor, AP_Arming and AP_ExternalAHRS, with their rules
// of who is usable.
#pragma once

#include <cstdint>

struct Vector3f {
  float x, y, z;
};

class AP_InertialSensor {
 public:
  explicit AP_InertialSensor(std::uint8_t count) : count_(count) {}

  std::uint8_t get_accel_count() const { return count_; }
  bool get_accel_health(std::uint8_t i) const { return i < count_ && (healthy_ >> i & 1U) != 0; }
  bool use_accel(std::uint8_t i) const { return get_accel_health(i) && (use_ >> i & 1U) != 0; }
  std::uint8_t get_first_usable_accel() const { return first_usable_; }
  bool get_accel_health_all() const {
    for (std::uint8_t i = 0; i < count_; ++i) {
      if (!get_accel_health(i)) return false;
    }
    return count_ > 0;
  }

  /// The last usable instance stays.
  void kill_imu(std::uint8_t i, bool kill) {
    const unsigned mask = kill ? killed_ | 1U << i : killed_ & ~(1U << i);
    if (!kill || (usable() & ~mask) != 0) killed_ = mask;
  }
  /// Healthy is who published since the last update; killed instances do not.
  void update() {
    healthy_ = ~killed_;
    for (std::uint8_t i = count_; i-- > 0;) {
      if (use_accel(i)) first_usable_ = i;
    }
  }
  void set_use(std::uint8_t i, bool use) { use_ = use ? use_ | 1U << i : use_ & ~(1U << i); }  // INS_USE, INS_USE2, ...

 private:
  unsigned usable() const {
    unsigned mask = 0;
    for (std::uint8_t i = 0; i < count_; ++i) mask |= use_accel(i) ? 1U << i : 0U;
    return mask;
  }
  std::uint8_t count_, first_usable_ = 0;
  unsigned use_ = ~0U, healthy_ = 0, killed_ = 0;
};

class AP_Arming {
 public:
  void set_aux_auth_passed(std::uint8_t) { passed = true, message = ""; }
  void set_aux_auth_failed(std::uint8_t, const char* fail_msg) { passed = false, message = fail_msg; }
  bool passed = false;
  const char* message = "";
};

struct ins_data_message_t {
  Vector3f accel, gyro;  // m/s^2, rad/s
  float temperature;
};

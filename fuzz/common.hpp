/// What the harnesses share. A harness does more than not to crash: what must hold for every input is `demand`ed, and a
/// demand that fails is a finding.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>

#include "plumb/health/health_monitor.hpp"

namespace fuzz {

inline void demand(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "demanded, and does not hold: %s\n", what);
  std::abort();
}

/// Takes figures off the front of the input; zeros when it is used up.
class Bytes {
 public:
  Bytes(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}
  bool empty() const { return at_ >= size_; }
  template <class T>
  T take() {
    T value{};
    const std::size_t n = sizeof value < size_ - at_ ? sizeof value : size_ - at_;
    if (n != 0) std::memcpy(&value, data_ + at_, n);
    at_ += n;
    return value;
  }

 private:
  const std::uint8_t* data_;
  std::size_t size_;
  std::size_t at_ = 0;
};

/// What holds after every step, whatever came in.
inline void demand_sound(const plumb::Verdict& v) {
  using plumb::SensorSet;
  demand(v.state <= plumb::HealthState::failed, "a state of the table");
  demand((v.in_service & v.excluded).empty() && (v.in_service & v.absent).empty(), "in service is not out of service");
  demand((v.in_service | v.provisionally_excluded | v.excluded | v.absent) == v.configured,
         "every sensor is somewhere");
  bool finite = true;
  for (const double x : v.gravity_mps2) finite = finite && x - x == 0.0;
  for (const double x : v.covariance) finite = finite && x - x == 0.0;
  const bool usable = v.validity == plumb::Validity::valid || v.validity == plumb::Validity::degraded;
  demand(finite || !usable, "what is usable is finite");
  for (std::size_t k = 0; k < 9 && usable; k += 4) demand(v.covariance[k] >= 0.0, "a variance");
  demand(!v.protection_available || v.protection_level_calibrated_axes_rad >= 0.0, "a bound is no less than zero");
  demand(v.state != plumb::HealthState::failed || v.validity == plumb::Validity::invalid, "failed is invalid");
}

}  // namespace fuzz

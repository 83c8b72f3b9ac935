/// A run for the target: the setup of a monitor, its samples, and what the host asks on the way, as 64-bit words. The
/// recorder writes it on the host with 24 sensors' room; the replay reads it, on host and target, with less.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

#include "plumb/health/health_monitor.hpp"

namespace metal {
inline namespace PLUMB_ABI {

inline constexpr std::uint64_t kMagic = 0x31305f6c6174656dULL;  // "metal_01"

/// What the host does before a sample.
enum class Request : std::uint64_t {
  none,
  recalibrate,
  reset,        ///< `argument`: the sensors to return to service, with the right key
  power_cycle,  ///< snapshot, everything forgotten, restore
  offer,        ///< the calibration in force as one made elsewhere
  forged,       ///< a snapshot with one bit changed must be refused; then the true one is restored
};

struct Row {
  plumb::Sample sample;
  Request request = Request::none;
  std::uint64_t argument = 0;
};

/// Words out, or only counted.
class WordWriter {
 public:
  WordWriter(std::uint64_t* to, std::size_t room) noexcept : to_(to), room_(room) {}
  void word(std::uint64_t value) noexcept {
    if (used_ < room_) to_[used_] = value;
    ++used_;
  }
  void number(double value) noexcept {
    std::uint64_t bits = 0;
    std::memcpy(&bits, &value, sizeof bits);
    word(bits);
  }
  std::size_t used() const noexcept { return used_; }
  bool full() const noexcept { return used_ > room_; }

 private:
  std::uint64_t* to_;
  std::size_t room_;
  std::size_t used_ = 0;
};

/// Words in. Beyond the end it gives zeros and says so.
class WordReader {
 public:
  WordReader(const std::uint64_t* from, std::size_t size) noexcept : from_(from), left_(size) {}
  void word(std::uint64_t& value) noexcept {
    value = 0;
    if (left_ == 0) {
      short_ = true;
      return;
    }
    value = *from_++;
    --left_;
  }
  void number(double& value) noexcept {
    std::uint64_t bits = 0;
    word(bits);
    std::memcpy(&value, &bits, sizeof value);
  }
  bool ran_short() const noexcept { return short_; }

 private:
  const std::uint64_t* from_;
  std::size_t left_;
  bool short_ = false;
};

/// All that is configured but the array's rows, in one order for both directions.
template <class Words, class Setup, class Uncertainty>
void transfer_setup(Words& words, Setup& setup, Uncertainty& uncertainty, std::size_t n) noexcept {
  for (std::size_t i = 0; i < n; ++i) {
    auto& c = setup.model.sensor[i];
    for (auto& v : c.scale) words.number(v);
    for (auto& v : c.bias) words.number(v);
    words.number(c.reference_degc);
    words.number(setup.full_scale_raw[i]);
    words.number(setup.resolution_raw[i]);
    words.number(uncertainty.misfit_mps2[i]);
  }
  for (std::size_t k = 0; k < 4 * n * (4 * n + 1) / 2; ++k) words.number(uncertainty.covariance[k]);
  words.number(uncertainty.common_scale);
  words.number(setup.gravity.g_mps2);
  words.number(setup.gravity.sigma_mps2);
  words.number(setup.config.temperature_min_degc);
  words.number(setup.config.temperature_max_degc);
}

}  // namespace PLUMB_ABI
}  // namespace metal

/// For tests of the snapshot: bytes of a monitor, forged bytes that pass the check sum, and a life that leads a monitor
/// through all its states.
#pragma once

#include <cstring>
#include <limits>
#include <memory>
#include <type_traits>
#include <vector>

#include "plumb/core/detail/archive.hpp"
#include "plumb/health/snapshot.hpp"
#include "recalibration_support.hpp"

namespace plumb_test {

using Bytes = std::vector<std::uint8_t>;

inline Bytes snapshot_of(const plumb::HealthMonitor& monitor) {
  Bytes bytes(monitor.snapshot_size());
  const plumb::Expected<std::size_t> size = monitor.snapshot(bytes.data(), bytes.size());
  EXPECT_TRUE(size.has_value());
  EXPECT_EQ(*size, bytes.size());
  EXPECT_LE(bytes.size(), plumb::HealthMonitor::snapshot_size_max());
  return bytes;
}

/// Every figure of a verdict, bit for bit.
inline Bytes bits_of(const plumb::Verdict& verdict) {
  Bytes bytes(plumb::stored_size_max<plumb::Verdict>());
  plumb::ArchiveWriter out(bytes.data(), bytes.size(), plumb::kCapacity);
  out.put(verdict);
  return bytes;
}

/// Makes the size in the header and the check sum true again.
inline void seal(Bytes& bytes) {
  for (std::size_t k = 0; k < 4; ++k) bytes[24 + k] = static_cast<std::uint8_t>(bytes.size() >> (8 * k));
  plumb::Crc64 crc;
  crc.add(bytes.data(), bytes.size() - 8);
  for (std::size_t k = 0; k < 8; ++k) bytes[bytes.size() - 8 + k] = static_cast<std::uint8_t>(crc.value() >> (8 * k));
}

/// Where every scalar of a snapshot lies: an archive that neither writes nor reads.
class Places {
 public:
  struct Place {
    std::size_t at, width;
    bool real;
    const void* figure;  ///< in the monitor
  };
  explicit Places(plumb::HealthMonitor& monitor) : sensors_(monitor.array().size()) {
    plumb::transfer(*this, monitor, plumb::AnyBits{});
    EXPECT_EQ(plumb::kSnapshotFrameSize + end_, monitor.snapshot_size());
  }
  int sensors() const noexcept { return sensors_; }
  void fail() noexcept { ADD_FAILURE() << "the monitor itself is none"; }
  template <class T>
  void done(T&) noexcept {}
  template <class T, class Check>
  void scalar(T& figure, const Check&) noexcept {
    list.push_back({plumb::kSnapshotHeaderSize + end_, sizeof(T), std::is_same_v<T, double>, &figure});
    end_ += sizeof(T);
  }

  std::vector<Place> list;

 private:
  int sensors_;
  std::size_t end_ = 0;
};

/// Whether a monitor takes these bytes up, with sums that are true.
inline bool is_taken_up(plumb::HealthMonitor& victim, const plumb::MonitorSetup& setup, Bytes bytes) {
  seal(bytes);
  return victim.restore(setup, bytes.data(), bytes.size()).has_value();
}

/// A tool in trouble: faults that come and go, lost channels, motion, gaps, heat, requests of the host.
class Life {
 public:
  Life(int n, std::uint64_t seed) : tool(n, after_exclusion(), seed), luck(seed + 7) {
    tool.drift(2e-3);
    tool.fault = [this](int i, double r, int) { return i == faulty ? lie(r) : r; };
    roll();
  }
  /// The next sample; now and then the host asks for something, of every monitor in `asked` alike.
  plumb::Sample next(const std::vector<plumb::HealthMonitor*>& asked) {
    if (--left <= 0) {
      roll();
      ask(asked);
    }
    const bool shaken = moving;
    const plumb::Vec3 u = shaken ? random_direction(luck) : direction;
    plumb::Sample s = tool.rig.sample(u, g_mps2);
    s.time_s += skew_s;
    s.delivered = s.delivered - missing;
    s.temperature_degc = temperature_degc;
    if (luck.uniform() < 0.005) s.raw[0] = std::numeric_limits<double>::quiet_NaN();
    if (luck.uniform() < 0.003) s.time_s -= 1.0;
    return s;
  }

  Tool tool;
  Noise luck;
  std::uint64_t states_seen = 0;

 private:
  double lie(double r) {
    switch (kind) {
      case 0: return r + 0.3;
      case 1: return 4.0;
      case 2: return 10.0 * (luck.uniform() - 0.5);
      default: return 1.05 * r;
    }
  }
  void roll() {
    const double pick = luck.uniform();
    left = 16 + static_cast<int>(80.0 * luck.uniform());
    direction = random_direction(luck);
    moving = pick < 0.05;
    if (pick > 0.05 && pick < 0.08) skew_s += 20.0;
    temperature_degc = pick > 0.98   ? 3e9
                       : pick > 0.96 ? std::numeric_limits<double>::quiet_NaN()
                                     : 20.0 + 10.0 * luck.uniform();
    const int n = tool.rig.setup.array.size();
    const double trouble = luck.uniform();
    if (trouble < 0.04) {
      faulty = static_cast<int>(luck.uniform() * n);
      kind = static_cast<int>(luck.uniform() * 4);
    }
    if (trouble > 0.04 && trouble < 0.10) faulty = -1;
    if (trouble > 0.10 && trouble < 0.12) missing = plumb::SensorSet::of(static_cast<int>(luck.uniform() * n));
    if (trouble > 0.20 && trouble < 0.23) g_mps2 = 1.002 * plumb::kG0_mps2;
    if (trouble > 0.23 && trouble < 0.28) g_mps2 = plumb::kG0_mps2;
    if (trouble > 0.12 && trouble < 0.2) missing = plumb::SensorSet{};
  }
  void ask(const std::vector<plumb::HealthMonitor*>& asked) {
    const double pick = luck.uniform();
    const double told_mps2 = plumb::kG0_mps2 * (1.0 + 2e-4 * (luck.uniform() - 0.5));
    if (!asked.empty() && pick > 0.30 && pick < 0.33) skew_s -= 50.0;  // told, as the clock is set back
    for (plumb::HealthMonitor* monitor : asked) {
      if (pick < 0.1) monitor->request_recalibration();
      if (pick > 0.1 && pick < 0.13) monitor->reset(monitor->config().reset_key, monitor->array().all());
      if (pick > 0.15 && pick < 0.18) monitor->inhibit(true);
      if (pick > 0.18 && pick < 0.24) monitor->inhibit(false);
      if (pick > 0.24 && pick < 0.26) monitor->set_rotation({true, false, {}});
      if (pick > 0.26 && pick < 0.30) monitor->set_rotation({});
      if (pick > 0.30 && pick < 0.33) monitor->begin_time_base();
      if (pick > 0.33 && pick < 0.36)
        monitor->set_motion({true, plumb::SensorSet::of(static_cast<int>(1e4 * pick) % 8)});
      if (pick > 0.36 && pick < 0.40) monitor->set_motion({});
      if (pick > 0.13 && pick < 0.15) {
        monitor->set_gravity({told_mps2, 1e-4 * plumb::kG0_mps2, plumb::GravityModel::value});
      }
    }
  }

  plumb::Vec3 direction{};
  int left = 0;
  bool moving = false;
  double skew_s = 0.0;
  double g_mps2 = plumb::kG0_mps2;
  double temperature_degc = 25.0;
  int faulty = -1;
  int kind = 0;
  plumb::SensorSet missing;
};

}  // namespace plumb_test

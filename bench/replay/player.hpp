// One monitor of one case: whatever it is given and answers is told.
#pragma once

#include <memory>
#include <vector>

#include "coverage.hpp"
#include "plumb/health/health_monitor.hpp"
#include "tell.hpp"
#include "trace.hpp"

namespace plumb_replay {

/// Where a case is told.
struct Stage {
  Trace& trace;
  Coverage& coverage;
  bool tells_memory = false;  ///< with every snapshot, for the text
  /// The sample that the monitor gets otherwise than told: every finite value is one unit in the last place more.
  std::uint64_t perturbed_row = ~std::uint64_t{0};
};

inline namespace PLUMB_ABI {

/// Moves every finite value by the least that there is.
void perturb(plumb::Sample& sample);

/// Tells states, causes and cells as they are met.
class Meeting {
 public:
  void note(Coverage& coverage, const plumb::Verdict& verdict);

 private:
  bool first_ = true;
  plumb::Verdict last_;
};

class Player {
 public:
  Player(const Stage& stage, const plumb::MonitorSetup& setup);

  /// Answers of `configure`, false where it was refused.
  bool configure();
  bool configure(const plumb::MonitorSetup& setup);
  void step(const plumb::Sample& sample);
  const plumb::HealthMonitor& monitor() const { return *monitor_; }
  const plumb::MonitorSetup& setup() const { return *setup_; }
  std::uint64_t rows() const { return row_; }

  void reset(std::uint64_t key, plumb::SensorSet sensors);
  void recalibrate();
  void offer(const plumb::SensorModel& model, const plumb::SensorArray& array);
  void set_gravity(const plumb::GravityReference& gravity);
  void set_rotation(const plumb::Rotation& rotation);
  void inhibit(bool frozen);

  /// A snapshot, and another monitor that takes it up.
  void power_cycle();
  enum class Damage : std::uint8_t { truncated, flipped, foreign, empty };
  /// The same with a snapshot that is refused.
  void power_cycle(Damage damage);
  /// Somebody overwrites the monitor's storage with one byte.
  void overwrite(unsigned char byte);
  /// What is left to tell at the end.
  void finish();

 private:
  void answer(const char* request, const plumb::Expected<void>& answer);
  void tell_now();  ///< the verdict that stands between two steps
  void snapshot();
  void tell_snapshot();

  const Stage& stage_;
  std::unique_ptr<plumb::MonitorSetup> setup_;
  std::unique_ptr<plumb::HealthMonitor> monitor_ = std::make_unique<plumb::HealthMonitor>();
  Meeting meeting_;
  std::vector<std::uint8_t> bytes_;
  std::size_t size_ = 0;  ///< of the last snapshot, 0 = none
  std::uint64_t row_ = 0, ticks_ = 0;
};

}  // namespace PLUMB_ABI
}  // namespace plumb_replay

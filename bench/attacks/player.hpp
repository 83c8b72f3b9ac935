// One tool and its monitor: the world moves by what an attack sets, every sample is offered, and every verdict is held
// to the truth of that sample.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "tally.hpp"
#include "tools.hpp"

namespace plumb_bench {
inline namespace PLUMB_ABI {

class Player {
 public:
  Player(const AttackTool& tool, const plumb::MonitorConfig& config, std::uint64_t stream, bool tell = false,
         double resolution_mps2 = 0.0);

  // The world, as it is at the next sample.
  plumb::Vec3 direction{0.0, 0.0, 1.0};  ///< of gravity, in the true frame of the tool
  double g_mps2 = plumb::kG0_mps2;
  plumb::Vec3 push_mps2{};  ///< acceleration that is no gravity
  double period_s = 0.01;
  double temperature_degc = 25.0;
  double noise_factor = 1.0;  ///< times the stated sigma
  double correlation = 0.0;   ///< of the noise, from sample to sample
  double step_mps2 = 0.0;     ///< of the converter
  bool steady_motion =
      false;  ///< it moves as it did over the last two blocks: the level must hold that at every sample
  plumb::Readings shift_mps2{};
  plumb::SensorSet faulty;                     ///< may be excluded
  bool count_all = false;                      ///< also what nothing promises, under its own name
  std::function<double(int i, double)> lie{};  ///< what a faulty sensor shows in place of its reading, before noise
  double time_s = 0.0;
  plumb_test::TrialNoise noise;

  const AttackTool& tool() const { return tool_; }
  int n() const { return tool_.n(); }
  int window() const { return setup_.config.window; }
  plumb::HealthMonitor& monitor() { return *monitor_; }
  const plumb::Verdict& verdict() const { return monitor_->verdict(); }

  std::uint64_t offered() const { return offered_; }  ///< samples; a block ends at every multiple of the window

  /// The next sample of the world as it is; time goes on by one period.
  plumb::Sample next();
  const plumb::Verdict& offer(const plumb::Sample& sample);
  void rest(int samples);
  void block(int blocks = 1) { rest(blocks * window()); }
  void turn_to(const plumb::Vec3& to, double rate_radps);
  /// States how far every sensor may have drifted, and powers on anew. Before the first sample.
  void state_stability(const plumb::Stability& stability);
  /// Honest blocks at random attitudes until nominal, sixty at most.
  void settle();
  /// From here on blocks count for availability.
  void attack() { counting_ = true; }
  /// A snapshot, and another monitor that takes it up.
  void power_cycle();

  /// What it came to; what went wrong first, of each kind, one line each.
  Tally finish();
  const std::vector<std::string>& findings() const { return findings_; }

 private:
  void note_motion();
  void note_data(const plumb::Sample& sample);
  void note_block();
  void tell_change() const;
  void judge();
  void judge_sensors();
  void judge_claims();
  void judge_vector();
  void find(Count what, bool promised, const std::string& how);

  const AttackTool& tool_;
  bool tell_;
  plumb::MonitorSetup setup_;
  std::unique_ptr<plumb::HealthMonitor> monitor_ = std::make_unique<plumb::HealthMonitor>();
  int strict_, parity_;  ///< grades of the whole array, counted from its axes
  Tally tally_;
  std::vector<std::string> findings_;
  bool counting_ = false;
  std::uint64_t offered_ = 0, nominal_after_ = 0;  ///< samples; blocks, 0 = not yet
  plumb::Readings slow_{};                         ///< state of correlated noise

  // What the newest verdict may rest on.
  plumb::Vec3 last_direction_{};
  std::uint64_t still_ = 0, since_tick_ = 0;  ///< samples at this attitude; samples since a block became complete
  std::uint64_t dry_ = 0;                     ///< samples in a row that did not bring every sensor in service
  double last_time_s_ = -1e9, last_full_s_ = -1e9;
  bool refused_ = false, behind_gap_ = false;
};

}  // namespace PLUMB_ABI
}  // namespace plumb_bench

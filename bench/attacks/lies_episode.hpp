// One episode of an attack: who lies, how, what else happens, and what the monitor made of it.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "lies.hpp"
#include "tools.hpp"

namespace plumb_bench {
inline namespace PLUMB_ABI {

class LiesEpisode {
 public:
  LiesEpisode(const AttackTool& tool, Situation situation, int lie, std::uint64_t seed, std::uint64_t number,
              bool tell);
  /// Plays it; what went wrong is one line each in `finds`.
  LiesCount play(std::vector<std::string>& finds);

 private:
  void plan();
  void configure();
  void host_before(int station);
  void offer();
  void power_cycle();
  void reset_if_failed();
  bool lies_at(int station, bool second_half) const;
  void visit(int station);
  void shake(plumb::Readings& y, const plumb::Vec3& along, double rms_mps2);
  void send(plumb::Sample& sample);
  void disturb_and_send(plumb::Sample& sample);
  void note_availability();
  void judge();
  void note_bounds();
  void judge_vector();
  void find(std::uint64_t& counter, const std::string& what);

  const AttackTool& tool_;
  Situation situation_;
  int lie_;
  std::uint64_t number_;
  bool tell_;
  plumb_test::TrialNoise noise_;
  double gravity_sigmas_;
  plumb_test::LawCase case_;
  plumb_test::TrialAttitudes attitudes_;
  plumb::MonitorSetup setup_;
  std::unique_ptr<plumb::HealthMonitor> monitor_ = std::make_unique<plumb::HealthMonitor>();
  plumb::SensorSet liars_;
  int strict_ = 0, parity_ = 0;  ///< grades that the monitor claims; the laws count them anew
  double time_s_ = 0.0;
  int stations_ = 0, onset_ = 0, pause_ = 0, resume_ = 0;  ///< station numbers; pause 0 = none
  bool mid_block_ = false, follows_motion_ = true;
  plumb::Vec3 direction_{};
  plumb::Vec3 pushed_mps2_{};   ///< sum over the rows of the block
  bool within_bounds_ = true;   ///< no motion below the noise has made gravity look more than three sigmas off
  double hidden_sigmas_ = 0.0;  ///< how far gravity ever looked off in a block that passed for quiet
  int steady_rows_ = 0;         ///< accepted in this direction
  int silent_ = -1, silent_rows_ = 0;
  LiesCount count_;
  std::vector<std::string>* finds_ = nullptr;
};

}  // namespace PLUMB_ABI
}  // namespace plumb_bench

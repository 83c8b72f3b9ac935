/// Plays scenarios with the monitor of this capacity and judges what it publishes (private to src/campaign).
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "generator.hpp"
#include "plumb/campaign/kernel.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace campaign_kernel {

/// Follows one scenario sample by sample. What it is given comes from the spec alone, never from the monitor.
class Judge {
 public:
  void begin(const Plan& plan, const Spec& spec, campaign::Outcome& outcome) noexcept;
  /// After every sample; `row` counts from 0, `truth` is gravity at its station.
  void look(const Verdict& verdict, int row, const Vec3& truth) noexcept {
    const bool ends = row == block_end_;
    if (ends || verdict.transition.sequence != 0) note(verdict, truth, ends);
  }
  void end(const Verdict& verdict) noexcept;

 private:
  void note(const Verdict& verdict, const Vec3& truth, bool ends) noexcept;

  campaign::Outcome* out_ = nullptr;
  int window_ = 1;
  int block_end_ = 0;  ///< row that completes the block
};

class Player final : public campaign::Kernel {
 public:
  explicit Player(const Plan& plan) : plan_(plan), generator_(plan_), from_s_(start_s(plan_)) {}

  /// Configures a monitor for every tool and has it be validated. Empty, or why it cannot.
  std::string prepare();
  void play(const Spec& spec, campaign::Outcome& outcome) noexcept override;
  int capacity() const noexcept override { return kCapacity; }

 private:
  void run(const Spec& spec, double from_s, campaign::Outcome& outcome) noexcept;

  Plan plan_;
  Generator generator_;
  double from_s_;
  HealthMonitor monitor_;
  std::vector<HealthMonitor> start_;  ///< by tool: as every scenario finds it
};

/// The kernel of this capacity, or null and why.
std::unique_ptr<campaign::Kernel> make(const Plan& plan, std::string& refusal);

}  // namespace campaign_kernel
}  // namespace PLUMB_ABI
}  // namespace plumb

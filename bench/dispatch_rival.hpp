/// The monitor's table as a state machine of Boost.MSM, for the benchmark of the dispatch alone.
#pragma once

#include <cstddef>

#include "plumb/health/transition_table.hpp"

namespace plumb_bench {
inline namespace PLUMB_ABI {

/// Facts that lead through every state: one sensor lost isolates, the next degrades, the third is one too many.
constexpr plumb::TargetFacts facts_at(plumb::Mode mode, plumb::HealthEvent event) noexcept {
  using plumb::Mode;
  using plumb::SizeClass;
  plumb::TargetFacts facts;
  facts.enough_passed = facts.calibrated = true;
  const bool better = event == plumb::HealthEvent::probation_passed || event == plumb::HealthEvent::passed_block;
  facts.size = mode == Mode::nominal ? SizeClass::reduced : better ? SizeClass::all_configured : SizeClass::critical;
  if (mode == Mode::degraded) facts.size = better ? SizeClass::reduced : SizeClass::rank_lost;
  return facts;
}

class MsmMachine {
 public:
  MsmMachine();
  ~MsmMachine();
  MsmMachine(const MsmMachine&) = delete;
  MsmMachine& operator=(const MsmMachine&) = delete;
  /// The events one after the other; where the machine is in the end.
  plumb::Mode run(const plumb::HealthEvent* events, std::size_t count);
  static std::size_t size() noexcept;

 private:
  struct Engine;
  Engine* engine_;
};

}  // namespace PLUMB_ABI
}  // namespace plumb_bench

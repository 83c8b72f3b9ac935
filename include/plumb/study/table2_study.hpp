/// Table 2 of the paper again: its 23 experiments with its rule and its limit, over many attitudes; and what plumb's
/// monitor makes of the same samples.
#pragma once

#include <array>

#include "plumb/health/health_monitor.hpp"
#include "plumb/paper/paper_rule.hpp"
#include "plumb/study/experiments.hpp"
#include "plumb/study/fits.hpp"
#include "plumb/study/proportion.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace study {

struct Table2Result {
  PaperFinding finding;
  bool same_verdict = false;  ///< detection and isolation as printed
  // plumb's monitor, proven before the fault, at the end of the same samples.
  HealthState state = HealthState::suspect;
  SensorSet excluded;    ///< for good or provisionally
  SensorSet ever_named;  ///< at any time
  int named_after = 0;   ///< attitudes until the first exclusion; 0: none
  int silent = 0;        ///< attitudes at whose end the output was valid and not suspect with a faulty sensor in use
};

struct Table2Study {
  std::array<Table2Result, kExperiments> result;
  int same_verdicts() const noexcept;
};

/// Attitudes and samples of each that are pooled, as the paper does; one block of the monitor each.
inline constexpr int kTable2Attitudes = 36;
inline constexpr int kBlock = 32;

StudyExpected<Table2Study> table2_study(const Fits& fits, const scenario::Tool& tool, std::uint64_t seed,
                                        RandomLaw law = RandomLaw::held, int attitudes = kTable2Attitudes);

/// The table again with other tools, other noise and other attitudes: how many of `tools` give all verdicts as printed.
StudyExpected<Proportion> all_verdicts_as_printed(std::uint64_t seed, int tools);

/// A monitor with plumb's calibration that is validated: nominal, after healthy samples at several attitudes.
struct ProvenMonitor {
  std::unique_ptr<HealthMonitor> monitor;  ///< 2 MB: on the heap
  double last_time_s = 0.0;
  std::uint32_t last_station = 0;

  /// The samples moved behind those that proved it, `station` attitudes later, at a new station.
  std::vector<Sample> continued(std::vector<Sample> samples, int station) const;
};
StudyExpected<ProvenMonitor> proven_monitor(const Fits& fits, const scenario::Tool& tool, std::uint64_t seed);

}  // namespace study
}  // namespace PLUMB_ABI
}  // namespace plumb

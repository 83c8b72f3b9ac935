/// The campaigns of a verification report: one without faults, for false alarms and availability, one with every kind
/// of fault within the array's grade. Every scenario leaves a row, so that tables, times and worst cases come from one
/// source.
#pragma once

#include <cstdint>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "plumb/campaign/campaign_file.hpp"
#include "plumb/campaign/engine.hpp"
#include "plumb/campaign/tally.hpp"
#include "plumb/io/array_file.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace report {

using Json = nlohmann::ordered_json;

/// What the campaigns are played with, beside the array file.
struct TrialSettings {
  int faults = 1;  ///< sensors at fault at once, at most; never beyond the strict grade where there is one
  double alert_limit_rad = 0.0;
  double e_cal_mps2 = 0.0;  ///< 1 sigma of what calibration left in a reading; 0 = nothing
  double days_since_calibration = 0.0;
  std::uint64_t seed = 1;
  std::uint64_t scenarios = 0;        ///< of each campaign
  std::uint32_t samples_per_row = 1;  ///< behind every row of the log, where its rows are means
};

/// The campaign files (docs/campaign.md). `array_path` is how they name the array file.
std::string fault_campaign(const io::ArrayFile& array, const std::string& array_path, const TrialSettings& settings);
std::string healthy_campaign(const io::ArrayFile& array, const std::string& array_path, const TrialSettings& settings);

/// What became of one scenario.
struct Trial {
  std::uint64_t number = 0;
  int cell = 0;
  std::uint32_t faulty = 0, excluded = 0, ever_excluded = 0, ever_set_aside = 0;  ///< bits of sensors
  int blocks = 0, first_fault_block = -1, alarm_block = -1, isolated_block = -1;
  bool failed = false, misleading = false, beyond_protection = false;
  double largest_mdb = 0.0;  ///< of a lone constant shift
  double tilt_before_alarm_rad = 0.0;
  double tilt_usable_rad = 0.0;  ///< largest error while published as usable and without an alert
  double excess_rad = 0.0;       ///< largest error less its protection level, where above it

  bool detected() const noexcept { return first_fault_block >= 0 && alarm_block >= first_fault_block; }
};

struct Trials {
  campaign::CampaignFile file;
  campaign::Progress counted;
  std::vector<Trial> trial;  ///< by number
};

/// Plays all scenarios of the file. The result does not depend on `threads`. `progress` sees how many are done and may
/// end it by false. Errors: those of `make_kernel`; "interrupted".
tl::expected<Trials, std::string> play_trials(const campaign::CampaignFile& file, int threads,
                                              const std::function<bool(std::uint64_t)>& progress);

/// One line a scenario, header first.
std::string trials_csv(const Trials& trials);

/// Tables, times, diagrams and worst cases, every rate as k of n with its interval. `command` is what replays scenario
/// numbers, to be completed by one.
Json fault_trials_json(const Trials& trials, const std::string& command);
Json healthy_trials_json(const Trials& trials, const std::string& command);

/// The first scenarios again by other code (the simulator, and the monitor for 24 sensors): whether both agree, and
/// which states, transitions and cells of the table they led through. `step_ns`, where given, gets how long every step
/// of that monitor took.
tl::expected<Json, std::string> replayed_json(const std::vector<const Trials*>& campaigns, std::uint64_t scenarios,
                                              std::vector<std::int64_t>* step_ns = nullptr);

/// Number, median, 99.9 % and high-water mark of these times; null where there are none.
Json step_times_json(std::vector<std::int64_t> step_ns);

/// k of n with its 95 % Clopper-Pearson interval.
Json rate_json(std::uint64_t count, std::uint64_t of);

}  // namespace report
}  // namespace PLUMB_ABI
}  // namespace plumb

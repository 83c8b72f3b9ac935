/// The campaigns of a verification report: one without faults, for false alarms and availability, one with every kind
/// of fault within the array's grade. Every scenario leaves a row, so that tables, times and worst cases come from one
/// source.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "plumb/campaign/campaign_file.hpp"
#include "plumb/campaign/engine.hpp"
#include "plumb/campaign/tally.hpp"
#include "plumb/io/array_file.hpp"
#include "plumb/verification/facts.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace verification {

/// What the campaigns are played with, beside the array file.
struct TrialSettings {
  int faults = 1;  ///< sensors at fault at once, at most; never beyond the confirmed grade where there is one
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
  std::uint32_t faulty = 0, excluded = 0, ever_excluded = 0, ever_provisionally_excluded = 0;  ///< bits of sensors
  int blocks = 0, first_fault_block = -1, alarm_block = -1, isolated_block = -1;
  bool failed = false, misleading = false, beyond_protection = false;
  double largest_mdb = 0.0;  ///< of a single constant shift
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

/// Blocks in which a first false alarm could come: of a scenario with one, those up to it.
std::uint64_t blocks_at_risk(const Trials& healthy);
/// The same of a longer campaign that was only counted, at most; 0 where the scenarios played here differ in length.
std::uint64_t blocks_at_risk(const Trials& healthy, const campaign::Tally& longer);

/// The counts without the zeros at their end.
std::vector<std::uint64_t> up_to_the_last(const std::array<std::uint64_t, campaign::kMostBlocks>& counts);

/// What the campaigns showed, and with the rates of a longer one in the place of theirs.
HealthyCampaign healthy_facts(const Trials& played);
void take_longer(const Trials& played, const campaign::Tally& longer, HealthyCampaign& out);
FaultCampaign fault_facts(const Trials& played);
void take_longer(const campaign::Tally& longer, FaultCampaign& out);

/// One line a scenario, header first.
std::string trials_csv(const Trials& trials);

}  // namespace verification
}  // namespace PLUMB_ABI
}  // namespace plumb

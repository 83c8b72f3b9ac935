/// What a verification judges. A criterion is known by its id: titles are for people, and nothing is looked up by them.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "plumb/core/config.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace verification {

enum class CriterionId : std::uint8_t {
  faults_isolated,
  protection_level,
  detectable_fault,
  calibration_accepted,
  wiring_confirmed,
  healthy_campaign_played,
  fault_campaign_played,
  false_alarms,
  available_while_healthy,
  wrong_exclusion,
  misleading,
  time_to_detect,
  replay_agrees,
  requirements_traced,
  requirements_failed,
  tests_of_this_build,
  requirements_verified,
  proofs_of_this_build,
  proofs_hold,
  analysis_findings,
  target_resources,
};
inline constexpr int kCriteria = static_cast<int>(CriterionId::target_resources) + 1;

/// The branches of the argument. Every criterion stands in exactly one.
enum class Strategy : std::uint8_t { geometry, calibration, campaign, proof, requirements, build };
inline constexpr int kStrategies = static_cast<int>(Strategy::build) + 1;

struct CriterionEntry {
  CriterionId id;
  const char* key;  ///< in files; stays when the title is reworded
  Strategy strategy;
  const char* title;
};

// clang-format off
inline constexpr std::array<CriterionEntry, kCriteria> kCriterionTable = {{
    {CriterionId::faults_isolated,         "faults_isolated",         Strategy::geometry,     "Faulty sensors isolated with confirmation"},
    {CriterionId::protection_level,        "protection_level",        Strategy::geometry,     "Protection level against the alert limit"},
    {CriterionId::detectable_fault,        "detectable_fault",        Strategy::geometry,     "Minimum detectable bias in one block"},
    {CriterionId::calibration_accepted,    "calibration_accepted",    Strategy::calibration,  "Calibration accepted"},
    {CriterionId::wiring_confirmed,        "wiring_confirmed",        Strategy::calibration,  "Wiring confirmed by a known attitude"},
    {CriterionId::healthy_campaign_played, "healthy_campaign_played", Strategy::campaign,     "Campaign: healthy"},
    {CriterionId::fault_campaign_played,   "fault_campaign_played",   Strategy::campaign,     "Campaign: faults"},
    {CriterionId::false_alarms,            "false_alarms",            Strategy::campaign,     "False alarms"},
    {CriterionId::available_while_healthy, "available_while_healthy", Strategy::campaign,     "Within the alert limit while healthy, in the axes"},
    {CriterionId::wrong_exclusion,         "wrong_exclusion",         Strategy::campaign,     "Healthy sensors excluded"},
    {CriterionId::misleading,              "misleading",              Strategy::campaign,     "Misleading output"},
    {CriterionId::time_to_detect,          "time_to_detect",          Strategy::campaign,     "Time to detect, 95 % of the detected faults"},
    {CriterionId::replay_agrees,           "replay_agrees",           Strategy::campaign,     "Independent re-run reproduces all results"},
    {CriterionId::requirements_traced,     "requirements_traced",     Strategy::requirements, "Traceability of requirements, hazards and tests"},
    {CriterionId::requirements_failed,     "requirements_failed",     Strategy::requirements, "Requirements failed"},
    {CriterionId::tests_of_this_build,     "tests_of_this_build",     Strategy::requirements, "Results of the tests of this build"},
    {CriterionId::requirements_verified,   "requirements_verified",   Strategy::requirements, "Requirements verified"},
    {CriterionId::proofs_of_this_build,    "proofs_of_this_build",    Strategy::proof,        "Results of the proofs of this build"},
    {CriterionId::proofs_hold,             "proofs_hold",             Strategy::proof,        "Proofs and model checking"},
    {CriterionId::analysis_findings,       "analysis_findings",       Strategy::build,        "Findings of the static analysis"},
    {CriterionId::target_resources,        "target_resources",        Strategy::build,        "Resources on the target"},
}};
// clang-format on

constexpr const CriterionEntry& entry_of(CriterionId id) { return kCriterionTable[static_cast<std::size_t>(id)]; }

namespace detail {

/// A row for every id, at its place; no key and no title twice.
constexpr bool rows_are_distinct() {
  for (std::size_t k = 0; k < kCriterionTable.size(); ++k) {
    const CriterionEntry& row = kCriterionTable[k];
    if (static_cast<std::size_t>(row.id) != k || row.key == nullptr || row.title == nullptr) return false;
    for (std::size_t j = 0; j < k; ++j) {
      const CriterionEntry& other = kCriterionTable[j];
      if (std::string_view(other.key) == row.key || std::string_view(other.title) == row.title) return false;
    }
  }
  return true;
}

/// No branch of the argument that nothing is judged for.
constexpr bool every_strategy_has_a_criterion() {
  for (int s = 0; s < kStrategies; ++s) {
    bool found = false;
    for (const CriterionEntry& row : kCriterionTable) found = found || static_cast<int>(row.strategy) == s;
    if (!found) return false;
  }
  return true;
}

}  // namespace detail

static_assert(detail::rows_are_distinct(), "a criterion without its row, or a key or title that stands twice");
static_assert(detail::every_strategy_has_a_criterion(), "a branch of the argument rests on no criterion");

/// Evidence on plumb itself, which a build brings along: it says nothing about the array.
constexpr bool is_evidence(CriterionId id) {
  return id == CriterionId::tests_of_this_build || id == CriterionId::requirements_verified ||
         id == CriterionId::proofs_of_this_build;
}

enum class Result : std::uint8_t { met, open, not_met };  ///< the later, the worse
inline constexpr std::array<const char*, 3> kResultWords = {"met", "open", "not met"};
constexpr const char* to_string(Result result) { return kResultWords[static_cast<std::size_t>(result)]; }

struct Criterion {
  CriterionId id = CriterionId::faults_isolated;
  Result result = Result::open;
  std::string limit, limit_from;  ///< what was asked for, and where that stands
  std::string found;
  std::string reason;  ///< empty where the criterion is met
};

/// Every field of a criterion, in the order of the report: `sink(key, text)`.
template <class Sink>
void describe(const Criterion& c, Sink&& sink) {
  sink("id", entry_of(c.id).key);
  sink("name", entry_of(c.id).title);
  sink("limit", c.limit);
  sink("limit_from", c.limit_from);
  sink("found", c.found);
  sink("result", to_string(c.result));
  sink("reason", c.reason);
}

/// From their words in files; nothing where there is no such word.
std::optional<CriterionId> criterion_of(std::string_view key) noexcept;
std::optional<Result> result_of(std::string_view word) noexcept;

}  // namespace verification
}  // namespace PLUMB_ABI
}  // namespace plumb

/// What was found out about one array, as the judgement needs it: figures, not texts or files.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "plumb/core/config.hpp"
#include "plumb/io/field.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace verification {

/// k of n with its 95 % Clopper-Pearson interval.
struct Rate {
  std::uint64_t count = 0, of = 0;
  double low = 0.0, high = 1.0;
};
Rate rate_of(std::uint64_t count, std::uint64_t of);

/// Least constant errors of one sensor; nothing where no test sees it.
struct SensorFacts {
  std::optional<double> detectable_mps2, sure_isolation_mps2;
};

/// Something that a user has to know, by name.
struct Note {
  std::string name, text;
};

struct ArrayFacts {
  io::FieldKind field = io::FieldKind::gravity;  ///< gravity or magnetic: then "mps2" is in units of 4 uT
  int confirmed_grade = 0, provisional_grade = 0;
  int units = 0;                               ///< what these count: chips where they are stated, else sensors
  std::optional<double> protection_level_deg;  ///< nothing where parity does not check every sensor
  double gravity_mps2 = 0.0;
  std::vector<SensorFacts> sensors;
  std::vector<Note> notes;  ///< warnings and known limits of its geometry
  bool chips() const { return units > 0 && units < static_cast<int>(sensors.size()); }
};

struct CalibrationFacts {
  bool accepted = false;
  std::string mode;             ///< "predicted", "stations", "calibration file", "known coefficients"
  std::string reason;           ///< of a refusal
  std::string taken_for_exact;  ///< names of the sensors of which it states no uncertainty
  bool predicted() const { return mode == "predicted"; }
  /// Of a calibration file in which nothing was fitted: no station of this tool has tested it.
  bool stated() const { return mode == "known coefficients"; }
};

/// What is known of the wirings that gravity cannot see. Open until a known attitude has spoken.
struct WiringFacts {
  enum class State : std::uint8_t { open, confirmed, contradicted };
  State state = State::open;
  std::string found;   ///< in a few words
  std::string reason;  ///< why it is open or contradicted, and what to do
};

/// How far the calibrated axes, as a whole, may be turned from the housing.
struct AlignmentFacts {
  bool in_housing = true;  ///< that is what the alert limit is about
  std::optional<double> bound_deg;
  std::string text;    ///< what it is, and by what
  std::string remedy;  ///< where it is too large
};

/// The rates are of the long campaign where its result was given.
struct HealthyCampaign {
  bool played = false;
  std::string reason;  ///< why it was not
  Rate false_alarm_per_block, unavailable;
};

struct FaultCampaign {
  bool played = false;
  std::string reason;
  Rate wrong_exclusion, misleading, isolated, ambiguous;
  std::vector<std::uint64_t> blocks_to_detect;  ///< how many faults were detected in their 1st, 2nd ... block
  double block_s = 0.0;
};

struct Replay {
  std::uint64_t agree = 0, scenarios = 0;
};

struct ProofItem {
  std::string title;
  bool holds = false;
};

/// How many there are, and of the requirements how many came to which result.
struct RequirementCounts {
  int requirements = 0, active = 0, verified = 0, failed = 0, open = 0, traced = 0, hazards = 0, tests = 0;
};

struct RequirementCount {
  const char* key;  ///< in files
  int RequirementCounts::*value;
  const char* title;  ///< null: not in the table of the requirements
};
inline constexpr RequirementCount kRequirementCounts[] = {
    {"requirements", &RequirementCounts::requirements, "all"},
    {"active", &RequirementCounts::active, "active"},
    {"verified", &RequirementCounts::verified, "verified"},
    {"failed", &RequirementCounts::failed, "failed"},
    {"open", &RequirementCounts::open, "open"},
    {"traced", &RequirementCounts::traced, "traced, results not given"},
    {"hazards", &RequirementCounts::hazards, nullptr},
    {"tests", &RequirementCounts::tests, nullptr}};

struct TraceFacts {
  std::vector<std::string> orphans;
  RequirementCounts counts;
  bool tests_given = false;                      ///< results of the tests
  std::string tests_not_of_this;                 ///< why those are not of this build; empty: they are
  std::string proofs_not_of_this;                ///< the same of the proofs
  std::optional<std::vector<ProofItem>> proofs;  ///< where their results were given
};

/// What the monitor costs on its target.
struct Resource {
  std::string name;
  double value = 0.0;
  std::optional<double> limit;
};

struct Facts {
  std::string name;  ///< of the array
  bool rows_are_stations = false;
  std::uint64_t samples_per_row = 1;
  ArrayFacts array;
  CalibrationFacts calibration;
  WiringFacts wiring;
  AlignmentFacts alignment;
  HealthyCampaign healthy;
  FaultCampaign faults;
  std::optional<Replay> replay;
  TraceFacts trace;
  std::optional<std::uint64_t> analysis_findings;  ///< where a static analysis was given
  std::optional<std::vector<Resource>> target;
};

}  // namespace verification
}  // namespace PLUMB_ABI
}  // namespace plumb

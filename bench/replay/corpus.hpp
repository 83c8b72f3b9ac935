// The generated cases: by number, the same in every run. Numbers step through array sizes, fault kinds and situations,
// whose counts have no common divisor, so that 2000 of them meet every pair.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "coverage.hpp"

namespace plumb_replay {

/// Grows with every change of the corpus: cases of two versions are not compared.
inline constexpr int kCorpusVersion = 1;

/// What the host does, or what the tool is told, beside the fault.
enum class Situation : std::uint8_t {
  plain,
  recalibrate,        ///< the host asks for one again and again
  policy,             ///< the monitor recalibrates after an exclusion
  offer_good,         ///< another fit of the same tool
  offer_wrong,        ///< biases off, a wrong size, no numbers
  offer_and_ask,      ///< offers and requests that get in each other's way
  reset,              ///< failed is left with the key; tried with a wrong one, and without need
  power_cycle,        ///< at any sample, by snapshot
  bad_snapshot,       ///< truncated, flipped, of another setup, none
  inhibit,            ///< frozen for some stations
  gravity,            ///< another length every few stations, some that are refused
  turning,            ///< the tool turns, known, unknown or wrongly told
  first_calibration,  ///< no calibration yet
  bound,              ///< an acceleration bound is stated, and the tool pushed
  asserted,           ///< the integrator's claim on the number of faults; a short isolation timeout
  stability,          ///< stability is stated, biases wander, temperature drifts
  means,              ///< every row is the mean of a station
  storage,            ///< overwritten, unconfigured, configured anew
  settings,           ///< what else a configuration can say
};
inline constexpr int kSituations = 19;
const char* to_string(Situation situation) noexcept;

inline constexpr int kLeastSensors = 3, kMostSensors = 16;
/// Entries of the fault catalogue, nobody in fault, and faults drawn freely.
inline constexpr int kFaultChoices = 31;

struct CaseNumber {
  std::uint64_t seed = 1;
  int number = 0;

  int sensors() const { return kLeastSensors + number % (kMostSensors - kLeastSensors + 1); }
  Situation situation() const { return static_cast<Situation>(number % kSituations); }
  int fault() const { return number % kFaultChoices; }
  /// Of the build that plays it: the instrument's usual one, and for every fourth case that of the host.
  int capacity() const { return sensors() <= 8 && number % 4 != 3 ? 8 : 24; }
  /// "s0007-n10-cap24-gravity-F12"
  std::string name() const;
};
/// "F12", "none", "drawn".
std::string fault_name(int choice);

/// What every corpus of that many cases has to meet; words of other rooms are the caller's.
void want_all(Coverage& coverage);

struct Stage;
// One for each capacity: generated.cpp is compiled for both.
void play_generated_8(const CaseNumber& number, const Stage& stage);
void play_generated_24(const CaseNumber& number, const Stage& stage);

}  // namespace plumb_replay

/// Laws that a monitor keeps on every case. Each one plays the case and says whether the law held, and if not, where.
#pragma once

#include <string>
#include <vector>

#include "plumb/core/config.hpp"
#include "plumb/testing/case.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace testing {

struct LawResult {
  bool holds = true;
  bool applies = true;  ///< false: the law says nothing about this case, and holds
  std::string reason;   ///< what broke it, or why it does not apply
};

/// No sensor that was healthy throughout is excluded by at most m_strict faults, or provisionally by at most the parity
/// grade (design, S1).
LawResult never_excludes_a_healthy_sensor(const Case& c);
/// Constant and held faults, at most n - 3 of them, are excluded at the end, and no other sensor. Other faults of the
/// case and its systematic errors are omitted, and the attitudes are random ones. Applies where every three axes are
/// independent and every triple that holds a faulty sensor misses the length of gravity by far at one of the stations
/// between the last onset and that from which an answer can still stand at four stations before the isolation timeout
/// is over
/// (`isolation_timeout`, counted from the first onset) and before the end; every four that hold one disagree by far at
/// each of them. Faults that come one after the other use up the isolation timeout, and where it ends first "failed" is
/// the answer; equal faults may leave four that agree, and where those miss the length of gravity the answer is
/// "reference".
LawResult isolates_what_is_isolable(const Case& c);
/// One fault whose parity is far above the limit at its first station is not plainly valid from there on.
LawResult detects_above_the_threshold(const Case& c);
/// In service, provisionally excluded, excluded and absent partition the sensors.
LawResult sets_are_a_partition(const Case& c);
/// What an excluded sensor says does not matter, bit for bit.
LawResult excluded_bytes_do_not_matter(const Case& c);
/// Failed is left by a reset alone.
LawResult failed_is_latched(const Case& c);
/// A monitor that is stopped, written, read and continued answers as one that never stopped, bit for bit.
LawResult snapshot_is_transparent(const Case& c);
/// The same samples give the same bits.
LawResult replay_is_exact(const Case& c);
/// State, validity and bits of a verdict do not contradict one another, and its numbers are finite.
LawResult verdict_agrees_with_itself(const Case& c);
/// Vibration of the whole tool excludes no sensor and fails nothing (the faults of the case are omitted).
LawResult motion_excludes_no_sensor(const Case& c);

struct Law {
  const char* name;
  LawResult (*check)(const Case&);
};
/// All of them.
const std::vector<Law>& laws();

}  // namespace testing
}  // namespace PLUMB_ABI
}  // namespace plumb

/// Whether an array is fit for what a user needs it for: every limit against what was found, and what follows.
#pragma once

#include <string>
#include <vector>

#include "plumb/verification/criterion.hpp"
#include "plumb/verification/facts.hpp"
#include "plumb/verification/limits.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace verification {

/// One of the questions of someone who is new to the array.
struct Answer {
  std::string question, value, label;
};

struct Report {
  Result fit = Result::open;    ///< "not met" where any criterion is not, "open" where one is
  bool lacks_evidence = false;  ///< open, but by nothing than the evidence on plumb itself
  std::string sentence;
  std::vector<Answer> answers;
  std::vector<Criterion> criteria;  ///< those that are judged, in the order of the sections of the report
  std::vector<std::string> assumptions;
  std::vector<Note> known_limits;
  RequirementCounts requirements;
  std::vector<std::string> orphans;
  std::string limits_file;  ///< empty: none was given
};

/// "fit", "fit, evidence incomplete", "open", "not fit".
const char* fitness(const Report& report) noexcept;

Report judge(const UserLimits& limits, const Facts& facts);

/// Its parts.
std::vector<Criterion> judge_criteria(const UserLimits& limits, const Facts& facts);
std::vector<Answer> answers_of(const Facts& facts);
std::vector<std::string> assumptions_of(const UserLimits& limits, const Facts& facts);

/// The result of a branch of the argument: the worst of its criteria; open where none was judged.
Result result_of(Strategy strategy, const std::vector<Criterion>& criteria);

}  // namespace verification
}  // namespace PLUMB_ABI
}  // namespace plumb

#include "plumb/verification/verdict.hpp"

#include <algorithm>
#include <iterator>

namespace plumb {
inline namespace PLUMB_ABI {
namespace verification {
namespace {

std::vector<Note> known_limits_of(const ArrayFacts& array) {
  std::vector<Note> out = array.notes;
  out.push_back({"correlated_rotation",
                 "m correlated faults (all show the same rotated gravity) can be isolated only if n >= 2m + c + 1"});
  out.push_back({"three_sensors",
                 "with three sensors in use only the length of gravity checks them: no protection level, no "
                 "isolation, and an error across gravity is not detected"});
  return out;
}

/// The reasons of every criterion with this result.
std::string reasons(const std::vector<Criterion>& criteria, Result result) {
  std::string out;
  for (const Criterion& c : criteria) {
    if (c.result == result) out += (out.empty() ? "" : "; ") + c.reason;
  }
  return out;
}

Result worst(const std::vector<Criterion>& criteria) {
  Result out = Result::met;
  for (const Criterion& c : criteria) out = std::max(out, c.result);
  return out;
}

/// Whether all that is open is evidence on plumb itself.
bool lacks_evidence_only(const std::vector<Criterion>& criteria) {
  return worst(criteria) == Result::open && std::all_of(criteria.begin(), criteria.end(), [](const Criterion& c) {
           return c.result == Result::met || is_evidence(c.id);
         });
}

std::string sentence_of(Result fit, const std::string& name, const UserLimits& limits,
                        const std::vector<Criterion>& criteria) {
  if (lacks_evidence_only(criteria)) return name + ": fit, evidence incomplete: " + reasons(criteria, fit) + ".";
  switch (fit) {
    case Result::not_met: return name + " is not fit for purpose: " + reasons(criteria, fit) + ".";
    case Result::open: return "INCONCLUSIVE for " + name + ": " + reasons(criteria, fit) + ".";
    case Result::met: break;
  }
  return name + " is fit for purpose within the limits and assumptions below" +
         (limits.file.empty() ? "; no limits file was given, so the default limits apply." : ".");
}

}  // namespace

const char* fitness(const Report& report) noexcept {
  if (report.lacks_evidence) return "fit, evidence incomplete";
  return report.fit == Result::met ? "fit" : report.fit == Result::open ? "open" : "not fit";
}

Result result_of(Strategy strategy, const std::vector<Criterion>& criteria) {
  std::vector<Criterion> of_it;
  std::copy_if(criteria.begin(), criteria.end(), std::back_inserter(of_it),
               [strategy](const Criterion& c) { return entry_of(c.id).strategy == strategy; });
  return of_it.empty() ? Result::open : worst(of_it);
}

Report judge(const UserLimits& limits, const Facts& facts) {
  Report out;
  out.criteria = judge_criteria(limits, facts);
  out.fit = worst(out.criteria);
  out.lacks_evidence = lacks_evidence_only(out.criteria);
  out.sentence = sentence_of(out.fit, facts.name, limits, out.criteria);
  out.answers = answers_of(facts);
  out.assumptions = assumptions_of(limits, facts);
  out.known_limits = known_limits_of(facts.array);
  out.requirements = facts.trace.counts;
  out.orphans = facts.trace.orphans;
  out.limits_file = limits.file;
  return out;
}

}  // namespace verification
}  // namespace PLUMB_ABI
}  // namespace plumb

#include "corpus.hpp"

#include <fmt/format.h>

#include "plumb/health/state.hpp"
#include "plumb/scenario/catalogue.hpp"

namespace plumb_replay {

const char* to_string(Situation situation) noexcept {
  constexpr const char* kNames[kSituations] = {
      "plain",       "recalibrate",  "policy",  "offer_good", "offer_wrong", "offer_and_ask",     "reset",
      "power_cycle", "bad_snapshot", "inhibit", "gravity",    "turning",     "first_calibration", "bound",
      "asserted",    "stability",    "means",   "storage",    "settings"};
  return kNames[static_cast<std::size_t>(situation)];
}

std::string fault_name(int choice) {
  if (choice < kFaultChoices - 2) return fmt::format("F{:02}", choice + 1);
  return choice == kFaultChoices - 2 ? "none" : "drawn";
}

std::string CaseNumber::name() const {
  return fmt::format("s{:04}-n{}-cap{}-{}-{}", number, sensors(), capacity(), to_string(situation()),
                     fault_name(fault()));
}

void want_all(Coverage& coverage) {
  for (int k = 0; k < kSituations; ++k) coverage.want("situation", to_string(static_cast<Situation>(k)));
  for (int k = 0; k < kFaultChoices; ++k) coverage.want("fault", fault_name(k));
  for (int n = kLeastSensors; n <= kMostSensors; ++n) coverage.want("sensors", fmt::format("{:2}", n));
  for (int k = 0; k < plumb::scenario::kFaultKinds; ++k) {
    coverage.want("fault kind", to_string(static_cast<plumb::scenario::FaultKind>(k)));
  }
  for (int k = 0; k < plumb::kStateCount; ++k) coverage.want("state", to_string(static_cast<plumb::HealthState>(k)));
  for (int k = 0; k < plumb::kEventCount; ++k) coverage.want("event", to_string(static_cast<plumb::HealthEvent>(k)));
  for (int k = 0; k <= static_cast<int>(plumb::kLastCause); ++k) {
    const auto cause = static_cast<plumb::Cause>(k);
    if (cause == plumb::Cause::power_on) continue;          // a word of reports alone
    if (cause == plumb::Cause::parity_in_motion) continue;  // no case has a monitor in motion beside
    coverage.want("cause", to_string(cause));
  }
}

}  // namespace plumb_replay

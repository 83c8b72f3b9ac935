// What the health report says: why, how far, and what to do about it.
#include <fmt/format.h>

#include <algorithm>

#include "plumb/verification/tool_health.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace verification {
namespace {

/// The remedy for a reason; one serves several.
const char* action_of(StationReason reason) {
  switch (reason) {
    case StationReason::failed:
      return "Do not survey or steer with this tool. Pull it, or replace the sensors named in the events and reset it.";
    case StationReason::no_direction:
      return "Re-shoot: hold the tool still for at least one block of samples at every station.";
    case StationReason::common_bias:
      return "The sensors share an error that turns the direction: recalibrate before any further survey.";
    case StationReason::length_far:
    case StationReason::length:
    case StationReason::norm_mismatch:
      return "Check the gravity reference of the array file (place, depth, model) and re-shoot; if the norm mismatch "
             "persists, recalibrate.";
    case StationReason::changed: return "Re-shoot the last station: it was not valid from its first block on.";
    case StationReason::degraded:
      return "Go on for orientation only, and change the tool or the sensors out of service at the next trip: a "
             "further "
             "fault cannot be isolated and may not be detected.";
    case StationReason::no_bound:
    case StationReason::wide_bound:
      return "The error is not bounded within the alert limit: use longer blocks or another calibration, or accept a "
             "wider limit (plumb geometry and plumb verify say what this array can reach).";
    case StationReason::temperature:
      return "Wait until the temperature is steady and within the calibrated span, or calibrate over a wider one.";
    case StationReason::calibration:
      return "Calibrate the tool on a stand: these coefficients were not checked by a redundant sensor.";
    case StationReason::alarm:
    case StationReason::unconfirmed: break;  // by what the sensors have read
  }
  return "?";
}

}  // namespace

const char* to_string(StationReason reason) noexcept {
  switch (reason) {
    case StationReason::failed: return "failed";
    case StationReason::no_direction: return "no_direction";
    case StationReason::alarm: return "alarm";
    case StationReason::common_bias: return "common_bias";
    case StationReason::length_far: return "length_far";
    case StationReason::length: return "length";
    case StationReason::norm_mismatch: return "norm_mismatch";
    case StationReason::unconfirmed: return "unconfirmed";
    case StationReason::degraded: return "degraded";
    case StationReason::no_bound: return "no_bound";
    case StationReason::wide_bound: return "wide_bound";
    case StationReason::temperature: return "temperature";
    case StationReason::calibration: return "calibration";
    case StationReason::changed: return "changed";
  }
  return "?";
}

const char* explain(StationReason reason) noexcept {
  switch (reason) {
    case StationReason::failed: return "FAILED (latched): the fault could not be isolated";
    case StationReason::no_direction: return "there is no valid direction";
    case StationReason::alarm: return "the sensors disagree and no sensor could be excluded";
    case StationReason::common_bias: return "the sensors share a bias";
    case StationReason::length_far: return "the error of |G| is more than twice its limit";
    case StationReason::length: return "|G| is beyond its limit";
    case StationReason::norm_mismatch: return "norm mismatch";
    case StationReason::unconfirmed: return "the sensors are not yet validated, or under suspicion";
    case StationReason::degraded: return "no redundancy left";
    case StationReason::no_bound: return "no bound on the error";
    case StationReason::wide_bound: return "the bound on the error is beyond the alert limit";
    case StationReason::temperature: return "temperature outside the calibrated span, or changing too fast";
    case StationReason::calibration: return "calibration not checked by a redundant sensor";
    case StationReason::changed: return "valid at its end, but not throughout";
  }
  return "?";
}

const char* to_string(SurveyUse use) noexcept {
  switch (use) {
    case SurveyUse::yes: return "yes";
    case SurveyUse::orientation_only: return "orientation only";
    case SurveyUse::no: return "no";
  }
  return "?";
}

std::string ToolHealth::sentence() const {
  if (stations_.empty()) return "Usable for survey: no. The run has no stretch at rest to evaluate.";
  const std::vector<StationReason> reasons = reasons_against(stations_.back());
  std::string why;
  for (const StationReason reason : reasons) why += std::string(why.empty() ? "" : "; ") + explain(reason);
  if (last_.state == HealthState::failed) {
    why = explain(StationReason::failed);
  } else if (last_.validity == Validity::invalid) {
    why = explain(StationReason::no_direction);
  } else if (!doubt_.empty()) {
    why += (why.empty() ? "" : "; ") + doubt_;
  } else if (reasons.empty() && use() != SurveyUse::yes) {
    why = "the monitor became suspect after the last station";
  } else if (reasons.empty()) {
    why = "the last station is green, and the sensors in service check one another";
  }
  return fmt::format("Usable for survey: {}. At the end of the run: {}.", to_string(use()), why);
}

SeenAttitudes ToolHealth::seen() const {
  SeenAttitudes out;
  out.tool_axis = {frame_[6], frame_[7], frame_[8]};
  for (const StationHealth& station : stations_) out.gravity_mps2.push_back(station.gravity_mps2);
  return out;
}

std::vector<std::string> ToolHealth::advice(StationReason reason, const SensorArray& array) const {
  if (reason == StationReason::alarm) return {isolating_advice(last_, seen())};
  if (reason != StationReason::unconfirmed) return {action_of(reason)};
  if ((last_.qualifiers & Qualifier::not_yet_validated) != 0) return validating_advice(array, last_, seen());
  if (last_.rotation.wanted) return {isolating_advice(last_, seen())};
  return {"Re-shoot, and hold the tool still for several blocks: the doubt ends where blocks in a row agree."};
}

std::vector<std::string> ToolHealth::actions(const SensorArray& array, const std::vector<std::string>& beside) const {
  std::vector<std::string> out;
  const auto add = [&out](const std::string& text) {
    if (std::find(out.begin(), out.end(), text) == out.end()) out.push_back(text);
  };
  if (last_.state == HealthState::failed) {
    add(action_of(StationReason::failed));
  } else if (stations_.empty() || last_.validity == Validity::invalid) {
    add(action_of(StationReason::no_direction));
  } else {
    const auto add_advice = [this, &array, &add](StationReason reason) {
      for (const std::string& one : advice(reason, array)) add(one);
    };
    for (const StationReason reason : reasons_against(stations_.back())) add_advice(reason);
    if (out.empty() && use() != SurveyUse::yes) add_advice(StationReason::unconfirmed);
  }
  std::string again;
  int listed = 0, left = 0;
  constexpr int kListed = 20;
  for (std::size_t k = 0; k < stations_.size(); ++k) {
    if (colour_of(stations_[k]) != Colour::red) continue;
    if (++listed > kListed) {
      ++left;
    } else {
      again += fmt::format("{}{}", again.empty() ? "" : ", ", k + 1);
    }
  }
  if (left > 0) again += fmt::format(" and {} more", left);
  if (!again.empty()) add("Do not use the red stations: " + again + ".");
  if (count(Colour::orange) > 0)
    add(use() == SurveyUse::no ? "Use the orange stations for orientation only."
                               : "Use the orange stations for orientation only, or shoot them again.");
  if (last_.noise_factor > 1.0)
    add(fmt::format(
        "The noise is {0:.2g} times what the array file states, and every limit is wider for it: write {0:.2g} "
        "times the noise.",
        last_.noise_factor));
  if (last_.noise_correlation > 1.0)
    add(fmt::format(
        "The noise of the rows is correlated: {:.2g} rows carry the information of one. Filter less before they "
        "are recorded, or take fewer of them.",
        last_.noise_correlation));
  for (const std::string& one : beside) add(one);
  if (use() == SurveyUse::yes) add("Continue.");
  return out;
}

}  // namespace verification
}  // namespace PLUMB_ABI
}  // namespace plumb

// How many, how large, how sure, what not to trust: the questions of someone who is new to an array.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "field_figures.hpp"
#include "plumb/scenario/count_text.hpp"
#include "plumb/study/proportion.hpp"
#include "plumb/verification/verdict.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace verification {
namespace {

/// A grade counts these: chips, where the array file states them, with the sensors that are on none.
std::string units_text(const ArrayFacts& array) {
  return array.chips() ? count_text(array.units, "unit") + " (chips, and sensors on none)"
                       : count_text(array.sensors.size(), "sensor");
}

/// What not to trust, in one sentence.
std::string distrust_of(const Facts& facts) {
  const int grade = facts.array.confirmed_grade;
  const bool chips = facts.array.chips();
  const char* const none = chips ? "any isolation of a chip or sensor: this array cannot isolate a fault; "
                                 : "any isolation of a sensor: this array cannot isolate a fault; ";
  std::string out = grade > 0 ? fmt::format("any output once more than {} of {} {} faulty; ", grade,
                                            units_text(facts.array), by_count(grade, "is", "are"))
                              : std::string(none);
  out += fmt::format(
      "any output during an alert or with only three sensors in use; several {} that all show the same wrong gravity",
      chips ? "units" : "sensors");
  if (facts.wiring.state != WiringFacts::State::confirmed)
    out += is_magnetic(facts.array.field)
               ? "; the direction as a whole: nothing ties the wiring to that of the accelerometers"
               : "; inclination and toolface as a whole: no known attitude confirms the wiring";
  if (facts.calibration.predicted())
    out += "; every figure here, because the tool was not calibrated: they come from a simulated calibration";
  if (facts.calibration.stated())
    out += "; any output beyond the stated uncertainty of the coefficients, which nothing has tested";
  if (!facts.calibration.accepted)
    out += "; any figure here: the calibration was refused, and they are of an exact tool";
  return out;
}

/// The worst sensor's; nothing where one has none.
std::optional<double> worst(const ArrayFacts& array, std::optional<double> SensorFacts::*size_mps2) {
  double out = 0.0;
  for (const SensorFacts& sensor : array.sensors) {
    if (!(sensor.*size_mps2)) return std::nullopt;
    out = std::fmax(out, *(sensor.*size_mps2));
  }
  return out;
}

Answer how_large(const ArrayFacts& array) {
  const std::optional<double> least = worst(array, &SensorFacts::detectable_mps2);
  const std::optional<double> sure = worst(array, &SensorFacts::sure_isolation_mps2);
  if (!least) return {"How large?", "never", "nothing checks every sensor"};
  return {
      "How large?", fine_words(*least, array.field, 3),
      "minimum detectable bias: constant error of any one sensor that raises an alarm in 999 of 1000 blocks" +
          std::string(array.chips() ? ", one axis of a chip being a sensor here (of orthogonal triads of equal noise "
                                      "a whole chip's error of this length is at least as visible)"
                                    : "") +
          (sure ? "; guaranteed isolation threshold " + fine_words(*sure, array.field, 3)
                : std::string("; no size of error is sure to be isolated"))};
}

}  // namespace

std::vector<Answer> answers_of(const Facts& facts) {
  const ArrayFacts& array = facts.array;
  const int sensors = static_cast<int>(array.sensors.size());
  const bool chips = array.chips();
  std::vector<Answer> out;
  out.push_back(
      {"How many faults?", fmt::format("{}", array.confirmed_grade),
       fmt::format(
           "faulty {} of {} at once are isolated and excluded, given several attitudes; {} at a single attitude",
           chips ? "units (chips, and sensors on none)" : "sensors", chips ? array.units : sensors,
           array.provisional_grade)});
  out.push_back(how_large(array));
  const std::optional<double>& level = array.protection_level_deg;
  out.push_back({"Protection level?", level ? fmt::format("{:.3g} deg", *level) : "unbounded",
                 std::string("protection level at rest: tilt error that can stay without an alarm") +
                     (facts.calibration.accepted ? "" : ", if the array file were exact")});
  if (facts.faults.played) {
    const Rate &wrong = facts.faults.wrong_exclusion, &isolated = facts.faults.isolated;
    out.push_back(
        {"How sure?", fmt::format("{} of {}", wrong.count, wrong.of),
         fmt::format("simulated scenarios of the fault campaign excluded a healthy sensor: a rate of such scenarios "
                     "of {}",
                     study::interval_words({wrong.count, wrong.of, wrong.low, wrong.high}))});
    out.push_back({"How often isolated?", fmt::format("{} of {}", isolated.count, isolated.of),
                   fmt::format("of the same scenarios, small faults among them, end with exactly the faulty sensors "
                               "excluded; {} end in an alarm without an exclusion",
                               facts.faults.ambiguous.count)});
  } else {
    out.push_back({"How sure?", "unknown", "no scenario was run"});
  }
  out.push_back({"What not to trust?", "Do not trust", distrust_of(facts)});
  return out;
}

}  // namespace verification
}  // namespace PLUMB_ABI
}  // namespace plumb

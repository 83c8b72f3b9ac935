/// The rules that autopilots and textbooks use against inconsistent accelerometers, on the flights on which a motion
/// monitor is judged. For comparison only; none of them is in the library.
///
/// They are re-stated from the sources named in rivals.cpp and px4_rules.cpp, with the parameters that those ship with.
/// What a rule knows beside accelerometers and gyros (GNSS, barometer, driver errors) is not simulated and stays
/// silent.
#pragma once

#include <array>
#include <limits>

#include "flight_case.hpp"

namespace plumb_bench {

inline constexpr int kRules = 7;
extern const std::array<const char*, kRules> kRuleNames;

/// Limits of the rules that are tuned on healthy flights. Without end, for the tuning itself.
struct TunedLimits {
  double median_mps2 = std::numeric_limits<double>::infinity();
  double parity_mps2 = std::numeric_limits<double>::infinity();
};

/// The least limits at which neither tuned rule would have said anything in this flight.
TunedLimits quiet_limits(const FlightCase& healthy);

/// One flight of three parallel triads, judged by the motion monitor and by every rule at once.
std::array<FlightOutcome, kRules> fly_rivals(const FlightCase& one, const TunedLimits& limits);

}  // namespace plumb_bench

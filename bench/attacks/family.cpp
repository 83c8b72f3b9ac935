#include "family.hpp"

namespace plumb_bench {
namespace {

constexpr Standing kPromised = Standing::promised;
constexpr Standing kOutside = Standing::outside;

// clang-format off
const std::vector<Family>& all() {
  static const std::vector<Family> kAll = {
      {"lies-plain", "1 to m faulty sensors, by one of 13 laws from station to station, or none", Play::lies, kPromised, kOutside, 4, 8, true, false, 0, 4},
      {"lies-motion", "the same amid vibration, sway and jolts below and above the noise", Play::lies, kPromised, kOutside, 4, 8, false, false, 1, 2},
      {"lies-recalibration", "the same while recalibrations are asked for", Play::lies, kPromised, kOutside, 4, 8, false, false, 2, 2},
      {"lies-offers", "the same while calibrations, most of them wrong, are offered", Play::lies, kPromised, kOutside, 4, 8, false, false, 3, 2},
      {"lies-reset", "the same while the host resets failed, whatever is broken", Play::lies, kPromised, kOutside, 4, 8, false, false, 4, 2},
      {"lies-reinstatement", "the faults cease until their sensors are reinstated, and begin again", Play::lies, kPromised, kOutside, 4, 8, false, false, 5, 2},
      {"lies-timing", "the same while rows are lost, late, repeated, or not a number", Play::lies, kPromised, kOutside, 4, 8, false, false, 6, 2},
      {"lies-host", "the same with new gravity, inhibits and power cycles", Play::lies, kPromised, kOutside, 4, 8, false, false, 7, 2},

      {"v1a-silence", "every channel silent or not a number for 20 s while the tool turns", Play::silence, kPromised, kOutside, 4, 8, false, false, 0, 1},
      {"v1b-gap", "a gap of 55 s, or one sample every 5.1 s, while the tool turns", Play::gap, kPromised, kOutside, 4, 8, false, false, 0, 1},
      {"v1c-turn-1hz", "a turn just after a block, one sample per second", Play::turn, kPromised, kOutside, 4, 8, false, false, 1, 1},
      {"v1c-turn-100hz", "a turn just after a block, 100 samples per second", Play::turn, kPromised, kOutside, 4, 8, false, false, 100, 1},
      {"v1d-small-turns", "turns of 0.05 to 2 deg between blocks, and then another one somewhat larger", Play::small_turns, kPromised, kOutside, 4, 8, false, false, 0, 1},
      {"v2-horizontal", "steady horizontal acceleration of 3 to 50 mg at every station; bound stated", Play::steady_push, kPromised, kOutside, 4, 8, false, false, 0, 1},
      {"v2-thrust", "thrust of 300 mg whose vertical part keeps the length of gravity; bound stated", Play::steady_push, kPromised, kOutside, 4, 8, false, false, 1, 1},
      {"v3-asserted", "one channel alone in the last row of a block as the tool starts to turn; assumed_faults = 1", Play::truncated_frame, kPromised, kOutside, 5, 8, false, false, 1, 1},
      {"v3-default", "the same in the default configuration", Play::truncated_frame, kPromised, kOutside, 5, 8, false, false, -1, 1},
      {"v4-clock", "time stamps repeated, then up to 70 s of nothing or slow rows, and a power cycle with its own snapshot", Play::clock, kPromised, kOutside, 4, 8, false, false, 0, 1},
      {"v5a-vertical", "a vertical tetrahedron at rest whose axial sensor reads -G/3", Play::vertical, kPromised, kPromised, 4, 4, false, false, 0, 1},
      {"v5b-steps", "at rest, one sensor steps by 0.3 to 3 g in the middle of every second block", Play::steps, kPromised, kPromised, 4, 8, false, false, 0, 1},
      {"v6-settling", "one sensor off by 0.05 to 1 g in the second half of each station's first block", Play::settling, kPromised, kPromised, 4, 8, false, false, 0, 1},

      {"drift", "every bias shifted by N(0, 0.5 mg) since the calibration, as stated", Play::drift, kPromised, kPromised, 4, 8, true, false, 0.5, 1},
      {"drift-fault", "every bias shifted by N(0, 0.2 mg), as stated, and one fault", Play::drift_and_fault, kPromised, kOutside, 4, 8, true, false, 0.2, 1},
      {"thermal-lag", "0.1 mg/degC behind a housing that warms by 5 degC/min; the lag stated", Play::thermal, kPromised, kOutside, 4, 8, false, false, 0.1, 1},
      {"mirror", "1 to m sensors, m the confirmed grade, show gravity mirrored in the plane of two others", Play::mirror, kPromised, kOutside, 5, 8, true, false, 0, 1},
      {"small-sigma", "calibration errors ten times their stated sigma", Play::small_sigma, kOutside, kOutside, 4, 8, false, false, 10, 1},
      {"no-covariance", "calibration errors of 0.3 mg and a stated covariance of zero", Play::no_covariance, kOutside, kOutside, 4, 8, false, false, 0.3, 1},
      {"gravity-off", "four sensors, gravity 0.6 to 10 mg off, and one fault", Play::gravity_off, kOutside, kOutside, 4, 4, false, false, 0, 1},

      {"adaptive-error", "one faulty sensor that tries its readings on copies of the monitor: largest error while valid", Play::adaptive, kPromised, kOutside, 4, 8, true, true, 0, 2},
      {"adaptive-accuse", "the same, to get a healthy sensor suspected", Play::adaptive, kPromised, kOutside, 4, 8, true, true, 1, 2},
      {"adaptive-many", "1 to m adaptive colluders, m the confirmed grade, with any of these three aims", Play::adaptive, kPromised, kOutside, 5, 8, true, true, 3, 2},
      {"adaptive-axis-cone", "two adaptive colluders among an axis and a cone of four, whose grade is one", Play::adaptive, kOutside, kOutside, 5, 5, false, true, 4, 1},

      {"b1-roll", "from power-on, rolling at one inclination of five, 20 attitudes each", Play::roll, kPromised, kOutside, 4, 8, true, false, 0, 0.5},
      {"b1-yaw", "from power-on, a rover that yaws: one attitude for good", Play::yaw, kPromised, kOutside, 4, 8, false, false, 0, 0.5},
      {"b1-tilt", "from power-on, a tetrahedron, a cone of five or upright triads within 5 deg of vertical", Play::tilting_triads, kPromised, kOutside, 4, 6, true, false, 5, 0.5},
      {"b2-turn-0.3", "turning all the time at 0.3 deg/s", Play::slow_turn, kPromised, kOutside, 4, 8, false, false, 0.3, 0.5},
      {"b2-turn-1", "turning all the time at 1 deg/s", Play::slow_turn, kPromised, kOutside, 4, 8, false, false, 1.0, 0.5},
      {"b2-wobble", "swaying by 0.05 deg rms at 1 Hz", Play::wobble, kPromised, kOutside, 4, 8, false, false, 0.05, 0.5},
      {"b2-vibration", "vibration of two sigma of the noise, all the time", Play::vibration, kPromised, kOutside, 4, 8, false, false, 2.0, 0.5},
      {"b3-bias", "one bias 0.2 mg off, sigma 0.2 mg, stability stated as 0.2 mg", Play::bias_shift, kPromised, kOutside, 4, 8, true, false, 0.2, 0.5},
      {"b3-noise-1.5", "noise of 1.5 times the stated sigma", Play::understated_noise, kPromised, kOutside, 4, 8, false, false, 1.5, 0.5},
      {"b3-noise-2", "noise of twice the stated sigma", Play::understated_noise, kPromised, kOutside, 4, 8, false, false, 2.0, 0.5},
      {"b3-noise-3", "noise of three times the stated sigma", Play::understated_noise, kPromised, kOutside, 4, 8, false, false, 3.0, 0.5},
      {"b3-resolution", "readings in steps of four sigma", Play::coarse_steps, kPromised, kOutside, 4, 8, false, false, 4.0, 0.5},
      {"b3-ar1", "noise of the stated sigma, correlated by 0.99 from row to row", Play::slow_noise, kPromised, kOutside, 4, 8, false, false, 0.99, 0.5},
      {"b4-adaptive-fail", "one faulty sensor that aims at failed", Play::adaptive, kPromised, kOutside, 4, 8, true, true, 2, 2},
      {"b4-successive-1", "sensors fail one after another, one station between: constant biases, as many as the confirmed grade", Play::successive, kPromised, kOutside, 5, 8, true, false, 1, 0.5},
      {"b4-successive-2", "the same with two stations between", Play::successive, kPromised, kOutside, 5, 8, true, false, 2, 0.5},
      {"b5-mirrored", "two mirrored sensors of 6 to 8, default configuration", Play::mirrored_still, kPromised, kOutside, 6, 8, true, false, 2, 0.5},
      {"b6-after-fault", "four sensors at rest behind a fault of one of them", Play::after_fault, kPromised, kOutside, 4, 4, false, false, 0, 0.5},
      {"b6-small-fault", "four sensors at rest behind a fault of one of them, of 1 to 12 mg", Play::after_fault, kPromised, kOutside, 4, 4, false, false, 0.012, 0.5},
      {"b7-latitude", "gravity left at another latitude, up to 2.7 mg off, and one fault", Play::latitude, kOutside, kOutside, 4, 8, true, false, 2.7, 0.5},
  };
  return kAll;
}
// clang-format on

}  // namespace

const char* to_string(Standing standing) {
  switch (standing) {
    case Standing::promised: return "promised";
    case Standing::open: return "open";
    case Standing::outside: return "outside";
  }
  return "?";
}

const std::vector<Family>& families() { return all(); }

int family_named(const std::string& name) {
  for (int k = 0; k < static_cast<int>(families().size()); ++k) {
    if (name == families()[static_cast<std::size_t>(k)].name) return k;
  }
  return -1;
}

std::vector<int> families_like(const std::string& name) {
  std::vector<int> out;
  for (int k = 0; k < static_cast<int>(families().size()); ++k) {
    const std::string full = families()[static_cast<std::size_t>(k)].name;
    if (full == name || full.rfind(name + "-", 0) == 0) out.push_back(k);
  }
  return out;
}

namespace {
std::uint64_t sizes_of(const Family& family) { return static_cast<std::uint64_t>(family.most_n - family.least_n + 1); }
}  // namespace

int sensors_of(const Family& family, std::uint64_t episode) {
  return family.least_n + static_cast<int>(episode % sizes_of(family));
}

std::uint64_t variant_of(const Family& family, std::uint64_t episode) { return episode / sizes_of(family); }

}  // namespace plumb_bench

// A survey station: the pumps are off, the tool hangs still, and one question is asked of plumb: may these angles be
// written down? Go, or no-go with the one reason that a driller can act on.
#pragma once

#include "plumb/health/verdict.hpp"
#include "plumb/navigation/tilt.hpp"

enum class Go { go, wait, no_go };

struct SurveyStation {
  Go go = Go::wait;
  const char* reason = "pumps are on";
  plumb::Tilt tilt;                         // of the vector in the output frame: z down hole
  double protection_level_housing_rad = 0;  // bound on the tilt, 0 where go is not
};

/// `pumps_off_s`: since when the pumps are off, in the time of the samples; negative = they run.
inline SurveyStation survey(const plumb::Verdict& v, double pumps_off_s) {
  using plumb::Usable;
  SurveyStation station;
  const auto answer = [&](Go go, const char* reason) {
    station.go = go;
    station.reason = reason;
    return station;
  };
  const auto has = [&](std::uint16_t bits) { return (v.usable & bits) == bits; };
  if (pumps_off_s < 0.0) return answer(Go::wait, "pumps are on");
  if (v.state == plumb::HealthState::failed) return answer(Go::no_go, "failed: too few sensors can be believed");
  // A vector from before the pumps stopped belongs to another attitude.
  if (!has(Usable::stationary) || !(v.time_s - v.age_s > pumps_off_s)) return answer(Go::wait, "not still yet");
  if (v.validity == plumb::Validity::invalid) return answer(Go::no_go, "no vector");
  if (!has(Usable::temperature)) return answer(Go::wait, "temperature outside the calibration");
  if (!has(Usable::reference)) return answer(Go::no_go, "length of gravity is in doubt");
  if (v.validity == plumb::Validity::unconfirmed) {
    const bool not_yet_validated =
        (v.qualifiers & plumb::Qualifier::not_yet_validated) != 0;  // history unknown, nobody suspected
    return answer(Go::no_go,
                  not_yet_validated ? "not validated yet: turn the tool" : "sensors disagree: turn the tool");
  }
  if (v.validity != plumb::Validity::valid || !has(Usable::monitored)) return answer(Go::no_go, "nothing checks them");
  if (v.alert || !has(Usable::protection_level)) return answer(Go::no_go, "tilt is not bounded well enough");
  station.tilt = plumb::tilt_of(v.gravity_mps2, v.covariance);
  if (!station.tilt.inclination_valid) return answer(Go::no_go, "no vector");
  station.protection_level_housing_rad = v.protection_level_housing_rad;
  return answer(Go::go,
                station.tilt.toolface_valid ? "inclination and toolface" : "inclination; too steep for toolface");
}

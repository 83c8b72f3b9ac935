/// What was found out about a calibrated tool of four sensors with which everything is well.
#pragma once

#include "plumb/verification/verdict.hpp"

namespace plumb_test {

inline plumb::verification::Facts calibrated_facts() {
  plumb::verification::Facts out;
  out.name = "paper-tetrahedron";
  out.array.confirmed_grade = 1;
  out.array.protection_level_deg = 0.3;
  out.array.gravity_mps2 = 9.81;
  out.array.sensors.assign(4, {0.02, 0.1});
  out.calibration = {true, "stations", "", ""};
  out.wiring = {plumb::verification::WiringFacts::State::confirmed, "confirmed by station 7", ""};
  out.alignment = {true, 0.1, "the calibrated axes as a whole are within 0.1 deg of the housing", "state it"};
  out.healthy = {true, "", plumb::verification::rate_of(0, 9600), plumb::verification::rate_of(0, 600)};
  out.faults.played = true;
  out.faults.wrong_exclusion = out.faults.misleading = plumb::verification::rate_of(0, 600);
  out.faults.isolated = plumb::verification::rate_of(400, 600);
  out.faults.blocks_to_detect = {9, 1};
  out.faults.block_s = 0.5;
  out.replay = plumb::verification::Replay{400, 400};
  out.trace.counts.requirements = out.trace.counts.active = out.trace.counts.verified = 90;
  out.trace.tests_given = true;
  out.trace.proofs = std::vector<plumb::verification::ProofItem>{{"spin", true}};
  return out;
}

}  // namespace plumb_test

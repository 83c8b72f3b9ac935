/// Ready scenarios: the paper's tool and one of six sensors, their calibration, a short drilling run and two drills.
/// Used by the demo, the tests and the benches alike, so that all of them speak of the same tools.
#pragma once

#include <cstdint>
#include <vector>

#include "plumb/calibration/datasheet.hpp"
#include "plumb/core/config.hpp"
#include "plumb/core/units.hpp"
#include "plumb/scenario/fault.hpp"
#include "plumb/scenario/host_request.hpp"
#include "plumb/scenario/scenario.hpp"
#include "plumb/scenario/truth.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace scenario {

/// White noise of one sample of the paper's tool: the paper prints none; 2e-4 g0 is the figure of
/// docs/theory.md, section 9.2, and gives MAEs of the size of Table 2 after calibration.
inline constexpr double kPaperNoise_mps2 = 2e-4 * kG0_mps2;
inline constexpr double kPaperScale_VpMps2 = 3.0 / kG0_mps2;  ///< 3 V/g0
inline constexpr double kPaperFullScale_V = 5.0;              ///< 1.67 g0: +-3 V faults lie inside it
inline constexpr double kPaperResolution_V = 5.0 / 32768.0;   ///< 16 bits over +-5 V: a quarter of the noise

/// Datasheet of the tool: axes of `paper_tetrahedron`, ids a1 .. a4, 3 V/g0, no bias, reading gravity [V].
Datasheet paper_datasheet() noexcept;

/// A tool of that datasheet with bias U(+-0.02 g0), scale U(+-2 %), axes tilted U(+-2 deg) about two axes.
Tool paper_tool(std::uint64_t seed) noexcept;

/// Six sensors, a1 .. a6, normal to the faces of a dodecahedron, otherwise like those of the paper's tool.
Datasheet hexad_datasheet() noexcept;
/// Drawn as the paper's tool is.
Tool hexad_tool(std::uint64_t seed) noexcept;

/// Calibration on a stand: `stations` random attitudes of 2 s at 100 Hz, tagged, motion not recorded.
Scenario calibration_run(const Tool& tool, std::uint64_t seed, int stations = 48);

/// Fourteen survey stations: windows at rest of 2 s at 100 Hz (pumps off), 1 s of motion with vibration of
/// 0.1 g0 rms per axis between them, inclination from 5 to 60 deg while the toolface turns. Without tags:
/// the stations are to be found. About 41 s.
Scenario drilling_run(const Tool& tool, std::uint64_t seed, std::vector<Fault> faults = {});

/// The output of `sensor` stands at 0 V from `station` on (the demo: a2, index 1, at station 6).
Fault dead_at_station(int sensor, int station) noexcept;

/// A run that leads the monitor through its states, and what the host asks of it on the way.
struct Drill {
  Scenario scenario;
  std::vector<HostRequest> requests;  ///< in order of time
};

/// For the paper's tool; thirty stations. a2 is stuck from station 6 and sound from station 21; a3 stands at 3 V from
/// station 12 on. At station 22 the host asks for a reset that names a2, first with a wrong key.
Drill drill_a(const Tool& tool, std::uint64_t seed);

/// For the tool of six sensors; forty-four stations. a2 reads 50 mg0 too much from station 6 to station 25; the host
/// asks for a recalibration at station 13; a5 gets stuck at station 30.
Drill drill_b(const Tool& tool, std::uint64_t seed);

}  // namespace scenario
}  // namespace PLUMB_ABI
}  // namespace plumb

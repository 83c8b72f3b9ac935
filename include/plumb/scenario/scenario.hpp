/// `Scenario`: everything that happens to one tool, as a value; `Simulator` turns it into samples.
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "plumb/core/config.hpp"
#include "plumb/core/sample.hpp"
#include "plumb/core/units.hpp"
#include "plumb/core/vec3.hpp"
#include "plumb/scenario/attitude.hpp"
#include "plumb/scenario/delivery.hpp"
#include "plumb/scenario/fault.hpp"
#include "plumb/scenario/heading.hpp"
#include "plumb/scenario/injector.hpp"
#include "plumb/scenario/noise.hpp"
#include "plumb/scenario/random.hpp"
#include "plumb/scenario/truth.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace scenario {

/// Sensor temperature over time; constant where the rate is 0.
struct TemperatureLaw {
  double start_degc = 25.0;
  double rate_degc_per_s = 0.0;
  double at(double time_s) const noexcept { return start_degc + rate_degc_per_s * time_s; }
};

/// How deep the tool is: it is lowered by a stand between two stations, and what depends on depth with it.
struct DepthLaw {
  double station_spacing_m = 0.0;  ///< between two stations
  double gravity_per_s2 = 0.0;     ///< growth of gravity with depth [m/s^2 per m]: 8.4e-7 in rock of 2670 kg/m^3
  double heat_degc_per_m = 0.0;    ///< growth of temperature with depth: 0.03 is ordinary
};

/// What the sensors of a tool measure. The attitudes are the same, and figures "in m/s^2" are in the inside unit of the
/// field (plumb/io/field.hpp).
enum class Sensed : std::uint8_t {
  gravity,
  magnetic,  ///< a vector of known length, `dip_rad` below the horizon, towards north
  rate,      ///< how the tool turns against the ground; without that of the Earth
};

/// A field beside the Earth's, that magnetometers see.
struct Interference {
  Vec3 field_mps2{};    ///< zero: none
  bool of_tool = true;  ///< in the tool frame, as of magnetised steel; else north, east, down, as of a casing
  double from_s = 0.0;  ///< on the log's own time axis
  double until_s = std::numeric_limits<double>::infinity();
};

struct Scenario {
  Tool tool;
  double gravity_mps2 = kG0_mps2;  ///< at the first station; the length of the magnetic field
  Sensed sensed = Sensed::gravity;
  double dip_rad = 0.0;
  Interference interference;
  std::uint64_t part = 0;  ///< tells the groups of one tool apart: each has noise of its own; 0: of the seed itself
  AttitudeLaw attitudes = FixedAttitude{};
  double rate_hz = 100.0;
  double dwell_s = 2.0;              ///< at rest at every station
  double move_s = 1.0;               ///< between two stations, turning along the great circle
  double vibration_mps2 = 0.0;       ///< rms per axis of the tool frame, while moving
  double rest_vibration_mps2 = 0.0;  ///< the same at rest
  Turning turning;                   ///< on top of the attitudes; sensors feel it through their lever arms
  DepthLaw depth;
  bool record_motion = true;  ///< false: the log has the dwells only, with time gaps between them
  bool tag_stations = false;  ///< true: samples at rest carry the tag 1, 2, ...; moving ones none
  bool tag_rolls = false;     ///< true: and the number of the inclination that they share with other stations
  double start_s = 0.0;       ///< time of the first sample
  NoiseLaw noise;
  TemperatureLaw temperature;
  std::vector<Fault> faults;  ///< Clock::station counts the stations of the law, the motion behind one included
  std::uint64_t seed = 1;
};

/// What is really the case at one sample.
struct Truth {
  Vec3 gravity_mps2{};            ///< in the tool frame, positive down; vibration omitted. Of magnetometers: the field
  Vec3 body_acceleration_mps2{};  ///< vibration, in the tool frame
  Vec3 rate_radps{};              ///< how the tool turns, tool frame; of accelerometers `Scenario::turning` alone
  double depth_m = 0.0;           ///< below the first station
  std::uint32_t station = 0;      ///< counted from 1; while moving: the one left behind
  bool moving = false;
  SensorSet faulty;  ///< sensors in fault
};

class Simulator {
 public:
  /// Refuses, with a remedy, a scenario that cannot be played: sensors, rates, counts, attitudes, faults.
  static tl::expected<Simulator, std::string> make(Scenario scenario);

  /// Number of samples of the whole run, as measured; delivery faults lose or double some on their way.
  std::uint64_t size() const noexcept { return rows_; }
  double duration_s() const noexcept;

  /// The next sample that arrives; false at the end. `truth()` then belongs to it, and `row()` is its number.
  bool next(Sample& sample);
  const Truth& truth() const noexcept { return truth_; }
  std::uint64_t row() const noexcept { return row_; }
  void rewind();

  /// Sample `row` < size() as measured, whatever was asked for before: a pure function of scenario and row.
  Sample at(std::uint64_t row, Truth* truth = nullptr) const noexcept;

  const Scenario& scenario() const noexcept { return scenario_; }
  const std::vector<Vec3>& directions() const noexcept { return directions_; }

 private:
  Simulator(Scenario scenario, std::vector<Vec3> directions, Injector injector);

  struct Place {
    Moment moment;
    bool moving = false;
    double part = 0.0;       ///< of the way to the next station
    std::uint64_t tick = 0;  ///< sample periods since the first row, unrecorded ones included
  };
  class Healthy;  // rows before any fault, for channels that are late
  Place place_of(std::uint64_t row) const noexcept;
  Truth truth_at(const Place& place) const noexcept;
  void feel_field(const Place& place, const Vec3& down, Truth& truth) const noexcept;
  void feel_rate(const Place& place, Truth& truth) const noexcept;
  Sample healthy(const Place& place, const Truth& truth) const noexcept;
  void remember_onsets() noexcept;

  Scenario scenario_;
  std::vector<Vec3> directions_;
  std::vector<Passage> passages_;
  Headings headings_;                      ///< where something else than gravity is sensed
  std::vector<std::uint32_t> roll_group_;  ///< by station; empty: no tags
  std::vector<Stream> noise_;
  std::vector<Instability> instability_;  ///< by sensor; empty: none
  Stream vibration_;
  Injector injector_;
  Delivery delivery_;
  std::uint64_t dwell_rows_ = 0;
  std::uint64_t move_rows_ = 0;
  std::uint64_t rows_ = 0;
  std::uint64_t cursor_ = 0;
  std::uint64_t row_ = 0;
  Truth truth_;
};

}  // namespace scenario
}  // namespace PLUMB_ABI
}  // namespace plumb

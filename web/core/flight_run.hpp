/// A flight of the page: the array in motion, and the motion monitor that watches it (private to web/core).
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "plumb/motion/motion_monitor.hpp"
#include "plumb/scenario/flight.hpp"
#include "plumb/scenario/injector.hpp"
#include "rivals.hpp"
#include "scene.hpp"

namespace plumb_web {

/// What happens in a flight: numbers of `At::event`.
enum class FlightEvent : std::uint8_t { alarm, isolated, excluded, quiet };
inline constexpr int kFlightEvents = 4;
const char* to_string(FlightEvent event) noexcept;

class FlightRun {
 public:
  /// The words are those of a refusal.
  static tl::expected<std::unique_ptr<FlightRun>, std::string> make(const json& scene, const plumb::AxisList& axes,
                                                                    const ChipList& chips, int n);
  /// One sample; false at the end.
  bool next(Record& record);
  std::uint64_t samples() const noexcept { return rows_; }
  double duration_s() const noexcept { return static_cast<double>(rows_) / kRate_hz; }
  const std::vector<std::string>& faults() const noexcept { return words_; }
  const Px4Beside& px4() const noexcept { return px4_; }
  /// Over what the monitor said of every sample, bit for bit.
  std::uint64_t digest() const noexcept { return digest_; }

 private:
  static constexpr double kRate_hz = 1000.0;
  FlightRun(const plumb::Datasheet& datasheet, const plumb::SensorArray& array, plumb::scenario::Flight flight,
            plumb::scenario::Injector injector, SceneFaults faults);
  void tell(const plumb::scenario::FlightSample& flown, plumb::SensorSet faulty, const plumb::Readings& y,
            Record& record);
  void tell_event(Record& record);
  void hash(const plumb::MotionVerdict& v);

  plumb::SensorModel model_;
  plumb::SensorArray array_;
  plumb::scenario::Flight flight_;
  plumb::scenario::Injector injector_;
  std::vector<std::string> words_;
  Px4Beside px4_;
  plumb::LeastSquares all_;
  std::unique_ptr<plumb::MotionMonitor> monitor_ = std::make_unique<plumb::MotionMonitor>();
  double full_scale_mps2_ = 0.0;
  std::array<plumb::Vec3, 3> truth_{};  ///< the last ones, the newest last
  std::uint64_t rows_ = 0, row_ = 0, digest_ = 0;
  int state_ = 0;
  plumb::SensorSet told_;      ///< isolated or excluded at the sample before
  plumb::SensorSet excluded_;  ///< then
};

}  // namespace plumb_web

/// A flight of the page: the array in motion, and the motion monitor that watches it (private to web/core).
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "plumb/health/health_monitor.hpp"
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

/// What is flown, and what the monitor of it is told: what the files of a flight have to say.
struct FlightPlan {
  plumb::Datasheet datasheet;
  plumb::scenario::FlightSpec spec;
  plumb::MotionSetup setup;
  std::vector<plumb::scenario::Fault> faults;
  double duration_s = 0.0;
};

class FlightRun {
 public:
  /// The words are those of a refusal.
  static tl::expected<std::unique_ptr<FlightRun>, std::string> make(const json& scene, const plumb::AxisList& axes,
                                                                    const ChipList& chips, int n);
  /// One sample; false at the end.
  bool next(Record& record);
  std::uint64_t samples() const noexcept { return rows_; }
  double duration_s() const noexcept { return static_cast<double>(rows_) / plan_.spec.rate_hz; }
  const FlightPlan& plan() const noexcept { return plan_; }
  const std::vector<std::string>& faults() const noexcept { return words_; }
  const Px4Beside& px4() const noexcept { return px4_; }
  /// Over what the monitor said of every sample, bit for bit.
  std::uint64_t digest() const noexcept { return digest_; }

 private:
  FlightRun(FlightPlan plan, const plumb::SensorArray& array, plumb::scenario::Flight flight,
            plumb::scenario::Injector injector, std::vector<std::string> words);
  plumb::Expected<void> configure();
  void step_at_rest(plumb::Sample sample, const plumb::MotionSample& row);
  plumb::MotionSample moved(const plumb::Sample& sample, const plumb::scenario::FlightSample& flown) const;
  void tell(const plumb::scenario::FlightSample& flown, plumb::SensorSet faulty, const plumb::Readings& y,
            Record& record);
  void tell_event(Record& record);
  plumb::SensorSet in_service() const { return rest_ ? rest_->verdict().in_service : array_.all(); }
  void hash(const plumb::MotionVerdict& v);

  FlightPlan plan_;
  plumb::SensorModel model_;
  plumb::SensorArray array_;
  plumb::scenario::Flight flight_;
  plumb::scenario::Injector injector_;
  std::vector<std::string> words_;
  Px4Beside px4_;
  plumb::LeastSquares all_;
  /// Beside it, calibrating itself as with `plumb monitor --calibrate-first`; null where every channel delivers.
  std::unique_ptr<plumb::HealthMonitor> rest_;
  std::unique_ptr<plumb::MotionMonitor> monitor_ = std::make_unique<plumb::MotionMonitor>();
  std::array<plumb::Vec3, 3> truth_{};  ///< the last ones, the newest last
  std::uint64_t rows_ = 0, row_ = 0, digest_ = 0;
  int state_ = 0;
  plumb::SensorSet told_;      ///< isolated or excluded at the sample before
  plumb::SensorSet excluded_;  ///< then
};

}  // namespace plumb_web

/// The samples of one scenario, bit for bit those of `scenario::Simulator`, without allocation: all noise of a sensor
/// is drawn at once, and faults that concern one channel alone do not go through the injector (private to
/// src/campaign).
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "plumb/scenario/injector.hpp"
#include "scene.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace campaign_kernel {

class Generator final : private scenario::Injector::Past {
 public:
  /// Memory for the longest scenario of the plan.
  explicit Generator(const Plan& plan);

  /// Prepares all rows of the scenario. The spec must stay in scope.
  void lay(const Spec& spec, double from_s) noexcept;

  int rows() const noexcept { return rows_; }
  void sample(int row, Sample& out) const noexcept;
  /// What gravity really is at a station counted from 0, in the frame of the calibrated axes.
  const Vec3& truth(int station) const noexcept { return truth_[static_cast<std::size_t>(station)]; }

 private:
  using Row = std::array<double, kCapacity>;
  void lay_readings(const Spec& spec, const scenario::Tool& tool) noexcept;
  void lay_faults(const Spec& spec, const scenario::Tool& tool) noexcept;
  void lay_clock();
  scenario::Moment moment_of(int row) const noexcept;
  double raw(int sensor, std::uint64_t row) const noexcept override;
  void disturb(Sample& out, const scenario::Moment& now) const noexcept;

  const Plan& plan_;
  std::vector<Datasheet> datasheets_;  ///< of the tools of the plan
  std::vector<Row> healthy_;           ///< raw values before any fault
  std::vector<double> noise_;          ///< of one sensor
  struct Tick {
    double offset_s = 0.0;  ///< since the first row
    std::uint64_t station = 0;
  };
  std::vector<Tick> clock_;  ///< of every row
  std::array<Vec3, campaign::kMostStations> truth_{};
  scenario::Injector injector_;
  bool alone_ = true;  ///< no fault looks beyond its own channel

  struct Channel {
    scenario::Fault fault;
    scenario::FaultMemory memory;
    scenario::ChannelLaw law;
    scenario::Stream stream{0, scenario::Purpose::fault};
    int first_row = 0;  ///< of its stations
    int end_row = 0;
  };
  std::array<Channel, campaign::kMostFaults> channel_{};
  int faults_ = 0;
  int first_fault_row_ = 0;
  int rows_ = 0;
  double from_s_ = 0.0;
  SensorSet all_;
  const Datasheet* datasheet_ = nullptr;
};

}  // namespace campaign_kernel
}  // namespace PLUMB_ABI
}  // namespace plumb

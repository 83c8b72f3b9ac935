/// Other rules on the samples that plumb judges: the paper's monitor, and PX4's choice between units of three sensors
/// (private to web/core). Each gets what it needs: the paper its own fits from the same stand, PX4 plumb's calibration.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "../../bench/motion/px4_rules.hpp"
#include "plumb/array/geometry.hpp"
#include "plumb/calibration/datasheet.hpp"
#include "plumb/core/sample.hpp"
#include "plumb/health/monitor_setup.hpp"
#include "plumb/paper/paper_monitor.hpp"
#include "records.hpp"

namespace plumb_web {

/// PX4's two rules, and the unit that they leave in use. A unit is a chip with three axes and more; of an array without
/// chips each three sensors in a row that span space, as a board with so many chips would have them.
class Px4Beside {
 public:
  explicit Px4Beside(const plumb::SensorArray& array, double rate_hz);
  void step(const plumb::Readings& y, plumb::SensorSet delivered);
  const std::vector<plumb::SensorSet>& units() const noexcept { return units_; }
  plumb::SensorSet selector() const { return sensors_of(selector_blames_); }
  plumb::SensorSet voter() const { return sensors_of(voter_blames_); }
  /// Empty where the array has no unit.
  plumb::SensorSet in_use() const { return units_.empty() ? plumb::SensorSet() : units_[in_use_]; }
  /// Of the unit in use, from the last sample.
  const plumb::Vec3& vector() const noexcept { return now_.vector[in_use_]; }

 private:
  plumb::SensorSet sensors_of(std::uint32_t units) const;

  std::vector<plumb::SensorSet> units_;
  std::vector<plumb::LeastSquares> solve_;
  plumb_bench::Px4Means means_;
  plumb_bench::Px4Selector selector_;
  plumb_bench::Px4Voter voter_;
  plumb_bench::UnitVectors now_;
  std::uint32_t selector_blames_ = 0, voter_blames_ = 0;
  std::size_t in_use_ = 0;
};

/// The paper's monitor beside plumb's.
class PaperBeside {
 public:
  /// Fits the paper's parameters to the stations of the stand. Where that cannot be, `absent` says why, and nothing
  /// steps.
  PaperBeside(const plumb::Datasheet& datasheet, const plumb::MonitorSetup& plumb_setup,
              const std::vector<plumb::Station>& stations);
  const std::string& absent() const noexcept { return absent_; }
  void step(const plumb::Sample& sample);
  const plumb::Verdict& verdict() const noexcept { return monitor_->verdict(); }
  /// What it says is down, in the frame of plumb's calibration: the frame of the paper's first fit is turned onto it.
  plumb::Vec3 down() const;

 private:
  void align(const plumb::PaperSetup& setup, const std::vector<plumb::Station>& stations);

  std::unique_ptr<plumb::PaperMonitor> monitor_ = std::make_unique<plumb::PaperMonitor>();
  std::string absent_;
  plumb::Mat3 turn_{1, 0, 0, 0, 1, 0, 0, 0, 1};
};

}  // namespace plumb_web

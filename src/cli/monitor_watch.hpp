/// One array under `plumb monitor`: the monitor that it is watched with, and what is written of it.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "monitor_motion.hpp"
#include "monitor_options.hpp"
#include "monitor_outputs.hpp"
#include "plumb/health/health_monitor.hpp"
#include "plumb/paper/paper_monitor.hpp"
#include "plumb/session/log_run.hpp"
#include "plumb/session/monitor_pipeline.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {

class ArrayWatch {
 public:
  /// Reads array file and calibration, says on standard error what is to be known of them, plays the roll test, opens
  /// the files. The error is how the command ends: it has been reported, or --limits has been answered. `gyros`: a
  /// group that is watched beside and gives the rate in motion.
  static tl::expected<std::unique_ptr<ArrayWatch>, io::ExitCode> begin(const MonitorOptions& options,
                                                                       const session::RateGroup* gyros = nullptr);

  const io::ArrayFile& array() const noexcept { return array_; }
  const SensorArray& sensors() const noexcept { return monitor_ ? monitor_->array() : paper_->array(); }
  session::LogSpec log() const;
  /// Behind the sinks that there are, or before them. Before `share`.
  void add(session::VerdictSink& sink) { outputs_.sinks.push_back(&sink); }
  void add_first(session::VerdictSink& sink) { outputs_.sinks.insert(outputs_.sinks.begin(), &sink); }
  Outputs& outputs() noexcept { return outputs_; }
  /// What the monitor in `monitor` was configured with; null of the paper's.
  const HealthMonitor* monitor() const noexcept { return monitor_.get(); }
  io::FileExpected<std::unique_ptr<MonitorSetup>> setup() const;
  /// Those of the group that `begin` was given; it outlives the run.
  void take_rates_of(const session::RateWatch& gyros) { motion_->take_rates_of(gyros); }

  session::LogShare share();
  /// Completes the files, the report among them.
  io::FileExpected<void> keep(session::LogEnd end);
  /// The summary, and how the command ends.
  io::ExitCode say();

 private:
  ArrayWatch(const MonitorOptions& options, io::ArrayFile array, const session::RateGroup* gyros)
      : options_(options), array_(std::move(array)), gyros_(gyros) {}
  using Ended = std::optional<io::ExitCode>;
  Ended prepare();
  Ended prepare_without_calibration();
  Ended take_paper();
  Ended take_monitor();
  Ended play_roll_test();
  Ended open();
  io::FileExpected<void> open_incidents();
  const Calibration* calibration() const noexcept { return calibration_ ? &calibration_->calibration : nullptr; }
  std::string incidents_text() const;
  io::ExitCode code() const;

  MonitorOptions options_;
  io::ArrayFile array_, aligned_;
  const session::RateGroup* gyros_;  ///< null: none
  std::optional<io::CalibrationFile> calibration_;
  double days_ = 0.0;  ///< since then
  std::string past_;   ///< what the run goes on from, in the table; empty: power-on
  io::Json roll_test_;
  std::unique_ptr<HealthMonitor> monitor_;  ///< or that of the paper
  std::unique_ptr<PaperMonitor> paper_;
  std::unique_ptr<scenario::Host> host_;
  std::unique_ptr<stepping::Stepper> stepper_;
  std::optional<MonitorMotion> motion_;
  Outputs outputs_;
  std::optional<session::StepperRun> stepping_;
  session::MonitorRun run_;
};

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb

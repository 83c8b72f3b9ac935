/// --report: the health report of a run, written when it ends.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "monitor_options.hpp"
#include "plumb/io/output_file.hpp"
#include "plumb/render/motion_words.hpp"
#include "plumb/session/monitor_pipeline.hpp"
#include "plumb/verification/tool_health.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {

/// The name of the JSON beside the page; empty where `path` is not named as a page.
std::string health_data_path(const std::string& path);

/// What --report cannot be.
std::optional<io::FileError> report_misuse(const MonitorOptions& options);

class HealthReport : public session::VerdictSink {
 public:
  /// Both files are opened now, so that a directory that is not there is reported before the run; they appear with
  /// `write`.
  static io::FileExpected<std::unique_ptr<HealthReport>> create(const MonitorOptions& options,
                                                                const io::ArrayFile& array, const SensorArray& sensors,
                                                                double days_since_calibration);

  io::FileExpected<void> take(const Sample& sample, const Verdict& verdict) override;
  void at_depth(double depth_m) override { depth_m_ = depth_m; }

  /// What other groups say against the result, and all groups of the tool for the beginning of the page. Before
  /// `write`.
  void doubt(const std::string& why) { doubt_ = why; }
  void begin_with(io::Json groups) { groups_ = std::move(groups); }
  /// Is to be told what a monitor of motion finds, where there is one.
  session::MotionTrace& motion() noexcept { return motion_; }
  /// At the end of the run, however it ended.
  io::FileExpected<void> write(const session::MonitorRun& run, const render::MotionTold& motion);
  const verification::ToolHealth& health() const noexcept { return health_; }
  /// "usable for survey: yes" and what to do, for the end of a terminal's summary.
  std::string summary() const;

 private:
  HealthReport(const MonitorOptions& options, const io::ArrayFile& array, const SensorArray& sensors, double days,
               io::OutputFile page, io::OutputFile data);

  const MonitorOptions& options_;
  const io::ArrayFile& array_;
  const SensorArray& sensors_;
  double days_;  ///< since the calibration
  io::OutputFile page_, data_;
  verification::ToolHealth health_;
  session::MotionTrace motion_;
  std::vector<std::string> beside_;  ///< what else is to be done
  std::string doubt_;
  io::Json groups_;
  double depth_m_;
};

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb

/// What `plumb monitor` writes of a run while it goes on: the table, and the files that were asked for.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "monitor_options.hpp"
#include "monitor_report.hpp"
#include "plumb/session/monitor_pipeline.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {

/// A table line at each change.
class TableSink : public session::VerdictSink {
 public:
  /// `now`: what the monitor says before the first sample; `past`: what it goes on from, empty where it was switched
  /// on; `label`: before each line, of a table that has its header already; empty: the table is this sink's.
  TableSink(const SensorArray& array, const Mat3& frame, const Verdict& now, std::string past, std::string label)
      : array_(array), frame_(frame), now_(now), past_(std::move(past)), label_(std::move(label)) {}

  io::FileExpected<void> take(const Sample& sample, const Verdict& verdict) override;
  stepping::Wanted wanted() const override { return stepping::Wanted::changes; }

 private:
  const SensorArray& array_;
  Mat3 frame_;
  Verdict now_;
  std::string past_, label_;
  bool started_ = false;
};

/// All that `run` opened, in the order in which samples are handed on.
struct Outputs {
  std::optional<session::EventsFile> events;
  std::optional<session::VerdictsFile> verdicts;
  std::optional<session::EventsFile> json;
  std::optional<TableSink> table;
  std::unique_ptr<HealthReport> report;
  std::unique_ptr<session::IncidentRecorder> incidents;
  std::vector<session::VerdictSink*> sinks;
};

/// `now`: what the monitor says before the first sample; `past`: see `TableSink`; `days` since the calibration.
io::FileExpected<void> open_outputs(const MonitorOptions& options, const io::ArrayFile& array,
                                    const SensorArray& sensors, const Verdict& now, const std::string& past,
                                    double days, Outputs& out);
/// At the end of the run, however it ended.
io::FileExpected<void> commit(Outputs& outputs, const session::MonitorRun& run, const render::MotionTold& motion);

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb

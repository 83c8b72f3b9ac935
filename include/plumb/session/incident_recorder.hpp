/// The rows of a log around every change of state and every finding in motion, each incident in a file of its own that
/// is a log again: for whoever wants to know afterwards what happened.
#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "plumb/io/log_writer.hpp"
#include "plumb/session/motion_watch.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace session {

struct IncidentSettings {
  std::string directory;  ///< is made where there is none
  int rows = 1000;        ///< kept before a change, and recorded after it
  int most = 100;         ///< incidents; later ones are counted, not recorded
};

/// Files "incident-0001.csv" and so on, and "incidents.jsonl" with a line for each: file, times, rows, and the changes
/// in it as --events has them. A change within the rows after another one belongs to the same incident.
class IncidentRecorder final : public VerdictSink, public MotionSink {
 public:
  static constexpr int kMostRows = 100000;

  /// Errors: the directory cannot be written, or holds the incidents of another run.
  static io::FileExpected<std::unique_ptr<IncidentRecorder>> create(IncidentSettings settings,
                                                                    const io::ArrayFile& array);

  io::FileExpected<void> take(const Sample& sample, const Verdict& verdict) override;
  void at_depth(double depth_m) override { notes_.depth_m = depth_m; }
  void at_turn(const stepping::Turn& turn) override;
  void at_second_turn(const stepping::Turn& turn) override;
  void at_clocks(const std::vector<double>& clock_s) override { notes_.clock_s = io::clock_times(clock_s); }
  /// Of the same row, before it: a monitor of motion runs ahead in the list of sinks.
  io::FileExpected<void> take(double time_s, const MotionVerdict& verdict,
                              const std::vector<io::MotionEvent>& events) override;

  /// At the end of the run: the incident at hand ends.
  io::FileExpected<void> commit();
  int recorded() const noexcept { return recorded_; }
  /// Changes after the last incident that is recorded.
  int passed_over() const noexcept { return passed_over_; }

 private:
  struct Row {
    Sample sample;
    io::LogWriter::Notes notes;
  };
  struct Incident {
    std::string name;
    io::LogWriter log;
    double begin_s = 0.0, end_s = 0.0;
    std::size_t rows = 0;
    int left = 0;  ///< rows to come
    std::vector<std::string> changes;
  };
  IncidentRecorder(IncidentSettings settings, const io::ArrayFile& array, io::OutputFile index)
      : settings_(std::move(settings)), array_(array), index_(std::move(index)) {}

  std::string path_of(const std::string& name) const;
  io::FileExpected<void> begin();
  io::FileExpected<void> record(const Row& row);
  io::FileExpected<void> end();

  IncidentSettings settings_;
  const io::ArrayFile& array_;
  io::OutputFile index_;
  io::LogWriter::Notes notes_;        ///< of the row to come
  std::vector<std::string> changes_;  ///< with the row to come
  std::deque<Row> before_;
  std::optional<Incident> now_;
  int recorded_ = 0, passed_over_ = 0;
};

}  // namespace session
}  // namespace PLUMB_ABI
}  // namespace plumb

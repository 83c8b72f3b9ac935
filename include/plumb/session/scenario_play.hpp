/// A scenario played into a log, the truth beside it, as `plumb simulate` does it.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "plumb/io/log_writer.hpp"
#include "plumb/io/scenario_file.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace session {

class TruthFile;

/// Plays one scenario from its first sample to its last, or to Ctrl-C. Where the array file has one row per station, so
/// have log and truth.
class ScenarioPlay {
 public:
  ScenarioPlay(const io::ScenarioFile& file, scenario::Simulator simulator);
  ~ScenarioPlay();
  ScenarioPlay(const ScenarioPlay&) = delete;
  ScenarioPlay& operator=(const ScenarioPlay&) = delete;

  /// Once. "-": standard output. `truth_path` may be empty; the truth is in the frame in which plumb answers.
  io::FileExpected<void> run(const std::string& log_path, const std::string& truth_path);

  std::uint64_t rows() const noexcept { return rows_; }
  double last_time_s() const noexcept { return last_time_s_; }
  std::size_t stations() const noexcept { return simulator_.directions().size(); }
  /// Faults that lie outside the run.
  std::vector<std::size_t> without_effect() const;

 private:
  io::FileExpected<void> play(io::LogWriter& log);
  io::FileExpected<void> put(io::LogWriter& log, const Sample& sample, const scenario::Truth& truth);
  void note_faults(const scenario::Moment& now);

  const io::ScenarioFile& file_;
  scenario::Simulator simulator_;
  std::unique_ptr<TruthFile> truth_;
  std::vector<bool> shown_;  ///< by fault: whether it was in effect
  std::uint64_t rows_ = 0;
  double last_time_s_ = 0.0;
};

}  // namespace session
}  // namespace PLUMB_ABI
}  // namespace plumb

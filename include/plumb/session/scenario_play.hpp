/// A scenario played into a log, the truth beside it, as `plumb simulate` does it.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "plumb/io/log_writer.hpp"
#include "plumb/io/scenario_file.hpp"
#include "plumb/session/station_mean.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace session {

class TruthFile;

/// Plays one scenario from its first sample to its last, or to Ctrl-C. Where the array file has one row per station, so
/// have log and truth.
class ScenarioPlay {
 public:
  /// Errors of `Simulator::make`, as texts.
  static tl::expected<std::unique_ptr<ScenarioPlay>, std::string> make(const io::ScenarioFile& file);
  ~ScenarioPlay();
  ScenarioPlay(const ScenarioPlay&) = delete;
  ScenarioPlay& operator=(const ScenarioPlay&) = delete;

  /// Once. "-": standard output. `truth_path` may be empty; the truth is in the frame in which plumb answers.
  io::FileExpected<void> run(const std::string& log_path, const std::string& truth_path);

  std::uint64_t rows() const noexcept { return rows_; }
  double last_time_s() const noexcept { return last_time_s_; }
  std::size_t stations() const noexcept { return simulators_.front().directions().size(); }

  /// A fault of the tool or of one of its groups.
  struct PlayedFault {
    const io::ArrayFile* array = nullptr;  ///< whose sensors it names
    scenario::Fault fault;
    std::size_t table = 0;  ///< [[fault]], counted from 1
    bool shown = false;     ///< it was in effect
  };
  /// In the order of the file; what strikes every column is told of the accelerometers.
  const std::vector<PlayedFault>& faults() const noexcept { return faults_; }

 private:
  ScenarioPlay(const io::ScenarioFile& file, std::vector<scenario::Simulator> simulators);
  io::FileExpected<void> play(io::LogWriter& log);
  bool next();
  io::FileExpected<void> put_mean(io::LogWriter& log);
  io::FileExpected<void> put(io::LogWriter& log, const std::vector<Sample>& samples,
                             const std::vector<scenario::Truth>& truth);
  void note_faults(const scenario::Moment& now);

  const io::ScenarioFile& file_;
  std::vector<scenario::Simulator> simulators_;  ///< of the array itself, then of its groups
  std::vector<Sample> samples_;                  ///< of one row
  std::vector<StationMean> means_;
  std::unique_ptr<TruthFile> truth_;
  std::vector<PlayedFault> faults_;
  std::uint64_t rows_ = 0;
  double last_time_s_ = 0.0;
};

}  // namespace session
}  // namespace PLUMB_ABI
}  // namespace plumb

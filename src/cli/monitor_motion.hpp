/// The monitor of motion in a run of `plumb monitor`: made from the array file where that states motion, and heard in
/// table, events, --motion, --inclination and summary.
#pragma once

#include <memory>
#include <optional>

#include "monitor_outputs.hpp"
#include "plumb/render/motion_words.hpp"
#include "plumb/session/motion_watch.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {

class MonitorMotion {
 public:
  /// `calibration`: null without one. Where motion is mentioned and cannot be judged, it says so on standard error;
  /// that is an error where --motion asks for its results.
  /// `gyros`: the group that gives the rate, where it is watched beside (`session::plan_motion`).
  static io::FileExpected<MonitorMotion> make(const MonitorOptions& options, const io::ArrayFile& array,
                                              const io::CalibrationFile* calibration, double days,
                                              const session::RateGroup* gyros);

  /// Joins the outputs of a run, behind those that are open.
  io::FileExpected<void> open(const MonitorOptions& options, const io::ArrayFile& array, Outputs& outputs);
  /// Whoever wants to hear what is found, where motion is judged; after `open`.
  void tell(session::MotionSink& sink) {
    if (watch_ != nullptr) watch_->tell(sink);
  }
  /// After `open`.
  void take_rates_of(const session::RateWatch& gyros) {
    if (watch_ != nullptr) watch_->take_rates_of(gyros);
  }
  io::FileExpected<void> commit();
  /// Something was judged though the tool never rested.
  bool judged() const noexcept { return watch_ != nullptr && watch_->run().judged > 0; }
  render::MotionTold told() const noexcept;

 private:
  std::unique_ptr<session::MotionPlan> plan_;
  std::optional<io::FileError> refusal_;
  std::unique_ptr<session::MotionWatch> watch_;
  std::unique_ptr<session::MotionFile> file_;
  std::unique_ptr<session::InclinationFile> inclination_;
  std::vector<std::unique_ptr<session::MotionSink>> sinks_;
};

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb

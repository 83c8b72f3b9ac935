#include "monitor_motion.hpp"

#include "tool.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {
namespace {

/// A table line at each event.
class MotionTable final : public session::MotionSink {
 public:
  explicit MotionTable(const SensorArray& array) : array_(array) {}
  io::FileExpected<void> take(double, const MotionVerdict&, const std::vector<io::MotionEvent>& events) override {
    for (const io::MotionEvent& event : events) print_now(render::motion_line(event, array_));
    return {};
  }

 private:
  const SensorArray& array_;
};

io::FileError asked_in_vain(const io::FileError& refusal) {
  io::FileError out = refusal;
  out.what += ", and --motion asks for its results";
  return out;
}

}  // namespace

io::FileExpected<MonitorMotion> MonitorMotion::make(const MonitorOptions& options, const io::ArrayFile& array,
                                                    const io::CalibrationFile* calibration, double days) {
  MonitorMotion out;
  if (!array.motion.mentioned) {
    if (options.motion.empty()) return out;
    return tl::unexpected<io::FileError>(io::FileError{
        array.path, 0, "motion", "is missing, and --motion asks for its results",
        "add [motion] and the bounds of the sensors (docs/array-file.md, Motion), or leave --motion out"});
  }
  io::FileExpected<session::MotionPlan> plan =
      session::plan_motion(array, calibration != nullptr ? &calibration->calibration : nullptr, days,
                           calibration != nullptr ? calibration->motion.get() : nullptr);
  if (plan) {
    out.plan_ = std::make_unique<session::MotionPlan>(*std::move(plan));
    return out;
  }
  if (!options.motion.empty()) return tl::unexpected<io::FileError>(asked_in_vain(plan.error()));
  if (!options.limits) print_error("plumb: " + plan.error().text() + "\n");
  out.refusal_ = plan.error();
  return out;
}

io::FileExpected<void> MonitorMotion::open(const MonitorOptions& options, const io::ArrayFile& array,
                                           Outputs& outputs) {
  if (plan_ == nullptr) return {};
  watch_ = std::make_unique<session::MotionWatch>(*plan_);
  const SensorArray& sensors = plan_->array;
  for (std::optional<session::EventsFile>* events : {&outputs.events, &outputs.json}) {
    if (*events) sinks_.push_back(std::make_unique<session::MotionEvents>(**events, sensors));
  }
  if (outputs.report) watch_->tell(outputs.report->motion());
  if (outputs.table) sinks_.push_back(std::make_unique<MotionTable>(sensors));
  for (const std::unique_ptr<session::MotionSink>& sink : sinks_) watch_->tell(*sink);
  if (!options.motion.empty()) {
    const bool live = options.log.path == "-" || options.log.follow;
    io::FileExpected<std::unique_ptr<session::MotionFile>> file =
        session::MotionFile::create(options.motion, sensors, array.output_frame, live);
    if (!file) return tl::unexpected<io::FileError>(file.error());
    file_ = *std::move(file);
    watch_->tell(*file_);
  }
  outputs.sinks.push_back(watch_.get());
  return {};
}

io::FileExpected<void> MonitorMotion::commit() { return file_ != nullptr ? file_->commit() : io::FileExpected<void>(); }

render::MotionTold MonitorMotion::told() const noexcept {
  if (refusal_) return {nullptr, nullptr, &*refusal_};
  if (watch_ == nullptr) return {};
  return {&watch_->run(), &plan_->setup, nullptr};
}

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb

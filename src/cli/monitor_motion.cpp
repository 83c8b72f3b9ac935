#include "monitor_motion.hpp"

#include "tool.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {
namespace {

/// A table line at each event.
class MotionTable final : public session::MotionSink {
 public:
  MotionTable(const SensorArray& array, const std::string& label) : array_(array), label_(label) {}
  io::FileExpected<void> take(double, const MotionVerdict&, const std::vector<io::MotionEvent>& events) override {
    for (const io::MotionEvent& event : events) print_now(label_ + render::motion_line(event, array_));
    return {};
  }

 private:
  const SensorArray& array_;
  const std::string& label_;
};

/// The option that asks for results in motion; empty: none does.
std::string asking_option(const MonitorOptions& options) {
  if (!options.motion.empty()) return "--motion";
  return options.inclination.empty() ? "" : "--inclination";
}

io::FileError asked_in_vain(const io::FileError& refusal, const std::string& option) {
  io::FileError out = refusal;
  out.what += ", and " + option + " asks for its results";
  return out;
}

}  // namespace

io::FileExpected<MonitorMotion> MonitorMotion::make(const MonitorOptions& options, const io::ArrayFile& array,
                                                    const io::CalibrationFile* calibration, double days,
                                                    const session::RateGroup* gyros) {
  MonitorMotion out;
  if (!array.motion.mentioned) {
    const std::string asked = asking_option(options);
    if (asked.empty()) return out;
    return tl::unexpected<io::FileError>(io::FileError{
        array.path, 0, "motion", "is missing, and " + asked + " asks for its results",
        "add [motion] and the bounds of the sensors (docs/array-file.md, Motion), or leave " + asked + " out"});
  }
  io::FileExpected<session::MotionPlan> plan =
      session::plan_motion(array, calibration != nullptr ? &calibration->calibration : nullptr, days,
                           calibration != nullptr ? calibration->motion.get() : nullptr, gyros);
  if (plan) {
    if (!options.inclination.empty() && !plan->inclination)
      return tl::unexpected<io::FileError>(io::FileError{
          array.path, 0, "motion.velocity_bound_mps", "is missing, and --inclination asks for its results",
          "state how near the velocity stays to a constant one (docs/array-file.md, Motion), or leave it out"});
    out.plan_ = std::make_unique<session::MotionPlan>(*std::move(plan));
    return out;
  }
  if (!asking_option(options).empty())
    return tl::unexpected<io::FileError>(asked_in_vain(plan.error(), asking_option(options)));
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
  if (outputs.table) sinks_.push_back(std::make_unique<MotionTable>(sensors, options.label));
  for (const std::unique_ptr<session::MotionSink>& sink : sinks_) watch_->tell(*sink);
  const bool live = options.log.path == "-" || options.log.follow;
  if (!options.inclination.empty()) {
    io::FileExpected<std::unique_ptr<session::InclinationFile>> file =
        session::InclinationFile::create(options.inclination, live);
    if (!file) return tl::unexpected<io::FileError>(file.error());
    inclination_ = *std::move(file);
    watch_->tell(*inclination_);
  }
  if (!options.motion.empty()) {
    io::FileExpected<std::unique_ptr<session::MotionFile>> file =
        session::MotionFile::create(options.motion, sensors, array.output_frame, live);
    if (!file) return tl::unexpected<io::FileError>(file.error());
    file_ = *std::move(file);
    watch_->tell(*file_);
  }
  outputs.sinks.push_back(watch_.get());
  return {};
}

io::FileExpected<void> MonitorMotion::commit() {
  io::FileExpected<void> done;
  if (file_ != nullptr) done = file_->commit();
  if (done && inclination_ != nullptr) done = inclination_->commit();
  return done;
}

render::MotionTold MonitorMotion::told() const noexcept {
  if (refusal_) return {nullptr, nullptr, &*refusal_, false};
  if (watch_ == nullptr) return {};
  return {&watch_->run(), &plan_->setup, nullptr, plan_->inclination.has_value()};
}

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb

#include "plumb/session/roll_test.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "plumb/session/interrupt.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace session {
namespace {

/// Counts the attitudes at which the tool was at rest.
class Attitudes : public VerdictSink {
 public:
  explicit Attitudes(double apart_rad) : apart_rad_(apart_rad) {}
  io::FileExpected<void> take(const Sample&, const Verdict& verdict) override {
    const bool at_rest = verdict.tick && (verdict.usable & Usable::stationary) != 0;
    if (at_rest && is_new(verdict.gravity_mps2)) seen_.push_back(verdict.gravity_mps2);
    return {};
  }
  stepping::Wanted wanted() const override { return stepping::Wanted::blocks; }
  int count() const { return static_cast<int>(seen_.size()); }

 private:
  bool is_new(const Vec3& direction) const {
    return norm(direction) > 0.0 && std::none_of(seen_.begin(), seen_.end(), [&](const Vec3& before) {
             return angle_between_rad(before, direction) < apart_rad_;
           });
  }

  std::vector<Vec3> seen_;
  double apart_rad_;
};

}  // namespace

io::FileExpected<RollTest> play_roll_test(HealthMonitor& monitor, const io::ArrayFile& array,
                                          const LogSpec& recording) {
  watch_interrupts();
  Attitudes attitudes(monitor.config().distinct_attitude_angle_rad);
  scenario::Host nobody;
  io::ArrayFile at_rest = array;
  at_rest.input.clock_columns.clear();  // nobody asks for the times of chips there
  io::FileExpected<MonitorRun> run = run_monitor(monitor, at_rest, recording, {&attitudes}, nobody);
  if (!run) return tl::unexpected<io::FileError>(run.error());
  if (run->stopped) {
    io::FileError error = run->stop;
    error.remedy += " (the roll test of --roll-test; the log was not read)";
    return tl::unexpected<io::FileError>(std::move(error));
  }
  monitor.begin_time_base();
  return RollTest{*std::move(run), attitudes.count()};
}

}  // namespace session
}  // namespace PLUMB_ABI
}  // namespace plumb

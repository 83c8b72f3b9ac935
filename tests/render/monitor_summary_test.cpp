// The last lines of a run: what may be used of it, and how often the state changed.
#include "plumb/render/monitor_summary.hpp"

#include <gtest/gtest.h>

#include "plumb/session/detail/step_rows.hpp"

namespace monitor_summary_test {
namespace {

using namespace plumb;

std::string output_line(Validity validity, bool alert) {
  const io::ArrayFile array = *io::read_array_file(PLUMB_SOURCE_DIR "/examples/paper_tool.toml");
  session::MonitorRun run;
  run.last.validity = validity;
  run.last.alert = alert;
  const std::string text = render::summary_text(run, array, array.array, 0.0);
  const std::size_t begin = text.find("inclination");
  return text.substr(begin, text.find('\n', begin) - begin);
}

// Verifies: REQ-120
TEST(MonitorSummary, DoesNotCallAnOutputUsableWhileTheAlertIsOn) {
  EXPECT_NE(output_line(Validity::degraded, false).find("may be used"), std::string::npos);
  for (const Validity validity : {Validity::invalid, Validity::held, Validity::unconfirmed, Validity::degraded}) {
    EXPECT_EQ(output_line(validity, true).find("may be used"), std::string::npos) << to_string(validity);
  }
  EXPECT_NE(output_line(Validity::degraded, true).find("the alert is on"), std::string::npos);
}

/// The first alarm of an episode, and what has event `none`, say something and move nothing.
TEST(MonitorSummary, CountsChangesAndNotNotices) {
  const auto notice = [](HealthEvent event, HealthState from, HealthState to) {
    TransitionRecord record;
    record.event = event;
    record.from = from;
    record.to = to;
    return stepping_detail::is_notice(record);
  };
  EXPECT_TRUE(notice(HealthEvent::alarm, HealthState::suspect, HealthState::suspect));
  EXPECT_TRUE(notice(HealthEvent::none, HealthState::nominal, HealthState::nominal));
  EXPECT_FALSE(notice(HealthEvent::alarm, HealthState::nominal, HealthState::suspect));
  EXPECT_FALSE(notice(HealthEvent::exclusion, HealthState::isolated, HealthState::isolated)) << "a second sensor goes";
}

}  // namespace
}  // namespace monitor_summary_test

// What the summary says of single sensors: noise, full scale, drift rate.
#include "plumb/render/sensor_notes.hpp"

#include <gtest/gtest.h>

#include "plumb/core/units.hpp"

namespace sensor_notes_test {
namespace {

using namespace plumb;

const io::ArrayFile& array() {
  static const io::ArrayFile file = *io::read_array_file(PLUMB_SOURCE_DIR "/examples/paper_tool.toml");
  return file;
}

session::MonitorRun counted() {
  session::MonitorRun run;
  run.counts.known = true;
  run.counts.sensor.resize(4);
  return run;
}

std::string text_of(const session::MonitorRun& run) { return render::notes_text(run, array(), array().array); }

bool says(const std::string& text, const std::string& what) { return text.find(what) != std::string::npos; }

TEST(SensorNotes, NothingIsSaidOfAPaperMonitor) { EXPECT_EQ(text_of(session::MonitorRun{}), ""); }

TEST(SensorNotes, BlocksInMotionHaveACountAndAShare) {
  session::MonitorRun run = counted();
  run.blocks = 333;
  run.counts.blocks_in_motion = 123;
  EXPECT_TRUE(says(text_of(run), "blocks in motion: 123 of 456 (27 %)")) << text_of(run);
  EXPECT_EQ(render::motion_words(counted()), "0 of 0");
}

TEST(SensorNotes, ADriftRateHasItsSensorSignUnitAndUncertainty) {
  session::MonitorRun run = counted();
  EXPECT_TRUE(says(text_of(run), "drift rate  none found")) << text_of(run);
  run.last.drift_mps2_per_h[1] = -0.0980665F;
  const std::string text = text_of(run);
  EXPECT_TRUE(says(text, "drift rate  a2 -0.0981 m/s^2/h (-10 mg0/h); positive: its reading grows")) << text;
  EXPECT_TRUE(says(text, "1 sigma at most a sixth of it")) << text;
  EXPECT_TRUE(says(text, "state `stability` as large as the drift")) << text;
  EXPECT_FALSE(says(text, "one of them explains all")) << text;
  EXPECT_EQ(render::note_actions(run, array(), array().array).size(), 1U);
  run.last.drift_mps2_per_h[3] = 0.1F;
  EXPECT_TRUE(
      says(text_of(run), "a4 +0.1 m/s^2/h (+10.2 mg0/h); each as if it alone drifted: one of them explains all"))
      << text_of(run);
}

/// The scale of the array file is 3 V/g0.
TEST(SensorNotes, ANoisySensorHasItsNoiseBesideTheDeclaredOne) {
  session::MonitorRun run = counted();
  run.counts.sensor[2].scattering_blocks = 4;
  run.counts.sensor[2].scatter_raw_sq = 4.0 * 6e-3 * 6e-3;
  EXPECT_FALSE(says(text_of(run), "noisy")) << "nothing named it";
  run.last.sensor_cause[2] = Cause::noisy;
  const std::string text = text_of(run);
  EXPECT_TRUE(says(text, "a3 scatters by 2 mg0, 10 times the 0.2 mg0 declared, in 4 blocks")) << text;
  EXPECT_TRUE(says(text, "state noise = \"2 mg0\" for it")) << text;
  EXPECT_TRUE(says(text, "plumb noise STILL.csv --array")) << text;
  run.counts.sensor[2].scattering_blocks = 0;
  EXPECT_FALSE(says(text_of(run), "state noise")) << "no figure was measured";
  EXPECT_TRUE(says(text_of(run), "check cable, connector and supply of a3")) << text_of(run);
}

TEST(SensorNotes, FullScaleAtRestHasAnotherRemedyThanInMotion) {
  session::MonitorRun run = counted();
  run.counts.sensor[0].full_scale_in_motion = 340;
  EXPECT_TRUE(says(text_of(run), "a1 was at full scale in 340 rows in motion and 0 rows at rest")) << text_of(run);
  EXPECT_TRUE(says(text_of(run), "shock or vibration exceeds the range")) << text_of(run);
  run.counts.sensor[0].full_scale_at_rest = 1;
  EXPECT_TRUE(says(text_of(run), "check `full_scale`")) << text_of(run);
}

}  // namespace
}  // namespace sensor_notes_test

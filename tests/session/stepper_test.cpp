// The monitor that `plumb monitor` steps, of every capacity, beside the one for all arrays: the same bytes in every
// output.
#include <gtest/gtest.h>
// RapidCheck's header needs what is above.
#include <rapidcheck/gtest.h>

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/tool_runner.hpp"
#include "plumb/io/log_writer.hpp"
#include "plumb/io/records.hpp"
#include "plumb/render/health_page.hpp"
#include "plumb/render/timeline.hpp"
#include "plumb/session/monitor_pipeline.hpp"
#include "plumb/verification/tool_health.hpp"
#include "support/recording.hpp"

namespace stepper_test {
namespace {

using namespace plumb_test;
using plumb::session::VerdictSink;

std::string text_of(const plumb::stepping::RunCounts& counts) {
  std::string out = fmt::format(" {} {} {}", counts.known, counts.length_off_after_exclusion, counts.blocks_in_motion);
  for (const plumb::stepping::SensorCounts& c : counts.sensor)
    out += fmt::format(" {} {} {} {} {} {}", c.excluded_by_reading, c.named_noisy, c.scattering_blocks,
                       c.scatter_raw_sq, c.full_scale_at_rest, c.full_scale_in_motion);
  return out;
}

/// All that a run may print or write, as text.
class Transcript : public VerdictSink {
 public:
  Transcript(const plumb::io::ArrayFile& array, const plumb::SensorArray& sensors)
      : array_(array), sensors_(sensors), health_(array.output_frame, false) {}

  plumb::io::FileExpected<void> take(const plumb::Sample& sample, const plumb::Verdict& verdict) override {
    plumb::io::append_verdict_json(text_, verdict, sensors_, array_.output_frame);
    text_ += '\n';
    if (verdict.transition.sequence != 0) {
      text_ += plumb::render::table_line(plumb::render::row_of(verdict, sensors_, array_.output_frame));
      plumb::io::append_event_json(text_, verdict.transition, sensors_);
      ++changes_;
    }
    health_.take(sample, verdict, depth_m_);
    return {};
  }
  void at_depth(double depth_m) override { depth_m_ = depth_m; }

  int changes() const { return changes_; }
  std::string text(const plumb::session::MonitorRun& run) const {
    std::string out = text_ + plumb::render::health_json(health_, sensors_).dump() + "\n";
    plumb::io::append_verdict_json(out, run.last, sensors_, array_.output_frame);
    return out + std::to_string(run.samples) + " " + std::to_string(run.blocks) + " " +
           std::to_string(run.transitions) + " " + std::to_string(run.last_time_s) + " " + run.stop.what +
           text_of(run.counts);
  }

 private:
  const plumb::io::ArrayFile& array_;
  const plumb::SensorArray& sensors_;
  plumb::verification::ToolHealth health_;
  double depth_m_ = std::numeric_limits<double>::quiet_NaN();
  std::string text_;
  int changes_ = 0;
};

/// Where two long texts part, so that a failure can be read.
std::string parting(const std::string& a, const std::string& b) {
  const auto at = static_cast<std::size_t>(
      std::mismatch(a.begin(), a.begin() + static_cast<std::ptrdiff_t>(std::min(a.size(), b.size())), b.begin()).first -
      a.begin());
  const std::size_t from = at > 120 ? at - 120 : 0;
  return "\n" + a.substr(from, 240) + "\nbeside\n" + b.substr(from, 240);
}

struct Compared {
  int monitors = 0;  ///< of how many capacities
  int changes = 0;
  std::string difference;  ///< empty: none
};

/// The log through a monitor of every capacity that holds the array and through that of `make_monitor`.
Compared compare(const plumb::io::ArrayFile& array, const plumb::Calibration* calibration, const std::string& log) {
  Compared out;
  const auto monitor = plumb::session::make_monitor(array, calibration);
  if (!monitor) {
    out.difference = monitor.error().text();
    return out;
  }
  const plumb::SensorArray& sensors = (*monitor)->array();
  plumb::scenario::Host nobody;
  Transcript large(array, sensors);
  const auto run = plumb::session::run_monitor(**monitor, array, {log}, {&large}, nobody);
  if (!run) {
    out.difference = run.error().text();
    return out;
  }
  out.changes = large.changes();
  for (const int capacity : plumb::stepping::stepper_capacities()) {
    if (capacity < array.array.size() || (capacity <= 8 && array.monitor.window > 32)) continue;
    const auto stepper = plumb::session::make_stepper(array, calibration, capacity);
    if (!stepper || stepper->capacity() != capacity) {
      out.difference = "no monitor for " + std::to_string(capacity);
      return out;
    }
    Transcript transcript(array, sensors);
    const auto again = plumb::session::run_stepper(*stepper, array, {log}, {&transcript});
    if (!again) {
      out.difference = again.error().text();
      return out;
    }
    const std::string one = transcript.text(*again), all = large.text(*run);
    if (one != all) out.difference = "capacity " + std::to_string(capacity) + parting(one, all);
    ++out.monitors;
  }
  return out;
}

int capacities_for(int sensors) {
  const std::vector<int>& all = plumb::stepping::stepper_capacities();
  return static_cast<int>(std::count_if(all.begin(), all.end(), [sensors](int c) { return c >= sensors; }));
}

struct Files {
  plumb::io::ArrayFile array;
  plumb::io::CalibrationFile calibration;
};

Files read_files(const std::string& array_path, const std::string& calibration_path) {
  auto array = plumb::io::read_array_file(array_path);
  EXPECT_TRUE(array.has_value()) << array.error().text();
  auto calibration = plumb::io::read_calibration(calibration_path, *array);
  EXPECT_TRUE(calibration.has_value()) << calibration.error().text();
  return {*std::move(array), *std::move(calibration)};
}

void expect_alike(const Compared& compared, int sensors, int least_changes) {
  EXPECT_EQ(compared.difference, "");
  EXPECT_EQ(compared.monitors, capacities_for(sensors));
  EXPECT_GE(compared.changes, least_changes);
}

TEST(Stepper, FourSensorsOfWhichOneGetsStuckGiveTheSameAtEveryCapacity) {
  ASSERT_GE(plumb::stepping::stepper_capacities().size(), 2U);
  const Workshop where;
  Files files = read_files(where / "array.toml", where / "calibration.json");
  const std::string log = where / "drilling.csv";
  expect_alike(compare(files.array, &files.calibration.calibration, log), 4, 3);
  files.array.monitor.recalibrate_after_exclusion = true;
  expect_alike(compare(files.array, &files.calibration.calibration, log), 4, 3);
}

TEST(Stepper, AMonitorThatCalibratesItselfGivesTheSameAtEveryCapacity) {
  const Workshop where;
  const Files files = read_files(where / "array.toml", where / "calibration.json");
  expect_alike(compare(files.array, nullptr, where / "calibration.csv"), 4, 1);
}

TEST(Stepper, SixSensorsGiveTheSameAtEveryCapacity) {
  const Directory where;
  const std::string examples = PLUMB_SOURCE_DIR "/examples/";
  const std::vector<std::vector<std::string>> steps = {
      {"simulate", examples + "hexad_stand.toml", "--out", "stand.csv"},
      {"calibrate", "--array", examples + "hexad_tool.toml", "--log", "stand.csv", "--out", "cal.json"},
      {"simulate", examples + "drill_b.toml", "--out", "drill.csv"}};
  for (const std::vector<std::string>& step : steps) {
    const Outcome outcome = run(where, step);
    ASSERT_EQ(outcome.code, 0) << outcome.err;
  }
  const Files files = read_files(examples + "hexad_tool.toml", where / "cal.json");
  expect_alike(compare(files.array, &files.calibration.calibration, where / "drill.csv"), 6, 3);
}

TEST(Stepper, ARecordingGivesTheSameAtEveryCapacity) {
  const std::string log = recording_path("mikoff5_static_means.csv");
  if (!std::filesystem::exists(log)) GTEST_SKIP() << "no " << log;
  const Directory where;
  const std::string array = PLUMB_SOURCE_DIR "/examples/mikoff5_z.toml";
  const std::vector<std::vector<std::string>> steps = {
      {"calibrate", "--array", array, "--log", log, "--out", "cal.json"},
      {"inject", "--array", array, "--log", log, "--fault", "a2z:stuck=1g0@station5", "--out", "stuck.csv"}};
  for (const std::vector<std::string>& step : steps) {
    const Outcome outcome = run(where, step);
    ASSERT_EQ(outcome.code, 0) << outcome.err;
  }
  const Files files = read_files(array, where / "cal.json");
  expect_alike(compare(files.array, &files.calibration.calibration, where / "stuck.csv"), 5, 2);
}

/// What may befall a log: a sensor off, silent, not a number or stuck for a while; a gap; a jump of temperature.
void spoil(std::vector<plumb::Sample>& samples, int sensors) {
  const auto from = *rc::gen::inRange<std::size_t>(0, samples.size());
  const auto count = *rc::gen::inRange<std::size_t>(1, samples.size());
  const auto sensor = *rc::gen::inRange(0, sensors);
  const auto kind = *rc::gen::inRange(0, 6);
  const double size = *rc::gen::inRange(-300, 300) * 1e-3;
  const auto a = static_cast<std::size_t>(sensor);
  const double held = samples[from].raw[a];
  for (std::size_t k = from; k < std::min(from + count, samples.size()); ++k) {
    plumb::Sample& s = samples[k];
    switch (kind) {
      case 0: s.raw[a] += size; break;
      case 1: s.delivered = s.delivered.without(sensor); break;
      case 2: s.raw[a] = std::numeric_limits<double>::quiet_NaN(); break;
      case 3: s.raw[a] = held; break;
      case 4: s.time_s += 20.0; break;
      default: s.temperature_degc += 200.0 * size; break;
    }
  }
  if (kind != 4) return;
  for (std::size_t k = std::min(from + count, samples.size()); k < samples.size(); ++k) samples[k].time_s += 20.0;
}

RC_GTEST_PROP(StepperLaw, AnyDamagedLogGivesTheSameAtEveryCapacity, ()) {
  static const Workshop where;
  static const Files files = read_files(where / "array.toml", where / "calibration.json");
  static const auto log = plumb::io::read_log(where / "drilling.csv", files.array, plumb::io::BadRowPolicy::stop);
  RC_ASSERT(log.has_value());
  std::vector<plumb::Sample> samples;  // a block and a half at every station
  for (std::size_t k = 0; k < log->samples.size(); k += 4) samples.push_back(log->samples[k]);
  const int spoils = *rc::gen::inRange(0, 5);
  for (int k = 0; k < spoils; ++k) spoil(samples, files.array.array.size());
  const std::string path = where / "spoilt.csv";
  auto writer = plumb::io::LogWriter::create(path, files.array);
  RC_ASSERT(writer.has_value());
  for (const plumb::Sample& sample : samples) RC_ASSERT(writer->write(sample).has_value());
  RC_ASSERT(writer->commit().has_value());
  const bool self = *rc::gen::element(false, false, false, true);
  const Compared compared = compare(files.array, self ? nullptr : &files.calibration.calibration, path);
  RC_LOG() << compared.difference;
  RC_ASSERT(compared.difference.empty());
  RC_ASSERT(compared.monitors == capacities_for(files.array.array.size()));
}

}  // namespace
}  // namespace stepper_test

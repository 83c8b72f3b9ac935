#include "plumb/session/scenario_play.hpp"

#include <fmt/format.h>

#include <utility>

#include "clock_plan.hpp"
#include "plumb/core/units.hpp"
#include "plumb/io/output_file.hpp"
#include "plumb/io/records.hpp"
#include "plumb/navigation/tilt.hpp"
#include "plumb/session/interrupt.hpp"
#include "plumb/session/played_log.hpp"
#include "plumb/session/progress.hpp"
#include "plumb/session/station_mean.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace session {

/// The truth as a table. Where the log has one row per station, so has this one.
class TruthFile {
 public:
  TruthFile(io::OutputFile file, const io::ScenarioFile& scenario) : file_(std::move(file)), array_(scenario.array) {
    // The turn is found once, by its effect on the three axes.
    std::vector<scenario::Truth> axes(3);
    for (std::size_t k = 0; k < 3; ++k) axes[k].gravity_mps2[k] = 1.0;
    into_frame_of_nominal_axes(scenario.scenario.tool, axes);
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t r = 0; r < 3; ++r) turn_[3 * r + k] = axes[k].gravity_mps2[r];
    }
  }

  io::FileExpected<void> head() {
    return file_.write("t_s,station,moving,gx_mps2,gy_mps2,gz_mps2,inclination_deg,toolface_deg,faulty\n");
  }

  io::FileExpected<void> write(double time_s, const scenario::Truth& truth) {
    const Vec3 g = io::in_frame(array_.output_frame, times(turn_, truth.gravity_mps2));
    const Tilt tilt = tilt_of(g, Mat3{});
    std::string faulty;
    for (int i = 0; i < array_.array.size(); ++i) {
      if (truth.faulty.has(i)) faulty += (faulty.empty() ? "" : " ") + std::string(array_.array.row(i).id.data());
    }
    const auto angle = [](bool valid, double rad) { return valid ? io::shortest(deg_from_rad(rad)) : std::string(); };
    return file_.write(fmt::format("{},{},{},{},{},{},{},{},{}\n", io::shortest(time_s), truth.station,
                                   truth.moving ? 1 : 0, io::shortest(g[0]), io::shortest(g[1]), io::shortest(g[2]),
                                   angle(tilt.inclination_valid, tilt.inclination_rad),
                                   angle(tilt.toolface_valid, tilt.toolface_rad), faulty));
  }
  io::FileExpected<void> commit() { return file_.commit(); }

 private:
  io::OutputFile file_;
  const io::ArrayFile& array_;
  Mat3 turn_{};
};

ScenarioPlay::ScenarioPlay(const io::ScenarioFile& file, scenario::Simulator simulator)
    : file_(file), simulator_(std::move(simulator)), shown_(file.scenario.faults.size()) {}

ScenarioPlay::~ScenarioPlay() = default;

io::FileExpected<void> ScenarioPlay::run(const std::string& log_path, const std::string& truth_path) {
  if (!truth_path.empty()) {
    io::FileExpected<io::OutputFile> out = io::OutputFile::create(truth_path, io::OutputFile::Mode::stream);
    if (!out) return tl::unexpected<io::FileError>(out.error());
    truth_ = std::make_unique<TruthFile>(*std::move(out), file_);
    io::FileExpected<void> done = truth_->head();
    if (!done) return done;
  }
  io::FileExpected<io::LogWriter> log = io::LogWriter::create(log_path, file_.array, io::LogWriter::Columns::all);
  if (!log) return tl::unexpected<io::FileError>(log.error());
  io::FileExpected<void> done = play(*log);
  if (done) done = log->commit();
  if (done && truth_) done = truth_->commit();
  return done;
}

std::vector<std::size_t> ScenarioPlay::without_effect() const {
  std::vector<std::size_t> out;
  for (std::size_t k = 0; k < shown_.size(); ++k) {
    if (!shown_[k]) out.push_back(k);
  }
  return out;
}

io::FileExpected<void> ScenarioPlay::play(io::LogWriter& log) {
  const bool means = file_.array.input.rows == io::RowKind::stations;
  StationMean station(file_.array.array.size());
  Progress progress("simulating " + file_.name);
  Sample sample;
  scenario::Moment now;
  while (!interrupted() && simulator_.next(sample)) {
    now.row = simulator_.row();
    const scenario::Truth& truth = simulator_.truth();
    now.time_s = last_time_s_ = sample.time_s;
    now.station = truth.station;
    note_faults(now);
    progress.at(now.row, sample.time_s);
    if (means && truth.moving) continue;
    if (means && !station.empty() && station.truth().station != truth.station) {
      io::FileExpected<void> done = put(log, station.mean(), station.truth());
      if (!done) return done;
      station = StationMean(file_.array.array.size());
    }
    if (means) {
      station.add(sample, truth);
      continue;
    }
    io::FileExpected<void> done = put(log, sample, truth);
    if (!done) return done;
  }
  return means && !station.empty() ? put(log, station.mean(), station.truth()) : io::FileExpected<void>();
}

io::FileExpected<void> ScenarioPlay::put(io::LogWriter& log, const Sample& sample, const scenario::Truth& truth) {
  ++rows_;
  const bool turning = norm(truth.rate_radps) > 0.0;
  const Rotation rotation{turning, true, truth.rate_radps};
  io::FileExpected<void> done =
      log.write(sample, {false, rotation, truth.depth_m, rotation, shown_by_clocks(file_.array, sample.time_s)});
  return done && truth_ ? truth_->write(sample.time_s, truth) : done;
}

void ScenarioPlay::note_faults(const scenario::Moment& now) {
  for (std::size_t k = 0; k < shown_.size(); ++k) {
    if (!shown_[k]) shown_[k] = scenario::in_effect(file_.scenario.faults[k], now);
  }
}

}  // namespace session
}  // namespace PLUMB_ABI
}  // namespace plumb

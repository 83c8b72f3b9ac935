#include "plumb/session/scenario_play.hpp"

#include <fmt/format.h>

#include <algorithm>
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

/// What is written of a vector: "gx_mps2,gy_mps2,gz_mps2", "mag_x_nt,mag_y_nt,mag_z_nt".
class TruthVector {
 public:
  TruthVector(const io::ArrayFile& array, const scenario::Tool& tool) : array_(array) {
    // The turn is found once, by its effect on the three axes.
    std::vector<scenario::Truth> axes(3);
    for (std::size_t k = 0; k < 3; ++k) axes[k].gravity_mps2[k] = 1.0;
    into_frame_of_nominal_axes(tool, axes);
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t r = 0; r < 3; ++r) turn_[3 * r + k] = axes[k].gravity_mps2[r];
    }
  }

  std::string names() const {
    if (array_.field == io::FieldKind::gravity) return "gx_mps2,gy_mps2,gz_mps2";
    return fmt::format("{0}_x_{1},{0}_y_{1},{0}_z_{1}", array_.group, io::units_of(array_.field).json_suffix);
  }
  /// In the frame in which plumb answers.
  Vec3 of(const scenario::Truth& truth) const {
    const Vec3& real = array_.field == io::FieldKind::rate ? truth.rate_radps : truth.gravity_mps2;
    return io::in_frame(array_.output_frame, times(turn_, real));
  }
  std::string cells(const scenario::Truth& truth) const {
    const Vec3 v = scaled(of(truth), io::units_of(array_.field).json_per_inside);
    return fmt::format("{},{},{}", io::shortest(v[0]), io::shortest(v[1]), io::shortest(v[2]));
  }
  std::string faulty(const scenario::Truth& truth) const {
    std::string out;
    for (int i = 0; i < array_.array.size(); ++i) {
      if (truth.faulty.has(i)) out += (out.empty() ? "" : " ") + std::string(array_.array.row(i).id.data());
    }
    return out;
  }
  bool gravity() const noexcept { return array_.field == io::FieldKind::gravity; }

 private:
  const io::ArrayFile& array_;
  Mat3 turn_{};
};

/// The truth as a table. Where the log has one row per station, so has this one.
class TruthFile {
 public:
  TruthFile(io::OutputFile file, const io::ScenarioFile& scenario) : file_(std::move(file)) {
    vectors_.emplace_back(scenario.array, scenario.scenario.tool);
    for (std::size_t k = 0; k < scenario.groups.size(); ++k)
      vectors_.emplace_back(scenario.array.groups[k], scenario.groups[k].scenario.tool);
  }

  io::FileExpected<void> head() {
    std::string out = "t_s,station,moving," + vectors_.front().names();
    if (vectors_.front().gravity()) out += ",inclination_deg,toolface_deg";
    for (std::size_t k = 1; k < vectors_.size(); ++k) out += "," + vectors_[k].names();
    return file_.write(out + ",faulty\n");
  }

  io::FileExpected<void> write(double time_s, const std::vector<scenario::Truth>& truth) {
    const scenario::Truth& own = truth.front();
    std::string out =
        fmt::format("{},{},{},{}", io::shortest(time_s), own.station, own.moving ? 1 : 0, vectors_.front().cells(own));
    if (vectors_.front().gravity()) {
      const Tilt tilt = tilt_of(vectors_.front().of(own), Mat3{});
      const auto angle = [](bool valid, double rad) { return valid ? io::shortest(deg_from_rad(rad)) : std::string(); };
      out += fmt::format(",{},{}", angle(tilt.inclination_valid, tilt.inclination_rad),
                         angle(tilt.toolface_valid, tilt.toolface_rad));
    }
    std::string faulty = vectors_.front().faulty(own);
    for (std::size_t k = 1; k < vectors_.size(); ++k) {
      out += "," + vectors_[k].cells(truth[k]);
      const std::string more = vectors_[k].faulty(truth[k]);
      faulty += (faulty.empty() || more.empty() ? "" : " ") + more;
    }
    return file_.write(out + "," + faulty + "\n");
  }
  io::FileExpected<void> commit() { return file_.commit(); }

 private:
  io::OutputFile file_;
  std::vector<TruthVector> vectors_;
};

tl::expected<std::unique_ptr<ScenarioPlay>, std::string> ScenarioPlay::make(const io::ScenarioFile& file) {
  std::vector<const scenario::Scenario*> all = {&file.scenario};
  for (const io::ScenarioFile::Group& group : file.groups) all.push_back(&group.scenario);
  std::vector<scenario::Simulator> simulators;
  for (const scenario::Scenario* one : all) {
    tl::expected<scenario::Simulator, std::string> simulator = scenario::Simulator::make(*one);
    if (!simulator) return tl::unexpected<std::string>(simulator.error());
    simulators.push_back(*std::move(simulator));
  }
  return std::unique_ptr<ScenarioPlay>(new ScenarioPlay(file, std::move(simulators)));
}

ScenarioPlay::ScenarioPlay(const io::ScenarioFile& file, std::vector<scenario::Simulator> simulators)
    : file_(file), simulators_(std::move(simulators)), samples_(simulators_.size()) {
  const auto add = [this](const io::ArrayFile& array, const std::vector<scenario::Fault>& faults,
                          const std::vector<std::size_t>& tables) {
    means_.emplace_back(array.array.size());
    for (std::size_t k = 0; k < faults.size(); ++k) {
      const bool told = faults[k].sensor == scenario::kWholeLog && &array != &file_.array;
      if (!told) faults_.push_back({&array, faults[k], tables[k], false});
    }
  };
  add(file.array, file.scenario.faults, file.fault_table);
  for (std::size_t k = 0; k < file.groups.size(); ++k)
    add(file.array.groups[k], file.groups[k].scenario.faults, file.groups[k].fault_table);
  std::stable_sort(faults_.begin(), faults_.end(),
                   [](const PlayedFault& a, const PlayedFault& b) { return a.table < b.table; });
}

ScenarioPlay::~ScenarioPlay() = default;

io::FileExpected<void> ScenarioPlay::run(const std::string& log_path, const std::string& truth_path) {
  if (!truth_path.empty()) {
    io::FileExpected<io::OutputFile> out = io::OutputFile::create(truth_path, io::OutputFile::Mode::stream);
    if (!out) return tl::unexpected<io::FileError>(out.error());
    truth_ = std::make_unique<TruthFile>(*std::move(out), file_);
    io::FileExpected<void> done = truth_->head();
    if (!done) return done;
  }
  io::FileExpected<io::LogWriter> log = io::LogWriter::create(log_path, file_.array, io::LogWriter::Columns::tool);
  if (!log) return tl::unexpected<io::FileError>(log.error());
  io::FileExpected<void> done = play(*log);
  if (done) done = log->commit();
  if (done && truth_) done = truth_->commit();
  return done;
}

/// Delivery faults strike every group alike, so that all of them have the same rows.
bool ScenarioPlay::next() {
  bool more = true;
  for (std::size_t k = 0; k < simulators_.size(); ++k) more = simulators_[k].next(samples_[k]) && more;
  return more;
}

io::FileExpected<void> ScenarioPlay::play(io::LogWriter& log) {
  const bool means = file_.array.input.rows == io::RowKind::stations;
  Progress progress("simulating " + file_.name);
  scenario::Moment now;
  std::vector<scenario::Truth> truth(simulators_.size());
  while (!interrupted() && next()) {
    now.row = simulators_.front().row();
    for (std::size_t k = 0; k < simulators_.size(); ++k) truth[k] = simulators_[k].truth();
    now.time_s = last_time_s_ = samples_.front().time_s;
    now.station = truth.front().station;
    note_faults(now);
    progress.at(now.row, last_time_s_);
    if (means && truth.front().moving) continue;
    if (means && !means_.front().empty() && means_.front().truth().station != truth.front().station) {
      io::FileExpected<void> done = put_mean(log);
      if (!done) return done;
    }
    if (means) {
      for (std::size_t k = 0; k < means_.size(); ++k) means_[k].add(samples_[k], truth[k]);
      continue;
    }
    io::FileExpected<void> done = put(log, samples_, truth);
    if (!done) return done;
  }
  return means && !means_.front().empty() ? put_mean(log) : io::FileExpected<void>();
}

io::FileExpected<void> ScenarioPlay::put_mean(io::LogWriter& log) {
  std::vector<Sample> samples;
  std::vector<scenario::Truth> truth;
  for (std::size_t k = 0; k < means_.size(); ++k) {
    samples.push_back(means_[k].mean());
    truth.push_back(means_[k].truth());
    means_[k] = StationMean(simulators_[k].scenario().tool.datasheet.size);
  }
  return put(log, samples, truth);
}

io::FileExpected<void> ScenarioPlay::put(io::LogWriter& log, const std::vector<Sample>& samples,
                                         const std::vector<scenario::Truth>& truth) {
  ++rows_;
  const Sample& sample = samples.front();
  const scenario::Truth& own = truth.front();
  const bool turning = norm(own.rate_radps) > 0.0;
  const Rotation rotation{turning, true, own.rate_radps};
  io::FileExpected<void> done =
      log.write(sample, {false, rotation, own.depth_m, rotation, shown_by_clocks(file_.array, sample.time_s),
                         samples.size() > 1 ? &samples[1] : nullptr});
  return done && truth_ ? truth_->write(sample.time_s, truth) : done;
}

void ScenarioPlay::note_faults(const scenario::Moment& now) {
  for (PlayedFault& one : faults_) {
    if (!one.shown) one.shown = scenario::in_effect(one.fault, now);
  }
}

}  // namespace session
}  // namespace PLUMB_ABI
}  // namespace plumb

#include "gyro_recording.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "plumb/detection/stationarity.hpp"
#include "plumb/session/interrupt.hpp"
#include "plumb/session/motion_commissioning.hpp"
#include "plumb/session/progress.hpp"
#include "plumb/session/rate_run.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace session {
namespace {

constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();
/// A gyro at rest scatters by its noise, and its mean stays: else the tool turned, about the vertical for instance.
constexpr double kTurnedNoises = 5.0;
/// Attitudes that differ by less tell nothing of a turn.
constexpr double kLeastTurn_rad = 0.05;
/// Of a direction by calibrated accelerometers, at least.
constexpr double kLeastSigma_rad = 1e-4;
constexpr std::size_t kSeam = 8;

io::FileError too_long(const std::string& path) {
  return {path, 0, "", "has more than " + std::to_string(kMostCommissionRows) + " rows",
          "cut a part out of it in which the tool rests and then turns about all axes"};
}

/// Rows by the number of their sample: what the log skips is a sample at which nothing is given.
class SampleGrid {
 public:
  SampleGrid(double start_s, double period_s) : start_s_(start_s), period_s_(period_s) {}
  /// Negative: before the first.
  std::ptrdiff_t at(double time_s) const { return std::lround((time_s - start_s_) / period_s_); }

 private:
  double start_s_, period_s_;
};

io::FileExpected<void> read_rates(const io::ArrayFile& group, const LogSpec& log, GyroRecording& out) {
  io::FileExpected<io::LogReader> reader = io::LogReader::open(log.path, group, log.on_bad_row);
  if (!reader) return tl::unexpected<io::FileError>(reader.error());
  reader->hash_bytes();
  reader->stop_when(interrupt_flag());
  const SensorModel model = group.datasheet.model();
  MotionInputsWatch inputs(group.rate.sample_period_s);
  Progress progress("reading " + log.path);
  const auto n = static_cast<std::size_t>(group.array.size());
  out.log.period_s = group.rate.sample_period_s;
  out.log.rate_radps.resize(n);
  Sample row;
  io::LogReader::Next status = reader->next(row);
  out.start_s = row.time_s;
  const SampleGrid grid(out.start_s, out.log.period_s);
  for (; status == io::LogReader::Next::row; status = reader->next(row)) {
    inputs.add(row.time_s);
    const std::ptrdiff_t at = grid.at(row.time_s);
    if (at < 0) continue;
    const auto k = static_cast<std::size_t>(at);
    if (k >= kMostCommissionRows) return tl::unexpected<io::FileError>(too_long(log.path));
    const RateSample sample = rate_sample(group, model, row);
    for (std::size_t i = 0; i < n; ++i) {
      std::vector<double>& readings = out.log.rate_radps[i];
      if (readings.size() <= k) readings.resize(k + 1, kNoNumber);
      const bool given = sample.delivered.has(static_cast<int>(i)) && !sample.clipped.has(static_cast<int>(i));
      readings[k] = given ? sample.rate_radps[i] : kNoNumber;
    }
    progress.at(reader->statistics().rows, row.time_s);
  }
  if (status == io::LogReader::Next::error) return tl::unexpected<io::FileError>(reader->error());
  out.inputs = inputs.found();
  out.file = reader->statistics();
  return {};
}

/// The specific force of accelerometers, least squares; readings count in the sense of gravity.
class AccelerometerForce {
 public:
  AccelerometerForce(const SensorArray& array, const SensorModel& model) : model_(model), size_(array.size()) {
    Eigen::MatrixXd rows(size_, 3);
    for (int i = 0; i < size_; ++i) {
      for (int c = 0; c < 3; ++c) rows(i, c) = array.axis(i)[static_cast<std::size_t>(c)] / array.sigma_mps2(i);
      weight_.push_back(1.0 / array.sigma_mps2(i));
    }
    solve_ = (rows.transpose() * rows).ldlt().solve(rows.transpose());
  }
  /// NaN where one of them is missing.
  Vec3 of(const std::array<double, kCapacity>& raw, double temperature_degc, SensorSet usable) const {
    if ((SensorSet::first(size_) - usable).size() > 0) return {kNoNumber, kNoNumber, kNoNumber};
    const Readings y = model_.apply(raw, temperature_degc, usable);
    Vec3 out{};
    for (int i = 0; i < size_; ++i) {
      const auto a = static_cast<std::size_t>(i);
      for (std::size_t c = 0; c < 3; ++c) out[c] -= solve_(static_cast<Eigen::Index>(c), i) * weight_[a] * y[a];
    }
    return out;
  }

 private:
  SensorModel model_;
  int size_;
  Eigen::MatrixXd solve_;
  std::vector<double> weight_;
};

SensorSet usable_of(const io::ArrayFile& tool, const Sample& row) {
  SensorSet out;
  for (int i = 0; i < tool.datasheet.size; ++i) {
    const auto a = static_cast<std::size_t>(i);
    const double full = tool.datasheet.sensor[a].full_scale_raw;
    const bool clipped = full > 0.0 && std::fabs(row.raw[a]) >= full;
    if (row.delivered.has(i) && std::isfinite(row.raw[a]) && !clipped) out = out.with(i);
  }
  return out;
}

/// Means of a stretch, and whether the gyros agree that it stood still.
void see_gyros(const io::ArrayFile& group, const commission::GyroLog& log, GyroRestStretch& stretch) {
  for (std::size_t i = 0; i < log.rate_radps.size(); ++i) {
    double sum = 0.0, square = 0.0;
    int count = 0;
    for (std::size_t k = stretch.begin; k <= stretch.end; ++k) {
      const double y = log.rate_radps[i][k];
      if (!std::isfinite(y)) continue;
      sum += y, ++count;
    }
    const double mean = count > 0 ? sum / count : kNoNumber;
    for (std::size_t k = stretch.begin; k <= stretch.end; ++k) {
      const double off = log.rate_radps[i][k] - mean;
      if (std::isfinite(off)) square += off * off;
    }
    stretch.mean_radps.push_back(mean);
    const double most = kTurnedNoises * group.array.sigma_mps2(static_cast<int>(i));
    if (count > 0 && std::sqrt(square / count) > most) stretch.turned = true;
  }
}

/// Stretches whose mean is far from that of most.
void drop_turned(const io::ArrayFile& group, std::vector<GyroRestStretch>& rest) {
  for (std::size_t i = 0; !rest.empty() && i < rest.front().mean_radps.size(); ++i) {
    std::vector<double> means;
    for (const GyroRestStretch& one : rest) {
      if (!one.turned && std::isfinite(one.mean_radps[i])) means.push_back(one.mean_radps[i]);
    }
    if (means.size() < 3) continue;
    const auto middle = means.begin() + static_cast<std::ptrdiff_t>(means.size() / 2);
    std::nth_element(means.begin(), middle, means.end());
    const double most = kTurnedNoises * group.array.sigma_mps2(static_cast<int>(i));
    for (GyroRestStretch& one : rest) one.turned = one.turned || std::fabs(one.mean_radps[i] - *middle) > most;
  }
}

io::FileExpected<void> read_accelerometers(const io::ArrayFile& tool, const GyroRecordingSpec& spec,
                                           GyroRecording& out) {
  io::FileExpected<io::LogReader> reader = io::LogReader::open(spec.log.path, tool, spec.log.on_bad_row);
  if (!reader) return tl::unexpected<io::FileError>(reader.error());
  reader->stop_when(interrupt_flag());
  const SensorModel nominal = tool.datasheet.model();
  const AccelerometerForce force =
      spec.accelerometers != nullptr
          ? AccelerometerForce(spec.accelerometers->calibration.array, spec.accelerometers->calibration.model)
          : AccelerometerForce(tool.array, nominal);
  StationFinder::Settings settings;
  settings.station_angle_rad = tool.monitor.station_angle_rad;
  settings.max_gap_s = tool.monitor.max_gap_s;
  const auto finder = std::make_unique<StationFinder>(tool.array, tool.gravity.g_mps2, settings);
  const std::size_t samples = out.log.samples();
  const SampleGrid grid(out.start_s, out.log.period_s);
  if (spec.force) out.log.force_mps2.assign(samples, {kNoNumber, kNoNumber, kNoNumber});
  const auto take = [&](const Station& station) {
    GyroRestStretch one;
    one.begin = static_cast<std::size_t>(std::max<std::ptrdiff_t>(grid.at(station.begin_s), 0));
    one.end = std::min(static_cast<std::size_t>(std::max<std::ptrdiff_t>(grid.at(station.end_s), 0)), samples - 1);
    const Vec3 f = force.of(station.mean, station.temperature_degc, station.delivered);
    if (norm(f) > 0.0) one.direction = scaled(f, 1.0 / norm(f));
    if (one.begin <= one.end) out.rest.push_back(one);
  };
  Sample row;
  Station finished;
  io::LogReader::Next status = reader->next(row);
  for (; status == io::LogReader::Next::row; status = reader->next(row)) {
    const SensorSet usable = usable_of(tool, row);
    if (finder->add(row, nominal.apply(row.raw, row.temperature_degc, usable), usable, finished)) take(finished);
    const std::ptrdiff_t at = grid.at(row.time_s);
    if (spec.force && at >= 0 && static_cast<std::size_t>(at) < samples)
      out.log.force_mps2[static_cast<std::size_t>(at)] = force.of(row.raw, row.temperature_degc, usable);
  }
  if (status == io::LogReader::Next::error) return tl::unexpected<io::FileError>(reader->error());
  if (finder->finish(finished)) take(finished);
  return {};
}

}  // namespace

io::FileExpected<GyroRecording> read_gyros(const io::ArrayFile& tool, const io::ArrayFile& group,
                                           const GyroRecordingSpec& spec) {
  GyroRecording out;
  if (const auto read = read_rates(group, spec.log, out); !read) return tl::unexpected<io::FileError>(read.error());
  if (const auto read = read_accelerometers(tool, spec, out); !read) return tl::unexpected<io::FileError>(read.error());
  for (GyroRestStretch& one : out.rest) see_gyros(group, out.log, one);
  drop_turned(group, out.rest);
  out.log.at_rest.assign(out.log.samples(), false);
  for (const GyroRestStretch& one : out.rest) {
    for (std::size_t k = one.begin; !one.turned && k <= one.end; ++k) out.log.at_rest[k] = true;
  }
  return out;
}

std::vector<commission::GravityTurn> turns_of(const GyroRecording& recording, double sigma_rad, double bias_sigma_radps,
                                              double noise_radps) {
  std::vector<commission::GravityTurn> out;
  const double direction_rad = std::fmax(sigma_rad, kLeastSigma_rad);
  for (std::size_t k = 1; k < recording.rest.size(); ++k) {
    const GyroRestStretch& from = recording.rest[k - 1];
    const GyroRestStretch& to = recording.rest[k];
    const double period_s = recording.log.period_s;
    const double duration_s = static_cast<double>(to.begin - std::min(from.end, to.begin)) * period_s;
    if (!(norm(from.direction) > 0.0) || !(norm(to.direction) > 0.0) || !(duration_s > 0.0) ||
        duration_s > kLongestTurn_s || angle_between_rad(from.direction, to.direction) < kLeastTurn_rad)
      continue;
    const double drift_rad = std::hypot(bias_sigma_radps, kEarthRate_radps) * duration_s;
    const double walk_rad = noise_radps * std::sqrt(period_s * duration_s);
    out.push_back({from.end, to.begin, from.direction, to.direction,
                   std::sqrt(2.0 * direction_rad * direction_rad + drift_rad * drift_rad + walk_rad * walk_rad)});
  }
  return out;
}

void append(const GyroRecording& more, GyroRecording& to) {
  if (to.log.rate_radps.empty()) {
    to = more;
    return;
  }
  const std::size_t offset = to.log.samples() + kSeam;
  for (std::size_t i = 0; i < to.log.rate_radps.size(); ++i) {
    to.log.rate_radps[i].resize(offset, kNoNumber);
    to.log.rate_radps[i].insert(to.log.rate_radps[i].end(), more.log.rate_radps[i].begin(),
                                more.log.rate_radps[i].end());
  }
  to.log.at_rest.resize(offset, false);
  to.log.at_rest.insert(to.log.at_rest.end(), more.log.at_rest.begin(), more.log.at_rest.end());
  if (!more.log.force_mps2.empty()) {
    to.log.force_mps2.resize(offset, {kNoNumber, kNoNumber, kNoNumber});
    to.log.force_mps2.insert(to.log.force_mps2.end(), more.log.force_mps2.begin(), more.log.force_mps2.end());
  }
  GyroRestStretch seam;  // no direction: no turn leads over it
  seam.begin = seam.end = to.log.samples() - more.log.samples() - 1;
  seam.turned = true;
  to.rest.push_back(seam);
  for (GyroRestStretch one : more.rest) {
    one.begin += offset, one.end += offset;
    to.rest.push_back(std::move(one));
  }
}

double bias_scatter_radps(const GyroRecording& recording) {
  double worst = 0.0;
  for (std::size_t i = 0; i < recording.log.rate_radps.size(); ++i) {
    double sum = 0.0, square = 0.0;
    int count = 0;
    for (const GyroRestStretch& one : recording.rest) {
      if (one.turned || one.mean_radps.size() <= i || !std::isfinite(one.mean_radps[i])) continue;
      sum += one.mean_radps[i], square += one.mean_radps[i] * one.mean_radps[i], ++count;
    }
    if (count < 3) continue;
    worst = std::fmax(worst, std::sqrt(std::fmax(0.0, square - sum * sum / count) / (count - 1)));
  }
  return worst;
}

}  // namespace session
}  // namespace PLUMB_ABI
}  // namespace plumb

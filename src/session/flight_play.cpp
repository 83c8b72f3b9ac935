#include "plumb/session/flight_play.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "clock_plan.hpp"
#include "clocked_flight.hpp"
#include "flight_gyros.hpp"
#include "plumb/io/output_file.hpp"
#include "plumb/io/records.hpp"
#include "plumb/session/flight_sheet.hpp"
#include "plumb/session/interrupt.hpp"
#include "plumb/session/monitor_pipeline.hpp"
#include "plumb/session/progress.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace session {
namespace {

using scenario::FlightErrorBox;
using scenario::FlightSpec;

constexpr double kUsualRate_hz = 1000.0;
/// Noises of sensors that count as one.
constexpr double kSameNoise = 1e-9;

io::FileError flight_refused(const io::ArrayFile& array, const char* field, const std::string& what,
                             const std::string& remedy) {
  return {array.path, 0, field, what, remedy, io::ExitCode::invalid_input};
}

/// The least that a sensor states: what is drawn within it is within the bounds of all. 0 where one states nothing.
double least_of(const io::ArrayFile& array, std::optional<double> io::MotionBounds::*bound) {
  double least = HUGE_VAL;
  for (std::size_t k = 0; k < static_cast<std::size_t>(array.array.size()); ++k)
    least = std::fmin(least, (array.motion.sensor[k].*bound).value_or(0.0));
  return least;
}

FlightErrorBox box_of(const io::ArrayFile& array, double bandwidth_hz) {
  const MotionErrors least = {least_of(array, &io::MotionBounds::lever_arm_m),
                              least_of(array, &io::MotionBounds::lag_s),
                              least_of(array, &io::MotionBounds::rectification_per_mps2),
                              least_of(array, &io::MotionBounds::scale),
                              least_of(array, &io::MotionBounds::axis_rad),
                              least_of(array, &io::MotionBounds::bias_mps2)};
  const io::GyroSpec& g = array.motion.gyro;
  const GyroErrors gyro = {g.scale.value_or(0.0), g.axis_rad.value_or(0.0), g.bias_radps.value_or(0.0),
                           g.noise_radps.value_or(0.0), g.lag_s.value_or(0.0)};
  return flight_errors_within(least, gyro, bandwidth_hz);
}

double rate_hz_of(const io::ArrayFile& array) {
  if (array.motion.sample_period_s) return 1.0 / *array.motion.sample_period_s;
  return array.input.rate_hz > 0.0 ? array.input.rate_hz : kUsualRate_hz;
}

/// What was really the case, by row, in the output frame.
class FlightTruth {
 public:
  FlightTruth(io::OutputFile file, const io::ArrayFile& array) : file_(std::move(file)), array_(array) {}
  io::FileExpected<void> head() {
    return file_.write("t_s,fx_mps2,fy_mps2,fz_mps2,wx_radps,wy_radps,wz_radps,faulty\n");
  }
  io::FileExpected<void> write(const scenario::FlightSample& flown, SensorSet faulty, const std::string& more) {
    const Vec3 f = io::in_frame(array_.output_frame, flown.specific_force_mps2);
    const Vec3 w = io::in_frame(array_.output_frame, flown.true_rate_radps);
    std::string line = io::shortest(flown.time_s);
    for (const Vec3& vector : {f, w}) {
      for (const double part : vector) line += "," + io::shortest(part);
    }
    std::string names;
    for (int i = 0; i < array_.array.size(); ++i) {
      if (faulty.has(i)) names += (names.empty() ? "" : " ") + std::string(array_.array.row(i).id.data());
    }
    return file_.write(line + "," + names + (names.empty() || more.empty() ? "" : " ") + more + "\n");
  }
  io::FileExpected<void> commit() { return file_.commit(); }

 private:
  io::OutputFile file_;
  const io::ArrayFile& array_;
};

}  // namespace

io::FileExpected<FlightSpec> flight_spec_of(const io::ArrayFile& array, const FlightRequest& request) {
  const auto refuse = [&array](const char* field, const std::string& what, const std::string& remedy) {
    return tl::unexpected<io::FileError>(flight_refused(array, field, what, remedy));
  };
  if (array.lever_arm_m.empty())
    return refuse("sensor[1].lever_arm_m", "is missing, and a flight needs to know where the sensors sit",
                  "give every sensor its position in m: lever_arm_m = [0.02, 0.0, 0.01]");
  if (array.input.rows != io::RowKind::samples)
    return refuse("input.rows", "is \"stations\", and a flight has none", "set rows = \"samples\"");
  const SensorArray sensors =
      request.calibration != nullptr ? calibrated_array(array, *request.calibration) : array.array;
  FlightSpec spec;
  spec.kind = request.kind;
  spec.seed = request.seed;
  spec.rate_hz = rate_hz_of(array);
  spec.bandwidth_hz = std::fmin(spec.bandwidth_hz, spec.rate_hz);
  spec.noise_mps2 = array.array.sigma_mps2(0);
  for (int i = 0; i < array.array.size(); ++i) {
    spec.axis.push_back(sensors.axis(i));
    spec.lever_arm_m.push_back(array.lever_arm_m[static_cast<std::size_t>(i)]);
    if (std::fabs(array.array.sigma_mps2(i) / spec.noise_mps2 - 1.0) > kSameNoise)
      return refuse("sensor.noise", "differs from sensor to sensor, and the sensors of a flight have one noise",
                    "simulate with an array file that states the same noise for all");
  }
  spec.full_scale_mps2 = flight_full_scale_mps2(array.datasheet, spec.full_scale_mps2);
  spec.box = box_of(array, spec.bandwidth_hz);
  spec.gyros = (array.input.rotation_columns.empty() ? 0 : 1) + (array.input.second_rotation_columns.empty() ? 0 : 1);
  spec.gyro_noise_radps = array.motion.gyro.noise_radps.value_or(0.0);
  const tl::expected<void, std::string> sound = scenario::check(spec);
  if (!sound) return refuse("", "cannot be flown: " + sound.error(), "change the array file");
  return spec;
}

FlightPlay::FlightPlay(const io::ArrayFile& array, const FlightRequest& request, const FlightSpec& spec,
                       scenario::Injector injector)
    : array_(array),
      request_(request),
      flight_(spec),
      injector_(std::move(injector)),
      model_(request.calibration != nullptr ? request.calibration->model : array.datasheet.model()),
      rate_hz_(spec.rate_hz) {
  if (array.motion.clocks.empty()) return;
  MotionSetup period;
  period.sample_period_s = 1.0 / spec.rate_hz;
  period.gyros = spec.gyros;
  clocked_ = std::make_unique<ClockedFlight>(spec, clock_plan_of(array, period));
}

FlightPlay::~FlightPlay() = default;

io::FileExpected<std::unique_ptr<FlightPlay>> FlightPlay::make(const io::ArrayFile& array,
                                                               const FlightRequest& request) {
  const io::FileExpected<FlightSpec> spec = flight_spec_of(array, request);
  if (!spec) return tl::unexpected<io::FileError>(spec.error());
  tl::expected<scenario::Injector, std::string> injector = scenario::Injector::make(
      array.datasheet, request.calibration != nullptr ? request.calibration->model : array.datasheet.model(),
      request.faults, request.seed);
  if (!injector)
    return tl::unexpected<io::FileError>(io::FileError{"--fault", 0, "", injector.error(), "", io::ExitCode::usage});
  std::unique_ptr<FlightPlay> out(new FlightPlay(array, request, *spec, *std::move(injector)));
  for (std::size_t k = 0; k < array.groups.size(); ++k) {
    const std::vector<scenario::Fault> none;
    io::FileExpected<FlightGyros> group =
        FlightGyros::make(array.groups[k], k < request.group_faults.size() ? request.group_faults[k] : none,
                          request.seed, static_cast<std::uint32_t>(k));
    if (!group) return tl::unexpected<io::FileError>(group.error());
    out->groups_.push_back(*std::move(group));
  }
  out->group_samples_.resize(out->groups_.size());
  return out;
}

std::vector<int> FlightPlay::without_effect(std::size_t group) const { return groups_[group].without_effect(); }

std::string FlightPlay::add_groups(Row& row) {
  std::string names;
  for (std::size_t k = 0; k < groups_.size(); ++k) {
    SensorSet faulty;
    group_samples_[k] = groups_[k].next(row.flown, faulty);
    for (int i = 0; i < array_.groups[k].array.size(); ++i) {
      if (faulty.has(i)) names += (names.empty() ? "" : " ") + std::string(array_.groups[k].array.row(i).id.data());
    }
  }
  row.notes.groups = group_samples_.empty() ? nullptr : group_samples_.data();
  return names;
}

Sample FlightPlay::sample_of(const scenario::FlightSample& flown) const {
  return flight_sample(array_.datasheet, model_, array_.input.default_temperature_degc, flown);
}

/// What a host logs next.
FlightPlay::Row FlightPlay::next() {
  Row out;
  std::array<bool, kGyros> given = {true, true};
  if (clocked_ == nullptr) {
    out.flown = flight_.next();
    out.sample = sample_of(out.flown);
  } else {
    const ClockedFlight::Row row = clocked_->next();
    out.flown = row.flown;
    out.sample = sample_of(row.flown);
    out.sample.delivered = row.delivered;
    out.notes.clock_s = row.clock_s;
    given = row.rate_given;
  }
  const auto rotation = [&out, &given](std::size_t gyro) {
    const Vec3& rate_radps = out.flown.rate_radps[gyro];
    return given[gyro] ? Rotation{norm(rate_radps) > 0.0, true, rate_radps} : Rotation{true, false, {}};
  };
  out.notes.rotation = rotation(0);
  out.notes.second_rotation = rotation(1);
  return out;
}

io::FileExpected<void> FlightPlay::run(const std::string& log_path, const std::string& truth_path) {
  std::unique_ptr<FlightTruth> truth;
  io::FileExpected<void> done;
  if (!truth_path.empty()) {
    io::FileExpected<io::OutputFile> out = io::OutputFile::create(truth_path, io::OutputFile::Mode::stream);
    if (!out) return tl::unexpected<io::FileError>(out.error());
    truth = std::make_unique<FlightTruth>(*std::move(out), array_);
    done = truth->head();
    if (!done) return done;
  }
  io::FileExpected<io::LogWriter> log = io::LogWriter::create(log_path, array_, io::LogWriter::Columns::tool);
  if (!log) return tl::unexpected<io::FileError>(log.error());
  Progress progress("flying " + array_.name);
  const auto rows = static_cast<std::uint64_t>(std::llround(request_.duration_s * rate_hz_));
  const double end_s = request_.duration_s - 0.5 / rate_hz_;
  while (done && !interrupted()) {
    if (clocked_ == nullptr && rows_ == rows) break;
    Row row = next();
    if (clocked_ != nullptr && row.flown.time_s > end_s) break;
    const SensorSet faulty = injector_.apply(row.sample);
    const std::string more = add_groups(row);
    done = log->write(row.sample, row.notes);
    if (done && truth) done = truth->write(row.flown, faulty, more);
    last_time_s_ = row.flown.time_s;
    progress.at(++rows_, row.flown.time_s);
  }
  if (done) done = log->commit();
  return done && truth ? truth->commit() : done;
}

}  // namespace session
}  // namespace PLUMB_ABI
}  // namespace plumb

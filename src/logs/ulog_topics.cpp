#include "ulog_topics.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace plumb {
inline namespace PLUMB_ABI {
namespace logs {
namespace {

enum UlogTopicNumber : std::size_t {
  kSensorAccel,
  kVehicleImu,
  kVehicleImuStatus,
  kSensorCombined,
  kVehicleAcceleration
};

/// PX4 publishes vehicle_imu_status this often and begins its mean anew each time; the log may hold one in ten.
constexpr double kStatusInterval_s = 0.1;
constexpr std::uint64_t kInvalidRelativeTime = 0x7fffffff;
constexpr const char* kCombined = "accelerometer_m_s2";
constexpr std::uint32_t kMostCombined = 4;  ///< chips in one message
constexpr std::uint64_t kMostCounted = std::numeric_limits<std::uint32_t>::max();

/// The first of these names that the message has.
io::UlogCell first_of(const io::UlogLayout& layout, std::initializer_list<const char*> names) {
  for (const char* name : names) {
    if (const io::UlogCell cell = layout.cell(name)) return cell;
  }
  return {};
}

std::uint64_t whole_or_zero(const unsigned char* payload, const io::UlogCell& cell) noexcept {
  return cell ? io::ulog_whole(payload, cell) : 0;
}

Axes axes_of(const unsigned char* payload, const io::UlogCells& cells) noexcept {
  if (!cells[0]) return kAbsentAxes;
  return {io::ulog_number(payload, cells[0]), io::ulog_number(payload, cells[1]), io::ulog_number(payload, cells[2])};
}

bool finite(const Axes& axes) noexcept {
  return std::all_of(axes.begin(), axes.end(), [](double x) { return std::isfinite(x); });
}

/// A time of integration: whole numbers are microseconds. A floating one is in seconds where it is below one, since no
/// interval of an IMU is a second long, nor one below a microsecond.
double interval_s(const unsigned char* payload, const io::UlogCell& cell) noexcept {
  const double value = io::ulog_number(payload, cell);
  const bool in_seconds = !io::ulog_is_whole(cell.type) && value < 1.0;
  return in_seconds ? value : 1e-6 * value;
}

/// Divides a change by the time that it took; false where that is none.
bool divide(const unsigned char* payload, const io::UlogCell& dt, Axes& axes) noexcept {
  if (!dt) return true;
  const double time_s = interval_s(payload, dt);
  if (!(time_s > 0.0) || !std::isfinite(time_s)) return false;
  for (double& x : axes) x /= time_s;
  return true;
}

std::uint32_t counted(double count) noexcept {
  if (!(count >= 1.0)) return 1;
  return static_cast<std::uint32_t>(std::min(std::round(count), static_cast<double>(kMostCounted)));
}

void read_clips(const unsigned char* payload, const UlogReadings& readings, std::array<std::uint64_t, 3>& last,
                bool first, ImuRecord& out) noexcept {
  for (std::size_t k = 0; k < 3; ++k) {
    if (readings.clip_mask) {
      out.clipped[k] = static_cast<std::uint32_t>(io::ulog_whole(payload, readings.clip_mask) >> k & 1U);
    } else if (readings.clips[k]) {
      const std::uint64_t now = io::ulog_whole(payload, readings.clips[k]);
      std::uint64_t since = now;
      // A count below the last one began anew; how much of the first one is older than the log is unknown.
      if (readings.clips_add_up) since = first ? 0 : now >= last[k] ? now - last[k] : now;
      out.clipped[k] = static_cast<std::uint32_t>(std::min(since, kMostCounted));
      last[k] = now;
    }
  }
}

void set_imu(const io::UlogLayout& layout, UlogReadings& out) {
  out.force = layout.three("delta_velocity");
  out.dt = first_of(layout, {"delta_velocity_dt", "accel_dt", "dt"});
  out.rate = layout.three("delta_angle");
  out.rate_dt = first_of(layout, {"delta_angle_dt", "gyro_dt", "dt"});
  if (!out.rate_dt) out.rate = io::UlogCells{};
  out.clip_mask = layout.cell("delta_velocity_clipping");
  out.device = layout.cell("accel_device_id");
  out.kind = RecordKind::mean;
}

void set_imu_status(const io::UlogLayout& layout, UlogReadings& out) {
  out.force = layout.three("mean_accel");
  out.rate = layout.three("mean_gyro");
  out.variance = layout.three("var_accel");
  out.temperature = layout.cell("temperature_accel");
  out.clips = layout.three("accel_clipping");
  out.clips_add_up = true;
  out.rate_hz = layout.cell("accel_rate_hz");
  out.device = layout.cell("accel_device_id");
  out.kind = RecordKind::mean;
}

/// What the force is named, for who must be told that it is missing.
const char* force_name(std::size_t topic) noexcept {
  switch (topic) {
    case kSensorAccel: return "x, y, z";
    case kVehicleImu: return "delta_velocity";
    case kVehicleImuStatus: return "mean_accel";
    case kSensorCombined: return kCombined;
    default: return "xyz";
  }
}

}  // namespace

std::size_t ulog_topic(std::string_view name) noexcept {
  const auto* const found = std::find(kUlogTopics.begin(), kUlogTopics.end(), name);
  return static_cast<std::size_t>(found - kUlogTopics.begin());
}

std::uint32_t ulog_chips(std::size_t topic, const io::UlogLayout& layout) {
  if (topic != kSensorCombined) return 1;
  std::uint32_t chips = 1;
  while (chips < kMostCombined && layout.three(kCombined, 3 * chips)[0]) ++chips;
  return chips;
}

UlogStatus ulog_status(const io::UlogLayout& layout) {
  UlogStatus out;
  const io::UlogCell time = layout.cell("timestamp");
  for (std::uint32_t k = 0; k < kUlogStatusChips; ++k) {
    out.device[k] = layout.cell("accel_device_ids", k);
    out.inconsistency[k] = layout.cell("accel_inconsistency_m_s_s", k);
    out.healthy[k] = layout.cell("accel_healthy", k);
  }
  if (io::ulog_is_whole(time.type) && io::ulog_is_whole(out.device[0].type)) out.time = time;
  return out;
}

tl::expected<UlogReadings, const char*> ulog_readings(std::size_t topic, const io::UlogLayout& layout,
                                                      std::uint32_t which) {
  UlogReadings out;
  out.time = layout.cell("timestamp");
  out.sample_time = layout.cell("timestamp_sample");
  if (topic == kSensorAccel) {
    out.force = {layout.cell("x"), layout.cell("y"), layout.cell("z")};
    if (!out.force[0] || !out.force[1] || !out.force[2]) out.force = io::UlogCells{};
    out.device = layout.cell("device_id");
    out.temperature = layout.cell("temperature");
    out.clips = layout.three("clip_counter");
    out.samples = layout.cell("samples");
    // Drivers of older firmware corrected the readings and kept the raw ones beside them.
    out.uncalibrated = !layout.cell("x_raw");
  } else if (topic == kVehicleImu) {
    set_imu(layout, out);
    if (!out.dt) return tl::make_unexpected("delta_velocity_dt");
  } else if (topic == kVehicleImuStatus) {
    set_imu_status(layout, out);
  } else if (topic == kSensorCombined) {
    out.force = layout.three(kCombined, 3 * which);
    out.rate = layout.three("gyro_rad", 3 * which);
    if (const io::UlogCell own = layout.cell("accelerometer_timestamp", which); io::ulog_is_whole(own.type)) {
      out.time = own;
      out.shared = true;
    }
    out.relative_time = layout.cell("accelerometer_timestamp_relative");
    out.clip_mask = layout.cell("accelerometer_clipping");
    out.kind = RecordKind::mean;
  } else {
    out.force = layout.three("xyz");
  }
  if (!out.force[0]) return tl::make_unexpected(force_name(topic));
  const bool timed = io::ulog_is_whole(out.time.type) || io::ulog_is_whole(out.sample_time.type);
  if (!timed) return tl::make_unexpected("timestamp");
  return out;
}

// Unsigned differences: a time since 1970 loses nothing by what a double holds.
double UlogSources::since_zero_s(std::uint64_t time_us) const noexcept {
  return time_us >= zero_us_ ? static_cast<double>(time_us - zero_us_) * 1e-6
                             : static_cast<double>(zero_us_ - time_us) * -1e-6;
}

double UlogSources::time_s(const UlogReadings& readings, const unsigned char* payload) const noexcept {
  std::uint64_t time_us = whole_or_zero(payload, readings.sample_time);
  if (time_us == 0) time_us = whole_or_zero(payload, readings.time);  // not every driver says when it sampled
  const double relative = readings.relative_time ? 1e-6 * io::ulog_number(payload, readings.relative_time) : 0.0;
  return since_zero_s(time_us) + relative;
}

bool UlogSources::refuse(std::uint64_t offset, const char* what) {
  if (notes_.wanted(UlogTrouble::value, offset)) notes_.say(offset, std::string(what) + ", the record is left out");
  return false;
}

bool UlogSources::read(std::uint64_t offset, const UlogReadings& readings, const unsigned char* payload,
                       ImuRecord& out) {
  if (readings.relative_time && whole_or_zero(payload, readings.relative_time) == kInvalidRelativeTime)
    return refuse(offset, "the accelerometer's reading is marked as invalid");
  out.specific_force_mps2 = axes_of(payload, readings.force);
  if (!divide(payload, readings.dt, out.specific_force_mps2))
    return refuse(offset, "the time that the velocity changed in is not above zero");
  if (!finite(out.specific_force_mps2)) return refuse(offset, "the specific force is no number");
  out.rate_radps = axes_of(payload, readings.rate);
  if (!divide(payload, readings.rate_dt, out.rate_radps) || !finite(out.rate_radps)) out.rate_radps = kAbsentAxes;
  out.variance_m2ps4 = axes_of(payload, readings.variance);
  if (readings.temperature) out.temperature_degc = io::ulog_number(payload, readings.temperature);
  if (readings.samples) out.count = counted(io::ulog_number(payload, readings.samples));
  out.time_s = time_s(readings, payload);
  return true;
}

UlogSources::State& UlogSources::state_of(std::size_t topic, int instance, const UlogReadings& readings,
                                          const unsigned char* payload) {
  const auto entry = states_.try_emplace({topic, instance});
  State& state = entry.first->second;
  if (!entry.second) return state;
  state.number = states_.size() - 1;
  ImuSource source;
  source.name = std::string(kUlogTopics[topic]) + "[" + std::to_string(instance) + "]";
  source.instance = instance;
  source.device_id = state.device = whole_or_zero(payload, readings.device);
  source.kind = readings.kind;
  source.uncalibrated = readings.uncalibrated;
  // More than one sample in its FIFO: PX4 hands on their mean.
  if (readings.samples && io::ulog_number(payload, readings.samples) > 1.0) source.kind = RecordKind::mean;
  sink_.source(state.number, source);
  return state;
}

void UlogSources::check_time(std::uint64_t offset, const State& state, const char* topic, double time_s) {
  if (!(time_s < state.last_time_s) || !notes_.wanted(UlogTrouble::time, offset)) return;
  notes_.say(offset, std::string("the time of ") + topic + " goes back by " +
                         std::to_string(state.last_time_s - time_s) + " s, the record is handed on as it is");
}

void UlogSources::add(std::uint64_t offset, std::size_t topic, int instance, const UlogReadings& readings,
                      const unsigned char* payload) {
  ImuRecord record;
  const std::uint64_t sampled_us = readings.shared ? io::ulog_whole(payload, readings.time) : 0;
  if (readings.shared && sampled_us == 0) return;  // no such chip in this vehicle
  if (!read(offset, readings, payload, record)) return;
  State& state = state_of(topic, instance, readings, payload);
  if (readings.shared && sampled_us == state.last_us) return;
  state.last_us = sampled_us;
  const std::uint64_t device = whole_or_zero(payload, readings.device);
  if (device != 0 && state.device != 0 && device != state.device) {
    if (notes_.wanted(UlogTrouble::device, offset))
      notes_.say(offset, std::string(kUlogTopics[topic]) + "[" + std::to_string(instance) + "] comes from device " +
                             std::to_string(device) + ", not from " + std::to_string(state.device) +
                             " as before, the record is left out");
    return;
  }
  check_time(offset, state, kUlogTopics[topic], record.time_s);
  const bool first = std::isnan(state.last_time_s);
  read_clips(payload, readings, state.last_clips, first, record);
  if (readings.rate_hz && !first) {
    const double mean_s = std::min(record.time_s - state.last_time_s, kStatusInterval_s);
    record.count = counted(io::ulog_number(payload, readings.rate_hz) * mean_s);
  }
  state.last_time_s = record.time_s;
  sink_.record(state.number, record);
  ++records_;
}

void UlogSources::add_status(const UlogStatus& cells, const unsigned char* payload) {
  for (std::size_t k = 0; k < kUlogStatusChips; ++k) {
    ChipStatus status;
    status.device_id = whole_or_zero(payload, cells.device[k]);
    if (status.device_id == 0) continue;
    status.time_s = since_zero_s(io::ulog_whole(payload, cells.time));
    if (cells.inconsistency[k]) status.inconsistency_mps2 = io::ulog_number(payload, cells.inconsistency[k]);
    if (cells.healthy[k])
      status.health =
          io::ulog_whole(payload, cells.healthy[k]) != 0 ? ChipStatus::Health::sound : ChipStatus::Health::failed;
    sink_.status(status);
  }
}

}  // namespace logs
}  // namespace PLUMB_ABI
}  // namespace plumb

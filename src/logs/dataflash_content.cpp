#include "dataflash_content.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "plumb/io/printable.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace logs {
namespace {

/// Messages of one start of the controller come nearly in order, those of another start mostly do not.
constexpr double kRestart_s = 1.0;

bool is_digit(char c) noexcept { return c >= '0' && c <= '9'; }

/// Of INS_ACC_ID, INS_ACC2_ID, INS_ACC3_ID, INS4_ACC_ID: the instance that the parameter names the chip of; else -1.
int instance_of_id(std::string_view name) noexcept {
  if (name == "INS_ACC_ID") return 0;
  if (name.size() != 11) return -1;
  const bool older = name.substr(0, 7) == "INS_ACC" && name.substr(8) == "_ID";
  const bool newer = name.substr(0, 3) == "INS" && name.substr(4) == "_ACC_ID";
  const char digit = older ? name[7] : name[3];
  return (older || newer) && is_digit(digit) && digit != '0' ? digit - '1' : -1;
}

bool is_parameter_name(std::string_view name) noexcept {
  return !name.empty() && std::all_of(name.begin(), name.end(), [](char c) {
    return is_digit(c) || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == '_' || c == '.' || c == '-';
  });
}

std::uint32_t clamped(double count) noexcept {
  constexpr double kMost = std::numeric_limits<std::uint32_t>::max();
  return count > 0.0 ? static_cast<std::uint32_t>(std::min(count, kMost)) : 0U;
}

double finite_or_absent(double value) noexcept { return std::isfinite(value) ? value : kAbsent; }

std::string seconds(double value) {
  std::string out = std::to_string(value);
  return out.substr(0, std::min(out.size(), out.find('.') + 4)) + " s";
}

std::string count_text(double value) { return std::to_string(static_cast<std::uint64_t>(std::min(value, 9e18))); }

}  // namespace

double DataflashContent::Counter::grow(double value, std::uint64_t offset) noexcept {
  if (!std::isfinite(value)) return 0.0;
  const double more = seen && value > last ? value - last : 0.0;
  seen = true;
  last = value;
  if (more > 0.0 && !(rise > 0.0)) first_rise = offset;
  rise += more;
  return more;
}

void DataflashContent::take(const unsigned char* message, std::uint64_t offset) {
  const std::uint8_t type = message[2];
  if (type == kFmtType) {
    has_format_ = true;
    formats_.fmt(message, offset);
    return;
  }
  if (formats_.of(type).family == Family::other) return;
  const Layout& layout = formats_.settled(type, offset);
  if (!layout.usable) return;
  const Columns& columns = layout.columns;
  switch (layout.family) {
    case Family::imu:
    case Family::acc: reading(message, layout, offset); return;
    case Family::vibe: vibe(message, columns, offset); return;
    case Family::parm: parameter(message, columns, offset); return;
    case Family::unit: formats_.unit(message, columns); return;
    case Family::mult: formats_.multiplier(message, columns); return;
    case Family::fmtu: formats_.fmtu(message, columns); return;
    case Family::dsf: (void)dropped_.grow(number_at(message, columns.value), offset); return;
    case Family::other: return;
  }
}

void DataflashContent::look_at_clock(double time_s, std::uint64_t offset) {
  if (!std::isfinite(time_s)) return;
  if (!(time_s < clock_s_ - kRestart_s)) {
    clock_s_ = std::fmax(clock_s_, time_s);
    return;
  }
  if (notes_.wanted(DataflashTrouble::clock, offset)) {
    notes_.say(offset, "the clock goes back from " + seconds(clock_s_) + " to " + seconds(time_s) +
                           ": the flight controller was started anew, records go on with its new time");
  }
  clock_s_ = time_s;
  // What is counted from a start begins anew, and what was counted before the log's first look belongs to no record.
  for (Instance& instance : instances_) instance.clips.seen = false;
  for (Source& source : sources_) {
    source.last_s = kAbsent;
    source.gyro_errors.seen = false;
    source.force_errors.seen = false;
  }
  dropped_.last = 0.0;
}

bool DataflashContent::instance_at(const unsigned char* message, const Layout& layout, std::uint64_t offset,
                                   std::size_t& instance) {
  if (!layout.columns.instance.present()) {
    instance = static_cast<std::size_t>(std::max(layout.instance, 0));
    return true;
  }
  const double read = number_at(message, layout.columns.instance);
  if (read >= 0.0 && read < static_cast<double>(kInstances)) {
    instance = static_cast<std::size_t>(read);
    return true;
  }
  if (notes_.wanted(DataflashTrouble::bad_instance, offset)) {
    notes_.say(offset, "a message " + layout.name_text() + " names an instance that cannot be: it is left out");
  }
  return false;
}

std::size_t DataflashContent::source_of(bool is_imu, std::size_t instance) {
  int& number = instances_[instance].sources[is_imu ? 0 : 1];
  if (number >= 0) return static_cast<std::size_t>(number);
  number = static_cast<int>(sources_.size());
  ImuSource source;
  source.name = (is_imu ? "IMU[" : "ACC[") + std::to_string(instance) + "]";
  source.instance = static_cast<int>(instance);
  source.device_id = instances_[instance].device_id;
  source.kind = RecordKind::sample;
  sources_.emplace_back();
  sources_.back().name = source.name;
  sink_.source(sources_.size() - 1, source);
  return sources_.size() - 1;
}

void DataflashContent::reading(const unsigned char* message, const Layout& layout, std::uint64_t offset) {
  std::size_t instance = 0;
  if (!instance_at(message, layout, offset, instance)) return;
  const Columns& columns = layout.columns;
  const bool is_imu = layout.family == Family::imu;
  const double written_s = number_at(message, columns.time);
  look_at_clock(written_s, offset);
  const std::size_t number = source_of(is_imu, instance);
  Source& source = sources_[number];
  ImuRecord record;
  // The time of the reading where the log has it; a driver that does not know it writes 0.
  const double sampled_s = number_at(message, columns.sample_time);
  record.time_s = finite_or_absent(sampled_s > 0.0 ? sampled_s : written_s);
  bool finite = true;
  for (std::size_t k = 0; k < 3; ++k) {
    record.specific_force_mps2[k] = finite_or_absent(number_at(message, columns.force[k]));
    record.rate_radps[k] = finite_or_absent(number_at(message, columns.rate[k]));
    finite = finite && !std::isnan(record.specific_force_mps2[k]);
  }
  record.temperature_degc = finite_or_absent(number_at(message, columns.temperature));
  if (!finite && notes_.wanted(DataflashTrouble::no_number, offset)) {
    notes_.say(offset, "a record of " + source.name + " has a specific force that is no finite number: absent there");
  }
  if (record.time_s < source.last_s && notes_.wanted(DataflashTrouble::clock, offset)) {
    notes_.say(offset, "the time of " + source.name + " goes back from " + seconds(source.last_s) + " to " +
                           seconds(record.time_s));
  }
  source.last_s = record.time_s;
  (void)source.gyro_errors.grow(number_at(message, columns.gyro_errors), offset);
  (void)source.force_errors.grow(number_at(message, columns.force_errors), offset);
  Instance& state = instances_[instance];
  if (state.clipped > 0.0 && (is_imu || state.sources[0] < 0)) {
    record.clipped[0] = clamped(state.clipped);
    state.clipped = 0.0;
  }
  ++records_;
  sink_.record(number, record);
  health(message, columns, static_cast<int>(instance), record.time_s, source);
}

/// Told while it lasts, and when it ends.
void DataflashContent::health(const unsigned char* message, const Columns& columns, int instance, double time_s,
                              Source& source) {
  if (!columns.force_health.present()) return;
  const bool failed = number_at(message, columns.force_health) < 0.5;
  if (!failed && !source.failed) return;
  source.failed = failed;
  ChipStatus status;
  status.time_s = time_s;
  status.instance = instance;
  status.health = failed ? ChipStatus::Health::failed : ChipStatus::Health::sound;
  sink_.status(status);
}

/// VIBE counts the clips of a chip, of whichever axis, from the start on. What it has grown by goes with the next
/// record of IMU of that instance (of ACC, where there is no IMU), all of it as of the first axis.
void DataflashContent::vibe(const unsigned char* message, const Columns& columns, std::uint64_t offset) {
  look_at_clock(number_at(message, columns.time), offset);
  std::size_t first = 0;
  if (columns.instance.present()) {
    const double read = number_at(message, columns.instance);
    if (!(read >= 0.0 && read < static_cast<double>(kInstances))) return;
    first = static_cast<std::size_t>(read);
  }
  for (std::size_t k = 0; k < columns.clips.size() && columns.clips[k].present(); ++k) {
    Instance& state = instances_[(first + k) % kInstances];
    state.clipped += state.clips.grow(number_at(message, columns.clips[k]), offset);
  }
  ChipStatus status;
  status.time_s = number_at(message, columns.time);
  // Without an instance it is that of the accelerometer in use.
  if (columns.instance.present()) status.instance = static_cast<int>(first);
  for (std::size_t k = 0; k < 3; ++k) status.vibration_mps2[k] = number_at(message, columns.vibration[k]);
  if (columns.vibration[0].present()) sink_.status(status);
}

void DataflashContent::parameter(const unsigned char* message, const Columns& columns, std::uint64_t offset) {
  look_at_clock(number_at(message, columns.time), offset);
  const std::string_view name = text_at(message, columns.name);
  const double value = number_at(message, columns.value);
  if (!is_parameter_name(name)) {
    if (!notes_.wanted(DataflashTrouble::bad_parameter, offset)) return;
    notes_.say(offset, "the parameter '" + io::printable_line(name) + "' has no name that can be one: left out");
    return;
  }
  const int instance = instance_of_id(name);
  if (instance >= 0 && value >= 0.0 && value < 9e15) {
    instances_[static_cast<std::size_t>(instance)].device_id = static_cast<std::uint64_t>(value);
  }
  sink_.parameter(std::string(name), value);
}

void DataflashContent::finish() {
  for (const Source& source : sources_) {
    const Counter& gyro = source.gyro_errors;
    const Counter& force = source.force_errors;
    if (!(gyro.rise + force.rise > 0.0)) continue;
    const bool gyro_first = gyro.rise > 0.0 && (!(force.rise > 0.0) || gyro.first_rise < force.first_rise);
    notes_.say(gyro_first ? gyro.first_rise : force.first_rise,
               "errors of " + source.name + " are counted from here on: " + count_text(force.rise) +
                   " of the accelerometer (EA), " + count_text(gyro.rise) + " of the gyroscope (EG)");
  }
  if (dropped_.rise > 0.0) {
    notes_.say(dropped_.first_rise,
               "the logger counts messages that it lost (DSF.Dp) from here on: " + count_text(dropped_.rise));
  }
  notes_.sum_up();
}

}  // namespace logs
}  // namespace PLUMB_ABI
}  // namespace plumb

#include "ros_topics.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>

#include "plumb/io/printable.hpp"
#include "ros_imu.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace logs {
namespace {

constexpr std::int64_t kSecond_ns = 1000000000;
constexpr std::size_t kOtherTypesTold = 10;
/// A message of an IMU has some 330 bytes.
constexpr std::size_t kLongestMessage = 1U << 20U;
/// Of messages of an IMU that are not read: as many topics are remembered as told.
constexpr std::size_t kMostOtherTypes = 256;

constexpr std::array<std::string_view, 3> kImuTypes = {"sensor_msgs/msg/Imu", "sensor_msgs/Imu",
                                                       "sensor_msgs::msg::dds_::Imu_"};

std::string shown(std::string_view name) { return io::printable_line(name.substr(0, RosTopics::kLongestName)); }

bool is_imu_type(std::string_view type) noexcept {
  return std::find(kImuTypes.begin(), kImuTypes.end(), type) != kImuTypes.end();
}

/// Whether a name speaks of an IMU: a type that is not read, and may hold what is looked for.
bool speaks_of_imu(std::string_view name) {
  std::string lower(name.substr(0, RosTopics::kLongestName));
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](char c) { return static_cast<char>(std::tolower(static_cast<unsigned char>(c))); });
  return lower.find("imu") != std::string::npos || lower.find("accel") != std::string::npos;
}

/// Larger ones are bits of something else: no accelerometer and no gyroscope comes near, and their squares may
/// overflow.
constexpr double kLargestReading = 1e9;

bool is_reading(const Axes& axes) noexcept {
  return std::all_of(axes.begin(), axes.end(), [](double x) { return std::abs(x) <= kLargestReading; });
}

}  // namespace

void RosTopics::say_not_read(std::string_view topic, std::string_view type, std::string_view encoding,
                             std::uint64_t offset) {
  const bool is_known_type = is_imu_type(type);
  std::string key = type.empty() ? "messages without a type" : shown(type);
  if (is_known_type) key += " in " + shown(encoding);
  if (other_types_.size() == kMostOtherTypes && other_types_.count(key) == 0) return;
  if (++other_types_[key] > 1 || !(is_known_type || speaks_of_imu(type))) return;
  if (!notes_.wanted(RosTrouble::not_read, offset)) return;
  notes_.say(offset, "the topic " + shown(topic) + " has messages of " + key +
                         ", which are not read: sensor_msgs/msg/Imu in cdr is");
}

std::size_t RosTopics::define(std::string_view topic, std::string_view type, std::string_view encoding,
                              std::uint64_t offset) {
  if (!is_imu_type(type) || encoding != "cdr") {
    say_not_read(topic, type, encoding, offset);
    return kNotRead;
  }
  const std::string name = topic.empty() ? "(a topic without a name)" : shown(topic);
  const auto known = numbers_.find(name);
  if (known != numbers_.end()) return known->second;
  if (topics_.size() == kMostTopics) {
    if (notes_.wanted(RosTrouble::channel, offset))
      notes_.say(offset, "more than 1024 topics of IMUs, " + name + " is left out");
    return kNotRead;
  }
  numbers_.emplace(name, topics_.size());
  topics_.emplace_back();
  topics_.back().name = name;
  return topics_.size() - 1;
}

void RosTopics::refuse(const Topic& topic, RosTrouble trouble, std::uint64_t offset, std::string_view what) {
  if (notes_.wanted(trouble, offset))
    notes_.say(offset, topic.name + ": " + std::string(what) + ", the message is left out");
}

double RosTopics::time_s(std::int64_t time_ns) {
  if (!has_zero_) {
    has_zero_ = true;
    zero_ns_ = time_ns / kSecond_ns * kSecond_ns;
    sink_.parameter("log_zero_unix_s", static_cast<double>(zero_ns_ / kSecond_ns));
  }
  // Whole seconds and the rest apart: their difference may be larger than what 64 bits hold of nanoseconds.
  const std::int64_t seconds = time_ns / kSecond_ns - zero_ns_ / kSecond_ns;
  return static_cast<double>(seconds) + static_cast<double>(time_ns % kSecond_ns) * 1e-9;
}

std::string_view RosTopics::parse(const unsigned char* bytes, std::size_t size, RosImu& out) {
  constexpr std::array<unsigned char, 4> kZstd = {0x28, 0xB5, 0x2F, 0xFD};  // CDR begins with 00
  if (size < kZstd.size() || !std::equal(kZstd.begin(), kZstd.end(), bytes)) return parse_ros_imu(bytes, size, out);
  if (unpacker_.unpack("zstd", bytes, size, kLongestMessage) != Unpacker::Outcome::whole)
    return "the message is packed with zstd and cannot be unpacked";
  return parse_ros_imu(unpacker_.data(), unpacker_.size(), out);
}

std::int64_t RosTopics::stamp_ns(Topic& topic, const RosImu& imu, std::int64_t log_time_ns, std::uint64_t offset) {
  const std::int64_t stamp_ns = std::int64_t{imu.sec} * kSecond_ns + imu.nanosec;
  if (stamp_ns != 0 && imu.nanosec < kSecond_ns) return stamp_ns;
  if (++topic.without_stamp == 1 && notes_.wanted(RosTrouble::stamp, offset))
    notes_.say(offset, topic.name +
                           (imu.nanosec == 0 ? ": the stamp of a header is 0"
                                             : ": the stamp of a header has more than 1e9 nanoseconds") +
                           ", the time at which the message was recorded is used where that is so");
  return log_time_ns;
}

void RosTopics::take(std::size_t topic, std::int64_t log_time_ns, const unsigned char* bytes, std::size_t size,
                     std::uint64_t offset) {
  if (topic >= topics_.size()) return;
  Topic& from = topics_[topic];
  RosImu imu;
  const std::string_view trouble = parse(bytes, size, imu);
  if (!trouble.empty()) return refuse(from, RosTrouble::message, offset, trouble);
  if (!imu.has_force) return refuse(from, RosTrouble::value, offset, "the driver says it measures no acceleration");
  if (!is_reading(imu.specific_force_mps2))
    return refuse(from, RosTrouble::value, offset, "the specific force is no number");
  if (from.source == kNoSource) {
    from.source = sources_++;
    ImuSource source;
    source.name = from.name;
    source.frame_id = shown(imu.frame_id);
    sink_.source(from.source, source);
  }
  ImuRecord record;
  record.time_s = time_s(stamp_ns(from, imu, log_time_ns, offset));
  record.specific_force_mps2 = imu.specific_force_mps2;
  if (is_reading(imu.rate_radps)) record.rate_radps = imu.rate_radps;
  record.variance_m2ps4 = imu.variance_m2ps4;
  if (record.time_s < from.last_time_s && notes_.wanted(RosTrouble::time, offset))
    notes_.say(offset, "the time of " + from.name + " goes back by " +
                           std::to_string(from.last_time_s - record.time_s) + " s, the record is handed on as it is");
  from.last_time_s = record.time_s;
  sink_.record(from.source, record);
  ++records_;
}

void RosTopics::finish() {
  for (const Topic& topic : topics_) {
    if (topic.without_stamp > 1 && notes_.wanted(RosTrouble::stamp, 0))
      notes_.say(0, topic.name + ": " + std::to_string(topic.without_stamp) + " headers have no stamp");
  }
  if (records_ > 0) return;
  std::string types;
  std::size_t told = 0;
  for (const auto& [type, topics] : other_types_) {
    if (++told > kOtherTypesTold) break;
    types += (types.empty() ? "" : ", ") + type;
  }
  if (told > kOtherTypesTold) types += " and others";
  notes_.say(0, "the bag has no message sensor_msgs/msg/Imu that could be read" +
                    (types.empty() ? std::string() : "; it has " + types));
}

}  // namespace logs
}  // namespace PLUMB_ABI
}  // namespace plumb

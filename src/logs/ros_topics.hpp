/// The topics of a bag of ROS 2 and their messages, whatever the bag is stored as (private to src/logs).
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "plumb/core/config.hpp"
#include "plumb/logs/flight_log.hpp"
#include "ros_notes.hpp"
#include "unpack.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace logs {

struct RosImu;

/// Hands on the messages of the topics that are read. What it holds is bounded whatever a bag says.
class RosTopics {
 public:
  static constexpr std::size_t kNotRead = std::numeric_limits<std::size_t>::max();
  static constexpr std::size_t kMostTopics = 1024;  ///< of IMUs
  static constexpr std::size_t kLongestName = 255;

  RosTopics(LogSink& sink, RosNotes& notes) : sink_(sink), notes_(notes) {}

  /// The number of a topic, the same for the same name; `kNotRead` where its messages are not read.
  std::size_t define(std::string_view topic, std::string_view type, std::string_view encoding, std::uint64_t offset);
  /// A message, recorded at a time since 1970. `ros2 bag record` may have packed it with zstd.
  void take(std::size_t topic, std::int64_t log_time_ns, const unsigned char* bytes, std::size_t size,
            std::uint64_t offset);
  /// Says what the bag has not.
  void finish();
  std::uint64_t records() const noexcept { return records_; }

 private:
  static constexpr std::size_t kNoSource = std::numeric_limits<std::size_t>::max();
  struct Topic {
    std::string name;
    std::size_t source = kNoSource;
    double last_time_s = -std::numeric_limits<double>::infinity();
    std::uint64_t without_stamp = 0;
  };

  void say_not_read(std::string_view topic, std::string_view type, std::string_view encoding, std::uint64_t offset);
  void refuse(const Topic& topic, RosTrouble trouble, std::uint64_t offset, std::string_view what);
  std::string_view parse(const unsigned char* bytes, std::size_t size, RosImu& out);
  std::int64_t stamp_ns(Topic& topic, const RosImu& imu, std::int64_t log_time_ns, std::uint64_t offset);
  double time_s(std::int64_t time_ns);

  LogSink& sink_;
  RosNotes& notes_;
  std::vector<Topic> topics_;
  std::map<std::string, std::size_t, std::less<>> numbers_;
  std::map<std::string, int, std::less<>> other_types_;
  Unpacker unpacker_;
  std::size_t sources_ = 0;
  std::uint64_t records_ = 0;
  bool has_zero_ = false;
  std::int64_t zero_ns_ = 0;
};

}  // namespace logs
}  // namespace PLUMB_ABI
}  // namespace plumb

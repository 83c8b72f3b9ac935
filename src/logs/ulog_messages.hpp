/// What the messages of a ULog say, and which bytes can be one (private to src/logs).
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "plumb/core/config.hpp"
#include "plumb/io/ulog_format.hpp"
#include "plumb/logs/flight_log.hpp"
#include "ulog_notes.hpp"
#include "ulog_topics.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace logs {

constexpr std::size_t kUlogNeeded = 8;  ///< bytes of a message that `judge` may look at

struct UlogMessage {
  std::uint64_t offset = 0;  ///< of its header in the file
  unsigned char type = 0;
  std::size_t size = 0;                    ///< without the header
  const unsigned char* payload = nullptr;  ///< all of it, or what there is
};

class UlogMessages {
 public:
  static constexpr std::size_t kMostSubscriptions = 4096;

  UlogMessages(LogSink& sink, UlogNotes& notes) : sink_(sink), notes_(notes), sources_(sink, notes) {}

  enum class Judgement : std::uint8_t { good, unknown_type, size, unknown_id, removed_id, data_size, sync };
  /// Whether a message can look like this. `available` bytes of its payload may be looked at.
  Judgement judge(const UlogMessage& message, std::size_t available) const;
  /// Says why a message is no good; a good one runs past `end`.
  void say(const UlogMessage& message, Judgement judgement, std::uint64_t end, const std::string& consequence);
  /// Only what is good.
  void take(const UlogMessage& message);

  void set_zero(std::uint64_t zero_us) noexcept { sources_.set_zero(zero_us); }
  std::uint64_t records() const noexcept { return sources_.records(); }
  double dropped_s() const noexcept { return 1e-3 * static_cast<double>(dropped_ms_); }

 private:
  struct Subscription {
    std::string name;
    int instance = 0;
    std::size_t topic = kNoUlogTopic;    ///< or one without all fields that are needed
    std::vector<UlogReadings> readings;  ///< a chip each
    UlogStatus status;                   ///< with a time, where it is sensors_status_imu
    std::uint32_t least = 0;             ///< bytes of its data
    std::uint32_t most = io::UlogFormats::kLargest;
    bool removed = false;
  };
  void take_format(const UlogMessage& message);
  void take_parameter(const UlogMessage& message);
  void take_subscription(const UlogMessage& message);
  void take_removal(const UlogMessage& message);
  void take_data(const UlogMessage& message);
  Subscription subscribe(const UlogMessage& message, const std::string& name);
  void note(UlogTrouble trouble, std::uint64_t offset, const std::string& what);

  LogSink& sink_;
  UlogNotes& notes_;
  io::UlogFormats formats_;
  UlogSources sources_;
  std::map<std::uint64_t, Subscription> subscriptions_;
  std::set<std::size_t> lacking_;  ///< topics of which it was said that they lack a field
  std::uint64_t dropped_ms_ = 0;
};

}  // namespace logs
}  // namespace PLUMB_ABI
}  // namespace plumb

/// The topics of PX4 with readings of an accelerometer, and records out of their messages (private to src/logs).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string_view>
#include <tl/expected.hpp>
#include <utility>

#include "plumb/core/config.hpp"
#include "plumb/io/ulog_format.hpp"
#include "plumb/logs/flight_log.hpp"
#include "ulog_notes.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace logs {

constexpr std::array<const char*, 5> kUlogTopics = {"sensor_accel", "vehicle_imu", "vehicle_imu_status",
                                                    "sensor_combined", "vehicle_acceleration"};
constexpr std::size_t kNoUlogTopic = kUlogTopics.size();
/// What PX4 says of its accelerometers: up to four in a message.
constexpr const char* kUlogStatusTopic = "sensors_status_imu";
constexpr std::size_t kUlogStatusChips = 4;

/// Its place in kUlogTopics, or kNoUlogTopic.
std::size_t ulog_topic(std::string_view name) noexcept;

/// Where the readings of a topic stand in its messages.
struct UlogReadings {
  io::UlogCell time;           ///< of publishing, us
  io::UlogCell sample_time;    ///< of sampling, us; before that of publishing
  io::UlogCell relative_time;  ///< us from `time` to the sample
  io::UlogCell device;
  io::UlogCell temperature;
  io::UlogCell samples;    ///< in the mean
  io::UlogCell rate_hz;    ///< of the samples in the mean
  io::UlogCell dt;         ///< `force` is a change of velocity in this time
  io::UlogCell rate_dt;    ///< `rate` is an angle turned in this time
  io::UlogCell clip_mask;  ///< bit 0 is x
  io::UlogCells force;
  io::UlogCells rate;
  io::UlogCells clips;
  io::UlogCells variance;
  bool clips_add_up = false;  ///< counted since the start, not since the last message
  bool uncalibrated = false;  ///< before the calibration of the autopilot
  bool shared = false;        ///< the message has several chips: this one's time tells whether its reading is new
  RecordKind kind = RecordKind::sample;
};

/// How many chips one message has the readings of: sensor_combined of 2016 had up to three.
std::uint32_t ulog_chips(std::size_t topic, const io::UlogLayout& layout);
/// Those of chip `which`. The error is the name of a field that the topic lacks.
tl::expected<UlogReadings, const char*> ulog_readings(std::size_t topic, const io::UlogLayout& layout,
                                                      std::uint32_t which = 0);

/// Where sensors_status_imu has what.
struct UlogStatus {
  io::UlogCell time;
  std::array<io::UlogCell, kUlogStatusChips> device, inconsistency, healthy;
};
/// Without a time where the message lacks something.
UlogStatus ulog_status(const io::UlogLayout& layout);

/// Numbers the sources and hands their records on.
class UlogSources {
 public:
  UlogSources(LogSink& sink, UlogNotes& notes) : sink_(sink), notes_(notes) {}

  /// The header's timestamp: times are seconds since this one.
  void set_zero(std::uint64_t zero_us) noexcept { zero_us_ = zero_us; }
  /// `payload` holds all of the message that `readings` speak of.
  void add(std::uint64_t offset, std::size_t topic, int instance, const UlogReadings& readings,
           const unsigned char* payload);
  void add_status(const UlogStatus& cells, const unsigned char* payload);
  std::uint64_t records() const noexcept { return records_; }

 private:
  struct State {
    std::size_t number = 0;
    std::uint64_t last_us = 0;  ///< of a chip in a shared message
    std::uint64_t device = 0;
    double last_time_s = kAbsent;
    std::array<std::uint64_t, 3> last_clips{};
  };
  /// False where the message is none of readings; says so.
  bool read(std::uint64_t offset, const UlogReadings& readings, const unsigned char* payload, ImuRecord& out);
  State& state_of(std::size_t topic, int instance, const UlogReadings& readings, const unsigned char* payload);
  void check_time(std::uint64_t offset, const State& state, const char* topic, double time_s);
  double since_zero_s(std::uint64_t time_us) const noexcept;
  double time_s(const UlogReadings& readings, const unsigned char* payload) const noexcept;
  bool refuse(std::uint64_t offset, const char* what);

  LogSink& sink_;
  UlogNotes& notes_;
  std::uint64_t zero_us_ = 0;
  std::uint64_t records_ = 0;
  std::map<std::pair<std::size_t, int>, State> states_;
};

}  // namespace logs
}  // namespace PLUMB_ABI
}  // namespace plumb

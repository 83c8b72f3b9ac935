/// What the messages of a DataFlash log mean: readings, clips, parameters and error counts, handed on to a sink.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "dataflash_format.hpp"
#include "dataflash_notes.hpp"
#include "plumb/core/config.hpp"
#include "plumb/logs/flight_log.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace logs {

class DataflashContent {
 public:
  DataflashContent(LogSink& sink, DataflashNotes& notes) : sink_(sink), notes_(notes), formats_(notes) {}

  const DataflashFormats& formats() const noexcept { return formats_; }
  std::uint64_t records() const noexcept { return records_; }
  bool has_format() const noexcept { return has_format_; }
  /// A whole message of a known type, at `offset` of the file.
  void take(const unsigned char* message, std::uint64_t offset);
  /// What only the end of the log shows.
  void finish();

 private:
  static constexpr std::size_t kInstances = 256;

  /// A count that a flight controller keeps from its start on.
  struct Counter {
    bool seen = false;
    double last = 0.0;
    double rise = 0.0;
    std::uint64_t first_rise = 0;  ///< offset

    /// By how much it has grown. One that has become smaller has begun anew.
    double grow(double value, std::uint64_t offset) noexcept;
  };
  struct Source {
    std::string name;
    double last_s = kAbsent;
    Counter gyro_errors;
    Counter force_errors;
    bool failed = false;  ///< by the autopilot's own word
  };
  struct Instance {
    std::uint64_t device_id = 0;
    Counter clips;
    double clipped = 0.0;                ///< that no record has carried yet
    std::array<int, 2> sources{-1, -1};  ///< IMU, ACC
  };

  void reading(const unsigned char* message, const Layout& layout, std::uint64_t offset);
  void vibe(const unsigned char* message, const Columns& columns, std::uint64_t offset);
  void health(const unsigned char* message, const Columns& columns, int instance, double time_s, Source& source);
  void parameter(const unsigned char* message, const Columns& columns, std::uint64_t offset);
  void look_at_clock(double time_s, std::uint64_t offset);
  std::size_t source_of(bool is_imu, std::size_t instance);
  bool instance_at(const unsigned char* message, const Layout& layout, std::uint64_t offset, std::size_t& instance);

  LogSink& sink_;
  DataflashNotes& notes_;
  DataflashFormats formats_;
  std::array<Instance, kInstances> instances_{};
  std::vector<Source> sources_;
  Counter dropped_{true, 0.0, 0.0, 0};  ///< from 0 on: the logger's own count
  double clock_s_ = kAbsent;
  std::uint64_t records_ = 0;
  bool has_format_ = false;
};

}  // namespace logs
}  // namespace PLUMB_ABI
}  // namespace plumb

/// What a monitor writes down before its power goes, and how it finds out whether that may be used afterwards.
///
///   offset  size  what (all little-endian)
///        0     8  "plumbSNP"
///        8     2  format: which fields in which order; grows with every change of `fields()` or of its meaning
///       10     2  capacity of the build
///       12     4  version of plumb that wrote it; reported, not judged
///       16     8  identity: CRC-64 of configuration, axes, noise, calibration, ranges, codes, frame, lever arms
///       24     4  bytes of the whole snapshot
///       28     .  the fields of `HealthMonitor`, doubles as IEEE 754
///        .     8  CRC-64/XZ of all before it
#pragma once

#include <cstddef>
#include <cstdint>

#include "plumb/core/config.hpp"
#include "plumb/core/error.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

inline constexpr std::uint16_t kSnapshotFormat = 12;
inline constexpr std::size_t kSnapshotHeaderSize = 28;
inline constexpr std::size_t kSnapshotFrameSize = kSnapshotHeaderSize + 8;

/// What stands before the fields. A snapshot of whatever version begins and ends so.
struct SnapshotHeader {
  std::uint16_t format = kSnapshotFormat;
  std::uint16_t capacity = kCapacity;
  std::uint32_t plumb_version = 0;
  std::uint64_t identity = 0;
  std::uint32_t size = 0;
};

/// Reads the header and checks what can be checked without a monitor. Errors, the first that applies:
/// snapshot_truncated, snapshot_damaged, snapshot_older, snapshot_newer, snapshot_capacity.
Expected<SnapshotHeader> snapshot_header(const std::uint8_t* bytes, std::size_t size) noexcept;

}  // namespace PLUMB_ABI
}  // namespace plumb

// What outlives a power cycle: written down, and judged before it is believed.
#include "plumb/health/snapshot.hpp"

#include <array>
#include <cmath>

#include "plausible.hpp"
#include "plumb/core/detail/archive.hpp"
#include "plumb/core/version.hpp"
#include "plumb/health/health_monitor.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

using std::size_t;

static_assert(HealthMonitor::snapshot_size_max() <= 0xFFFF'FFFFU, "the header counts in 32 bits");
static_assert(stored_size_max<MonitorConfig>() > 0, "its identity holds every setting");

namespace {

constexpr std::array<char, 8> kMagic = {'p', 'l', 'u', 'm', 'b', 'S', 'N', 'P'};
constexpr size_t kCrcSize = 8;
Error error(Errc code, double value, double limit) noexcept { return Error{code, -1, value, limit}; }

void put_header(ArchiveWriter& out, std::uint64_t identity, size_t size) noexcept {
  out.put(kMagic);
  out.put_bits(kSnapshotFormat, 2);
  out.put_bits(kCapacity, 2);
  out.put_bits(kLibraryVersion, 4);
  out.put_bits(identity, 8);
  out.put_bits(size, 4);
}

}  // namespace

Expected<SnapshotHeader> snapshot_header(const std::uint8_t* bytes, size_t size) noexcept {
  const auto given = static_cast<double>(size);
  if (bytes == nullptr || size < kSnapshotFrameSize) {
    return tl::unexpected<Error>(
        error(Errc::snapshot_truncated, bytes == nullptr ? 0.0 : given, 1.0 * kSnapshotFrameSize));
  }
  for (size_t k = 0; k < kMagic.size(); ++k) {
    if (bytes[k] != static_cast<std::uint8_t>(kMagic[k])) return fail(Errc::snapshot_damaged);
  }
  ArchiveReader in(bytes + kMagic.size(), kSnapshotHeaderSize - kMagic.size(), 0);
  SnapshotHeader header;
  header.format = static_cast<std::uint16_t>(in.get_bits(2));
  header.capacity = static_cast<std::uint16_t>(in.get_bits(2));
  header.plumb_version = static_cast<std::uint32_t>(in.get_bits(4));
  header.identity = in.get_bits(8);
  header.size = static_cast<std::uint32_t>(in.get_bits(4));
  if (header.size < kSnapshotFrameSize) return fail(Errc::snapshot_damaged);
  if (header.size > size) {
    return tl::unexpected<Error>(error(Errc::snapshot_truncated, given, static_cast<double>(header.size)));
  }
  Crc64 crc;
  crc.add(bytes, header.size - kCrcSize);
  ArchiveReader end(bytes + header.size - kCrcSize, kCrcSize, 0);
  if (end.get_bits(kCrcSize) != crc.value()) return fail(Errc::snapshot_damaged);
  // From here on the bytes are as they were written.
  const double format = header.format;
  if (header.format < kSnapshotFormat) {
    return tl::unexpected<Error>(error(Errc::snapshot_older, format, kSnapshotFormat));
  }
  if (header.format > kSnapshotFormat) {
    return tl::unexpected<Error>(error(Errc::snapshot_newer, format, kSnapshotFormat));
  }
  if (header.capacity != kCapacity) {
    return tl::unexpected<Error>(error(Errc::snapshot_capacity, header.capacity, kCapacity));
  }
  return header;
}

/// Gravity is omitted: it is what the depth makes of it, and a tool that is switched on elsewhere has no other past.
std::uint64_t HealthMonitor::identity(const MonitorSetup& setup) const noexcept {
  const int n = setup.array.size();
  ArchiveWriter out(nullptr, 0, n);
  out.put_bits(static_cast<std::uint64_t>(n), 4);
  out.put(setup.config);
  out.put_bits(setup.model.reads == Reads::gravity ? 0 : 1, 1);
  for (int i = 0; i < n; ++i) {
    const SensorCoefficients& c = setup.model.sensor[static_cast<size_t>(i)];
    out.put(setup.array.row(i).id);
    out.put(setup.array.row(i).axis);
    out.put(setup.array.row(i).sigma_mps2);
    out.put(c.scale);
    out.put(c.bias);
    out.put(c.reference_degc);
    out.put(setup.full_scale_raw[static_cast<size_t>(i)]);
    out.put(setup.lever_arm_m[static_cast<size_t>(i)]);
    out.put(setup.resolution_raw[static_cast<size_t>(i)]);
    out.put(setup.stability[static_cast<size_t>(i)]);
  }
  out.put(setup.array.uncertainty());
  out.put(setup.output_frame);
  out.put(setup.lever_arms_known);
  if (setup.array.units().grouped()) {  // arrays without chips keep the name that they had
    for (int i = 0; i < n; ++i) out.put_bits(static_cast<std::uint64_t>(setup.array.units().of(i)), 1);
  }
  if (kSingle) out.put(kSingle);                     // readings that add up to other sums
  if (!setup.calibrated) out.put(setup.calibrated);  // what was written before there was the choice keeps its name
  return out.crc();
}

size_t HealthMonitor::snapshot_size() const noexcept {
  ArchiveWriter counter(nullptr, 0, state_.in_force.array.size());
  counter.put(*this);
  return kSnapshotFrameSize + counter.used();
}

Expected<size_t> HealthMonitor::snapshot(std::uint8_t* to, size_t room) const noexcept {
  if (!configured_ || !whole()) return fail(Errc::not_calibrated);
  const size_t size = snapshot_size();
  if (to == nullptr || room < size) {
    const double given = to == nullptr ? 0.0 : static_cast<double>(room);
    return tl::unexpected<Error>(error(Errc::buffer_too_small, given, static_cast<double>(size)));
  }
  ArchiveWriter out(to, room, state_.in_force.array.size());
  put_header(out, state_.settings.identity, size);
  out.put(*this);
  out.put_bits(out.crc(), kCrcSize);
  return size;
}

Expected<void> HealthMonitor::restore(const MonitorSetup& setup, const std::uint8_t* bytes, size_t size) noexcept {
  const Expected<void> configured = configure(setup);
  if (!configured) return configured;
  const Expected<void> taken = take_up(setup, bytes, size);
  if (taken) {
    seal();
    return taken;
  }
  // Nothing of what was read before the fault was found may stay.
  const Expected<void> again = configure(setup);
  if (!again) return again;
  verdict_.cause = state_.last.cause = Cause::snapshot_refused;
  verdict_.snapshot_refusal = taken.error().code;
  seal();
  return taken;
}

Expected<void> HealthMonitor::take_up(const MonitorSetup& setup, const std::uint8_t* bytes, size_t size) noexcept {
  const Expected<SnapshotHeader> header = snapshot_header(bytes, size);
  if (!header) return tl::unexpected<Error>(header.error());
  if (header->identity != state_.settings.identity) return fail(Errc::snapshot_foreign);
  ArchiveReader in(bytes + kSnapshotHeaderSize, header->size - kSnapshotFrameSize, state_.in_force.array.size());
  in.get(*this);
  if (!in.sound() || in.left() != 0 || !resume(setup)) return fail(Errc::snapshot_implausible);
  return {};
}

/// Derives what is not stored, and asks of the whole what its parts alone cannot answer.
bool HealthMonitor::resume(const MonitorSetup& setup) noexcept {
  MonitorState& s = state_;
  if (!sets_are_plausible(s) || !calibration_is_plausible(s, setup)) return false;
  s.intake.coefficients.forget();
  s.window.forget_near();
  derive_limits();
  s.service.size = s.classify(s.in_service());
  s.service.map = least_squares(s.in_force.array, s.in_service());
  s.diagnosis.resume(s.in_force.array, s.monitored());
  return s.recalibration.resume(s.fit_terms()) && mode_is_plausible(s) && verdict_is_plausible(s, verdict_);
}

}  // namespace PLUMB_ABI
}  // namespace plumb

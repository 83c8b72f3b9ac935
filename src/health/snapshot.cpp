// What outlives a power cycle: written down, and judged before it is believed.
#include "plumb/health/snapshot.hpp"

#include <array>
#include <cmath>

#include "plumb/core/archive.hpp"
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
/// A vector computed anew from the same numbers, by whichever compiler.
constexpr double kRounding_mps2 = 1e-9;

Error error(Errc code, double value, double limit) noexcept { return Error{code, -1, value, limit}; }

bool same_coefficients(const SensorModel& a, const SensorModel& b) noexcept {
  for (size_t i = 0; i < static_cast<size_t>(a.size); ++i) {
    if (a.sensor[i].scale != b.sensor[i].scale || a.sensor[i].bias != b.sensor[i].bias) return false;
  }
  return true;
}

/// What a recalibration leaves alone: it changes scale and bias, and the terms in temperature only along with the
/// scale.
bool same_temperature_terms(const SensorModel& now, const SensorModel& was) noexcept {
  constexpr double kRounding = 1e-9;
  const auto near = [](double a, double b) { return std::fabs(a - b) <= kRounding * std::fabs(b); };
  for (size_t i = 0; i < static_cast<size_t>(now.size); ++i) {
    const double length = now.sensor[i].scale[0] / was.sensor[i].scale[0];
    for (size_t k = 1; k < 4; ++k) {
      if (!near(now.sensor[i].scale[k], length * was.sensor[i].scale[k])) return false;
      if (!near(now.sensor[i].bias[k] * length, was.sensor[i].bias[k])) return false;
    }
  }
  return true;
}

bool same_rows(const SensorArray& a, const SensorArray& b) noexcept {
  for (int i = 0; i < a.size(); ++i) {
    if (a.axis(i) != b.axis(i) || a.sigma_mps2(i) != b.sigma_mps2(i)) return false;
  }
  return true;
}

bool same_uncertainty(const RowUncertainty& a, const RowUncertainty& b, int sensors) noexcept {
  for (int k = 0; k < RowUncertainty::packed_size(sensors); ++k) {
    if (a.covariance[static_cast<size_t>(k)] != b.covariance[static_cast<size_t>(k)]) return false;
  }
  for (int i = 0; i < sensors; ++i) {
    if (a.misfit_mps2[static_cast<size_t>(i)] != b.misfit_mps2[static_cast<size_t>(i)]) return false;
  }
  return true;
}

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

/// Gravity is left out: it is what the depth makes of it, and a tool that is switched on elsewhere has no other past.
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
  if (kSingle) out.put(kSingle);                     // readings that add up to other sums
  if (!setup.calibrated) out.put(setup.calibrated);  // what was written before there was the choice keeps its name
  return out.crc();
}

size_t HealthMonitor::snapshot_size() const noexcept {
  ArchiveWriter counter(nullptr, 0, array_.size());
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
  ArchiveWriter out(to, room, array_.size());
  put_header(out, identity_, size);
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
  verdict_.cause = Cause::snapshot_refused;
  verdict_.snapshot_refusal = taken.error().code;
  seal();
  return taken;
}

Expected<void> HealthMonitor::take_up(const MonitorSetup& setup, const std::uint8_t* bytes, size_t size) noexcept {
  const Expected<SnapshotHeader> header = snapshot_header(bytes, size);
  if (!header) return tl::unexpected<Error>(header.error());
  if (header->identity != identity_) return fail(Errc::snapshot_foreign);
  ArchiveReader in(bytes + kSnapshotHeaderSize, header->size - kSnapshotFrameSize, array_.size());
  in.get(*this);
  if (!in.sound() || in.left() != 0 || !resume(setup)) return fail(Errc::snapshot_implausible);
  return {};
}

/// Derives what is not stored, and asks of the whole what its parts alone cannot answer.
bool HealthMonitor::resume(const MonitorSetup& setup) noexcept {
  if (!sets_are_plausible()) return false;
  if (!calibration_is_plausible(setup)) return false;
  coefficients_.forget();
  forget_near();
  derive_limits();
  size_class_ = classify(in_service_);
  map_ = least_squares(array_, in_service_);
  isolation_.resume(array_, in_service_ | set_aside_);
  return recalibration_.resume({model_, array_, gravity_, limits_}) && mode_is_plausible() && verdict_is_plausible();
}

/// The coefficients in force, and how they can have come about.
bool HealthMonitor::calibration_is_plausible(const MonitorSetup& setup) const noexcept {
  const bool changed = recalibration_.adopted();
  if (changed && !array_.uncertainty().is_covariance()) return false;
  if (!same_temperature_terms(model_, setup.model)) return false;
  if (recalibration_.first() != owes_calibration()) return false;
  const bool own = !setup.calibrated && !owes_calibration();
  if (own) {
    if (rank_of(array_, calibrated_) < 3 || !array_.uncertainty().is_covariance()) return false;
    const SensorModel commissioned = recalibration_.commissioned(model_);
    const Error off = Recalibration::off_datasheet(setup.model, setup.array, commissioned, array_, array_.all());
    return off.code == Errc::ok && (changed || (same_coefficients(model_, commissioned)));
  }
  if (setup.calibrated != (calibrated_ == array_.all())) return false;
  if (temperature_min_degc_ != config_.temperature_min_degc || temperature_max_degc_ != config_.temperature_max_degc)
    return false;
  if (!same_rows(array_, setup.array) || !recalibration_.commissioned_as(setup.model)) return false;
  // Where nobody has changed the calibration it is not another one.
  return changed || (!three_sensor_fit_ && same_coefficients(model_, setup.model) &&
                     same_uncertainty(array_.uncertainty(), setup.array.uncertainty(), array_.size()));
}

bool HealthMonitor::sets_are_plausible() const noexcept {
  const SensorSet sets[] = {in_service_, set_aside_, excluded_, absent_};
  SensorSet seen;
  for (const SensorSet set : sets) {
    if (!(seen & set).empty()) return false;
    seen = seen | set;
  }
  return seen == array_.all();
}

bool HealthMonitor::mode_is_plausible() const noexcept {
  if ((pending_ & ~kKeptEvents) != 0 || block_.size() >= config_.window) return false;
  if (have_evidence_ && !(evidence_.samples > 0.0)) return false;
  const bool rank_lost = size_class_ == SizeClass::rank_lost;
  if (owes_calibration() && mode_ != Mode::initial && mode_ != Mode::failed) return false;
  // Nobody whom the monitor has not calibrated serves.
  if (!owes_calibration() && !calibrated_.contains(in_service_ | set_aside_)) return false;
  switch (mode_) {
    case Mode::nominal:
    case Mode::isolated:
    case Mode::degraded: return mode_ == mode_by_size(size_class_) && !unproven_;
    case Mode::suspect: return !rank_lost;
    case Mode::recalibrating: return kRecalibrates && !rank_lost && recalibration_.under_way();
    case Mode::initial: return !rank_lost && owes_calibration() && unproven_ && recalibration_.collects(in_service_);
    case Mode::failed: return true;
  }
  return false;
}

/// What was published last must follow from what is remembered: it is what the host reads until the next step.
bool HealthMonitor::verdict_is_plausible() const noexcept {
  const Verdict& v = verdict_;
  const bool masks = v.configured == array_.all() && v.in_service == in_service_ && v.set_aside == set_aside_ &&
                     v.excluded == excluded_ && v.absent == absent_;
  if (!masks || v.state != state_of(mode_)) return false;
  const Validity now = validity();
  if (v.validity != now && (v.validity != Validity::held || now == Validity::invalid)) return false;
  if (v.protection_available && !scan_.protection_available) return false;
  if (v.protection_level_rad != (v.protection_available ? scan_.protection_rad : 0.0)) return false;
  if (v.validity == now && v.usable != usable_bits()) return false;
  const bool within = v.protection_available && v.protection_level_rad <= config_.alert_limit_rad;
  if (!v.alert && (!within || v.validity != Validity::valid)) return false;
  if (!have_evidence_) return true;
  const SetTest t = test_set(array_, gravity_, limits_, evidence_, in_service_ & evidence_.usable);
  if (!t.tested) return true;
  const Vec3 x_mps2 = times(frame_, t.x_mps2);
  for (size_t k = 0; k < 3; ++k) {
    if (!(std::fabs(v.gravity_mps2[k] - x_mps2[k]) <= kRounding_mps2 * (1.0 + norm(x_mps2)))) return false;
  }
  return true;
}

}  // namespace PLUMB_ABI
}  // namespace plumb

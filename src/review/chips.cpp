#include "chips.hpp"

#include <algorithm>
#include <cmath>

#include "limits.hpp"
#include "plumb/core/units.hpp"
#include "plumb/core/vec3.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace review {
namespace {

constexpr int kCalibrationSlots = 8;  ///< of PX4, and some to spare: it has four

std::string family_of(const std::string& source) { return source.substr(0, source.find('[')); }

/// What an autopilot chose among its chips, or made of them.
bool is_chosen(const logs::ImuSource& source) {
  const std::string family = family_of(source.name);
  return family == "sensor_combined" || family == "vehicle_acceleration";
}

bool same_chip(const logs::ImuSource& a, const logs::ImuSource& b) {
  if (a.device_id != 0 && b.device_id != 0) return a.device_id == b.device_id;
  return a.instance == b.instance && a.instance >= 0 && a.name.find('[') != std::string::npos &&
         b.name.find('[') != std::string::npos;
}

/// The message by which the chips are compared: that of most records, since chips must be compared by the same one.
std::string family_to_judge(const LogDigest& digest, const std::vector<std::size_t>& among) {
  std::map<std::string, std::uint64_t> records;
  for (const std::size_t k : among) records[family_of(digest.sources[k].source.name)] += digest.sources[k].records;
  const auto most = std::max_element(records.begin(), records.end(),
                                     [](const auto& a, const auto& b) { return a.second < b.second; });
  return most == records.end() ? "" : most->first;
}

double parameter(const LogDigest& digest, const std::string& name, double otherwise) {
  const auto found = digest.parameters.find(name);
  return found == digest.parameters.end() ? otherwise : found->second;
}

/// PX4: the slot whose id is the device's.
InstalledCalibration px4_calibration(const LogDigest& digest, std::uint64_t device) {
  InstalledCalibration out;
  for (int slot = 0; slot < kCalibrationSlots; ++slot) {
    const std::string prefix = "CAL_ACC" + std::to_string(slot) + "_";
    const double id = parameter(digest, prefix + "ID", 0.0);
    if (device == 0 || std::abs(id - static_cast<double>(device)) > 0.5) continue;
    out.present = true;
    out.more = parameter(digest, prefix + "ROT", -1.0) > 0.5 || parameter(digest, "TC_A_ENABLE", 0.0) > 0.5;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::string axis(1, static_cast<char>('X' + k));
      out.offset_mps2[k] = parameter(digest, prefix + axis + "OFF", 0.0);
      out.scale[k] = parameter(digest, prefix + axis + "SCALE", 1.0);
    }
    return out;
  }
  return out;
}

/// ArduPilot: by instance; the first has no number in its name.
InstalledCalibration ardupilot_calibration(const LogDigest& digest, int instance) {
  InstalledCalibration out;
  const std::string number = instance == 0 ? "" : std::to_string(instance + 1);
  for (std::size_t k = 0; k < 3; ++k) {
    const std::string axis(1, static_cast<char>('X' + k));
    const auto offset = digest.parameters.find("INS_ACC" + number + "OFFS_" + axis);
    if (offset == digest.parameters.end()) return out;
    out.offset_mps2[k] = offset->second;
    out.scale[k] = parameter(digest, "INS_ACC" + number + "SCAL_" + axis, 1.0);
  }
  out.present = true;
  return out;
}

/// PX4 does not use a chip of priority 0 (CAL_ACCn_PRIO), nor ArduPilot one whose INS_USE is 0.
bool is_disabled(const LogDigest& digest, std::uint64_t device, int instance) {
  for (int slot = 0; slot < kCalibrationSlots; ++slot) {
    const std::string prefix = "CAL_ACC" + std::to_string(slot) + "_";
    const double id = parameter(digest, prefix + "ID", 0.0);
    if (device == 0 || std::abs(id - static_cast<double>(device)) > 0.5) continue;
    return std::abs(parameter(digest, prefix + "PRIO", -1.0)) < 0.5;
  }
  if (instance < 0) return false;
  const std::string use = "INS_USE" + (instance == 0 ? std::string() : std::to_string(instance + 1));
  return std::abs(parameter(digest, use, 1.0)) < 0.5;
}

/// One record far from all others has a wrong time: the extent is that of the rest.
bool is_stray(const std::vector<SourceBlock>& blocks, std::size_t k, std::size_t neighbour, double block_s) {
  const double apart_s = block_s * static_cast<double>(std::abs(blocks[k].index - blocks[neighbour].index));
  return blocks.size() > 2 && blocks[k].records == 1 && apart_s > kStray_s;
}

void widen(const SourceDigest& source, double block_s, ChipSummary& chip) {
  const std::vector<SourceBlock>& blocks = source.blocks;
  const bool first = is_stray(blocks, 0, 1, block_s);
  const bool last = is_stray(blocks, blocks.size() - 1, blocks.size() - 2, block_s);
  chip.stray = chip.stray || first || last;
  chip.from_s = std::fmin(chip.from_s, first ? block_s * static_cast<double>(blocks[1].index) : source.first_s);
  chip.to_s =
      std::fmax(chip.to_s, last ? block_s * static_cast<double>(blocks[blocks.size() - 2].index + 1) : source.last_s);
}

void set_extent(const LogDigest& digest, ChipSummary& chip) {
  for (const std::size_t k : chip.sources) {
    const SourceDigest& source = digest.sources[k];
    widen(source, digest.block_s, chip);
    std::array<std::uint64_t, 3> clipped{};
    for (const SourceBlock& block : source.blocks) {
      for (std::size_t axis = 0; axis < 3; ++axis) clipped[axis] += block.clipped[axis];
      if (block.temperatures == 0) continue;
      chip.coldest_degc = std::fmin(chip.coldest_degc, block.temperature_degc);
      chip.warmest_degc = std::fmax(chip.warmest_degc, block.temperature_degc);
    }
    // Several messages, and several axes, count the same clips.
    chip.clipped = std::max({chip.clipped, clipped[0], clipped[1], clipped[2]});
  }
  chip.rate_hz = 1.0 / digest.sources[chip.judged].intervals.usual_s();
}

void set_calibration(const LogDigest& digest, ChipSummary& chip) {
  const SourceDigest& judged = digest.sources[chip.judged];
  chip.calibration = px4_calibration(digest, chip.device_id);
  if (!chip.calibration.present && judged.source.instance >= 0)
    chip.calibration = ardupilot_calibration(digest, judged.source.instance);
  chip.calibration.applied_here = chip.calibration.present && judged.source.uncalibrated;
  chip.calibration.more = chip.calibration.more && judged.source.uncalibrated;
}

}  // namespace

std::vector<ChipSummary> chips_of(const LogDigest& digest) {
  std::vector<std::size_t> own;
  std::vector<std::size_t> chosen;
  for (std::size_t k = 0; k < digest.sources.size(); ++k) {
    if (digest.sources[k].records > 0) (is_chosen(digest.sources[k].source) ? chosen : own).push_back(k);
  }
  const std::vector<std::size_t>& used = own.empty() ? chosen : own;
  const std::string family = family_to_judge(digest, used);
  std::vector<ChipSummary> chips;
  for (const std::size_t k : used) {
    const logs::ImuSource& source = digest.sources[k].source;
    const auto found = std::find_if(chips.begin(), chips.end(), [&](const ChipSummary& chip) {
      return same_chip(digest.sources[chip.sources.front()].source, source);
    });
    ChipSummary& chip = found == chips.end() ? chips.emplace_back() : *found;
    if (chip.device_id == 0) chip.device_id = source.device_id;
    chip.sources.push_back(k);
    const bool first = chip.sources.size() == 1;
    const bool better =
        family_of(source.name) == family && family_of(digest.sources[chip.judged].source.name) != family;
    if (first || better) chip.judged = k;
  }
  if (chips.size() > kMostChips) {
    std::stable_sort(chips.begin(), chips.end(), [&](const ChipSummary& a, const ChipSummary& b) {
      return digest.sources[a.judged].records > digest.sources[b.judged].records;
    });
    chips.resize(kMostChips);
  }
  std::sort(chips.begin(), chips.end(), [&](const ChipSummary& a, const ChipSummary& b) {
    return digest.sources[a.judged].source.instance < digest.sources[b.judged].source.instance;
  });
  for (ChipSummary& chip : chips) {
    chip.name = digest.sources[chip.judged].source.name;
    set_extent(digest, chip);
    set_calibration(digest, chip);
    chip.disabled = is_disabled(digest, chip.device_id, digest.sources[chip.judged].source.instance);
  }
  return chips;
}

SourceBlock block_of(const SourceDigest& source, std::int64_t from, std::int64_t to) {
  SourceBlock out;
  out.index = from;
  auto place = std::lower_bound(source.blocks.begin(), source.blocks.end(), from,
                                [](const SourceBlock& b, std::int64_t index) { return b.index < index; });
  for (; place != source.blocks.end() && place->index < to; ++place) out.add(*place);
  return out;
}

SourceBlock reading_of(const LogDigest& digest, const ChipSummary& chip, std::int64_t from, std::int64_t to) {
  SourceBlock out = block_of(digest.sources[chip.judged], from, to);
  if (!chip.calibration.applied_here) return out;
  for (std::size_t k = 0; k < 3; ++k) {
    const double scale = chip.calibration.scale[k];
    out.mean_mps2[k] = (out.mean_mps2[k] - chip.calibration.offset_mps2[k]) * scale;
    out.squares_m2ps4[k] *= scale * scale;
  }
  return out;
}

double length_of(const Axes& v) noexcept { return norm(v); }

Axes difference(const Axes& a, const Axes& b) noexcept { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }

double angle_deg(const Axes& a, const Axes& b) noexcept {
  const Axes cross = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
  return std::atan2(length_of(cross), a[0] * b[0] + a[1] * b[1] + a[2] * b[2]) * (180.0 / kPi);
}

}  // namespace review
}  // namespace PLUMB_ABI
}  // namespace plumb

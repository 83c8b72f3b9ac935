#include "chips.hpp"

#include <algorithm>
#include <cmath>

#include "plumb/core/units.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace review {
namespace {

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
  for (int slot = 0; slot < 8; ++slot) {
    const std::string prefix = "CAL_ACC" + std::to_string(slot) + "_";
    const double id = parameter(digest, prefix + "ID", 0.0);
    if (device == 0 || std::abs(id - static_cast<double>(device)) > 0.5) continue;
    out.present = true;
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

void set_extent(const LogDigest& digest, ChipSummary& chip) {
  for (const std::size_t k : chip.sources) {
    const SourceDigest& source = digest.sources[k];
    chip.from_s = std::fmin(chip.from_s, source.first_s);
    chip.to_s = std::fmax(chip.to_s, source.last_s);
    std::uint64_t clipped = 0;
    for (const SourceBlock& block : source.blocks) {
      clipped += block.clipped[0] + block.clipped[1] + block.clipped[2];
      if (block.temperatures == 0) continue;
      chip.coldest_degc = std::fmin(chip.coldest_degc, block.temperature_degc);
      chip.warmest_degc = std::fmax(chip.warmest_degc, block.temperature_degc);
    }
    chip.clipped = std::max(chip.clipped, clipped);  // several messages count the same clips
  }
  chip.rate_hz = 1.0 / digest.sources[chip.judged].intervals.usual_s();
}

void set_calibration(const LogDigest& digest, ChipSummary& chip) {
  const SourceDigest& judged = digest.sources[chip.judged];
  chip.calibration = px4_calibration(digest, chip.device_id);
  if (!chip.calibration.present && judged.source.instance >= 0)
    chip.calibration = ardupilot_calibration(digest, judged.source.instance);
  chip.calibration.applied_here = chip.calibration.present && judged.source.uncalibrated;
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
  std::sort(chips.begin(), chips.end(), [&](const ChipSummary& a, const ChipSummary& b) {
    return digest.sources[a.judged].source.instance < digest.sources[b.judged].source.instance;
  });
  for (ChipSummary& chip : chips) {
    chip.name = digest.sources[chip.judged].source.name;
    set_extent(digest, chip);
    set_calibration(digest, chip);
  }
  return chips;
}

SourceBlock reading_of(const LogDigest& digest, const ChipSummary& chip, std::int64_t from, std::int64_t to) {
  const std::vector<SourceBlock>& blocks = digest.sources[chip.judged].blocks;
  SourceBlock out;
  out.index = from;
  auto place = std::lower_bound(blocks.begin(), blocks.end(), from,
                                [](const SourceBlock& b, std::int64_t index) { return b.index < index; });
  for (; place != blocks.end() && place->index < to; ++place) out.add(*place);
  if (!chip.calibration.applied_here) return out;
  for (std::size_t k = 0; k < 3; ++k) {
    const double scale = chip.calibration.scale[k];
    out.mean_mps2[k] = (out.mean_mps2[k] - chip.calibration.offset_mps2[k]) * scale;
    out.squares_m2ps4[k] *= scale * scale;
  }
  return out;
}

double length_of(const Axes& v) noexcept { return std::hypot(v[0], v[1], v[2]); }

Axes difference(const Axes& a, const Axes& b) noexcept { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }

double angle_deg(const Axes& a, const Axes& b) noexcept {
  const Axes cross = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
  return std::atan2(length_of(cross), a[0] * b[0] + a[1] * b[1] + a[2] * b[2]) * (180.0 / kPi);
}

}  // namespace review
}  // namespace PLUMB_ABI
}  // namespace plumb

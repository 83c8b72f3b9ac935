#include "renamed_keys.hpp"

#include <array>

#include "plumb/io/file_error.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {
namespace {

constexpr std::array<RenamedKey, 13> kKeys = {{{"monitor", "patience", "isolation_timeout"},
                                               {"monitor", "patience_blocks", "isolation_timeout_blocks"},
                                               {"monitor", "excitation_angle", "distinct_attitude_angle"},
                                               {"monitor", "clean_blocks", "passed_blocks"},
                                               {"monitor", "asserted_faults", "assumed_faults"},
                                               {"monitor", "drift_bias", ""},
                                               {"monitor", "drift_scale", ""},
                                               {"monitor", "common_drift", ""},
                                               {"depth", "stand", "station_spacing"},
                                               {"run", "trust_stations", "validation_stations"},
                                               {"expect", "wrong_set_aside", "wrong_provisional_exclusion"},
                                               {"roll", "lone", "single_station_groups"},
                                               {"roll", "wobble_rad", "axis_deviation_rad"}}};

constexpr std::array<RenamedWord, 1> kWords = {{{"run", "start", "proven", "validated"}}};

/// "array.monitor" -> "monitor", "sensor[2]" -> "sensor".
std::string_view section_of(std::string_view path) noexcept {
  const std::size_t dot = path.rfind('.');
  if (dot != std::string_view::npos) path.remove_prefix(dot + 1);
  return path.substr(0, path.find('['));
}

}  // namespace

const RenamedKey* renamed_key(std::string_view path, std::string_view key) noexcept {
  for (const RenamedKey& one : kKeys) {
    if (key == one.old_key && section_of(path) == one.section) return &one;
  }
  return nullptr;
}

const RenamedWord* renamed_word(std::string_view path, std::string_view key, std::string_view word) noexcept {
  for (const RenamedWord& one : kWords) {
    if (word == one.old_word && key == one.key && section_of(path) == one.section) return &one;
  }
  return nullptr;
}

std::string what_of(const RenamedKey& key) {
  if (key.new_key[0] == '\0')
    return "is no longer a key: `stability` now states the drift for limits, protection level and recalibration";
  return std::string("is not a known key: renamed \"") + key.new_key + "\"";
}

std::string remedy_of(const RenamedKey& key, const std::string& file) {
  if (key.new_key[0] != '\0') return upgrade_remedy(file);
  return "write stability = \"0.2 mg\" instead: the error of a reading since the calibration, 1 sigma, from bias and "
         "scale together";
}

std::string upgrade_remedy(const std::string& file) {
  return "run `plumb upgrade " + shell_word(file) + " --in-place`";
}

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb

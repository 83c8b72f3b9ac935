#include "plumb/render/sensor_notes.hpp"

#include <fmt/format.h>

#include "plumb/render/field_words.hpp"

#include <cmath>

#include "plumb/render/figures.hpp"
#include "plumb/render/words.hpp"
#include "plumb/scenario/count_text.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {
namespace {

std::string name_of(const SensorArray& sensors, int i) { return sensors.row(i).id.data(); }

stepping::SensorCounts counts_of(const session::MonitorRun& run, int i) {
  return at(i) < run.counts.sensor.size() ? run.counts.sensor[at(i)] : stepping::SensorCounts{};
}

/// Of one sample, in the blocks in which it scattered by itself, by the scale of the array file; 0: not measured.
double measured_noise_mps2(const session::MonitorRun& run, const io::ArrayFile& array, int i) {
  const stepping::SensorCounts counts = counts_of(run, i);
  const double scale = std::fabs(array.datasheet.sensor[at(i)].coefficients.scale[0]);
  if (counts.scattering_blocks == 0 || !(scale > 0.0)) return 0.0;
  return std::sqrt(counts.scatter_raw_sq / static_cast<double>(counts.scattering_blocks)) / scale;
}

bool is_noisy(const session::MonitorRun& run, int i) {
  return counts_of(run, i).named_noisy || run.last.noisy.has(i) || run.last.sensor_cause[at(i)] == Cause::noisy;
}

SensorNote noise_note_of(const session::MonitorRun& run, const io::ArrayFile& array, const SensorArray& sensors,
                         int i) {
  const std::string id = name_of(sensors, i);
  const double shown = measured_noise_mps2(run, array, i), declared = sensors.sigma_mps2(i);
  const std::string check = "check cable, connector and supply of " + id +
                            ", and whether it is mounted firmly: vibration that only " + id + " feels looks the same";
  if (!(shown > declared)) return {"noisy", id + " scattered by itself while the others were at rest", check};
  return {"noisy",
          fmt::format("{} scatters by {:.3g} mg0, {:.3g} times the {:.3g} mg0 declared, in {} while the others "
                      "are at rest",
                      id, in_fine(array, shown), shown / declared, in_fine(array, declared),
                      count_text(counts_of(run, i).scattering_blocks, "block")),
          fmt::format("{}; if {} is sound and always scatters like this, state noise = \"{:.3g} mg0\" for it in {}; {}",
                      check, id, in_fine(array, shown), array.path, measure_noise_words(array))};
}

/// Most sensors scatter and a few do not: that is no noise of each of them.
SensorNote stillness_note_of(SensorSet noisy, const SensorArray& sensors) {
  std::string those, others;
  for (int i = 0; i < sensors.size(); ++i) {
    std::string& names = noisy.has(i) ? those : others;
    names += (names.empty() ? "" : ", ") + name_of(sensors, i);
  }
  return {"scatter",
          fmt::format("{} of {} sensors ({}) scatter while {} do not: the tool moved, and these read the same whatever "
                      "happens, or most sensors are noisy",
                      noisy.size(), sensors.size(), those, others),
          "check " + others + " first: a dead or stuck chip looks as if the tool were at rest"};
}

/// "z1 (imu1), z3 (imu3)": with the chip where it is stated.
std::string names_with_chips(SensorSet set, const io::ArrayFile& array, const SensorArray& sensors) {
  std::string out;
  for (int i = 0; i < sensors.size(); ++i) {
    if (!set.has(i)) continue;
    const std::string package = io::package_of(array, i);
    out += (out.empty() ? "" : ", ") + name_of(sensors, i) + (package.empty() ? "" : " (" + package + ")");
  }
  return out;
}

SensorNote common_note_of(const findings::CommonCause& found, const io::ArrayFile& array, const SensorArray& sensors) {
  const std::string others = names_with_chips(found.others, array, sensors);
  const std::string causes = "one cause (temperature, supply voltage, a bent mount)";
  const std::string check =
      "look for that cause before you believe in several faults; compare with a known attitude, or calibrate again";
  if (found.sign == findings::CommonSign::length) {
    return {"common",
            fmt::format("the length of gravity is off along the one direction of {}: {} that moved them alike explains "
                        "it, and parity cannot see it",
                        others, causes),
            check};
  }
  const std::string moved = names_with_chips(found.moved, array, sensors);
  const bool chips = sensors.units().grouped();
  if (found.sign == findings::CommonSign::remaining) {
    return {
        "common",
        fmt::format("{} {} excluded, and without {} the length of gravity is still off: {} that moved {} as well "
                    "explains that, and a fault of one {} does not",
                    moved, chips ? "were" : "was", chips ? "them" : "it", causes, others, chips ? "chip" : "sensor"),
        check};
  }
  return {"common",
          fmt::format("{} were excluded and {}: {} explains that as well as several faults{}", moved,
                      chips ? "their axes lie alike" : "lie along one direction", causes,
                      others.empty() ? "" : ", and may have moved " + others + " too"),
          check};
}

SensorNote full_scale_note_of(const session::MonitorRun& run, const SensorArray& sensors, int i) {
  const stepping::SensorCounts counts = counts_of(run, i);
  return {"full scale",
          fmt::format("{} was at full scale in {} in motion and {} at rest", name_of(sensors, i),
                      count_text(counts.full_scale_in_motion, "row"), count_text(counts.full_scale_at_rest, "row")),
          counts.full_scale_at_rest > 0
              ? "at rest gravity is within the range of a sound sensor: check `full_scale`, `scale` and the channel"
              : "shock or vibration exceeds the range: damp the mount or use a wider range; the rows in motion are in "
                "no direction"};
}

}  // namespace

std::optional<findings::CommonCause> common_cause_of(const session::MonitorRun& run, const io::ArrayFile& array) {
  findings::CommonEvidence evidence;
  for (int i = 0; i < array.array.size(); ++i) {
    if (counts_of(run, i).excluded_by_reading) evidence.excluded = evidence.excluded.with(i);
  }
  evidence.length_off_after_exclusion = run.counts.length_off_after_exclusion;
  return findings::common_cause(array.array, array.output_frame, evidence, run.last);
}

std::vector<SensorNote> sensor_notes(const session::MonitorRun& run, const io::ArrayFile& array,
                                     const SensorArray& sensors) {
  std::vector<SensorNote> out;
  if (const auto found = common_cause_of(run, array); found) out.push_back(common_note_of(*found, array, sensors));
  SensorSet noisy;
  for (int i = 0; i < sensors.size(); ++i) noisy = is_noisy(run, i) ? noisy.with(i) : noisy;
  const bool most = 2 * noisy.size() > sensors.size() && noisy.size() < sensors.size();
  if (most) out.push_back(stillness_note_of(noisy, sensors));
  for (int i = 0; i < sensors.size() && !most; ++i) {
    if (noisy.has(i)) out.push_back(noise_note_of(run, array, sensors, i));
  }
  for (int i = 0; i < sensors.size(); ++i) {
    const stepping::SensorCounts counts = counts_of(run, i);
    if (counts.full_scale_in_motion + counts.full_scale_at_rest > 0) out.push_back(full_scale_note_of(run, sensors, i));
  }
  std::string drifts;
  int drifting = 0;
  for (int i = 0; i < sensors.size(); ++i) {
    const double rate = static_cast<double>(run.last.drift_mps2_per_h[at(i)]);
    if (rate == 0.0) continue;
    drifts += fmt::format("{}{} {:+.3g} m/s^2/h ({:+.3g} mg0/h)", drifting++ == 0 ? "" : ", ", name_of(sensors, i),
                          io::units_of(array.field).coarse_per_inside * rate, in_fine(array, rate));
  }
  if (drifting > 0)
    out.push_back(
        {"drift rate",
         drifts + (drifting > 1 ? "; each as if it alone drifted: one of them explains all" : "") +
             "; positive: its reading grows; 1 sigma at most a sixth of it",
         "calibrate again before it reaches the limits, and state `stability` as large as the drift in " + array.path});
  return out;
}

std::string notes_text(const session::MonitorRun& run, const io::ArrayFile& array, const SensorArray& sensors) {
  const std::string motion = motion_words(run);
  std::string out = motion.empty() ? "" : "motion      blocks in motion: " + motion + "\n";
  bool drifts = false;
  for (const SensorNote& note : sensor_notes(run, array, sensors)) {
    out += fmt::format("{:<12}{}. Remedy: {}\n", note.label, note.text, note.remedy);
    drifts = drifts || note.label == "drift rate";
  }
  if (run.counts.known && !drifts) out += "drift rate  none found\n";
  return out;
}

std::vector<std::string> note_actions(const session::MonitorRun& run, const io::ArrayFile& array,
                                      const SensorArray& sensors) {
  std::vector<std::string> out;
  for (const SensorNote& note : sensor_notes(run, array, sensors))
    out.push_back(fmt::format("{}{}: {}.", note.label == "drift rate" ? "Drift rate " : "", note.text, note.remedy));
  return out;
}

std::string motion_words(const session::MonitorRun& run) {
  if (!run.counts.known) return "";
  const std::uint64_t moving = run.counts.blocks_in_motion, all = moving + run.blocks;
  return all == 0 ? "0 of 0" : fmt::format("{} of {} ({:.0f} %)", moving, all, 1e2 * motion_share(run).get<double>());
}

io::Json common_cause_json(const session::MonitorRun& run, const io::ArrayFile& array, const SensorArray& sensors) {
  const std::optional<findings::CommonCause> found = common_cause_of(run, array);
  if (!found) return {};
  const SensorNote note = common_note_of(*found, array, sensors);
  return io::object({{"sign", to_string(found->sign)},
                     {"excluded", io::ids_of(found->moved, sensors)},
                     {"others", io::ids_of(found->others, sensors)},
                     {"text", note.text},
                     {"remedy", note.remedy}});
}

io::Json motion_share(const session::MonitorRun& run) {
  if (!run.counts.known) return {};
  const std::uint64_t moving = run.counts.blocks_in_motion, all = moving + run.blocks;
  return all == 0 ? 0.0 : static_cast<double>(moving) / static_cast<double>(all);
}

void put_sensor_counts(io::Json& out, const session::MonitorRun& run, const io::ArrayFile& array,
                       const SensorArray& sensors, int i) {
  const stepping::SensorCounts counts = counts_of(run, i);
  const bool known = run.counts.known;
  const double noise = measured_noise_mps2(run, array, i);
  out["noisy"] = is_noisy(run, i);
  out["noise_declared_mps2"] = sensors.sigma_mps2(i);
  out["noise_measured_mps2"] = noise > 0.0 ? io::Json(noise) : io::Json();
  out["rows_full_scale_in_motion"] = known ? io::Json(counts.full_scale_in_motion) : io::Json();
  out["rows_full_scale_at_rest"] = known ? io::Json(counts.full_scale_at_rest) : io::Json();
  out["drift_mps2_per_h"] = static_cast<double>(run.last.drift_mps2_per_h[at(i)]);
}

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb

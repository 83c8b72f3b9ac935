#include "review_words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "plumb/core/units.hpp"
#include "plumb/core/vec3.hpp"
#include "plumb/io/printable.hpp"
#include "plumb/scenario/count_text.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {
namespace {

using review::Finding;
using review::FindingCode;
using review::kNoChip;
using review::LogReview;
using review::OpenQuestion;

std::string axis_word(int axis) { return axis < 0 ? "" : std::string(1, static_cast<char>('x' + axis)); }

double milli_g0(double mps2) { return 1000.0 * g0_from_mps2(mps2); }

std::string percent(double share) { return fmt::format("{:.3g} %", 100.0 * share); }

std::string both(const Finding& f, const LogReview& in) {
  return chip_name(in, f.chip) + " and " + chip_name(in, f.other);
}

ReviewSentence of_length(const Finding& f, const LogReview& in) {
  return {fmt::format("{} reads gravity {:.0f} mg0 too {} at rest ({:.2f} m/s^2, +-{:.2f}; limit {:.2f})",
                      chip_name(in, f.chip), std::abs(milli_g0(f.figure)), f.figure > 0.0 ? "long" : "short",
                      std::abs(f.figure), f.uncertainty, f.limit),
          "", "calibrate this accelerometer at rest in six attitudes; if the error stays or comes back, replace it"};
}

ReviewSentence of_disagreement(const Finding& f, const LogReview& in) {
  const bool motion = f.code == FindingCode::motion_disagreement;
  const std::string when = motion ? "in motion" : "at rest";
  const std::string figures = fmt::format("{:.2f} m/s^2 ({:.0f} mg0, +-{:.2f} for noise{}; limit {:.2f})", f.figure,
                                          milli_g0(f.figure), f.uncertainty, motion ? " and lever arms" : "", f.limit);
  if (f.other != kNoChip) {
    if (f.likely != kNoChip) {
      return {fmt::format("{} differ by {} {}: likely the fault is that of {}, which other findings name", both(f, in),
                          figures, when, chip_name(in, f.likely)),
              "", "calibrate this accelerometer; if it differs again, take it out of use"};
    }
    const bool two = in.chips.size() == 2;
    return {
        fmt::format("{} differ by {} {}: which one is wrong cannot be told from this log", both(f, in), figures, when),
        "",
        two ? "hold the vehicle still in six attitudes and review that log: the lengths of gravity tell; or calibrate "
              "both"
            : "calibrate all accelerometers, then fly again"};
  }
  const std::string why =
      f.told_by_length ? "its length of gravity is wrong, that of the other one is right" : "the others agree";
  return {fmt::format("{} differs by {} {}, and {}", chip_name(in, f.chip), figures, when, why), "",
          "calibrate this accelerometer; if it differs again, take it out of use"};
}

ReviewSentence of_stillness(const Finding& f, const LogReview& in) {
  const std::string subject = f.axis < 0 ? chip_name(in, f.chip) : axis_word(f.axis) + " of " + chip_name(in, f.chip);
  const std::string moved =
      f.grade == review::Grade::red ? " while other axes moved" : " (others changed or were noisy)";
  return {fmt::format("{} stands still at {:.3f} m/s^2 for {}{}", subject, f.figure,
                      count_text(static_cast<std::uint64_t>(f.limit), "record"), moved),
          "", "check the wiring and the driver; replace the chip where it happens again"};
}

ReviewSentence of_scatter(const Finding& f, const LogReview& in) {
  if (f.code == FindingCode::vibration) {
    return {fmt::format("{} vibrates with {:.0f} m/s^2 along {} (standard deviation within a second; limit {:.0f})",
                        chip_name(in, f.chip), f.figure, axis_word(f.axis), f.limit),
            "", "balance propellers and motors, mount the controller softly; accelerometers err under vibration"};
  }
  return {fmt::format("{} scatters by {:.2f} m/s^2 along {} at rest (limit {:.2f})", chip_name(in, f.chip), f.figure,
                      axis_word(f.axis), f.limit),
          "", "look for vibration at rest (fan, running motor) and for a loose board; else replace the chip"};
}

ReviewSentence of_times(const Finding& f, const LogReview& in) {
  if (f.code == FindingCode::backwards) {
    return {fmt::format("the time of {} goes back {}", chip_name(in, f.chip),
                        count_text(static_cast<std::uint64_t>(f.figure), "time")),
            "", "treat delays and rates of this log with care; update the firmware"};
  }
  if (f.code == FindingCode::late) {
    return {fmt::format("{} begins {:.1f} s later than the others", chip_name(in, f.chip), f.figure), "",
            "look for the reason in the messages of the autopilot: a driver that starts late or again"};
  }
  if (f.code == FindingCode::stray) {
    return {fmt::format(
                "the first or last record of {} has a time more than 60 s from all others; it is left out of the times",
                chip_name(in, f.chip)),
            "", "treat delays and rates of this log with care; update the firmware"};
  }
  if (f.code == FindingCode::skew) {
    const std::size_t late = f.figure > 0.0 ? f.other : f.chip;
    const std::size_t early = f.figure > 0.0 ? f.chip : f.other;
    return {fmt::format("{} shows motion {:.1f} ms later than {} (+-{:.1f}; limit {:.0f} ms)", chip_name(in, late),
                        1000.0 * std::abs(f.figure), chip_name(in, early), 1000.0 * f.uncertainty, 1000.0 * f.limit),
            "", "compare filters and time stamps of both drivers; state the delay to whatever fuses them"};
  }
  if (f.code == FindingCode::stopped) {
    return {fmt::format("{} says nothing for the last {:.1f} s while the log goes on", chip_name(in, f.chip), f.figure),
            "", "the chip or its bus failed in flight: check connectors and power, replace it before the next flight"};
  }
  return {fmt::format("{} lacks {:.1f} s of records in {}; the longest gap is {:.2f} s", chip_name(in, f.chip),
                      f.figure, count_text(f.times, "gap"), f.to_s - f.from_s),
          "", "use a faster card or log less; a bus error shows as gaps of one chip alone"};
}

ReviewSentence of_calibration(const Finding& f, const LogReview& in) {
  if (f.code == FindingCode::disabled) {
    return {fmt::format("{} is switched off in the autopilot's parameters: it is logged and judged, not flown by",
                        chip_name(in, f.chip)),
            "", "nothing, where that is meant; else set CAL_ACCn_PRIO (PX4) or INS_USEn (ArduPilot) again"};
  }
  if (f.code == FindingCode::uncalibrated) {
    return {fmt::format("{} has no calibration in the autopilot's parameters", chip_name(in, f.chip)), "",
            "calibrate the accelerometers of this vehicle"};
  }
  const bool offset = f.code == FindingCode::far_offset;
  return {fmt::format("the installed calibration of {} has {} of {} (limit {})", chip_name(in, f.chip),
                      offset ? "an offset" : "a scale that differs from 1 by",
                      offset ? fmt::format("{:.2f} m/s^2", f.figure) : percent(f.figure),
                      offset ? fmt::format("{:.0f} m/s^2", f.limit) : percent(f.limit)),
          "", "calibrate again; a chip that needs such a correction is damaged or was moved while it was calibrated"};
}

ReviewSentence worded(const Finding& f, const LogReview& in) {
  switch (f.code) {
    case FindingCode::gravity_length: return of_length(f, in);
    case FindingCode::disagreement:
    case FindingCode::motion_disagreement: return of_disagreement(f, in);
    case FindingCode::common_length:
      return {fmt::format("all accelerometers read the same length at rest, {:.2f} m/s^2 {} gravity (limit {:.2f})",
                          std::abs(f.figure), f.figure > 0.0 ? "above" : "below", f.limit),
              "", "nothing speaks against the sensors: the vehicle accelerated or turned steadily, or state --gravity"};
    case FindingCode::orientation:
      return {
          fmt::format("{} and another chip read gravity in directions that are {:.0f} deg apart, with equal lengths",
                      f.other == kNoChip ? chip_name(in, f.chip) : both(f, in), f.figure),
          "", "state how each chip is mounted; where it should be aligned, check its mounting"};
    case FindingCode::axis_stuck:
    case FindingCode::chip_frozen: return of_stillness(f, in);
    case FindingCode::clipping:
      return {fmt::format("{} clipped {} (limit {:.0f})", chip_name(in, f.chip),
                          count_text(static_cast<std::uint64_t>(f.figure), "reading"), f.limit),
              "", "reduce vibration and shocks, or choose a wider range: a clipped reading is wrong"};
    case FindingCode::vibration:
    case FindingCode::noise: return of_scatter(f, in);
    case FindingCode::drift:
      return {fmt::format("{} wanders by {:.2f} m/s^2 at rest (+-{:.2f}; limit {:.2f})", chip_name(in, f.chip),
                          f.figure, f.uncertainty, f.limit),
              "", "let it warm up before the flight, or calibrate it over temperature"};
    case FindingCode::changed:
      return {fmt::format("{} reads {:.2f} m/s^2 otherwise than before, at rest in the same attitude (+-{:.2f}; limit "
                          "{:.2f}): it changed in between",
                          chip_name(in, f.chip), f.figure, f.uncertainty, f.limit),
              "",
              "look for a shock or a step of temperature in between; calibrate, and replace it if it changes again"};
    case FindingCode::gaps:
    case FindingCode::backwards:
    case FindingCode::skew:
    case FindingCode::late:
    case FindingCode::stray:
    case FindingCode::stopped: return of_times(f, in);
    case FindingCode::uncalibrated:
    case FindingCode::disabled:
    case FindingCode::far_offset:
    case FindingCode::far_scale: return of_calibration(f, in);
    case FindingCode::autopilot_failed:
      return {fmt::format("the autopilot took {} for failed in {} in a row", chip_name(in, f.chip),
                          count_text(static_cast<std::uint64_t>(f.figure), "report")),
              "",
              "read the autopilot's messages of that time (timeouts, bus errors); replace the chip if it fails again"};
    case FindingCode::autopilot_apart:
      return {fmt::format("by the autopilot's own comparison at rest {} is {:.2f} m/s^2 apart from the mean of all "
                          "(limit {:.2f})",
                          chip_name(in, f.chip), f.figure, f.limit),
              "", "calibrate all accelerometers, then compare again"};
    case FindingCode::damage: break;
  }
  return {fmt::format("the last {:.0f} of {:.0f} bytes could not be read", f.figure, f.limit), "",
          "copy the log again; if it ends like this on the card, power was lost while it was written"};
}

}  // namespace

std::string place_words(double from_s, double to_s) {
  if (!std::isfinite(from_s)) return "";
  if (!(to_s > from_s)) return fmt::format("at {:.1f} s", from_s);
  return fmt::format("{:.1f} to {:.1f} s", from_s, to_s);
}

ReviewSentence sentence_of(const Finding& finding, const LogReview& in) {
  ReviewSentence out = worded(finding, in);
  out.where = place_words(finding.from_s, finding.to_s);
  const bool counted = finding.code == FindingCode::motion_disagreement;
  if (counted && finding.times > 1) out.where += fmt::format(", the longest of {}", finding.times);
  return out;
}

std::string code_word(FindingCode code) {
  switch (code) {
    case FindingCode::gravity_length: return "gravity_length";
    case FindingCode::disagreement: return "disagreement";
    case FindingCode::motion_disagreement: return "motion_disagreement";
    case FindingCode::orientation: return "orientation";
    case FindingCode::axis_stuck: return "axis_stuck";
    case FindingCode::chip_frozen: return "chip_frozen";
    case FindingCode::clipping: return "clipping";
    case FindingCode::vibration: return "vibration";
    case FindingCode::noise: return "noise";
    case FindingCode::drift: return "drift";
    case FindingCode::changed: return "changed";
    case FindingCode::gaps: return "gaps";
    case FindingCode::backwards: return "backwards";
    case FindingCode::skew: return "skew";
    case FindingCode::late: return "late";
    case FindingCode::stray: return "stray";
    case FindingCode::common_length: return "common_length";
    case FindingCode::stopped: return "stopped";
    case FindingCode::uncalibrated: return "uncalibrated";
    case FindingCode::disabled: return "disabled";
    case FindingCode::far_offset: return "far_offset";
    case FindingCode::far_scale: return "far_scale";
    case FindingCode::autopilot_failed: return "autopilot_failed";
    case FindingCode::autopilot_apart: return "autopilot_apart";
    case FindingCode::damage: break;
  }
  return "damage";
}

std::string sentence_of(OpenQuestion question) {
  switch (question) {
    case OpenQuestion::one_chip:
      return "one accelerometer: nothing to compare it with, its errors across gravity stay unseen";
    case OpenQuestion::two_chips:
      return "two accelerometers: a difference is seen, which one is wrong only where its length of gravity tells";
    case OpenQuestion::never_at_rest:
      return "never at rest for 3 s: lengths of gravity, noise and drift are not judged";
    case OpenQuestion::never_in_motion: return "always at rest: vibration and agreement in motion are not judged";
    case OpenQuestion::one_attitude:
      return "one attitude at rest: errors across gravity are seen only as differences between chips";
    case OpenQuestion::slow_log:
      return "fewer than 20 records a second: vibration is judged only where the log has variances or the autopilot's "
             "own measure";
    case OpenQuestion::not_compared:
      return "at least one accelerometer has too few readings, or too much scatter, to be compared with another one";
    case OpenQuestion::motion_unclear:
      return "in motion the accelerometers differ by more than the limit, within what scatter and turning allow: "
             "agreement "
             "in motion is not judged";
    case OpenQuestion::more_calibration:
      return "the autopilot also turns or corrects readings by temperature, which is not applied here: those "
             "accelerometers are not compared; log vehicle_imu";
    case OpenQuestion::no_calibration_in_log: break;
  }
  return "the log holds no calibration parameters: whether one is installed is not known";
}

std::string code_word(OpenQuestion question) {
  switch (question) {
    case OpenQuestion::one_chip: return "one_chip";
    case OpenQuestion::two_chips: return "two_chips";
    case OpenQuestion::never_at_rest: return "never_at_rest";
    case OpenQuestion::never_in_motion: return "never_in_motion";
    case OpenQuestion::one_attitude: return "one_attitude";
    case OpenQuestion::slow_log: return "slow_log";
    case OpenQuestion::not_compared: return "not_compared";
    case OpenQuestion::motion_unclear: return "motion_unclear";
    case OpenQuestion::more_calibration: return "more_calibration";
    case OpenQuestion::no_calibration_in_log: break;
  }
  return "no_calibration_in_log";
}

const char* grade_word(review::Grade grade) noexcept {
  if (grade == review::Grade::red) return "RED";
  return grade == review::Grade::orange ? "ORANGE" : "GREEN";
}

namespace {

/// Nothing but information was found.
std::string answer_where_green(const LogReview& in) {
  if (!in.judged) return "Nothing was judged: never at rest, and no two accelerometers to compare.";
  const auto compared = static_cast<std::size_t>(
      std::count_if(in.chips.begin(), in.chips.end(), [](const review::ChipSummary& chip) { return chip.compared; }));
  if (in.chips.size() == 1) return "The accelerometer reads gravity at rest.";
  const bool all = compared == in.chips.size();
  const std::string subject =
      all ? fmt::format("All {} accelerometers", compared)
          : fmt::format("{} of {} accelerometers could be compared, and they", compared, in.chips.size());
  if (compared < 2)
    return fmt::format("{} accelerometers, none of which could be compared with another one.", in.chips.size());
  const bool unclear = std::find(in.open.begin(), in.open.end(), OpenQuestion::motion_unclear) != in.open.end();
  if (in.stretches.empty()) return subject + " agree in motion; none was seen at rest.";
  return subject + (unclear ? " agree at rest; in motion that is not judged." : " read gravity at rest and agree.");
}

}  // namespace

std::string answer_of(const LogReview& in) {
  if (in.chips.empty()) return "No accelerometer in this log: nothing was judged.";
  const auto wrong = static_cast<std::size_t>(std::count_if(
      in.findings.begin(), in.findings.end(), [](const Finding& f) { return f.grade != review::Grade::green; }));
  if (wrong > 0) {
    const ReviewSentence worst = sentence_of(in.findings.front(), in);
    const std::size_t more = wrong - 1;
    return worst.what + (more == 0 ? "." : fmt::format("; and {}.", count_text(more, "more finding")));
  }
  const auto off = static_cast<std::size_t>(
      std::count_if(in.chips.begin(), in.chips.end(), [](const review::ChipSummary& chip) { return chip.disabled; }));
  return answer_where_green(in) + (off == 0 ? "" : fmt::format(" Switched off in the autopilot: {}.", off));
}

std::string chip_name(const LogReview& in, std::size_t chip) { return io::printable_line(in.chips.at(chip).name); }

std::string device_words(const review::ChipSummary& chip) {
  return chip.device_id == 0 ? "-" : std::to_string(chip.device_id);
}

std::string calibration_words(const review::ChipSummary& chip) {
  const review::InstalledCalibration& c = chip.calibration;
  const std::string off = chip.disabled ? "; switched off" : "";
  if (!c.present) return "none in this log" + off;
  double offset = 0.0;
  double scale = 0.0;
  for (std::size_t k = 0; k < 3; ++k) {
    offset = std::max(offset, std::abs(c.offset_mps2[k]));
    scale = std::max(scale, std::abs(c.scale[k] - 1.0));
  }
  return fmt::format("up to {:.2f} m/s^2, {}{}{}", offset, percent(scale), c.applied_here ? ", applied here" : "", off);
}

std::string temperature_words(const review::ChipSummary& chip) {
  if (!std::isfinite(chip.coldest_degc)) return "-";
  return fmt::format("{:.0f} to {:.0f}", chip.coldest_degc, chip.warmest_degc);
}

double off_gravity_mps2(const LogReview& in, std::size_t chip) {
  double sum = 0.0;
  double weight = 0.0;
  for (const review::Stretch& stretch : in.stretches) {
    const review::Axes& mean = stretch.mean_mps2[chip];
    if (!std::isfinite(mean[0])) continue;
    const double length_s = stretch.to_s - stretch.from_s;
    sum += length_s * (norm(mean) - in.gravity_mps2);
    weight += length_s;
  }
  return weight > 0.0 ? sum / weight : std::nan("");
}

std::vector<DeviceTrend> trends_of(const std::vector<LogReview>& logs) {
  std::vector<DeviceTrend> out;
  for (std::size_t log = 0; log < logs.size(); ++log) {
    for (std::size_t chip = 0; chip < logs[log].chips.size(); ++chip) {
      const review::ChipSummary& summary = logs[log].chips[chip];
      if (summary.device_id == 0) continue;
      auto found = std::find_if(out.begin(), out.end(),
                                [&](const DeviceTrend& one) { return one.device_id == summary.device_id; });
      if (found == out.end()) {
        found = out.insert(out.end(), DeviceTrend{});
        found->device_id = summary.device_id;
      }
      found->logs.push_back(log);
      found->off_gravity_mps2.push_back(off_gravity_mps2(logs[log], chip));
      found->warmest_degc.push_back(summary.warmest_degc);
    }
  }
  out.erase(std::remove_if(out.begin(), out.end(), [](const DeviceTrend& one) { return one.logs.size() < 2; }),
            out.end());
  return out;
}

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb

#include "plumb/review/log_import.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>

#include "plumb/core/config.hpp"
#include "plumb/core/units.hpp"
#include "plumb/io/printable.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace review {
namespace {

constexpr std::size_t kMostImported = static_cast<std::size_t>(kCapacity) / 3;
/// Scatter that is declared where the log was never at rest, and the least that is declared.
constexpr double kUnknownScatter_mps2 = 0.05;
constexpr double kLeastScatter_mps2 = 0.002;
constexpr double kMostScatter_mps2 = 0.5;
/// A block of the monitor is about this long, and has 32 rows where it can.
constexpr double kBlock_s = 2.0;
/// What an accelerometer is off by after an autopilot's calibration by hand, 1 sigma: bias, scale, axis.
constexpr const char* kCorrectedUncertainty = "0.05 m/s^2,0.5 %,0.5 deg";

std::string family_of(const std::string& source) { return source.substr(0, source.find('[')); }

/// PX4 and ArduPilot correct what they log, but for `ImuSource::uncalibrated`; what a robot or a table holds is
/// unknown.
bool is_of_autopilot(const logs::ImuSource& source) {
  static const std::set<std::string> families = {
      "sensor_accel", "vehicle_imu", "vehicle_imu_status", "sensor_combined", "vehicle_acceleration", "IMU", "ACC"};
  return families.count(family_of(source.name)) > 0;
}

io::FileError refused(std::string what, std::string remedy) {
  return {"", 0, "", std::move(what), std::move(remedy), io::ExitCode::invalid_input};
}

/// The source of the chip in that message; kNoChip where it has none.
std::size_t source_of(const LogDigest& digest, const ChipSummary& chip, const std::string& message) {
  if (message.empty()) return chip.judged;
  const auto found = std::find_if(chip.sources.begin(), chip.sources.end(), [&](std::size_t k) {
    return family_of(digest.sources[k].source.name) == message || digest.sources[k].source.name == message;
  });
  return found == chip.sources.end() ? kNoChip : *found;
}

std::string messages_of(const LogDigest& digest) {
  std::set<std::string> names;
  for (const SourceDigest& source : digest.sources) names.insert(io::printable_line(family_of(source.source.name)));
  std::string out;
  for (const std::string& name : names) out += (out.empty() ? "" : ", ") + name;
  return out;
}

/// Standard ranges of chips: the least that holds what was read with a tenth to spare, +-16 g0 at least.
double full_scale_g0(const LogDigest& digest, const std::vector<std::size_t>& sources) {
  double largest = 0.0;
  for (const std::size_t k : sources) {
    for (const SourceBlock& block : digest.sources[k].blocks) {
      for (std::size_t axis = 0; axis < 3; ++axis)
        largest = std::max({largest, std::abs(block.least_mps2[axis]), std::abs(block.most_mps2[axis])});
    }
  }
  double out = 16.0;
  while (mps2_from_g0(out) < 1.1 * largest && out < 1024.0) out *= 2.0;
  return out;
}

std::string head_of(const LogDigest& digest, const ImportPlan& plan, const ImportSettings& settings) {
  const double rate_hz = 1.0 / digest.sources[plan.sources[plan.reference]].intervals.usual_s();
  const double rows = std::isfinite(rate_hz) ? kBlock_s * rate_hz : 32.0;
  std::string out =
      "# Made by plumb import. Bounds are those of an autopilot's sensors: state yours where you know them.\n";
  out += "name = \"imported\"\n\n[gravity]\nmodel = \"value\"\n";
  if (settings.gravity_mps2) {
    out += fmt::format("value = \"{} m/s^2\"\n", *settings.gravity_mps2);
  } else {
    out +=
        "value = \"9.7985 m/s^2\"   # anywhere on the ground; state yours, or model = \"normal\" with latitude\n"
        "sigma = \"0.017 m/s^2\"\n";
  }
  out += "\n[input]\nreads = \"specific-force\"\nunit = \"m/s^2\"\ntime = \"t_s\"\n";
  if (plan.corrected)
    out += "corrected = true   # by the autopilot's own calibration: its parameters are not to be applied again\n";
  if (plan.temperature) out += "temperature = \"temperature_degc\"\n";
  if (plan.rates_from != kNoChip) out += "rotation_radps = [\"wx_radps\", \"wy_radps\", \"wz_radps\"]\n";
  const double longest_s = *std::max_element(plan.longest_gap_s.begin(), plan.longest_gap_s.end());
  out += fmt::format("\n[monitor]\nwindow = {:.0f}\nmax_gap = \"{:.3g} s\"\n", std::clamp(std::round(rows), 4.0, 32.0),
                     std::max(5.0, longest_s));
  out += fmt::format(
      "# The error of direction that you accept. A calibration by an autopilot leaves a bound of 5 to 7 deg in the\n"
      "# housing, with two chips or more; with better coefficients and known attitudes state less.\n"
      "alert_limit = \"{:.0f} deg\"\n",
      kImportAlertLimit_deg);
  return out;
}

std::string sensors_of(const LogDigest& digest, const ImportPlan& plan, const LogReview& found) {
  const double range_g0 = full_scale_g0(digest, plan.sources);
  std::string out;
  for (std::size_t chip = 0; chip < plan.sources.size(); ++chip) {
    const logs::ImuSource& source = digest.sources[plan.sources[chip]].source;
    out += fmt::format("\n# {}, device {}\n", io::printable_line(source.name), source.device_id);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      double scatter = kUnknownScatter_mps2;
      for (const ChipSummary& summary : found.chips) {
        const bool same =
            std::find(summary.sources.begin(), summary.sources.end(), plan.sources[chip]) != summary.sources.end();
        if (same && std::isfinite(summary.scatter_mps2[axis]))
          scatter = std::clamp(summary.scatter_mps2[axis], kLeastScatter_mps2, kMostScatter_mps2);
      }
      out += fmt::format("[[sensor]]\nid = \"{}{}\"\n", static_cast<char>('x' + axis), chip);
      if (plan.sources.size() > 1) out += fmt::format("package = \"imu{}\"\n", chip);
      out += fmt::format("axis = [{}, {}, {}]\nscale = \"1\"\nnoise = \"{:.2g} m/s^2\"\nfull_scale = \"{:.0f} g0\"\n",
                         axis == 0 ? 1 : 0, axis == 1 ? 1 : 0, axis == 2 ? 1 : 0, scatter, range_g0);
      out += source.uncalibrated ? "prior = {bias = \"0.5 m/s^2\", scale = \"3 %\", axis = \"1 deg\"}\n"
                                 : "prior = {bias = \"0.1 m/s^2\", scale = \"1 %\", axis = \"1 deg\"}\n";
      if (plan.rates_from != kNoChip) out += "lever_arm_m = [0, 0, 0]   # state where the chip sits\n";
    }
  }
  return out;
}

/// The table for `plumb calibrate --from`. Readings that have the autopilot's calibration keep scale 1 and bias 0; the
/// others get it, by their device: what the autopilot makes of a reading r is (r - offset) scale, so that r = a / scale
/// + offset. Empty where a chip has none, or more than that.
std::string coefficients_of(const LogDigest& digest, const LogReview& found, const ImportPlan& plan) {
  std::string out = "id,scale,bias,sigma_bias,sigma_scale,sigma_axis\n";
  for (std::size_t chip = 0; chip < plan.sources.size(); ++chip) {
    const auto summary = std::find_if(found.chips.begin(), found.chips.end(), [&](const ChipSummary& one) {
      return std::find(one.sources.begin(), one.sources.end(), plan.sources[chip]) != one.sources.end();
    });
    if (summary == found.chips.end()) return "";
    const InstalledCalibration& installed = summary->calibration;
    const bool raw = digest.sources[plan.sources[chip]].source.uncalibrated;
    if (raw && (!installed.present || installed.more)) return "";
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double scale = raw ? installed.scale[axis] : 1.0;
      const double offset_mps2 = raw ? installed.offset_mps2[axis] : 0.0;
      if (!(std::abs(scale) > 0.0)) return "";
      out += fmt::format("{}{},{:.17g},{:.17g} m/s^2,{}\n", static_cast<char>('x' + axis), chip, 1.0 / scale,
                         offset_mps2 * scale, kCorrectedUncertainty);
    }
  }
  return out;
}

/// The chip whose instants the rows have: of those that are there for nine tenths of the longest time, the slowest, but
/// not slower than a tenth of the fastest.
std::size_t reference_of(const LogDigest& digest, const ImportPlan& plan) {
  double longest_s = 0.0;
  double fastest_s = HUGE_VAL;
  const auto length_of = [&](std::size_t k) {
    const SourceDigest& source = digest.sources[plan.sources[k]];
    return source.records > 1 ? source.last_s - source.first_s : 0.0;
  };
  for (std::size_t k = 0; k < plan.sources.size(); ++k) {
    longest_s = std::max(longest_s, length_of(k));
    fastest_s = std::fmin(fastest_s, digest.sources[plan.sources[k]].intervals.usual_s());
  }
  std::size_t out = 0;
  double slowest_s = -1.0;
  for (std::size_t k = 0; k < plan.sources.size(); ++k) {
    const double interval_s = digest.sources[plan.sources[k]].intervals.usual_s();
    if (length_of(k) < 0.9 * longest_s || !(interval_s <= 10.0 * fastest_s) || interval_s <= slowest_s) continue;
    slowest_s = interval_s;
    out = k;
  }
  return out;
}

}  // namespace

io::FileExpected<ImportPlan> plan_import(const LogDigest& digest, const LogReview& found,
                                         const ImportSettings& settings) {
  if (found.chips.empty())
    return tl::unexpected<io::FileError>(refused("has no accelerometer", "log the accelerometers of the vehicle"));
  ImportPlan plan;
  for (const ChipSummary& chip : found.chips) {
    const std::size_t source = source_of(digest, chip, settings.message);
    if (source == kNoChip) continue;
    if (plan.sources.size() < kMostImported)
      plan.sources.push_back(source);
    else
      ++plan.left_out;
  }
  if (plan.sources.empty()) {
    return tl::unexpected<io::FileError>(
        refused("has no message \"" + io::printable_line(settings.message) + "\" of an accelerometer",
                "choose one of " + messages_of(digest)));
  }
  for (const std::size_t number : plan.sources) {
    const SourceDigest& source = digest.sources[number];
    const double interval_s = std::isfinite(source.intervals.usual_s()) ? source.intervals.usual_s() : digest.block_s;
    plan.longest_gap_s.push_back(kGapIntervals * interval_s);
    plan.uncalibrated = plan.uncalibrated || source.source.uncalibrated;
    plan.corrected = plan.corrected || (!source.source.uncalibrated && is_of_autopilot(source.source));
    for (const SourceBlock& block : source.blocks) {
      plan.temperature = plan.temperature || block.temperatures > 0;
      if (settings.rates && plan.rates_from == kNoChip && block.rates > 0)
        plan.rates_from = plan.longest_gap_s.size() - 1;
    }
  }
  plan.reference = reference_of(digest, plan);
  plan.array_text = head_of(digest, plan, settings) + sensors_of(digest, plan, found);
  plan.coefficients_text = coefficients_of(digest, found, plan);
  return plan;
}

}  // namespace review
}  // namespace PLUMB_ABI
}  // namespace plumb

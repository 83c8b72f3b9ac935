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

constexpr std::size_t kMostChips = static_cast<std::size_t>(kCapacity) / 3;
/// Scatter that is declared where the log was never at rest, and the least that is declared.
constexpr double kUnknownScatter_mps2 = 0.05;
constexpr double kLeastScatter_mps2 = 0.002;
/// A block of the monitor is about this long, and has 32 rows where it can.
constexpr double kBlock_s = 2.0;
/// What an accelerometer is off by after an autopilot's calibration by hand, 1 sigma: bias, scale, axis.
constexpr const char* kCorrectedUncertainty = "0.05 m/s^2,0.5 %,0.5 deg";

std::string family_of(const std::string& source) { return source.substr(0, source.find('[')); }

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
  if (plan.temperature) out += "temperature = \"temperature_degc\"\n";
  if (plan.rates_from != kNoChip) out += "rotation_radps = [\"wx_radps\", \"wy_radps\", \"wz_radps\"]\n";
  const double longest_s = *std::max_element(plan.longest_gap_s.begin(), plan.longest_gap_s.end());
  out += fmt::format("\n[monitor]\nwindow = {:.0f}\nmax_gap = \"{:.3g} s\"\n", std::clamp(std::round(rows), 4.0, 32.0),
                     std::max(5.0, longest_s));
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
          scatter = std::max(summary.scatter_mps2[axis], kLeastScatter_mps2);
      }
      out += fmt::format("[[sensor]]\nid = \"{}{}\"\n", static_cast<char>('x' + axis), chip);
      if (plan.sources.size() > 1) out += fmt::format("package = \"imu{}\"\n", chip);
      out += fmt::format("axis = [{}, {}, {}]\nscale = \"1\"\nnoise = \"{:.2g} m/s^2\"\nfull_scale = \"{:.0f} g0\"\n",
                         axis == 0 ? 1 : 0, axis == 1 ? 1 : 0, axis == 2 ? 1 : 0, scatter, range_g0);
      out += plan.uncalibrated ? "prior = {bias = \"0.5 m/s^2\", scale = \"3 %\", axis = \"1 deg\"}\n"
                               : "prior = {bias = \"0.1 m/s^2\", scale = \"1 %\", axis = \"1 deg\"}\n";
      if (plan.rates_from != kNoChip) out += "lever_arm_m = [0, 0, 0]   # state where the chip sits\n";
    }
  }
  return out;
}

/// Tab-separated: vehicle, component, name, value, type (9 is a float, 6 a whole number).
std::string parameter_line(const std::string& name, double value) {
  const bool whole = name.size() > 3 && name.compare(name.size() - 3, 3, "_ID") == 0;
  return whole ? fmt::format("1\t1\t{}\t{:.0f}\t6\n", name, value) : fmt::format("1\t1\t{}\t{:.17g}\t9\n", name, value);
}

/// The installed calibration of each chip that is taken, numbered as in the array file: the autopilot keeps them by
/// device, in an order of its own. Empty where a chip has none.
std::string parameters_of(const LogDigest& digest, const LogReview& found, const ImportPlan& plan) {
  std::string out = "# Vehicle-Id Component-Id Name Value Type\n";
  for (std::size_t chip = 0; chip < plan.sources.size(); ++chip) {
    const auto summary = std::find_if(found.chips.begin(), found.chips.end(), [&](const ChipSummary& one) {
      return std::find(one.sources.begin(), one.sources.end(), plan.sources[chip]) != one.sources.end();
    });
    if (summary == found.chips.end() || !summary->calibration.present) return "";
    const std::string prefix = fmt::format("CAL_ACC{}_", chip);
    out += parameter_line(prefix + "ID", static_cast<double>(summary->device_id));
    for (std::size_t k = 0; k < 3; ++k) {
      const std::string axis(1, static_cast<char>('X' + k));
      out += parameter_line(prefix + axis + "OFF", summary->calibration.offset_mps2[k]);
      out += parameter_line(prefix + axis + "SCALE", summary->calibration.scale[k]);
    }
  }
  for (const auto& [name, value] : digest.parameters) {
    if (name.rfind("TC_A", 0) == 0) out += parameter_line(name, value);
  }
  return out;
}

/// Readings that the autopilot has corrected already: nothing is left but what its own calibration is off by.
std::string corrected_coefficients(std::size_t chips) {
  std::string out = "id,scale,bias,sigma_bias,sigma_scale,sigma_axis\n";
  for (std::size_t chip = 0; chip < chips; ++chip) {
    for (std::size_t axis = 0; axis < 3; ++axis)
      out += fmt::format("{}{},1,0 m/s^2,{}\n", static_cast<char>('x' + axis), chip, kCorrectedUncertainty);
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
    if (plan.sources.size() < kMostChips)
      plan.sources.push_back(source);
    else
      ++plan.left_out;
  }
  if (plan.sources.empty()) {
    return tl::unexpected<io::FileError>(
        refused("has no message \"" + io::printable_line(settings.message) + "\" of an accelerometer",
                "choose one of " + messages_of(digest)));
  }
  double slowest_s = -1.0;
  for (std::size_t k = 0; k < plan.sources.size(); ++k) {
    const SourceDigest& source = digest.sources[plan.sources[k]];
    const double interval_s = std::isfinite(source.intervals.usual_s()) ? source.intervals.usual_s() : digest.block_s;
    plan.longest_gap_s.push_back(kGapIntervals * interval_s);
    if (interval_s > slowest_s) {
      slowest_s = interval_s;
      plan.reference = k;
    }
    for (const SourceBlock& block : source.blocks) {
      plan.temperature = plan.temperature || block.temperatures > 0;
      if (settings.rates && plan.rates_from == kNoChip && block.rates > 0) plan.rates_from = k;
    }
    plan.uncalibrated = plan.uncalibrated || source.source.uncalibrated;
  }
  plan.array_text = head_of(digest, plan, settings) + sensors_of(digest, plan, found);
  if (!plan.uncalibrated) plan.coefficients_text = corrected_coefficients(plan.sources.size());
  if (plan.uncalibrated) plan.coefficients_text = parameters_of(digest, found, plan);
  return plan;
}

}  // namespace review
}  // namespace PLUMB_ABI
}  // namespace plumb

// The report of a fit in motion as a table for people.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "plumb/core/units.hpp"
#include "plumb/render/figures.hpp"
#include "plumb/render/motion_fit_report.hpp"
#include "plumb/render/words.hpp"
#include "plumb/scenario/count_text.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {
namespace {

using session::MotionCommissioning;

std::string line(const std::string& label, const std::string& text) {
  return fmt::format("  {:<16}  {}\n", label, text);
}

std::string arms_table(const MotionCommissioning& run, const io::ArrayFile& array) {
  std::string out =
      fmt::format("\n  {:<10}  {:<26}  {:<27}  {:>8}{}\n", "lever arm", "       x       y       z, mm",
                  "        1 sigma, mm", "bound", run.found.lever_arms_stated ? "    less the stated, mm" : "");
  for (std::size_t k = 0; k < run.found.sensor.size(); ++k) {
    const io::MotionCalibration::Sensor& one = run.found.sensor[k];
    std::string arm, sigma, moved;
    for (std::size_t c = 0; c < 3; ++c) {
      arm += fmt::format("{:>8}", fixed_words(1e3 * one.lever_arm_m[c], 2));
      sigma +=
          fmt::format("{:>8}{}", fixed_words(1e3 * run.fit.arm_m[k][c].sigma, 2), run.fit.arm_m[k][c].open ? "*" : " ");
      moved += fmt::format(
          "{:>8}", unsigned_zero(fmt::format("{:+.2f}", 1e3 * (one.lever_arm_m[c] - one.stated_lever_arm_m[c]))));
    }
    out += fmt::format("  {:<10}  {:<26}  {:<27}  {:>8}{}\n", array.array.row(static_cast<int>(k)).id.data(), arm,
                       sigma, fixed_words(1e3 * one.lever_arm_bound_m, 2), run.found.lever_arms_stated ? moved : "");
  }
  return out;
}

std::string sensors_table(const MotionCommissioning& run, const io::ArrayFile& array) {
  std::string out = fmt::format("\n  {:<10}  {:>20}  {:>8}  {:>24}  {:>8}\n", "sensor", "lag, us", "bound",
                                "rectification, ug/g^2", "bound");
  constexpr double kUgPerG2 = 1e6 * kG0_mps2;
  for (std::size_t k = 0; k < run.found.sensor.size(); ++k) {
    const io::MotionCalibration::Sensor& one = run.found.sensor[k];
    const MotionErrors& used = run.setup.errors[k];
    const auto figure = [](double factor, const commission::Estimate& e) {
      return fmt::format("{} +- {:.1f}{}", unsigned_zero(fmt::format("{:+.1f}", factor * e.value)), factor * e.sigma,
                         e.open ? "*" : " ");
    };
    out += fmt::format("  {:<10}  {:>20}  {:>8.1f}  {:>24}  {:>8.1f}\n", array.array.row(static_cast<int>(k)).id.data(),
                       figure(1e6, run.fit.lag_s[k]),
                       1e6 * (run.refusal == session::MotionRefusal::none ? used.lag_s : one.lag_bound_s),
                       figure(kUgPerG2, run.fit.rectification[k]),
                       kUgPerG2 * (run.refusal == session::MotionRefusal::none ? used.rectification
                                                                               : one.rectification_bound_per_mps2));
  }
  return out;
}

std::string gyro_lines(const MotionCommissioning& run) {
  const GyroErrors& found = run.found.gyro;
  std::string scale;
  for (std::size_t c = 0; c < 3; ++c)
    scale += fmt::format("{}{} {:+.2f} +- {:.2f} %", c > 0 ? ", " : "", std::string(1, "xyz"[c]),
                         100.0 * run.fit.gyro[4 * c].value, 100.0 * run.fit.gyro[4 * c].sigma);
  return line("gyro scale", scale) +
         line("gyro bounds",
              fmt::format("scale {:.2g} %, axes {:.2g} deg, bias {:.2g} deg/s, lag {:.2g} us; noise {:.2g} deg/s",
                          100.0 * found.scale, deg_from_rad(found.axis_rad), deg_from_rad(found.bias_radps),
                          1e6 * found.lag_s, deg_from_rad(found.noise_radps)));
}

/// Keys of the array file that count before what was found.
std::vector<std::string> stated_keys(const MotionCommissioning& run, const io::ArrayFile& array) {
  std::vector<std::string> out;
  const auto any = [](const std::array<bool, kCapacity>& set) {
    return std::any_of(set.begin(), set.end(), [](bool one) { return one; });
  };
  if (any(run.lag_stated)) out.emplace_back("lag_bound_s");
  if (any(run.rectification_stated)) out.emplace_back("vibration_rectification_per_mps2");
  const io::GyroSpec& gyro = array.motion.gyro;
  if (gyro.scale || gyro.axis_rad || gyro.bias_radps || gyro.noise_radps || gyro.lag_s) out.emplace_back("[gyro]");
  return out;
}

std::string checks(const MotionCommissioning& run) {
  std::string out =
      line("parity residual", fmt::format("{:.2f} mg0 in the fitted part, {:.2f} mg0 before the fit",
                                          in_mg0(run.fit.residual_mps2), in_mg0(run.fit.residual_before_mps2)));
  if (run.lag_needed_s > 0.0)
    out += line("lag", fmt::format("the log needs {:.1f} us beyond what was fitted; bounds are {} of that",
                                   1e6 * run.lag_needed_s, "1.5 times"));
  if (run.held_out_own_mps2 > 0.0)
    out += line("held out",
                fmt::format("{:.2f} mg0 in the last third, {:.2f} mg0 by a fit of its own; {} of {} samples "
                            "judged, {}",
                            in_mg0(run.held_out_mps2), in_mg0(run.held_out_own_mps2), run.held_out_judged,
                            run.rows - run.fitted_rows,
                            run.refusal == session::MotionRefusal::held_out_alarm ? "with an alarm" : "no alarm"));
  return out;
}

}  // namespace

std::vector<std::string> left_open(const MotionCommissioning& run, const io::ArrayFile& array) {
  std::vector<std::string> out;
  for (std::size_t c = 0; c < 3; ++c) {
    std::vector<std::string> names;
    for (std::size_t k = 0; k < run.fit.arm_m.size(); ++k) {
      const std::string chip = io::package_of(array, static_cast<int>(k));
      const std::string name = chip.empty() ? array.array.row(static_cast<int>(k)).id.data() : chip;
      if (run.fit.arm_m[k][c].open && std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
    }
    if (!names.empty()) out.push_back("lever arm of " + listed(names) + " along " + std::string(1, "xyz"[c]));
  }
  const auto add = [&](const char* what, const std::vector<commission::Estimate>& all) {
    SensorSet open;
    for (std::size_t k = 0; k < all.size(); ++k) open = all[k].open ? open.with(static_cast<int>(k)) : open;
    if (!open.empty()) out.push_back(what + sensor_names(open, array.array));
  };
  add("lag of ", run.fit.lag_s);
  add("rectification of ", run.fit.rectification);
  return out;
}

std::string motion_fit_text(const MotionCommissioning& run, const io::ArrayFile& array) {
  std::string out = fmt::format("Calibration of {} in motion\n", array.name);
  out += line("log", fmt::format("{} over {:.1f} s; the first two thirds are fitted, the last third checks",
                                 count_text(run.rows, "row"), run.duration_s));
  if (!run.fitted) return out;
  out +=
      line("fit", fmt::format("{} of 32 samples; of {} unknowns {} are found, {} are free by choice of the reference "
                              "point and of the instant (their means are zero)",
                              count_text(static_cast<std::uint64_t>(run.fit.block_pairs), "block pair"),
                              run.fit.parameters, run.fit.rank, run.fit.gauge));
  if (!run.found.sensor.empty()) out += arms_table(run, array) + sensors_table(run, array) + "\n" + gyro_lines(run);
  out += checks(run);
  const std::vector<std::string> open = left_open(run, array);
  for (std::size_t k = 0; k < open.size(); ++k) out += line(k == 0 ? "left open (*)" : "", open[k]);
  if (!open.empty() && run.refusal == session::MotionRefusal::none)
    out += line("", "there the bound that the array file states is kept");
  if (!run.fit.stated_arms_hold)
    out += line("stated arms", "are off by more than lever_arm_bound_m, which counts for none of them");
  const std::vector<std::string> stated = stated_keys(run, array);
  if (!stated.empty())
    out +=
        line("stated", "the array file states " + listed(stated) + ", which counts; leave it out for what was found");
  return out;
}

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb

// The report of a fit of gyros as a table for people.
#include <fmt/format.h>

#include <cmath>

#include "plumb/core/units.hpp"
#include "plumb/render/figures.hpp"
#include "plumb/render/gyro_fit_report.hpp"
#include "plumb/render/words.hpp"
#include "plumb/scenario/count_text.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {
namespace {

using session::GyroCheck;
using session::GyroCommissioning;
using GyroAxis = io::GyroCalibration::Axis;

std::string gyro_line(const std::string& label, const std::string& text) {
  return fmt::format("  {:<16}  {}\n", label, text);
}

/// 1 sigma of the length of a row, and of its direction.
std::pair<double, double> row_sigmas(const GyroAxis& axis) {
  const double length = norm(axis.row);
  const Vec3 unit = scaled(axis.row, 1.0 / length);
  double along = 0.0, trace = 0.0;
  for (std::size_t r = 0; r < 3; ++r) {
    trace += axis.row_covariance[4 * r];
    for (std::size_t c = 0; c < 3; ++c) along += unit[r] * axis.row_covariance[3 * r + c] * unit[c];
  }
  return {std::sqrt(std::fmax(along, 0.0)), std::sqrt(std::fmax(trace - along, 0.0)) / length};
}

std::string gyro_with_sigma(double value, double sigma, int digits) {
  return fmt::format("{} +- {:.{}f}", unsigned_zero(fmt::format("{:+.{}f}", value, digits)), sigma, digits);
}

std::string found_table(const GyroCommissioning& run, const io::ArrayFile& group) {
  std::string out = fmt::format("\n  {:<8}  {:>16}  {:>15}  {:>18}  {:>16}  {:>17}\n", "gyro", "scale, %", "turn, deg",
                                "bias, deg/s", "delay, us", "g-sens., deg/s/g");
  for (std::size_t k = 0; k < run.found.axis.size(); ++k) {
    const GyroAxis& one = run.found.axis[k];
    const int i = static_cast<int>(k);
    const auto [scale_sigma, turn_sigma] = row_sigmas(one);
    const double per_g = deg_from_rad(kG0_mps2);
    out += fmt::format(
        "  {:<8}  {:>16}  {:>15}  {:>18}  {:>16}  {:>17}\n", group.array.row(i).id.data(),
        gyro_with_sigma(100.0 * (norm(one.row) - 1.0), 100.0 * scale_sigma, 3),
        fmt::format("{:.3f} +- {:.3f}", deg_from_rad(angle_between_rad(one.row, group.array.axis(i))),
                    deg_from_rad(turn_sigma)),
        gyro_with_sigma(deg_from_rad(one.bias_radps), deg_from_rad(one.bias_sigma_radps), 4),
        run.found.delay_fitted ? gyro_with_sigma(1e6 * one.delay_s, 1e6 * one.delay_sigma_s, 1) : "not fitted",
        run.found.force_fitted
            ? fmt::format("{:.4f} +- {:.4f}", per_g * norm(one.per_force), per_g * norm(one.per_force_sigma))
            : "not fitted");
  }
  return out;
}

std::string bounds_table(const GyroCommissioning& run, const io::ArrayFile& group) {
  std::string out = fmt::format("\n  {:<8}  {:>9}  {:>9}  {:>11}  {:>8}  {:>17}\n", "bounds", "scale, %", "turn, deg",
                                "bias, deg/s", "lag, us", "g-sens., deg/s/g");
  for (std::size_t k = 0; k < run.found.axis.size(); ++k) {
    const RateErrors& bound = run.found.axis[k].bound;
    const double later_radps = kStabilitySigmas * group.stability[k].mps2;
    out += fmt::format("  {:<8}  {:>9.3f}  {:>9.3f}  {:>11.3f}  {:>8.1f}  {:>17.4f}\n",
                       group.array.row(static_cast<int>(k)).id.data(), 100.0 * bound.scale,
                       deg_from_rad(bound.axis_rad), deg_from_rad(bound.bias_radps + later_radps), 1e6 * bound.lag_s,
                       deg_from_rad(kG0_mps2 * bound.g_sensitivity_s_per_m));
  }
  out += gyro_line("",
                   "three sigma of what was found, and floors for what changes from run to run; of biases four times "
                   "the stability that [group.rate] states, too");
  return out;
}

std::string check_words(const GyroCheck& check) {
  std::string out =
      fmt::format("{:.3g} deg/s rms a sample, {:.3g} in means of {}", deg_from_rad(check.all.sample_radps),
                  deg_from_rad(check.all.block_radps), commission::kGyroBlock);
  if (check.fast.samples > 0)
    out += fmt::format("; above {:.3g} deg/s {:.3g} and {:.3g}", deg_from_rad(check.fast_radps),
                       deg_from_rad(check.fast.sample_radps), deg_from_rad(check.fast.block_radps));
  return out + (check.alarm ? "; the monitor contradicts" : "; no alarm");
}

/// What would have to be better for the residual to be less.
std::string limit_words(const GyroCommissioning& run) {
  const session::GyroLimit& limit = run.limit;
  const double noise_share = 1.0 - limit.timing_share - limit.relative_share;
  const std::string parts = fmt::format(
      "noise {:.3g} deg/s ({:.0f} %), times of samples {:.3g} us ({:.0f} %), what "
      "grows with the rate {:.2g} % ({:.0f} %)",
      deg_from_rad(limit.noise_radps), 100.0 * noise_share, 1e6 * limit.timing_s, 100.0 * limit.timing_share,
      100.0 * limit.relative, 100.0 * limit.relative_share);
  if (limit.timing_share > std::fmax(noise_share, limit.relative_share))
    return parts + ": the gyros sample at times of their own; one clock for all would show more";
  if (limit.relative_share > noise_share)
    return parts + ": scales are not constant over the rate; look at linearity and full scale";
  return parts + ": more or longer motion tells rows better, not single samples";
}

std::string common_matrix_words(const GyroCommissioning& run) {
  if (!run.found.absolute)
    return "pinned by the nominal axes, as gyros alone do not tell it; " +
           (std::isfinite(run.common_part)
                ? fmt::format("the rate of all may be off by {:.2g} % of itself beside (--turns finds it)",
                              100.0 * run.common_part)
                : std::string("no rate has a bound before scale_bound and axis_bound_rad of the datasheet are stated, "
                              "or --turns finds it"));
  double worst = 0.0;
  for (std::size_t k = 0; k < 9; ++k) worst = std::fmax(worst, std::sqrt(run.common->covariance[10 * k]));
  std::string out = fmt::format(
      "from {} between stations, entries to {:.2g} %; gravity as carried is off by {:.3g} deg "
      "rms",
      count_text(static_cast<std::size_t>(run.turns), "turn"), 100.0 * worst, deg_from_rad(run.found.turns_rad));
  if (run.turns_held_out > 0)
    out +=
        fmt::format(", by {:.3g} deg in {} held out", deg_from_rad(run.found.held_out_turns_rad), run.turns_held_out);
  return out;
}

}  // namespace

std::string gyro_fit_text(const session::GyroCommissioning& run, const io::ArrayFile& group) {
  std::string out = fmt::format("Calibration of {} in motion\n", group.name);
  out += gyro_line(
      "log", fmt::format("{} over {:.1f} s, {} fitted", count_text(run.rows, "row"), run.duration_s, run.fitted_rows));
  out += gyro_line(
      "rest",
      fmt::format("{} of {:.1f} s in all{}", count_text(static_cast<std::size_t>(run.rests), "stretch", "stretches"),
                  run.rest_s,
                  run.rests_turned > 0 ? fmt::format("; {} more in which the gyros turn", run.rests_turned) : ""));
  if (!run.fit) return out;
  if (run.found.absolute || run.fit->absolute || run.turns == 0)
    out += gyro_line("common matrix", common_matrix_words(run));
  if (run.found.axis.empty()) return out;
  out += found_table(run, group) + bounds_table(run, group) + "\n";
  if (run.lag_factor > 1.0)
    out += gyro_line("lag", fmt::format("the log needs {:.3g} times what three sigma of delay and sample times make",
                                        run.lag_factor));
  out += gyro_line("fitted", check_words(run.fitted));
  for (const GyroCheck& one : run.held_out) out += gyro_line("held out", one.name + ": " + check_words(one));
  out += gyro_line("limited by", limit_words(run));
  out += gyro_line("in a monitor",
                   "scales, axes and biases are corrected; delays and g-sensitivity are not, and lie within "
                   "the bounds above");
  return out;
}

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb

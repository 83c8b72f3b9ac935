// Clock and gyro of a log in motion, where they are not what the array file says.
#include <fmt/format.h>

#include <cmath>

#include "plumb/core/units.hpp"
#include "plumb/render/motion_words.hpp"
#include "plumb/scenario/count_text.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {
namespace {

using session::MotionInputs;
using session::RateInputs;

/// A stated period that is further off is worth a word; time stamps count in any case.
constexpr double kPeriodShare = 0.05;
/// Time stamps that scatter by more are of arrival rather than of sampling.
constexpr double kJitterShare = 0.1;
/// A rate that does not change by one digit for so long is no reading: gyros have noise.
constexpr double kStill_s = 1.0;
constexpr double kStillPeriods = 64.0;
/// The largest full scale of common gyros is 4000 deg/s.
constexpr double kMostRate_radps = rad_from_deg(4000.0);

void add_clock(const MotionInputs& in, const MotionSetup& setup, std::vector<MotionNote>& out) {
  const double period_s = setup.sample_period_s;
  if (in.steps_back > 0)
    out.push_back(
        {"time_backwards",
         fmt::format("{} not later than the row before, the first at t = {:.3f} s, and blocks begin anew there",
                     in.steps_back == 1 ? "1 row is" : count_text(in.steps_back, "row") + " are", in.first_back_s),
         "sort the log by time, and remove rows that are there twice"});
  const bool off = in.mean_step_s > 0.0 && std::fabs(in.mean_step_s / period_s - 1.0) > kPeriodShare;
  if (off || in.period_is_another)
    out.push_back({"period",
                   fmt::format("rows are {:.4g} s apart, and sample_period_s is {:.4g} s", in.mean_step_s, period_s),
                   fmt::format("set sample_period_s = {:.4g} in [motion]", in.mean_step_s)});
  if (in.steps_irregular > 0 && !in.period_is_another)
    out.push_back({"gaps",
                   fmt::format("{} between rows {} no sample period (half to one and a half of it), the first at t = "
                               "{:.3f} s: rows are missing or doubled there, and blocks begin anew",
                               count_text(in.steps_irregular, "step"), in.steps_irregular == 1 ? "is" : "are",
                               in.first_irregular_s),
                   "log every sample with the time at which it was taken"});
  if (in.jitter_s > kJitterShare * period_s && !off && !in.period_is_another)
    out.push_back({"jitter",
                   fmt::format("times scatter by up to {:.3g} s about a period of {:.4g} s", in.jitter_s, period_s),
                   "log the time at which a sample was taken, not that at which it arrived"});
}

std::string deg_words(const RateInputs& in, double most_radps) {
  if (rad_from_deg(in.largest_radps) > most_radps) return "";
  return fmt::format("; taken as deg/s it would be {:.3g} rad/s, so the columns seem to hold deg/s",
                     rad_from_deg(in.largest_radps));
}

/// Of one gyro: its name in sentences, and the key of its columns.
struct Gyro {
  const RateInputs& in;
  const char *rate, *columns;
};

void add_rates(const Gyro& gyro, std::uint64_t rows, const MotionSetup& setup, std::vector<MotionNote>& out) {
  const RateInputs& in = gyro.in;
  const bool stated = setup.rate_bound_radps > 0.0;
  if (in.missing > 0)
    out.push_back({"rate_missing",
                   fmt::format("{} is missing in {} of {}, the first at t = {:.3f} s: {}", gyro.rate, in.missing,
                               count_text(rows, "row"), in.first_missing_s,
                               stated ? "there rate_bound_radps counts in its place, and bounds are wide"
                                      : "nothing is judged there"),
                   stated ? "log the rates of every sample"
                          : "log the rates of every sample, or state rate_bound_radps in [motion]"});
  const double most_radps = stated ? setup.rate_bound_radps : kMostRate_radps;
  if (in.largest_radps > most_radps)
    out.push_back({"rate_too_large",
                   fmt::format("{} reaches {:.4g} rad/s at t = {:.3f} s, beyond {} {:.4g} rad/s{}", gyro.rate,
                               in.largest_radps, in.largest_at_s, stated ? "rate_bound_radps =" : "what gyros measure,",
                               most_radps, deg_words(in, most_radps)),
                   fmt::format("write rad/s into the columns of {}{}", gyro.columns,
                               stated ? "; raise rate_bound_radps if the tool turns so fast" : "")});
  if (in.still_s > std::fmax(kStill_s, kStillPeriods * setup.sample_period_s))
    out.push_back({"rate_stuck",
                   fmt::format("{} stood at {} for {:.3f} s from t = {:.3f} s on, while a gyro has noise", gyro.rate,
                               in.still_at_zero ? "0, 0, 0" : "one value", in.still_s, in.still_from_s),
                   "see whether the gyro was on, and its columns are filled at the rate of the samples"});
}

}  // namespace

std::vector<MotionNote> motion_notes(const session::MotionRun& run, const MotionSetup& setup) {
  std::vector<MotionNote> out;
  add_clock(run.inputs, setup, out);
  const MotionInputs& in = run.inputs;
  if (setup.gyros > 0)
    add_rates({in.gyro[0], setup.gyros > 1 ? "the rate of the first gyro" : "the rate", "rotation_radps"}, in.rows,
              setup, out);
  if (setup.gyros > 1)
    add_rates({in.gyro[1], "the rate of the second gyro", "second_rotation_radps"}, in.rows, setup, out);
  return out;
}

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb

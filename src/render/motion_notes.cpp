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

/// Where so many instants, and this share of them, lack a chip, it is no start of a log.
constexpr std::uint64_t kMostAbsent = 64;
constexpr double kMostAbsentShare = 0.01;

const char* table_of(const session::ClockRun& run) { return run.of_the_log ? "[motion]" : "its [[clock]]"; }

std::string samples_of(const session::ClockRun& run, std::uint64_t count) {
  return count_text(count, "sample") + " of " + run.name;
}

/// False where the sample period is another one: what else is wrong follows from it.
bool add_steps(const session::ClockRun& run, std::vector<MotionNote>& out) {
  const double period_s = run.clock.sample_period_s, mean_s = run.mean_step_s();
  if (mean_s > 0.0 && std::fabs(mean_s / period_s - 1.0) > kPeriodShare) {
    out.push_back(
        {"clock_period",
         fmt::format("samples of {} are {:.4g} s apart, and sample_period_s is {:.4g} s", run.name, mean_s, period_s),
         fmt::format("set sample_period_s = {:.4g} in {}", mean_s, table_of(run))});
    return false;
  }
  if (run.anew > 0)
    out.push_back(
        {"clock_gaps",
         fmt::format("before {} one is missing, or the clock has jumped, the first at t = {:.3f} s: this chip "
                     "is left out until six more have come",
                     samples_of(run, run.anew), run.first_anew_s),
         "log every sample of the chip, with the time at which it was taken"});
  if (run.early > 0)
    out.push_back({"clock_early",
                   fmt::format("{} came less than 0.9 sample periods after the one before, the first at t = {:.3f} s, "
                               "and did not count",
                               samples_of(run, run.early), run.first_early_s),
                   "log the time at which the chip took a sample, not that at which it arrived"});
  return true;
}

/// Of one clock, where its samples are not as the array file says.
void add_chip(const session::ClockRun& run, std::vector<MotionNote>& out) {
  if (run.samples == 0) {
    out.push_back({"clock_silent", fmt::format("{} delivered no sample", run.name),
                   run.of_the_log ? "see whether its columns are filled"
                                  : "see whether its columns, and that of its time, are filled"});
    return;
  }
  if (!add_steps(run, out)) return;
  if (run.not_valid > 0)
    out.push_back(
        {"clock_not_valid",
         fmt::format("{} lie further than valid_s = {:.6g} s from since_s = {:.6g} s, the first at t = {:.3f} "
                     "s, and did not count",
                     samples_of(run, run.not_valid), run.clock.valid_s, run.clock.since_s, run.first_not_valid_s),
         "compare the clock with the common one again and state offset_s and since_s of that time, or a longer "
         "valid_s where rate_bound allows it"});
  const bool often = run.absent > kMostAbsent &&
                     static_cast<double>(run.absent) > kMostAbsentShare * static_cast<double>(run.instants);
  if (often && run.not_valid == 0)
    out.push_back(
        {"clock_absent",
         fmt::format("{} is missing in {} of {}; by the stated clock its samples are {:.4g} s older than "
                     "their rows on average, and clock_wait_s is {:.4g} s",
                     run.name, run.absent, count_text(run.instants, "common instant"), run.mean_late_s(), run.wait_s),
         run.of_the_log ? "log every sample" : "log every sample, and compare offset_s and rate with the log"});
}

std::string deg_words(const RateInputs& in, double most_radps) {
  if (rad_from_deg(in.largest_radps) > most_radps) return "";
  return fmt::format("; taken as deg/s it would be {:.3g} rad/s, so the columns seem to hold deg/s",
                     rad_from_deg(in.largest_radps));
}

/// Of one gyro, or of a group: its name in sentences, and what to do where rates are missing or too large.
struct Gyro {
  const RateInputs& in;
  std::string rate, log_them, check_unit;
};

Gyro gyro_of(const RateInputs& in, const char* rate, const char* columns) {
  return {in, rate, "log the rates of every sample", fmt::format("write rad/s into the columns of {}", columns)};
}

Gyro gyro_group(const RateInputs& in) {
  return {in, "the rate of the group of gyros", "see which gyros of the group deliver in every row",
          "check the unit of the group"};
}

void add_rates(const Gyro& gyro, const MotionSetup& setup, std::vector<MotionNote>& out) {
  const RateInputs& in = gyro.in;
  const bool stated = setup.rate_bound_radps > 0.0;
  if (in.missing > 0)
    out.push_back({"rate_missing",
                   fmt::format("{} is missing in {} of {}, the first at t = {:.3f} s: {}", gyro.rate, in.missing,
                               count_text(in.rates + in.missing, "row"), in.first_missing_s,
                               stated ? "there rate_bound_radps counts in its place, and bounds are wide"
                                      : "nothing is judged there"),
                   gyro.log_them + (stated ? "" : ", or state rate_bound_radps in [motion]")});
  const double most_radps = stated ? setup.rate_bound_radps : kMostRate_radps;
  if (in.largest_radps > most_radps)
    out.push_back({"rate_too_large",
                   fmt::format("{} reaches {:.4g} rad/s at t = {:.3f} s, beyond {} {:.4g} rad/s{}", gyro.rate,
                               in.largest_radps, in.largest_at_s, stated ? "rate_bound_radps =" : "what gyros measure,",
                               most_radps, deg_words(in, most_radps)),
                   gyro.check_unit + (stated ? "; raise rate_bound_radps if the tool turns so fast" : "")});
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
  for (const session::ClockRun& clock : run.clocks) add_chip(clock, out);
  const MotionInputs& in = run.inputs;
  if (run.rates_of_group) add_rates(gyro_group(in.gyro[0]), setup, out);
  if (setup.gyros > 0 && !run.rates_of_group)
    add_rates(gyro_of(in.gyro[0], setup.gyros > 1 ? "the rate of the first gyro" : "the rate", "rotation_radps"), setup,
              out);
  if (setup.gyros > 1)
    add_rates(gyro_of(in.gyro[1], "the rate of the second gyro", "second_rotation_radps"), setup, out);
  return out;
}

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb

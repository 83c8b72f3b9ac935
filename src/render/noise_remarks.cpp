#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "noise_words.hpp"
#include "plumb/io/printable.hpp"
#include "plumb/render/figures.hpp"
#include "plumb/scenario/count_text.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {
namespace {

using noise::AxisStudy;

constexpr const char* kCut = "the longest stretch without is used: ";

std::string stretch_words(const AxisStudy& study) {
  return fmt::format("{}{} of {} from t = {:.6g} s", kCut, study.readings, count_text(study.stretch.rows, "row"),
                     study.stretch.begin_s);
}

/// Of one kind of breaks, one remark.
void add_breaks(const AxisStudy& study, noise::BreakCode code, std::vector<NoiseRemark>& out) {
  const noise::Breaks& breaks = study.stretch.breaks_of(code);
  if (breaks.count == 0) return;
  const noise::Break& first = breaks.first;
  const double worst = breaks.worst.value;
  const std::string most = breaks.count == 1 ? std::string() : fmt::format(", at most {:.3g} s", worst);
  const std::string times = breaks.count == 1 ? std::string("once") : fmt::format("{} times", breaks.count);
  switch (code) {
    case noise::BreakCode::gap:
      out.push_back({study.name,
                     fmt::format("rows are missing {}, first {:.3g} s at t = {:.6g} s{}; {}", times, first.value,
                                 first.time_s, most, stretch_words(study)),
                     "record without gaps: slow terms need one long stretch"});
      return;
    case noise::BreakCode::silent:
      out.push_back({study.name,
                     fmt::format("the column delivers nothing {}, first {:.3g} s at t = {:.6g} s{}; {}", times,
                                 first.value, first.time_s, most, stretch_words(study)),
                     "check the channel, or the recorder"});
      return;
    case noise::BreakCode::motion:
      out.push_back({study.name,
                     fmt::format("it moves {}, first at t = {:.6g} s, at most {:.3g} times what rest does from one "
                                 "second to the next; {}",
                                 times, first.time_s, worst, stretch_words(study)),
                     "hold the tool still, away from steps and machines, while it is recorded"});
      return;
  }
}

void add_refusal(const AxisStudy& study, std::vector<NoiseRemark>& out) {
  switch (study.stretch.refused) {
    case noise::Refused::no: return;
    case noise::Refused::constant:
      out.push_back({study.name, fmt::format("all {} readings are alike: no noise is seen", study.readings),
                     "check that the channel is connected and not stuck, and that the log keeps enough digits"});
      return;
    case noise::Refused::too_short:
      out.push_back({study.name,
                     fmt::format("the longest stretch at rest has {}, and {} are the least",
                                 count_text(study.readings, "reading"), noise::kLeastReadings),
                     "record the tool at rest for minutes; for slow terms for hours"});
      return;
    case noise::Refused::no_rate:
      out.push_back({study.name, "the time column tells no sampling rate",
                     "name the time column with --time, or give --rate \"100 Hz\""});
      return;
  }
}

void add_fit(const NoiseAxis& axis, std::vector<NoiseRemark>& out) {
  const AxisStudy& study = axis.study;
  const double half_rate_hz = 0.5 / study.stretch.period_s;
  if (study.fit.highest_hz < 0.99 * half_rate_hz)
    out.push_back({study.name,
                   fmt::format("above {:.3g} Hz the spectrum is none of these terms, as behind an output filter: they "
                               "are fitted to what is below",
                               study.fit.highest_hz),
                   "none is needed; `noise` above is measured, not fitted"});
  if (study.fit.misfit != 1.0)
    out.push_back({study.name,
                   fmt::format("the terms do not describe this log: at {:.3g} Hz its power is {:.3g} times the fitted "
                               "one, and the intervals are too narrow",
                               study.fit.misfit_hz, study.fit.misfit),
                   "look at the plots; record at an even temperature, away from vibration"});
  const noise::Whiteness& w = study.whiteness;
  if (w.wander > 0.0)
    out.push_back(
        {study.name,
         fmt::format("means of blocks wander by {:.3g} {} (1 sigma) over the {:.3g} h of the log, beyond `noise`",
                     w.wander * shown_unit(axis).factor, shown_unit(axis).name, study.duration_s / 3600.0),
         axis.unit.field == io::FieldKind::rate
             ? "`noise` does not cover it: allow at least that in `bias_bound_radps`, in rad/s"
             : "`noise` does not cover it: state at least that as `stability`"});
}

/// What is said of several columns alike is said once.
std::vector<NoiseRemark> once_each(const std::vector<NoiseRemark>& all) {
  std::vector<NoiseRemark> out;
  for (const NoiseRemark& one : all) {
    const auto same = std::find_if(out.begin(), out.end(), [&one](const NoiseRemark& other) {
      return other.what == one.what && other.remedy == one.remedy;
    });
    if (same == out.end())
      out.push_back(one);
    else
      same->axis += ", " + one.axis;
  }
  return out;
}

}  // namespace

std::vector<NoiseRemark> noise_remarks(const NoiseReport& report) {
  std::vector<NoiseRemark> out;
  if (!report.complete)
    out.push_back({"", "the log is longer than what is kept in memory; its end is not used",
                   "choose fewer columns with --columns"});
  if (report.rows_bad > 0)
    out.push_back({"", count_text(report.rows_bad, "bad row") + " skipped", "see docs/array-file.md, \"The log\""});
  for (const std::string& name : report.left_out)
    out.push_back({name, "holds no numbers and is left out", "none is needed where it is no sensor"});
  for (const NoiseAxis& axis : report.axes) {
    const noise::Stretch& stretch = axis.study.stretch;
    for (const noise::BreakCode code : {noise::BreakCode::gap, noise::BreakCode::silent, noise::BreakCode::motion})
      add_breaks(axis.study, code, out);
    add_refusal(axis.study, out);
    if (stretch.refused != noise::Refused::no) continue;
    if (stretch.filled > 0)
      out.push_back({axis.study.name, count_text(stretch.filled, "reading") + " missing alone, taken from neighbours",
                     "none is needed for so few; else check the recorder"});
    if (stretch.irregular > noise::kIrregular)
      out.push_back(
          {axis.study.name,
           fmt::format("{:.0f} % of the steps of time are off by more than half a step: the readings are taken "
                       "as even, {:.5g} Hz",
                       100.0 * stretch.irregular, 1.0 / stretch.period_s),
           "log the time at which the chip sampled, not that of the transfer"});
    add_fit(axis, out);
  }
  return once_each(out);
}

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb

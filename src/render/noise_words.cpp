#include "noise_words.hpp"

#include <fmt/format.h>

#include <cmath>

#include "plumb/io/printable.hpp"
#include "plumb/render/figures.hpp"
#include "plumb/scenario/count_text.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {
namespace {

using noise::Term;

std::string hours_words(double hours) {
  if (hours < 1.0 / 60.0) return fmt::format("{:.2g} more seconds", 3600.0 * hours);
  if (hours < 1.0) return fmt::format("{:.2g} more minutes", 60.0 * hours);
  return fmt::format("{} more hours", hours < 10.0 ? fmt::format("{:.1f}", hours) : fmt::format("{:.0f}", hours));
}

}  // namespace

ShownUnit shown_unit(const NoiseAxis& axis) {
  const io::FieldUnits& field = io::units_of(axis.unit.field);
  if (axis.unit.acceleration) return {field.fine_per_inside / field.json_per_inside, field.fine};
  return {1.0, axis.unit.name.empty() ? "(unit of the log)" : axis.unit.name};
}

ShownUnit fine_unit(const NoiseAxis& axis) {
  const ShownUnit shown = shown_unit(axis);
  if (!axis.unit.acceleration) return shown;
  if (axis.unit.field == io::FieldKind::rate) return {3600.0 * shown.factor, "deg/h"};
  return axis.unit.field == io::FieldKind::gravity ? ShownUnit{1e3 * shown.factor, "ug0"} : shown;
}

std::string term_words(Term term) {
  switch (term) {
    case Term::quantisation: return "quantisation Q";
    case Term::white: return "white noise N";
    case Term::bias_instability: return "bias instability B";
    case Term::random_walk: return "random walk K";
    case Term::drift_rate: return "drift rate R";
  }
  return "?";
}

/// Of gyros as their datasheets have them: angle random walk in deg/sqrt(h), bias instability in deg/h.
static ShownUnit gyro_term(Term term) {
  constexpr double kDeg = 180.0 / kPi;
  switch (term) {
    case Term::quantisation: return {kDeg, "deg"};
    case Term::white: return {60.0 * kDeg, "deg/sqrt(h)"};
    case Term::bias_instability: return {3600.0 * kDeg, "deg/h"};
    case Term::random_walk: return {3600.0 * 60.0 * kDeg, "deg/h/sqrt(h)"};
    case Term::drift_rate: return {3600.0 * 3600.0 * kDeg, "deg/h/h"};
  }
  return {kDeg, "deg/s"};
}

ShownUnit term_unit(Term term, const NoiseAxis& axis) {
  if (axis.unit.acceleration && axis.unit.field == io::FieldKind::rate) return gyro_term(term);
  const ShownUnit fine = fine_unit(axis);
  switch (term) {
    case Term::quantisation: return {fine.factor, fine.name + " s"};
    case Term::white: return {fine.factor, fine.name + "/sqrt(Hz)"};
    case Term::bias_instability: return fine;
    case Term::random_walk: return {fine.factor, fine.name + "/sqrt(s)"};
    case Term::drift_rate: return {3600.0 * fine.factor, fine.name + "/h"};
  }
  return fine;
}

std::string term_value(Term term, const NoiseAxis& axis) {
  const noise::TermEstimate& one = axis.study.fit.of(term);
  if (!one.visible) return "not visible";
  return fmt::format(term == Term::drift_rate ? "{:+.3g}" : "{:.3g}", one.value * term_unit(term, axis).factor);
}

std::string term_interval(Term term, const NoiseAxis& axis) {
  const noise::TermEstimate& one = axis.study.fit.of(term);
  const double factor = term_unit(term, axis).factor;
  if (one.visible || term == Term::drift_rate)
    return fmt::format(term == Term::drift_rate ? "{:+.3g} .. {:+.3g}" : "{:.3g} .. {:.3g}", one.low * factor,
                       one.high * factor);
  return fmt::format("below {:.3g}", one.high * factor);
}

std::string term_remark(const noise::TermEstimate& term) {
  if (term.visible) return "";
  if (!term.more_hours) return "a log 100 times as long would not show it either: leave it out";
  return "record " + hours_words(*term.more_hours) + " for this term";
}

std::string peak_words(const noise::Peak& peak, const NoiseAxis& axis) {
  const ShownUnit unit = shown_unit(axis);
  std::string out = fmt::format("{:.5g} Hz, amplitude {:.3g} {}, {:.3g} times the floor", peak.frequency_hz,
                                peak.amplitude * unit.factor, unit.name, peak.over_floor);
  switch (peak.origin) {
    case noise::PeakOrigin::unknown: return out;
    case noise::PeakOrigin::harmonic: return out + fmt::format(" ({} times the lowest peak)", peak.order);
    case noise::PeakOrigin::mains_50_hz:
    case noise::PeakOrigin::mains_60_hz: {
      const int mains_hz = peak.origin == noise::PeakOrigin::mains_50_hz ? 50 : 60;
      return out + fmt::format(" (where mains of {} Hz would be: {} Hz{})", mains_hz, peak.order * mains_hz,
                               peak.aliased ? ", seen folded" : "");
    }
  }
  return out;
}

std::string whiteness_words(const NoiseAxis& axis) {
  const noise::Whiteness& w = axis.study.whiteness;
  std::string out = fmt::format(
      "means over {} scatter {:.3g} times as those of white noise: ", count_text(w.block, "sample"), w.factor);
  switch (w.verdict) {
    case noise::WhitenessVerdict::white: out += "white"; break;
    case noise::WhitenessVerdict::correlated:
      out += "correlated, by an output filter, vibration or slow terms; `noise` is larger than the scatter of samples";
      break;
    case noise::WhitenessVerdict::opposed:
      out +=
          "each sample takes back what the one before it added, as quantisation does; `noise` is the scatter of "
          "samples";
      break;
  }
  return out + fmt::format("; a block still averages up to {}{}", count_text(w.best_block, "sample"),
                           w.best_block >= noise::kLongestWindow ? ", the longest window" : "");
}

std::string declare_words(const NoiseAxis& axis) {
  const double sigma = axis.study.whiteness.declare_sigma;
  const ShownUnit shown = shown_unit(axis);
  if (axis.unit.acceleration) return fmt::format("{:.3g} {}", sigma * shown.factor, shown.name);
  return fmt::format("{:.3g} {}", sigma, axis.unit.name.empty() ? "UNIT" : axis.unit.name);
}

std::string declared_words(const NoiseAxis& axis) {
  if (!axis.declared) return "";
  const ShownUnit shown = shown_unit(axis);
  return fmt::format("declared {:.3g} {}: the measured one is {:.3g} times that", *axis.declared * shown.factor,
                     shown.name, axis.study.whiteness.declare_sigma / *axis.declared);
}

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb

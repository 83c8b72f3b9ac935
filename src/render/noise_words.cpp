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
  if (axis.unit.acceleration) return {kMg0, "mg0"};
  return {1.0, axis.unit.name.empty() ? "(unit of the log)" : axis.unit.name};
}

ShownUnit fine_unit(const NoiseAxis& axis) {
  if (axis.unit.acceleration) return {1e3 * kMg0, "ug0"};
  return shown_unit(axis);
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

std::string term_unit(Term term, const std::string& unit) {
  switch (term) {
    case Term::quantisation: return unit + " s";
    case Term::white: return unit + "/sqrt(Hz)";
    case Term::bias_instability: return unit;
    case Term::random_walk: return unit + "/sqrt(s)";
    case Term::drift_rate: return unit + "/h";
  }
  return unit;
}

/// From the unit of the readings and seconds to that of term_unit.
static double term_factor(Term term, const NoiseAxis& axis) {
  return fine_unit(axis).factor * (term == Term::drift_rate ? 3600.0 : 1.0);
}

std::string term_value(Term term, const NoiseAxis& axis) {
  const noise::TermEstimate& one = axis.study.fit.of(term);
  if (!one.visible) return "not visible";
  return fmt::format(term == Term::drift_rate ? "{:+.3g}" : "{:.3g}", one.value * term_factor(term, axis));
}

std::string term_interval(Term term, const NoiseAxis& axis) {
  const noise::TermEstimate& one = axis.study.fit.of(term);
  const double factor = term_factor(term, axis);
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
  if (axis.unit.acceleration) return fmt::format("{:.3g} mg0", in_mg0(sigma));
  return fmt::format("{:.3g} {}", sigma, axis.unit.name.empty() ? "UNIT" : axis.unit.name);
}

std::string declared_words(const NoiseAxis& axis) {
  if (!axis.declared_mps2) return "";
  return fmt::format("declared {:.3g} mg0: the measured one is {:.3g} times that", in_mg0(*axis.declared_mps2),
                     axis.study.whiteness.declare_sigma / *axis.declared_mps2);
}

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb

#include <fmt/format.h>

#include <algorithm>

#include "noise_words.hpp"
#include "plumb/io/printable.hpp"
#include "plumb/scenario/count_text.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {
namespace {

using noise::AxisStudy;
using noise::Term;

std::string key_line(const std::string& key, const std::string& text) { return fmt::format("  {:<20}{}\n", key, text); }

std::string least_deviation(const NoiseAxis& axis) {
  const std::vector<noise::AllanPoint>& points = axis.study.allan;
  const auto least = std::min_element(points.begin(), points.end(),
                                      [](const auto& a, const auto& b) { return a.deviation < b.deviation; });
  const ShownUnit unit = fine_unit(axis);
  return fmt::format("{:.3g} {} over {:.3g} s, least {:.3g} ({:.3g} .. {:.3g}) over {:.3g} s",
                     points.front().deviation * unit.factor, unit.name, points.front().tau_s,
                     least->deviation * unit.factor, least->low * unit.factor, least->high * unit.factor, least->tau_s);
}

std::string axis_text(const NoiseAxis& axis) {
  const AxisStudy& study = axis.study;
  std::string out =
      fmt::format("\n{}: {} at {:.5g} Hz, {:.4g} h\n", io::printable_line(study.name),
                  count_text(study.readings, "reading"), 1.0 / study.stretch.period_s, study.duration_s / 3600.0);
  for (const Term term : noise::kAllTerms) {
    const std::string unit = term_unit(term, axis).name;
    const noise::TermEstimate& one = study.fit.of(term);
    const std::string value = one.visible ? term_value(term, axis) + " " + unit : "not visible";
    const std::string rest = one.visible ? term_interval(term, axis)
                                         : fmt::format("{} {}; {}", term_interval(term, axis), unit, term_remark(one));
    out += key_line(term_words(term), fmt::format("{:<24}{}", value, rest));
  }
  out += key_line("Allan deviation", least_deviation(axis));
  for (const noise::Peak& peak : study.spectrum.peaks) out += key_line("peak", peak_words(peak, axis));
  if (study.spectrum.peaks.empty()) out += key_line("peaks", "none in the spectrum");
  out += key_line("whiteness", whiteness_words(axis));
  const std::string declared = declared_words(axis);
  return out + key_line("noise to declare", declare_words(axis) + (declared.empty() ? "" : "; " + declared));
}

const char* sensor_table(const NoiseAxis& axis) {
  return axis.unit.field == io::FieldKind::gravity ? "[[sensor]]" : "[[group.sensor]]";
}

/// A name as a TOML string.
std::string toml_text(const std::string& text) {
  std::string out = "\"";
  for (const char c : io::printable_line(text))
    out += (c == '"' || c == '\\') ? std::string("\\") + c : std::string(1, c);
  return out + "\"";
}

}  // namespace

std::string noise_lines(const NoiseReport& report) {
  std::string out;
  bool unknown = false;
  for (const NoiseAxis& axis : report.axes) {
    if (axis.study.stretch.refused != noise::Refused::no || !axis.unit.sensor) continue;
    unknown = unknown || axis.unit.name.empty();
    out += fmt::format("{}\nid = {}\nnoise = \"{}\"\n\n", sensor_table(axis), toml_text(axis.study.name),
                       declare_words(axis));
  }
  if (out.empty()) return out;
  const NoiseAxis& first = report.axes.front();
  const std::string window =
      first.unit.field == io::FieldKind::rate ? std::string() : fmt::format(" (window = {})", report.block);
  std::string head = fmt::format("# 1 sigma of one sample, for blocks of {}{}; put each `noise` into its {}\n",
                                 count_text(report.block, "sample"), window, sensor_table(first));
  if (unknown) head += "# UNIT: that of the log; --unit names it\n";
  out.pop_back();
  return head + out;
}

std::string noise_text(const NoiseReport& report) {
  std::string out =
      fmt::format("log         {}{}\n", io::printable_line(report.log),
                  report.time_column.empty() ? "" : ", time in " + io::printable_line(report.time_column));
  if (!report.array.empty()) out += "array       " + io::printable_line(report.array) + "\n";
  out += fmt::format("block       {}\n", count_text(report.block, "sample"));
  out += "intervals   95 %; terms as in IEEE Std 952, docs/noise.md\n";
  for (const NoiseAxis& axis : report.axes) {
    if (axis.study.stretch.refused == noise::Refused::no) out += axis_text(axis);
  }
  const std::vector<NoiseRemark> remarks = noise_remarks(report);
  if (!remarks.empty()) out += "\n";
  for (const NoiseRemark& remark : remarks)
    out += fmt::format("{:<11} {}. Remedy: {}\n", remark.axis.empty() ? "log" : io::printable_line(remark.axis),
                       remark.what, remark.remedy);
  const std::string lines = noise_lines(report);
  return lines.empty() ? out : out + "\n" + lines;
}

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb

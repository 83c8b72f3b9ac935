#include <fmt/format.h>

#include "html_view.hpp"
#include "noise_words.hpp"
#include "plumb/io/printable.hpp"
#include "plumb/scenario/count_text.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {
namespace {

using noise::Term;

Section summary_view(const NoiseReport& report) {
  Section out("noise", "Noise to declare", "One row for each column, then the lines for the array file.");
  std::vector<std::string> head = {"column", "noise to declare", "declared", "white over a block"};
  for (const Term term : noise::kAllTerms) head.push_back(term_words(term));
  ViewRows rows;
  for (const NoiseAxis& axis : report.axes) {
    const bool judged = axis.study.stretch.refused == noise::Refused::no;
    std::vector<ViewCell> row = {io::printable_line(axis.study.name)};
    row.emplace_back(judged ? declare_words(axis) : std::string("not judged"), judged ? "" : "open");
    const std::string declared = judged ? declared_words(axis) : "";
    row.emplace_back(declared.empty() ? std::string("-") : declared);
    row.emplace_back(judged ? std::string(noise::to_string(axis.study.whiteness.verdict)) : std::string("-"));
    for (const Term term : noise::kAllTerms) {
      row.emplace_back(!judged                           ? std::string("-")
                       : axis.study.fit.of(term).visible ? term_value(term, axis) + " " + term_unit(term, axis).name
                                                         : std::string("not visible"));
    }
    rows.push_back(row);
  }
  out.table("Every column", head, rows);
  ViewRows remarks;
  for (const NoiseRemark& one : noise_remarks(report))
    remarks.push_back({one.axis.empty() ? std::string("log") : io::printable_line(one.axis), one.what, one.remedy});
  if (!remarks.empty()) out.table("Remarks", {"column", "what", "what to do"}, remarks);
  std::vector<std::string> lines;
  std::string line;
  for (const char c : noise_lines(report)) {
    if (c != '\n') {
      line += c;
      continue;
    }
    lines.push_back(line);
    line.clear();
  }
  if (!lines.empty()) {
    out.heading("Lines for the array file");
    out.commands(lines);
  }
  return out;
}

Section axis_view(const NoiseAxis& axis, std::size_t k, const PagePictures& pictures) {
  const noise::AxisStudy& study = axis.study;
  Section out(fmt::format("column{}", k + 1), io::printable_line(study.name),
              fmt::format("{} at {:.5g} Hz, {:.4g} h", count_text(study.readings, "reading"),
                          1.0 / study.stretch.period_s, study.duration_s / 3600.0));
  out.figures({{"Noise to declare", declare_words(axis), "1 sigma of one sample"},
               {"White", noise::to_string(study.whiteness.verdict),
                fmt::format("over {}", count_text(study.whiteness.block, "sample"))},
               {"Peaks", std::to_string(study.spectrum.peaks.size()), "lines in the spectrum"}});
  ViewRows terms;
  for (const Term term : noise::kAllTerms)
    terms.push_back({term_words(term), term_unit(term, axis).name, term_value(term, axis), term_interval(term, axis),
                     term_remark(study.fit.of(term))});
  out.table("Terms of noise", {"term", "unit", "value", "95 % interval", "remark"}, terms);
  out.text("Whiteness: " + whiteness_words(axis) + ".");
  out.picture("Allan deviation", picture_of(pictures, allan_picture_name(k)),
              "Allan deviation against the averaging time, with the fitted slopes.",
              "Bars: 95 % by chi-square. Dashed: the terms that the log shows.");
  std::vector<std::string> peaks;
  for (const noise::Peak& peak : study.spectrum.peaks) peaks.push_back(peak_words(peak, axis));
  if (!peaks.empty()) out.list("Peaks", peaks);
  out.picture("Spectrum", picture_of(pictures, spectrum_picture_name(k)), "Root of the power density over frequency.",
              "Peaks stand above the floor with a chance of one in a thousand spectra; the fit leaves them out.");
  return out;
}

}  // namespace

std::string noise_html(const NoiseReport& report, const PagePictures& pictures) {
  std::vector<Section> sections;
  sections.push_back(summary_view(report));
  for (std::size_t k = 0; k < report.axes.size(); ++k) {
    if (report.axes[k].study.stretch.refused == noise::Refused::no)
      sections.push_back(axis_view(report.axes[k], k, pictures));
  }
  return sections_html({"Noise of " + io::printable_line(report.log),
                        "What a log at rest tells of the noise of its sensors. docs/noise.md explains every figure.",
                        "plumb noise", "", true},
                       std::move(sections));
}

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb

#include <fmt/format.h>

#include <cmath>

#include "chart.hpp"
#include "noise_words.hpp"
#include "plumb/core/units.hpp"
#include "plumb/io/printable.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {
namespace {

using noise::Term;

std::string csv_name(const char* kind, std::size_t k) { return fmt::format("noise-{}-{}.csv", kind, k + 1); }

/// A name inside single quotes.
std::string quoted_name(const std::string& name) {
  std::string out = io::printable_line(name);
  for (char& c : out) c = c == '\'' ? ' ' : c;
  return out;
}

std::string allan_csv(const NoiseAxis& axis) {
  const double factor = fine_unit(axis).factor;
  std::string out = "tau_s,deviation,low,high,fit,Q,N,B,K,R\n";
  const noise::Coefficients values = axis.study.fit.values();
  for (const noise::AllanPoint& point : axis.study.allan) {
    out += fmt::format("{:.6g},{:.6g},{:.6g},{:.6g},{:.6g}", point.tau_s, point.deviation * factor, point.low * factor,
                       point.high * factor, std::sqrt(noise::allan_variance(values, point.tau_s)) * factor);
    for (const Term term : noise::kAllTerms) {
      // What the log does not show is not drawn.
      const bool shown = axis.study.fit.of(term).visible;
      const double value = std::sqrt(noise::allan_variance(term, values[noise::index(term)], point.tau_s)) * factor;
      out += shown ? fmt::format(",{:.6g}", value) : std::string(",nan");
    }
    out += "\n";
  }
  return out;
}

std::string spectrum_csv(const NoiseAxis& axis) {
  const double factor = fine_unit(axis).factor;
  const noise::Spectrum& s = axis.study.spectrum;
  const noise::Coefficients values = axis.study.fit.values();
  const noise::Variances squares = noise::squares(values);
  const double period_s = axis.study.stretch.period_s;
  std::string out = "frequency_hz,root_density,floor,fit\n";
  for (std::size_t k = 1; k < s.density.size(); ++k) {
    const double hz = static_cast<double>(k) * s.bin_hz;
    const noise::Variances unit = noise::power_of_unit_terms(std::fmin(hz * period_s, 0.5), period_s);
    double fit = 0.0;
    for (std::size_t t = 0; t < noise::kNoiseTerms; ++t) fit += squares[t] * unit[t];
    out += fmt::format("{:.6g},{:.6g},{:.6g},{:.6g}\n", hz, std::sqrt(s.density[k]) * factor,
                       std::sqrt(s.floor[k]) * factor, std::sqrt(2.0 * period_s * fit) * factor);
  }
  return out;
}

std::string allan_script(const NoiseAxis& axis, std::size_t k) {
  const std::string data = csv_name("allan", k);
  std::string out = chart_head(allan_picture_name(k), 800, 520, 420) +
                    fmt::format(
                        "set tmargin 3\nset logscale xy\nset grid lw 0.4 lc rgb '#999999'\nset key top right\n"
                        "set xlabel 'averaging time, s'\nset ylabel 'Allan deviation, {}'\n"
                        "set format y '%g'\nset format x '%g'\n"
                        "set label 1 '{}' at graph 0, graph 1 offset 0,0.7 left noenhanced\n",
                        quoted_name(fine_unit(axis).name), quoted_name(axis.study.name));
  const char* colours[] = {"#8f55c4", "#b97a00", "#2c8f57", "#1f8a99", "#c53a3a"};
  double lowest = 0.0;
  for (const noise::AllanPoint& point : axis.study.allan)
    lowest = lowest == 0.0 || (point.low > 0.0 && point.low < lowest) ? point.low : lowest;
  // Slopes run far below the sum: the axis ends below the measured deviations.
  if (lowest > 0.0) out += fmt::format("set yrange [{:.4g}:]\n", 0.5 * lowest * fine_unit(axis).factor);
  out += fmt::format(
      "plot '{0}' skip 1 using 1:2:3:4 with yerrorbars pt 7 ps 0.5 lw 1 lc rgb '#2f78b7' title 'measured, 95 %', "
      "'' skip 1 using 1:5 with lines lw 2 lc rgb '#d0553c' title 'fit'",
      data);
  for (const Term term : noise::kAllTerms) {
    if (!axis.study.fit.of(term).visible) continue;
    const std::size_t t = noise::index(term);
    out += fmt::format(", '' skip 1 using 1:{} with lines dt 2 lw 1.2 lc rgb '{}' title '{}'", 6 + t, colours[t],
                       term_words(term));
  }
  return out + "\nunset output\n";
}

std::string spectrum_script(const NoiseAxis& axis, std::size_t k) {
  std::string out = chart_head(spectrum_picture_name(k), 800, 520, 420) +
                    fmt::format(
                        "set tmargin 3\nset logscale xy\nset grid lw 0.4 lc rgb '#999999'\nset key bottom left\n"
                        "set xlabel 'frequency, Hz'\nset ylabel 'root of the power density, {}/sqrt(Hz)'\n"
                        "set format y '%g'\nset format x '%g'\n"
                        "set label 1 '{}' at graph 0, graph 1 offset 0,0.7 left noenhanced\n",
                        quoted_name(fine_unit(axis).name), quoted_name(axis.study.name));
  int label = 2;
  for (const noise::Peak& peak : axis.study.spectrum.peaks) {
    out += fmt::format("set label {} '{:.4g} Hz' at {:.6g}, graph 0.96 rotate by 90 right font ',11'\n", label++,
                       peak.frequency_hz, peak.frequency_hz);
  }
  return out + fmt::format(
                   "plot '{}' skip 1 using 1:2 with lines lw 0.7 lc rgb '#2f78b7' title 'measured', "
                   "'' skip 1 using 1:3 with lines lw 1 lc rgb '#b97a00' title 'floor', "
                   "'' skip 1 using 1:4 with lines lw 1.6 lc rgb '#d0553c' title 'fit'\nunset output\n",
                   csv_name("spectrum", k));
}

bool drawn(const NoiseAxis& axis) { return axis.study.stretch.refused == noise::Refused::no; }

}  // namespace

std::string allan_picture_name(std::size_t k) { return fmt::format("noise-allan-{}.svg", k + 1); }
std::string spectrum_picture_name(std::size_t k) { return fmt::format("noise-spectrum-{}.svg", k + 1); }

std::vector<std::string> noise_picture_names(const NoiseReport& report) {
  std::vector<std::string> out;
  for (std::size_t k = 0; k < report.axes.size(); ++k) {
    if (!drawn(report.axes[k])) continue;
    out.push_back(allan_picture_name(k));
    out.push_back(spectrum_picture_name(k));
  }
  return out;
}

std::vector<PlotFile> noise_plot_files(const NoiseReport& report) {
  std::vector<PlotFile> out;
  std::string script = "# Draws the pictures of `plumb noise`. Run: gnuplot noise.gp\n";
  for (std::size_t k = 0; k < report.axes.size(); ++k) {
    const NoiseAxis& axis = report.axes[k];
    if (!drawn(axis)) continue;
    out.push_back({csv_name("allan", k), allan_csv(axis)});
    out.push_back({csv_name("spectrum", k), spectrum_csv(axis)});
    script += allan_script(axis, k) + spectrum_script(axis, k);
  }
  out.push_back({kNoiseScript, std::move(script)});
  return out;
}

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb

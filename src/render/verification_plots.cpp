// The charts of the verification page, drawn by gnuplot from the master JSON.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "chart.hpp"
#include "clipped.hpp"
#include "plumb/core/units.hpp"
#include "plumb/io/json_fields.hpp"
#include "plumb/render/figures.hpp"
#include "plumb/render/verification_page.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {
namespace {

constexpr const char* kBlue = "#2f78b7";
constexpr const char* kRed = "#d0553c";

std::string chart_terminal(const char* name, int width, int height, int narrow_height) {
  return chart_head(name, width, height, narrow_height) + "set grid lw 0.4 lc rgb '#999999'\n";
}

bool has_faults(const Json& report) { return report["campaign"]["faults"].value("played", false); }
/// A fit that was refused before it began has no stations, and gnuplot ends at a chart without a point.
bool has_residuals(const Json& report) {
  const Json& calibration = report["calibration"];
  if (!calibration.contains("fit")) return false;
  const Json& stations = calibration["fit"]["stations"];
  return std::any_of(stations.begin(), stations.end(), [](const Json& s) { return s["norm_error_mps2"].is_number(); });
}
bool has_trace(const Json& report) { return !report["calibration"].value("trace", Json::array()).empty(); }

double share(const Json& rate) {
  return rate["of"] == 0 ? 0.0 : rate["count"].get<double>() / rate["of"].get<double>();
}

PlotFile by_size_csv(const Json& bins) {
  std::string csv = "size_mdb,detected,detected_low,detected_high,isolated,isolated_low,isolated_high\n";
  for (const Json& bin : bins) {
    const double size = std::sqrt(bin["from_mdb"].get<double>() * bin["to_mdb"].get<double>());
    const Json& d = bin["detected"];
    const Json& i = bin["isolated"];
    csv += fmt::format("{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g}\n", size, share(d), d["low"].get<double>(),
                       d["high"].get<double>(), share(i), i["low"].get<double>(), i["high"].get<double>());
  }
  return {"by-size.csv", csv};
}

/// Shares that have come to an end by then, of those that come to one.
PlotFile times_csv(const Json& faults) {
  const double block_s = faults["plan"]["block_s"];
  const Json& detect = faults["blocks_to_detect"];
  const Json& isolate = faults["blocks_to_isolate"];
  const auto total = [](const Json& counts) {
    double out = 0.0;
    for (const Json& c : counts) out += c.get<double>();
    return out;
  };
  const double detected = total(detect), isolated = total(isolate);
  double d = 0.0, i = 0.0;
  std::string csv = "time_s,detected,isolated\n0,0,0\n";
  for (std::size_t k = 0; k < std::max(detect.size(), isolate.size()); ++k) {
    d += k < detect.size() ? detect[k].get<double>() : 0.0;
    i += k < isolate.size() ? isolate[k].get<double>() : 0.0;
    csv += fmt::format("{:.6g},{:.6g},{:.6g}\n", static_cast<double>(k + 1) * block_s,
                       detected > 0.0 ? d / detected : 0.0, isolated > 0.0 ? i / isolated : 0.0);
  }
  return {"times.csv", csv};
}

PlotFile stanford_csv(const Json& stanford) {
  const double first = stanford["first_octave_ends_at_deg"];
  std::string csv = "error_deg,protection_level_deg,blocks,log10_blocks\n";
  for (std::size_t level = 0; level < stanford["counts"].size(); ++level) {
    const Json& row = stanford["counts"][level];
    for (std::size_t error = 0; error < row.size(); ++error) {
      const double blocks = row[error];
      if (blocks > 0.0)
        csv += fmt::format("{:.6g},{:.6g},{},{:.6g}\n", first * std::exp2(static_cast<double>(error)),
                           first * std::exp2(static_cast<double>(level)), blocks, std::log10(blocks));
    }
  }
  return {"stanford.csv", csv};
}

PlotFile residuals_csv(const Json& stations) {
  std::string csv = "station,fit_mg0,held_out_mg0\n";
  const auto cell = [](const Json& value) {
    return value.is_number() ? fmt::format("{:.6g}", 1e3 * g0_from_mps2(value.get<double>())) : std::string();
  };
  int number = 0;
  for (const Json& s : stations)
    csv += fmt::format("{},{},{}\n", ++number, cell(s["norm_error_mps2"]),
                       s["held_out"].is_object() ? cell(s["held_out"]["norm_error_mps2"]) : "");
  return {"residuals.csv", csv};
}

PlotFile traces_csv(const Json& trace) {
  std::string csv = "iteration,cost";
  for (const char* what : {"bias_mg0", "scale_pct", "axis_deg"}) {
    for (const Json& s : trace.front()["sensors"]) csv += fmt::format(",{}_{}", s["id"].get<std::string>(), what);
  }
  csv += "\n";
  for (const Json& step : trace) {
    csv += fmt::format("{},{}", step["iteration"].get<int>(),
                       step["cost"].is_number() ? fmt::format("{:.6g}", step["cost"].get<double>()) : "");
    for (const auto& [key, factor] : {std::pair<const char*, double>{"bias_mps2", 1e3 / kG0_mps2},
                                      {"scale_change", 100.0},
                                      {"axis_shift_deg", 1.0}}) {
      for (const Json& s : step["sensors"]) csv += fmt::format(",{:.6g}", factor * s[key].get<double>());
    }
    csv += "\n";
  }
  return {"traces.csv", csv};
}

/// Four panels: what Figs 4 to 7 of the paper show.
std::string traces_script(const Json& trace) {
  const std::size_t n = trace.front()["sensors"].size();
  std::string names;
  for (const Json& s : trace.front()["sensors"]) {
    std::string id = s["id"];
    for (char& c : id) {
      if (c == ' ' || c == '\'' || c == '"' || c == '\\' || c == ',') c = '_';
    }
    names += (names.empty() ? "" : " ") + id;
  }
  std::string out = chart_terminal("traces.svg", 1000, 760, 1240) +
                    fmt::format(
                        "set multiplot layout (narrow ? 4 : 2),(narrow ? 1 : 2)\nset xrange [-0.2:{}.2]\nset xtics "
                        "1\nset xlabel 'iteration'\nset "
                        "format y '%g'\nset palette defined (0 '#2f78b7', 1 '#2c8f57', 2 '#c98a00', 3 '#d0553c', 4 "
                        "'#8f55c4')\nunset colorbox\nset key above samplen 1\n",
                        trace.size() - 1);
  std::size_t first = 3;
  for (const char* label : {"bias, mg0", "scale less the datasheet, %", "axis turned, deg"}) {
    out += fmt::format(
        "set ylabel '{}'\nplot for [i=0:{}] 'traces.csv' skip 1 using 1:(column({}+i)) with linespoints pt 7 ps 0.6 lc "
        "palette frac (i/{}.0) title word('{}', i+1) noenhanced\n",
        label, n - 1, first, n, names);
    out += axes_told("iteration", label);
    first += n;
  }
  double least = 1e300, most = 0.0;
  for (const Json& step : trace) {
    if (!step["cost"].is_number()) continue;
    least = std::fmin(least, step["cost"].get<double>());
    most = std::fmax(most, step["cost"].get<double>());
  }
  // A cost that hardly falls has no tic to read on a logarithmic axis.
  const bool wide = least > 0.0 && most > 100.0 * least;
  return out + "set ylabel 'cost, squared sigmas'\n" +
         (wide ? "set logscale y\nset format y '10^{%T}'\n" : "set yrange [0:*]\n") +
         "unset key\nplot 'traces.csv' skip 1 using 1:2 with linespoints pt 7 ps 0.6 lc rgb '#2f78b7' notitle\n" +
         axes_told("iteration", "cost", wide ? Log::y : Log::none) + "unset multiplot\nunset output\n";
}

std::string by_size_script() {
  return chart_terminal("by-size.svg", 800, 440, 360) +
         fmt::format(
             "set logscale x\nset xlabel 'size, multiples of the minimal detectable bias'\nset ylabel 'share'\nset "
             "yrange [-0.03:1.03]\nset key right bottom\n"
             "set arrow 1 from 1, graph 0 to 1, graph 1 nohead dt 3 lc rgb '#8a8a8a'\n"
             "plot 'by-size.csv' skip 1 using 1:2:3:4 with yerrorbars pt 7 ps 0.7 lc rgb '{0}' title 'detected', '' "
             "skip 1 using 1:2 with lines lc rgb '{0}' notitle, "
             "'' skip 1 using 1:5:6:7 with yerrorbars pt 5 ps 0.7 lc rgb '{1}' title 'isolated', '' skip 1 using 1:5 "
             "with lines lc rgb '{1}' notitle\n",
             kBlue, kRed) +
         axes_told("size, MDB", "share", Log::x) + "unset output\n";
}

std::string times_script() {
  return chart_terminal("times.svg", 800, 400, 340) +
         fmt::format(
             "set xlabel 'time at rest since the onset, s'\nset ylabel 'share'\nset yrange [0:1.03]\nset key right "
             "bottom\n"
             "plot 'times.csv' skip 1 using 1:2 with linespoints pt 7 ps 0.6 lc rgb '{}' title 'detected', '' skip 1 "
             "using 1:3 with linespoints pt 5 ps 0.6 lc rgb '{}' title 'isolated'\n"
             "{}",
             kBlue, kRed, axes_told("s since the onset", "share") + "unset output\n");
}

std::string stanford_script(double alert_limit_deg) {
  // A cell of the diagram ends at its octave; the row above all has no protection level.
  return chart_terminal("stanford.svg", 800, 640, 460) +
         fmt::format(
             "set logscale xy 2\nset xlabel 'tilt error up to, deg'\nset ylabel 'protection level up to, deg'\nset "
             "format '%.3g'\nset xrange [0.0004:1100]\nset yrange [0.0004:1100]\n"
             "set xtics (0.001,0.01,0.1,1,10,100)\nset ytics (0.001,0.01,0.1,1,10,100,'none' 724)\nset cblabel "
             "'blocks'\nset cbrange [0:*]\nset format cb '10^{{%.0f}}'\n"
             "set cbtics 1\nset palette defined (0 '#9ec9e8', 0.5 '#2f8aa0', 1 '#c53a3a')\nset arrow 1 from {0}, graph "
             "0 to {0}, graph 1 nohead dt 2 lc rgb '#c53a3a'\n"
             "set arrow 2 from graph 0, first {0} to graph 1, first {0} nohead dt 2 lc rgb '#c53a3a'\nset label 1 "
             "'alert limit' at {0}, graph 0.02 offset 0.5,0 tc rgb '#c53a3a'\n"
             "plot 'stanford.csv' skip 1 using ($1/sqrt(2)):($2/sqrt(2)):($1/2):1:($2/2):2:4 with boxxyerror fs solid "
             "1 noborder lc palette notitle, "
             "x with lines lc rgb '#8a8a8a' dt 3 title 'error = protection level'\n",
             alert_limit_deg) +
         axes_told("error, deg", "protection level, deg", Log::both) + "unset output\n";
}

double norm_error_of(const Json& station) {
  const Json& error = station["norm_error_mps2"];
  return error.is_number() ? kMg0 * error.get<double>() : std::nan("");
}

Clipped residual_axis(const Json& stations) {
  std::vector<double> all;
  for (const Json& s : stations) all.push_back(norm_error_of(s));
  return {all, 0.0};
}

std::string residuals_script(const Json& stations) {
  const Clipped axis = residual_axis(stations);
  std::string labels;
  std::size_t written = 0;
  for (std::size_t k = 0; k < stations.size(); ++k) {
    const double error = norm_error_of(stations[k]);
    if (axis.beyond(error) && written++ < kMostLabels) labels += axis.label(static_cast<double>(k + 1), error);
  }
  return chart_terminal("residuals.svg", 800, 380, 340) + axis.range() + labels +
         fmt::format(
             "edge(v) = v > {2:.6g} ? {2:.6g} : (v < -{2:.6g} ? -{2:.6g} : v)\n"
             "set xlabel 'station'\nset ylabel 'length of the vector less gravity, mg0'\nset xzeroaxis lw 0.7\nset key "
             "top right\n"
             "plot 'residuals.csv' skip 1 using 1:(edge($2)) with points pt 7 ps 0.6 lc rgb '{0}' title 'in the fit', "
             "'' "
             "skip 1 using 1:(edge($3)) with points pt 6 ps 0.8 lc rgb '{1}' title 'held out'\n",
             kBlue, kRed, axis.edge()) +
         axes_told("station", "mg0") + "unset output\n";
}

}  // namespace

std::vector<std::string> verification_picture_names(const Json& report, const GeometryPictures& geometry) {
  std::vector<std::string> out = geometry_picture_names(geometry);
  if (has_trace(report)) out.emplace_back("traces.svg");
  if (has_residuals(report)) out.emplace_back("residuals.svg");
  if (!has_faults(report)) return out;
  if (!report["campaign"]["faults"]["by_size"].empty()) out.emplace_back("by-size.svg");
  out.emplace_back("times.svg");
  out.emplace_back("stanford.svg");
  return out;
}

std::vector<PlotFile> verification_plot_files(const Json& report, const GeometryPictures& geometry) {
  std::vector<PlotFile> out;
  std::string script = "# Draws the charts of a verification report. Run: gnuplot charts.gp\n";
  for (PlotFile& file : geometry_plot_files(geometry)) {
    if (file.name == kGeometryScript) {
      script += file.text;
    } else {
      out.push_back(std::move(file));
    }
  }
  if (has_trace(report)) {
    out.push_back(traces_csv(report["calibration"]["trace"]));
    script += traces_script(report["calibration"]["trace"]);
  }
  if (has_residuals(report)) {
    out.push_back(residuals_csv(report["calibration"]["fit"]["stations"]));
    script += residuals_script(report["calibration"]["fit"]["stations"]);
  }
  if (has_faults(report)) {
    const Json& faults = report["campaign"]["faults"];
    if (!faults["by_size"].empty()) {
      out.push_back(by_size_csv(faults["by_size"]));
      script += by_size_script();
    }
    out.push_back(times_csv(faults));
    out.push_back(stanford_csv(faults["stanford"]));
    script += times_script() + stanford_script(faults["plan"]["alert_limit_deg"]);
  }
  out.push_back({kVerificationScript, std::move(script)});
  return out;
}

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb

// The charts of the health report, drawn by gnuplot from its JSON.
#include <fmt/format.h>

#include <cmath>
#include <functional>

#include "chart.hpp"
#include "clipped.hpp"
#include "plumb/core/units.hpp"
#include "plumb/io/json_fields.hpp"
#include "plumb/render/figures.hpp"
#include "plumb/render/health_page.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {
namespace {

constexpr int kPlotWidth = 900;
/// Of green, orange and red, readable on white and on black; with a shape each, for those who see no colours.
constexpr const char* kPalette =
    "green = '#2c8f57'\norange = '#c98a00'\nred = '#d0553c'\nbound = '#8a8a8a'\n"
    "set style line 1 lc rgb green pt 7 ps 0.8\nset style line 2 lc rgb orange pt 9 ps 1.0\nset style line 3 lc rgb "
    "red "
    "pt 13 ps 1.1\n";

std::string cell(const Json& value, double factor = 1.0) {
  return value.is_number() ? fmt::format("{:.8g}", factor * value.get<double>()) : std::string();
}

/// Along the well where every station has a depth and the tool moved one way, else over time.
struct RunAxis {
  const char* key;    ///< of a point
  double factor;      ///< to what is drawn
  const char* title;  ///< with its unit
  double of(const Json& point, const char* time) const {
    const Json& value = point[key == nullptr ? time : key];
    return value.is_number() ? factor * value.get<double>() : std::nan("");
  }
};

RunAxis axis_of(const Json& report) {
  constexpr double kHours_s = 7200.0;
  bool down = true, up = true;
  double last = std::nan(""), first = last;
  for (const Json& s : report["stations"]) {
    const double depth_m = s["depth_m"].is_number() ? s["depth_m"].get<double>() : std::nan("");
    down = down && std::isfinite(depth_m) && !(depth_m < last);
    up = up && std::isfinite(depth_m) && !(depth_m > last);
    if (!std::isfinite(first)) first = depth_m;
    last = depth_m;
  }
  if ((down || up) && first != last) return {"depth_m", 1.0, "depth, m"};
  const bool hours =
      report["extremes"]["last_s"].get<double>() - report["extremes"]["first_s"].get<double>() > kHours_s;
  return hours ? RunAxis{nullptr, 1.0 / 3600.0, "t, h"} : RunAxis{nullptr, 1.0, "t, s"};
}

/// An id inside single quotes.
std::string quoted_id(std::string id) {
  for (char& c : id) {
    if (c == '\'' || c == '\n') c = ' ';
  }
  return id;
}

std::string number_cell(double value) { return std::isfinite(value) ? fmt::format("{:.8g}", value) : std::string(); }

/// Of |G| less its reference, in mg0, over all stations.
Clipped length_axis(const Json& stations) {
  std::vector<double> off;
  double limit = 0.0;
  for (const Json& s : stations) {
    if (s["off_mps2"].is_number()) off.push_back(kMg0 * s["off_mps2"].get<double>());
    if (s["length_limit_mps2"].is_number()) limit = std::fmax(limit, kMg0 * s["length_limit_mps2"].get<double>());
  }
  return {off, 1.2 * limit};
}

PlotFile stations_csv(const Json& report) {
  std::string csv =
      "number,begin_s,colour,off_mg0,limit_mg0,inclination_deg,inclination_sigma_deg,toolface_deg,"
      "statistic_over_limit,x,drawn_mg0\n";
  const RunAxis axis = axis_of(report);
  const Clipped length = length_axis(report["stations"]);
  for (const Json& s : report["stations"]) {
    const std::string colour = s["colour"];
    const double off = s["off_mps2"].is_number() ? kMg0 * s["off_mps2"].get<double>() : std::nan("");
    csv += fmt::format("{},{},{},{},{},{},{},{},{},{},{}\n", s["number"].dump(), cell(s["begin_s"]),
                       colour == "green" ? 1 : (colour == "orange" ? 2 : 3), number_cell(off),
                       cell(s["length_limit_mps2"], kMg0), cell(s["inclination_deg"]), cell(s["inclination_sigma_deg"]),
                       cell(s["toolface_deg"]), cell(s["worst_statistic_over_limit"]),
                       number_cell(axis.of(s, "begin_s")), number_cell(length.drawn(off)));
  }
  return {"stations.csv", csv};
}

/// Three plots of one column, one for each colour. `titles`: name them.
std::string by_colour(const char* x, const char* y, bool titles) {
  std::string out;
  const char* const names[] = {"green", "orange", "red"};
  for (int k = 1; k <= 3; ++k) {
    out += fmt::format("{}'stations.csv' skip 1 using ({}):($3=={}?{}:NaN) with points ls {} {}", k == 1 ? "" : ", ", x,
                       k, y, k, titles ? fmt::format("title '{}'", names[k - 1]) : std::string("notitle"));
  }
  return out;
}

std::string limits_over(const char* x) {
  return fmt::format(
      "'stations.csv' skip 1 using ({0}):5 with lines dt 2 lc rgb bound title 'limit', '' skip 1 using ({0}):(-$5) "
      "with "
      "lines dt 2 lc rgb bound notitle",
      x);
}

std::string grid() { return "set grid lw 0.4 lc rgb '#999999'\n"; }

/// Beside the stations whose |G| is drawn at the edge.
std::string far_labels(const Json& stations, const std::function<double(const Json&)>& x) {
  const Clipped length = length_axis(stations);
  std::string out;
  std::size_t labels = 0;
  for (const Json& s : stations) {
    const double off = s["off_mps2"].is_number() ? kMg0 * s["off_mps2"].get<double>() : 0.0;
    if (length.beyond(off) && std::isfinite(x(s)) && labels++ < kMostLabels) out += length.label(x(s), off);
  }
  return out;
}

/// Panels above one another, with room for the names of stations, sensors and units at the left.
std::string panels(int count, const std::string& key = "set key outside top right horizontal\n") {
  return fmt::format("set multiplot layout {},1\nset lmargin (narrow ? 8 : 11)\nset rmargin 3\n", count) + key;
}

std::string run_script(const Json& report) {
  const RunAxis axis = axis_of(report);
  const std::string length = "|G| minus reference, mg0";
  return chart_head("run.svg", kPlotWidth, 860, 820) + grid() + kPalette + panels(3) +
         fmt::format("set xlabel '{}'\nset autoscale xfix\nset offsets graph 0.03,graph 0.06,0,0\nset ylabel '{}'\n",
                     axis.title, length) +
         length_axis(report["stations"]).range() +
         far_labels(report["stations"], [&axis](const Json& s) { return axis.of(s, "begin_s"); }) + "plot " +
         limits_over("$10") + ", " + by_colour("$10", "$11", true) + "\n" + axes_told(axis.title, length) +
         "unset key\nunset label\nset yrange [*:*]\nset ylabel 'inclination, deg'\nplot " +
         by_colour("$10", "$6", false) + "\n" + axes_told(axis.title, "inclination, deg") +
         "set ylabel 'statistic over limit'\nset logscale y\nplot 1 with lines dt 2 lc rgb bound notitle, " +
         by_colour("$10", "$9", false) + "\n" + axes_told(axis.title, "statistic over limit", Log::y) +
         "unset logscale y\nunset multiplot\nunset output\n";
}

std::string roll_script(const Json& report) {
  const auto toolface = [](const Json& s) {
    return s["toolface_deg"].is_number() ? s["toolface_deg"].get<double>() : std::nan("");
  };
  const std::string length = "|G| minus reference, mg0";
  return chart_head("roll.svg", kPlotWidth, 620, 560) + grid() + kPalette + panels(2) +
         "set xlabel 'toolface, deg'\nset xrange [0:360]\nset xtics 45\nset ylabel '" + length + "'\n" +
         length_axis(report["stations"]).range() + far_labels(report["stations"], toolface) + "plot " +
         by_colour("$8", "$11", true) + "\n" + axes_told("toolface, deg", length) +
         "unset key\nunset label\nset yrange [*:*]\nset ylabel 'inclination, deg'\nplot " +
         by_colour("$8", "$6", false) + "\n" + axes_told("toolface, deg", "inclination, deg") +
         "unset multiplot\nunset output\n";
}

double residual_of(const Json& point, std::size_t sensor) {
  const Json& off = point["off_mps2"][sensor];
  return off.is_number() ? kMg0 * off.get<double>() : std::nan("");
}

/// One scale for all sensors, which a faulty one does not set.
Clipped trace_axis(const Json& residuals) {
  std::vector<double> all;
  for (const Json& point : residuals["points"])
    for (std::size_t i = 0; i < residuals["sensors"].size(); ++i) all.push_back(residual_of(point, i));
  return {all, 0.0};
}

PlotFile traces_of_sensors_csv(const Json& report) {
  const Json& residuals = report["residuals"];
  const RunAxis axis = axis_of(report);
  const Clipped scale = trace_axis(residuals);
  std::string csv = "x";
  for (std::size_t i = 1; i <= residuals["sensors"].size(); ++i) csv += fmt::format(",off{0}_mg0,beyond{0}_mg0", i);
  for (const Json& point : residuals["points"]) {
    csv += "\n" + number_cell(axis.of(point, "t_s"));
    for (std::size_t i = 0; i < residuals["sensors"].size(); ++i) {
      const double off = residual_of(point, i);
      const std::string drawn = number_cell(scale.drawn(off));
      csv += scale.beyond(off) ? ",," + drawn : "," + drawn + ",";
    }
  }
  return {"residuals.csv", csv + "\n"};
}

/// One sensor; a series without a single point would only draw a warning.
std::string trace_strip(const Json& residuals, std::size_t sensor, const Clipped& scale, const std::string& axis) {
  double worst = 0.0;
  bool within = false;
  for (const Json& point : residuals["points"]) {
    const double off = residual_of(point, sensor);
    if (!std::isfinite(off)) continue;
    within = within || !scale.beyond(off);
    if (std::fabs(off) > std::fabs(worst)) worst = off;
  }
  const std::string id = quoted_id(residuals["sensors"][sensor]);
  std::string out = fmt::format("set ylabel '{}' noenhanced\nunset label 1\n", id), series;
  if (within)
    series +=
        fmt::format(", 'residuals.csv' skip 1 using 1:{} with linespoints pt 7 ps 0.3 lw 0.8 lc rgb '#2f78b7' notitle",
                    2 * sensor + 2);
  if (scale.beyond(worst)) {
    out += fmt::format("set label 1 'up to {:+.3g}' at graph 0.99,graph 0.86 right front font ',12' tc rgb '#c53a3a'\n",
                       worst);
    series +=
        fmt::format(", 'residuals.csv' skip 1 using 1:{} with points pt 13 ps 0.7 lc rgb red notitle", 2 * sensor + 3);
  }
  return out + "plot 0 with lines lw 0.7 lc rgb bound notitle" + series + "\n" + axes_told(axis, id + ", mg0");
}

/// A strip for each sensor.
std::string traces_of_sensors_script(const Json& report) {
  constexpr int kStrip = 84, kTop = 34, kBottom = 72, kGap = 14;
  const Json& residuals = report["residuals"];
  const std::size_t n = residuals["sensors"].size();
  const RunAxis axis = axis_of(report);
  const Clipped scale = trace_axis(residuals);
  const int height = kTop + static_cast<int>(n) * kStrip + kBottom;
  std::string out = chart_head("residuals.svg", kPlotWidth, height, height) + grid() + kPalette +
                    fmt::format(
                        "set multiplot layout {},1 margins (narrow ? 0.2 : 0.12),0.97,{:.4f},{:.4f} spacing {:.4f}\n"
                        "unset key\nset autoscale xfix\nset offsets graph 0.03,graph 0.06,0,0\nset format x ''\n"
                        "set ytics {:.1g}\n{}set label 2 'mg0' at screen 0.02,screen {:.4f} left\n",
                        n, 1.0 * kBottom / height, 1.0 - 1.0 * kTop / height, 1.0 * kGap / height, scale.room() / 2.0,
                        scale.range(), 1.0 - 0.5 * kTop / height);
  for (std::size_t i = 0; i < n; ++i) {
    if (i + 1 == n) out += fmt::format("set format x '%g'\nset xlabel '{}'\n", axis.title);
    out += trace_strip(residuals, i, scale, axis.title);
  }
  return out + "unset multiplot\nunset output\n";
}

bool has_traces_of_sensors(const Json& report) {
  if (!report.contains("residuals") || !report["residuals"].is_object()) return false;
  for (const Json& point : report["residuals"]["points"])
    for (std::size_t i = 0; i < report["residuals"]["sensors"].size(); ++i)
      if (std::isfinite(residual_of(point, i))) return true;
  return false;
}

/// Empty cells end a line: no bound, no point.
PlotFile motion_csv(const Json& motion) {
  std::string csv = "t_s,force_g0,bound_mg0,alarm\n";
  for (const Json& p : motion["trace"])
    csv += fmt::format("{},{},{},{}\n", cell(p["t_s"]), cell(p["force_mps2"], 1e-3 * kMg0), cell(p["bound_mps2"], kMg0),
                       p["alarm"].get<bool>() ? 1 : 0);
  return {"motion.csv", csv};
}

std::string motion_script() {
  const auto panel = [](int column) {
    return fmt::format(
        "'motion.csv' skip 1 using 1:(${0}) with lines lc rgb bound notitle, '' skip 1 using 1:($4==0?${0}:NaN) with "
        "points "
        "lc rgb green pt 7 ps 0.3 title 'no contradiction', '' skip 1 using 1:($4==1?${0}:NaN) with points lc rgb "
        "orange "
        "pt 7 ps 0.5 title 'contradictions on record'\n",
        column);
  };
  return chart_head("motion.svg", kPlotWidth, 620, 560) + grid() + kPalette +
         panels(2, "set key outside top right vertical\n") +
         "set xlabel 't, s'\nset ylabel 'specific force, g0'\nplot " + panel(2) +
         axes_told("t, s", "specific force, g0") +
         "unset key\nset ylabel 'bound of its error, mg0'\nset logscale y\nplot " + panel(3) +
         axes_told("t, s", "bound of its error, mg0", Log::y) + "unset logscale y\nunset multiplot\nunset output\n";
}

bool has_motion(const Json& report) {
  const Json& motion = report["motion"];
  if (motion.is_null() || !motion.contains("trace")) return false;
  for (const Json& point : motion["trace"]) {
    if (point["bound_mps2"].is_number()) return true;
  }
  return false;
}

bool has_rolls(const Json& report) {
  for (const Json& s : report["stations"]) {
    if (s["toolface_deg"].is_number()) return true;
  }
  return false;
}

}  // namespace

std::vector<std::string> health_picture_names(const Json& report) {
  std::vector<std::string> out;
  if (!report["stations"].empty()) out.emplace_back("run.svg");
  if (has_traces_of_sensors(report)) out.emplace_back("residuals.svg");
  if (has_rolls(report)) out.emplace_back("roll.svg");
  if (has_motion(report)) out.emplace_back("motion.svg");
  return out;
}

std::vector<PlotFile> health_plot_files(const Json& report) {
  std::string script = "# Draws the charts of a health report. Run: gnuplot health.gp\n";
  std::vector<PlotFile> out = {stations_csv(report)};
  if (!report["stations"].empty()) script += run_script(report);
  if (has_traces_of_sensors(report)) {
    script += traces_of_sensors_script(report);
    out.push_back(traces_of_sensors_csv(report));
  }
  if (has_rolls(report)) script += roll_script(report);
  if (has_motion(report)) {
    script += motion_script();
    out.push_back(motion_csv(report["motion"]));
  }
  out.push_back({kHealthScript, std::move(script)});
  return out;
}

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb

// The charts of the health report, drawn by gnuplot from its JSON.
#include <fmt/format.h>

#include <cmath>

#include "chart.hpp"
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

PlotFile stations_csv(const Json& stations) {
  std::string csv =
      "number,begin_s,colour,off_mg0,limit_mg0,inclination_deg,inclination_sigma_deg,toolface_deg,"
      "statistic_over_limit\n";
  for (const Json& s : stations) {
    const std::string colour = s["colour"];
    csv += fmt::format("{},{},{},{},{},{},{},{},{}\n", s["number"].dump(), cell(s["begin_s"]),
                       colour == "green" ? 1 : (colour == "orange" ? 2 : 3), cell(s["off_mps2"], kMg0),
                       cell(s["length_limit_mps2"], kMg0), cell(s["inclination_deg"]), cell(s["inclination_sigma_deg"]),
                       cell(s["toolface_deg"]), cell(s["worst_statistic_over_limit"]));
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

std::string run_script() {
  return chart_head("run.svg", kPlotWidth, 860) + grid() + kPalette +
         "set multiplot layout 3,1\nset lmargin 11\nset rmargin 3\nset xlabel 'station'\nset key outside top right "
         "horizontal\nset xrange [0.5:*]\nset offsets 0,0.5,0,0\n"
         "set ylabel '|G| minus reference, mg0'\nplot " +
         limits_over("$1") + ", " + by_colour("$1", "$4", true) + "\nunset key\nset ylabel 'inclination, deg'\nplot " +
         by_colour("$1", "$6", false) +
         "\nset ylabel 'statistic over limit'\nset logscale y\nplot 1 with lines dt 2 lc rgb bound notitle, " +
         by_colour("$1", "$9", false) + "\nunset logscale y\nunset multiplot\nunset output\n";
}

std::string roll_script() {
  return chart_head("roll.svg", kPlotWidth, 620) + grid() + kPalette +
         "set multiplot layout 2,1\nset lmargin 11\nset rmargin 3\nset xlabel 'toolface, deg'\nset xrange [0:360]\nset "
         "xtics 45\nset key outside top right horizontal\n"
         "set ylabel '|G| minus reference, mg0'\nplot " +
         by_colour("$8", "$4", true) + "\nunset key\nset ylabel 'inclination, deg'\nplot " +
         by_colour("$8", "$6", false) + "\nunset multiplot\nunset output\n";
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
  return chart_head("motion.svg", kPlotWidth, 620) + grid() + kPalette +
         "set multiplot layout 2,1\nset lmargin 11\nset rmargin 3\nset xlabel 't, s'\nset key outside top right "
         "horizontal\nset ylabel 'specific force, g0'\nplot " +
         panel(2) + "unset key\nset ylabel 'bound of its error, mg0'\nset logscale y\nplot " + panel(3) +
         "unset logscale y\nunset multiplot\nunset output\n";
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
  if (has_rolls(report)) out.emplace_back("roll.svg");
  if (has_motion(report)) out.emplace_back("motion.svg");
  return out;
}

std::vector<PlotFile> health_plot_files(const Json& report) {
  std::string script = "# Draws the charts of a health report. Run: gnuplot health.gp\n";
  if (!report["stations"].empty()) script += run_script();
  if (has_rolls(report)) script += roll_script();
  std::vector<PlotFile> out = {stations_csv(report["stations"])};
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

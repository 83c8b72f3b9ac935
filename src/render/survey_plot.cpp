#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "chart.hpp"
#include "clipped.hpp"
#include "plumb/render/survey_page.hpp"
#include "survey_words.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {
namespace {

constexpr const char* kChecksData = "survey-checks.csv";
constexpr const char* kPathData = "survey-path.csv";
/// Limits fill this part of a panel's height; what is further off is drawn at the edge, with its value.
constexpr double kRoom = 1.6;
constexpr double kEdge = 1.4;

struct Panel {
  const char* title;
  double unit;
  int decimals;
  survey::Check survey::StationChecks::*check;
};
constexpr std::array<Panel, 3> kPanels{{{"dG, mg", kMg_mps2, 2, &survey::StationChecks::gravity},
                                        {"dB, nT", 1e-9, 0, &survey::StationChecks::field},
                                        {"ddip, deg", rad_from_deg(1.0), 2, &survey::StationChecks::dip}}};

double largest_limit(const SurveyReport& r, const Panel& panel) {
  double out = 0.0;
  for (const survey::SurveyStation& s : r.survey.stations)
    out = std::max(out, (s.checks.*panel.check).limit / panel.unit);
  return out > 0.0 ? out : 1.0;
}

bool beyond_edge(const SurveyReport& r, const Panel& panel, const survey::SurveyStation& s) {
  return !(std::fabs((s.checks.*panel.check).difference() / panel.unit) <= kEdge * largest_limit(r, panel));
}

/// Three columns a panel: limit, difference where it passed, difference where it failed.
std::string checks_csv(const SurveyReport& r) {
  std::array<double, 3> most{};
  for (std::size_t k = 0; k < 3; ++k) most[k] = kEdge * largest_limit(r, kPanels[k]);
  std::string out = "md_m,limit_g,passed_g,failed_g,limit_b,passed_b,failed_b,limit_dip,passed_dip,failed_dip\n";
  for (const survey::SurveyStation& s : r.survey.stations) {
    out += fmt::format("{:.3f}", s.measured.md_m);
    for (std::size_t k = 0; k < 3; ++k) {
      const survey::Check& check = s.checks.*kPanels[k].check;
      const std::string value =
          fmt::format("{:.6g}", std::clamp(check.difference() / kPanels[k].unit, -most[k], most[k]));
      out += fmt::format(",{:.6g},{},{}", check.limit / kPanels[k].unit, check.passed ? value : "nan",
                         check.passed ? "nan" : value);
    }
    out += '\n';
  }
  return out;
}

std::string path_csv(const SurveyReport& r) {
  const std::vector<survey::PathPoint>& path = *r.survey.path;
  const double closure = std::hypot(path.back().north_m, path.back().east_m);
  const double north = closure > 0.0 ? path.back().north_m / closure : 1.0;
  const double east = closure > 0.0 ? path.back().east_m / closure : 0.0;
  std::string out = "north_m,east_m,section_m,tvd_m\n";
  for (const survey::PathPoint& p : path)
    out +=
        fmt::format("{:.3f},{:.3f},{:.3f},{:.3f}\n", p.north_m, p.east_m, north * p.north_m + east * p.east_m, p.tvd_m);
  return out;
}

std::string panel_script(const SurveyReport& r, std::size_t k) {
  const Panel& panel = kPanels[k];
  const double limit = largest_limit(r, panel);
  std::string out = fmt::format("unset label\nset ylabel '{}'\nset yrange [{:.6g}:{:.6g}]\n", panel.title,
                                -kRoom * limit, kRoom * limit);
  std::size_t labels = 0;
  for (const survey::SurveyStation& s : r.survey.stations) {
    if (!beyond_edge(r, panel, s) || ++labels > kMostLabels) continue;
    const double off = (s.checks.*panel.check).difference() / panel.unit;
    out += fmt::format("set label '{:+.{}f}' at {:.3f},{:.6g} offset 0.8,0 left font ',11' tc rgb '#c53a3a'\n", off,
                       panel.decimals, s.measured.md_m, std::copysign(kEdge * limit, off));
  }
  const std::size_t column = 2 + 3 * k;
  out += k == 2 ? "set xlabel 'measured depth, m'\nset format x '%g'\n" : "unset xlabel\nset format x ''\n";
  return out +
         fmt::format(
             "plot '{0}' skip 1 using 1:(-${1}):{1} with filledcurves fs transparent solid 0.16 noborder lc rgb "
             "'#2f78b7' title '{4}', '' skip 1 using 1:{1} with lines lw 0.8 lc rgb '#2f78b7' notitle, "
             "'' skip 1 using 1:(-${1}) with lines lw 0.8 lc rgb '#2f78b7' notitle, "
             "0 with lines lw 0.7 lc rgb '#999999' notitle, "
             "'' skip 1 using 1:{2} with points pt 7 ps 0.55 lc rgb '#2c8f57' title '{5}', "
             "'' skip 1 using 1:{3} with points pt 9 ps 1.0 lc rgb '#c53a3a' title '{6}'\n",
             kChecksData, column, column + 1, column + 2, k == 0 ? "limit" : "", k == 0 ? "passed" : "",
             k == 0 ? "failed" : "") +
         axes_told("md, m", panel.title);
}

std::string path_script(const SurveyReport& r) {
  const survey::PathPoint& end = r.survey.path->back();
  const bool away = std::hypot(end.north_m, end.east_m) > 0.0;
  const double closure_deg = deg_from_rad(survey::full_turn_rad(std::atan2(end.east_m, end.north_m)));
  // Both axes of a panel have one scale. A straight vertical hole has no extent across: the range is given room.
  return chart_head(kSurveyPathPicture, 900, 470, 860) +
         fmt::format(
             "set multiplot layout (narrow ? 2 : 1),(narrow ? 1 : 2)\nset grid lw 0.4 lc rgb '#999999'\nunset key\nset "
             "size ratio -1\n"
             "set format x '%g'\nset format y '%g'\nset xtics autofreq rotate by -40\n"
             "stats '{0}' skip 1 using 2:1 nooutput name 'P'\nstats '{0}' skip 1 using 3:4 nooutput name 'S'\n"
             "half(a, b) = 0.55 * (b - a > 10 ? b - a : 10)\nmiddle(a, b) = 0.5 * (a + b)\n"
             "h = half(P_min_x, P_max_x) > half(P_min_y, P_max_y) ? half(P_min_x, P_max_x) : half(P_min_y, P_max_y)\n"
             "set xrange [middle(P_min_x, P_max_x) - h:middle(P_min_x, P_max_x) + h]\n"
             "set yrange [middle(P_min_y, P_max_y) - h:middle(P_min_y, P_max_y) + h]\n"
             "set title 'from above'\nset xlabel 'east, m'\nset ylabel '{1} north, m'\n"
             "plot '{0}' skip 1 using 2:1 with linespoints pt 7 ps 0.45 lw 1.6 lc rgb '#2f78b7'\n{3}"
             "h = half(S_min_x, S_max_x) > half(S_min_y, S_max_y) ? half(S_min_x, S_max_x) : half(S_min_y, S_max_y)\n"
             "set xrange [middle(S_min_x, S_max_x) - h:middle(S_min_x, S_max_x) + h]\n"
             "set yrange [middle(S_min_y, S_max_y) + h:middle(S_min_y, S_max_y) - h]\n"
             "set title 'from the side'\nset xlabel 'along {2}, m'\nset ylabel 'true vertical depth, m'\n"
             "plot '{0}' skip 1 using 3:4 with linespoints pt 7 ps 0.45 lw 1.6 lc rgb '#2f78b7'\n{4}"
             "unset multiplot\nunset output\n",
             kPathData, to_string(r.survey.north), away ? fmt::format("{:.1f} deg", closure_deg) : std::string("north"),
             axes_told("east, m", "north, m"), axes_told("along, m", "tvd, m"));
}

bool has_path(const SurveyReport& r) { return r.survey.path && r.survey.path->size() > 1; }

}  // namespace

std::vector<std::string> survey_picture_names(const SurveyReport& r) {
  if (!has_path(r)) return {kSurveyChecksPicture};
  return {kSurveyChecksPicture, kSurveyPathPicture};
}

std::vector<PlotFile> survey_plot_files(const SurveyReport& r) {
  std::string script = "# Draws the pictures of `plumb survey`. Run: gnuplot " + std::string(kSurveyScript) + "\n" +
                       chart_head(kSurveyChecksPicture, 900, 620, 620) +
                       "set multiplot layout 3,1 margins (narrow ? 0.2 : 0.1),0.97,0.1,0.95 spacing 0.03\n"
                       "set grid lw 0.4 lc rgb '#999999'\nset key at graph 1,1.19 right top horizontal samplen 1.5\n"
                       "set autoscale xfix\nset offsets graph 0.02, graph 0.06, 0, 0\n";
  for (std::size_t k = 0; k < kPanels.size(); ++k) script += panel_script(r, k);
  script += "unset multiplot\nunset output\n";
  std::vector<PlotFile> out{{kChecksData, checks_csv(r)}};
  if (has_path(r)) {
    out.push_back({kPathData, path_csv(r)});
    script += path_script(r);
  }
  out.push_back({kSurveyScript, std::move(script)});
  return out;
}

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb

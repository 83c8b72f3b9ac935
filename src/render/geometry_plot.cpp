#include "plumb/render/geometry_plot.hpp"

#include <fmt/format.h>

#include <cmath>

#include "chart.hpp"
#include "plumb/render/field_words.hpp"
#include "plumb/render/figures.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {
namespace {

constexpr const char* kMap = "geometry-attitudes.svg";
constexpr const char* kProtection = "geometry-protection.svg";

/// A name inside single quotes.
std::string quoted(std::string text) {
  for (char& c : text) {
    if (c == '\'' || c == '\n') c = ' ';
  }
  return text;
}

bool is_magnetic(const GeometryPictures& p) { return p.field == io::FieldKind::magnetic; }

/// Two maps, one above the other.
std::string map_script(const GeometryPictures& p) {
  std::string out = chart_head(kMap, 1000, 900);
  // A pixel reaches half a step beyond its attitude. Both ends of the palette are readable on either background.
  const double half = p.map.size() > 1 ? 0.5 * (p.map[1].toolface_deg - p.map[0].toolface_deg) : 0.0;
  out += fmt::format(
      "set multiplot\nset lmargin at screen 0.09\nset rmargin at screen 0.84\nset xrange [{}:{}]\nset yrange [{}:{}]\n"
      "set xtics 45\nset ytics 30\nset palette defined (0 '#31406f', 0.35 '#2f8aa0', 0.7 '#d9b44a', 1 '#c53a3a')\n"
      "set ylabel 'inclination, deg'\n",
      -half, 360.0 + half, 180.0 + half, -half);
  const char* const fault = is_magnetic(p) ? "fault, uT" : "fault, g0";
  const auto panel = [&out](double top, double bottom, const std::string& title, const char* unit, int column) {
    out += fmt::format(
        "set tmargin at screen {}\nset bmargin at screen {}\nset label 1 '{}' at graph 0, graph 1 offset 0,0.7 left "
        "noenhanced\n"
        "set cblabel '{}'\nplot 'geometry-attitudes.csv' skip 1 using 2:1:{} with image notitle\n",
        top, bottom, title, unit, column);
  };
  out += "set format x ''\n";
  panel(0.93, 0.56, quoted(p.name) + ": any larger fault is isolated by the length of gravity at this attitude alone",
        fault, 3);
  out += "set format x '%g'\nset xlabel 'toolface, deg'\n";
  panel(0.47, 0.10, "nearest mirror: the least fault that has a second explanation (0: blind)", fault, 4);
  return out + "unset multiplot\nunset output\n";
}

std::string protection_script(const GeometryPictures& p) {
  return chart_head(kProtection, 800, 500) +
         fmt::format(
             "set tmargin 3\nset logscale xy\nset grid lw 0.4 lc rgb '#999999'\nset xlabel 'noise of one sample, 1 "
             "sigma, mg0'\n"
             "set ylabel 'protection level, deg'\nset key left top Left reverse\nset format y '%g'\n"
             "set label 1 '{0}: tilt error that can go undetected' at graph 0, graph 1 offset 0,0.7 left noenhanced\n"
             "set arrow 1 from {1}, graph 0 to {1}, graph 1 nohead dt 3 lc rgb '#8a8a8a'\n"
             "plot 'geometry-protection.csv' skip 1 using 1:2 with linespoints pt 7 ps 0.6 lw 1.4 lc rgb '#d0553c' "
             "title 'one sample', '' skip 1 using 1:3 with linespoints pt 7 ps 0.6 lw 1.4 lc rgb '#2f78b7' title "
             "'block of {2}'\nunset output\n",
             quoted(p.name), p.sigma_fine, p.samples);
}

}  // namespace

GeometryPictures geometry_pictures(const findings::GeometrySubject& subject, const findings::GeometryStudy& study) {
  const double fine = io::units_of(subject.field()).fine_per_inside;
  double sigma = 0.0;
  for (int i = 0; i < subject.array.size(); ++i) sigma = std::fmax(sigma, subject.array.sigma_mps2(i));
  return {subject.name, subject.field(), static_cast<int>(subject.settings.samples),
          fine * sigma, study.map,       study.levels};
}

std::vector<std::string> geometry_picture_names(const GeometryPictures& pictures) {
  std::vector<std::string> out;
  if (!pictures.map.empty()) out.emplace_back(kMap);
  if (!pictures.levels.empty()) out.emplace_back(kProtection);
  return out;
}

std::vector<PlotFile> geometry_plot_files(const GeometryPictures& pictures) {
  std::string script = "# Draws the pictures of a geometry. Run: gnuplot geometry.gp\n";
  std::vector<PlotFile> out;
  if (!pictures.map.empty()) {
    const char* const unit = is_magnetic(pictures) ? "ut" : "g0";
    const double per_g0 = is_magnetic(pictures) ? kG0_mps2 * io::units_of(pictures.field).coarse_per_inside : 1.0;
    std::string csv = fmt::format(
        "inclination_deg,toolface_deg,guaranteed_above_{0},nearest_mirror_{0},not_guaranteed_sensors\n", unit);
    for (const GeometryPictures::Point& at : pictures.map)
      csv += fmt::format("{},{},{:.6g},{:.6g},{}\n", at.inclination_deg, at.toolface_deg,
                         per_g0 * at.guaranteed_above_g0, per_g0 * at.nearest_mirror_g0, at.not_guaranteed_sensors);
    out.push_back({"geometry-attitudes.csv", std::move(csv)});
    script += map_script(pictures);
  }
  if (!pictures.levels.empty()) {
    std::string csv = fmt::format("sigma_{},one_sample_deg,block_deg\n", is_magnetic(pictures) ? "nt" : "mg0");
    for (const GeometryPictures::Level& at : pictures.levels)
      csv += fmt::format("{:.6g},{:.6g},{:.6g}\n", at.sigma_fine, at.one_sample_deg, at.block_deg);
    out.push_back({"geometry-protection.csv", std::move(csv)});
    script += protection_script(pictures);
  }
  out.push_back({kGeometryScript, in_field_words(std::move(script), pictures.field)});
  return out;
}

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb

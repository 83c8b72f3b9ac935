#include "plumb/render/fit_plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "chart.hpp"
#include "plumb/core/units.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {
namespace {

constexpr const char* kResiduals = "fit-residuals.svg";
constexpr const char* kParameters = "fit-parameters.svg";
constexpr const char* kConvergence = "fit-convergence.svg";
constexpr const char* kAttitudes = "fit-attitudes.svg";

/// Names of more sensors than this are written aslant.
constexpr std::size_t kUprightNames = 12;
/// Up to so many have room for a sentence each.
constexpr std::size_t kWideNames = 5;
/// Costs that span less are drawn from zero up, where a logarithmic axis would have no tic to read.
constexpr double kManyTimes = 100.0;
/// Up to so many costs are written beside their points.
constexpr std::size_t kFewCosts = 8;

/// Colours that are readable on white and on black.
constexpr const char* kColours =
    "found = '#2f78b7'\nheld = '#c98a00'\nodd = '#c53a3a'\nprior = '#8a8a8a'\nnext = '#2c8f57'\n";

std::string terminal(const char* name, int width, int height) {
  return chart_head(name, width, height, height) + kColours;
}

/// An id as one word that neither CSV nor gnuplot takes apart.
std::string word(std::string id) {
  for (char& c : id) {
    if (c == ' ' || c == ',' || c == '\'' || c == '"' || c == '\\') c = '_';
  }
  return id;
}

std::string stations_csv(const FitPictures& p) {
  std::string out = "station,norm_mg0,held_out_mg0,stands_out,x,y,z";
  for (const FitPictures::Sensor& s : p.sensors) out += "," + word(s.id);
  out += "\n";
  for (std::size_t k = 0; k < p.stations.size(); ++k) {
    const FitPictures::Station& s = p.stations[k];
    out +=
        fmt::format("{},{},{},{},{},{},{}", k + 1, s.norm_mg0, s.held_out_mg0 ? fmt::format("{}", *s.held_out_mg0) : "",
                    s.stands_out ? 1 : 0, s.down[0], s.down[1], s.down[2]);
    for (const double r : s.residual_mg0) out += fmt::format(",{}", r);
    out += "\n";
  }
  return out;
}

std::string parameters_csv(const FitPictures& p) {
  std::string out = "row,id,bias_mg0,sigma,prior,scale_pct,sigma,prior,axis_deg,sigma,prior\n";
  for (std::size_t i = 0; i < p.sensors.size(); ++i) {
    const FitPictures::Sensor& s = p.sensors[i];
    out += fmt::format("{},{}", i + 1, word(s.id));
    for (const FitPictures::Value& v : {s.bias_mg0, s.scale_pct, s.axis_deg})
      out += fmt::format(",{},{},{}", v.change, v.sigma, v.prior);
    out += "\n";
  }
  return out;
}

std::string next_csv(const FitPictures& p) {
  std::string out = "x,y,z\n";
  for (const Vec3& u : p.proposed_down) out += fmt::format("{},{},{}\n", u[0], u[1], u[2]);
  return out;
}

std::string cost_csv(const FitPictures& p) {
  std::string out = "iteration,cost\n";
  for (std::size_t k = 0; k < p.cost.size(); ++k) out += fmt::format("{},{}\n", k + 1, p.cost[k]);
  return out;
}

template <class Is>
bool any(const FitPictures& p, Is is) {
  return std::any_of(p.stations.begin(), p.stations.end(), is);
}

std::string residual_script(const FitPictures& p) {
  std::string out = terminal(kResiduals, 1000, 720);
  out += fmt::format(
      "set multiplot\nset lmargin at screen 0.1\nset rmargin at screen {}\nset xrange [0.5:{}.5]\n"
      "set grid ytics lw 0.4 lc rgb '#999999'\nset xzeroaxis lw 0.8 lc rgb prior\n"
      "set offsets 0,0,graph 0.07,graph 0.07\n",  // no ring is cut at the edge
      p.sensors.size() > kUprightNames ? 0.77 : 0.85, p.stations.size());
  const auto panel = [](double top, double bottom, const char* title) {
    return fmt::format(
        "set tmargin at screen {}\nset bmargin at screen {}\nset label 1 '{}' at graph 0, graph 1 offset "
        "0,0.6 left\nset ylabel 'mg0' offset 1\n",
        top, bottom, title);
  };
  out += panel(0.93, 0.6, "length of the vector minus gravity");
  out += "set key at graph 1.01, graph 1 left top Left reverse samplen 0.6 font ',13'\nset format x ''\n";
  out +=
      "plot 'fit-stations.csv' skip 1 using 1:2 with impulses lw 1 lc rgb found notitle, '' skip 1 using 1:2 with "
      "points pt 7 ps 0.5 lc rgb found title 'fitted'";
  // A series without a single point would only draw a warning.
  if (any(p, [](const FitPictures::Station& s) { return s.held_out_mg0.has_value(); })) {
    out += ", '' skip 1 using 1:(strlen(strcol(3)) ? $3 : NaN) with points pt 6 ps 0.8 lc rgb held title 'held out'";
  }
  if (any(p, [](const FitPictures::Station& s) { return s.stands_out; }))
    out += ", '' skip 1 using 1:($4 > 0 ? $2 : NaN) with points pt 6 ps 1.6 lw 1.5 lc rgb odd title 'stands out'";
  out += "\n";
  out += panel(0.52, 0.1, "what each sensor says beside the fitted vector");
  out +=
      "set format x '%g'\nset xlabel 'station' offset 0,0.4\nset palette defined (0 '#2f78b7', 1 '#2c8f57', 2 "
      "'#c98a00', 3 '#d0553c', 4 '#8f55c4')\nunset colorbox\n";
  std::string names;
  for (const FitPictures::Sensor& sensor : p.sensors) names += (names.empty() ? "" : " ") + word(sensor.id);
  out += fmt::format(
      "plot for [i=8:{0}] 'fit-stations.csv' skip 1 using 1:i with points pt 7 ps 0.5 lc palette frac ((i - 8) / "
      "{1}.0) "
      "title word('{2}', i - 7) noenhanced\nunset multiplot\nunset output\n",
      7 + p.sensors.size(), p.sensors.size(), names);
  return out;
}

/// A good sigma is too small to be seen beside that of the datasheet: it is written above the point, with what part of
/// the value comes from the log where there is room.
std::string sigma_label(std::size_t sensors, int column) {
  if (sensors > kWideNames) return fmt::format("sprintf('±%.2g', ${})", column + 1);
  return fmt::format("sprintf('±%.2g, %.0f %% from the log', ${0}, ${1} > 0 ? 100*(1 - (${0}/${1})**2) : 0)",
                     column + 1, column + 2);
}

std::string parameter_script(const FitPictures& p) {
  std::string out = terminal(kParameters, 1000, 780);
  out += fmt::format(
      "set multiplot\nset lmargin at screen 0.1\nset rmargin at screen 0.975\nset xrange [0.4:{}.6]\n"
      "set grid ytics lw 0.4 lc rgb '#999999'\nset xzeroaxis lw 0.8 lc rgb prior\n"
      "set style fill solid 0.2 noborder\nset offsets 0,0,graph {},graph 0.08\nset encoding utf8\nset xtics "
      "noenhanced{}\n",
      p.sensors.size(), p.sensors.size() > kUprightNames ? 0.7 : 0.25,
      p.sensors.size() > kUprightNames ? " rotate by -60" : "");
  const struct {
    double top, bottom;
    const char *title, *unit;
    int column;
  } panels[] = {{0.93, 0.71, "bias, found less datasheet", "mg0", 3},
                {0.63, 0.41, "scale, found against datasheet", "%", 6},
                {0.33, 0.11, "axis, found against nominal", "deg", 9}};
  for (const auto& panel : panels) {
    const int c = panel.column;
    out += fmt::format(
        "set tmargin at screen {}\nset bmargin at screen {}\nset label 1 '{}' at graph 0, graph 1 offset 0,0.6 left\n"
        "set ylabel '{}' offset 1\n",
        panel.top, panel.bottom, panel.title, panel.unit);
    out += c == 9 ? "set xtics autofreq\nset format x\n" : "set xtics 1\nset format x ''\n";
    out += c == 3 ? "set key at graph 1.01, graph 1 right bottom horizontal samplen 1 font ',13' width -2\n"
                  : "unset key\n";
    // An angle has no sign: its band begins at zero.
    out += fmt::format(
        "plot 'fit-parameters.csv' skip 1 using 1:(0):($1-0.35):($1+0.35):({1}):{0} with boxxyerror lc rgb prior title "
        "'datasheet, 1 sigma', '' skip 1 using 1:{2}:{3}{4} with yerrorbars pt 7 ps 0.6 lw 1.4 lc rgb found title "
        "'found, with 1 sigma', '' skip 1 using 1:{2}:({5}) with labels {6} font ',11' notitle\n",
        c + 2, c == 9 ? "0" : fmt::format("-${}", c + 2), c, c + 1, c == 9 ? ":xtic(2)" : "",
        sigma_label(p.sensors.size(), c), p.sensors.size() > kUprightNames ? "rotate left offset 0,0.7" : "offset 0,1");
  }
  return out + "unset multiplot\nunset output\n";
}

std::string convergence_script(const FitPictures& p) {
  const auto [least, most] = std::minmax_element(p.cost.begin(), p.cost.end());
  const bool wide = *least > 0.0 && *most > kManyTimes * *least;
  std::string out = terminal(kConvergence, 800, 460);
  out += fmt::format(
      "set label 1 'cost of the fit by iteration, in squared sigmas' at graph 0, graph 1 offset 0,0.8 left\n"
      "set tmargin 3\n{}set format y '%g'\nset xlabel 'iteration'\nset xtics 1\n"
      "set autoscale xfix\nset offsets 0.3,0.3,graph 0.15,0\nunset key\nset grid ytics lw 0.4 lc rgb '#999999'\n"
      "plot 'fit-cost.csv' skip 1 using 1:2 with linespoints pt 7 ps 0.7 lw 1.4 lc rgb found",
      wide ? "set logscale y\n" : "set yrange [0:*]\n");
  if (p.cost.size() <= kFewCosts)
    out += ", '' skip 1 using 1:2:(sprintf('%.4g', $2)) with labels offset 0,1 font ',12'";
  return out + "\nunset output\n";
}

/// Two discs of equal area: the half of the sphere about z, and the other half.
std::string attitude_script(const FitPictures& p) {
  std::string out = terminal(kAttitudes, 1000, 600);
  out +=
      "unset border\nunset tics\nset size ratio -1\nset xrange [-2.25:2.25]\nset yrange [-1.3:1.25]\n"
      "set lmargin 1\nset rmargin 1\nset tmargin 1\nset bmargin 1\nset key at graph 0.5, graph 0 center bottom "
      "horizontal samplen 0.6 width 1\n";
  for (const int side : {-1, 1}) {
    const double centre = 1.12 * side;
    for (const int from_pole_deg : {30, 60, 90}) {
      const double radius = std::sqrt(1.0 - std::cos(rad_from_deg(from_pole_deg)));
      const int inclination_deg = side < 0 ? from_pole_deg : 180 - from_pole_deg;
      out += fmt::format("set object circle at {0},0 size {1:.4f} fc rgb prior fs empty border lc rgb prior lw {2}\n",
                         centre, radius, from_pole_deg == 90 ? 1.2 : 0.5);
      out += fmt::format("set label '{} deg' at {},{:.4f} center offset 0,0.5 tc rgb prior font ',12'\n",
                         inclination_deg, centre, radius);
    }
    out += fmt::format("set label 'inclination {}' at {},-1 center offset 0,-1\n",
                       side < 0 ? "0 to 90 deg (z points down)" : "90 to 180 deg (z points up)", centre);
    out += fmt::format("set label 'x' at {},0 left offset 0.4,0 tc rgb prior font ',12'\n", centre + 1.0);
  }
  out +=
      "side(z) = z >= 0 ? -1.12 : 1.12\nradius(z) = sqrt(1 - abs(z))\nlength(x, y) = x*x + y*y > 0 ? sqrt(x*x + y*y) : "
      "1\n"
      "px(x, y, z) = side(z) + radius(z)*x/length(x, y)\npy(x, y, z) = radius(z)*y/length(x, y)\n"
      "plot 'fit-stations.csv' skip 1 using (px($5, $6, $7)):(py($5, $6, $7)) with points pt 7 ps 0.7 lc rgb found "
      "title "
      "'recorded'";
  if (any(p, [](const FitPictures::Station& s) { return s.stands_out; })) {
    out +=
        ", '' skip 1 using ($4 > 0 ? px($5, $6, $7) : NaN):(py($5, $6, $7)) with points pt 6 ps 1.6 lw 1.5 lc rgb odd "
        "title 'stands out'";
  }
  if (!p.proposed_down.empty()) {
    out +=
        ", 'fit-next.csv' skip 1 using (px($1, $2, $3)):(py($1, $2, $3)) with points pt 8 ps 1.1 lw 1.5 lc rgb next "
        "title "
        "'to record next'";
  }
  return out + "\nunset output\n";
}

bool has_residuals(const FitPictures& p) {
  return !p.stations.empty() && p.stations.front().residual_mg0.size() == p.sensors.size();
}

}  // namespace

std::vector<std::string> fit_picture_names(const FitPictures& pictures) {
  std::vector<std::string> out;
  if (has_residuals(pictures)) out.insert(out.end(), {kResiduals, kParameters});
  if (!pictures.cost.empty()) out.emplace_back(kConvergence);
  if (!pictures.stations.empty()) out.emplace_back(kAttitudes);
  return out;
}

std::vector<PlotFile> fit_plot_files(const FitPictures& pictures) {
  std::string script = "# Draws the pictures of a calibration. Run: gnuplot fit.gp\n";
  std::vector<PlotFile> out;
  if (!pictures.stations.empty()) out.push_back({"fit-stations.csv", stations_csv(pictures)});
  if (has_residuals(pictures)) {
    out.push_back({"fit-parameters.csv", parameters_csv(pictures)});
    script += residual_script(pictures) + parameter_script(pictures);
  }
  if (!pictures.cost.empty()) {
    out.push_back({"fit-cost.csv", cost_csv(pictures)});
    script += convergence_script(pictures);
  }
  if (!pictures.stations.empty()) {
    if (!pictures.proposed_down.empty()) out.push_back({"fit-next.csv", next_csv(pictures)});
    script += attitude_script(pictures);
  }
  out.push_back({kFitScript, std::move(script)});
  return out;
}

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb

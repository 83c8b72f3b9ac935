// Section 1 of the demo: the paper's geometry and what it can and cannot determine.
#include <fmt/format.h>

#include "demo_picture.hpp"
#include "demo_section.hpp"
#include "plumb/array/geometry.hpp"
#include "plumb/core/units.hpp"
#include "plumb/io/json_fields.hpp"
#include "plumb/study/fits.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {
namespace {

/// Eq (16) as it is printed.
constexpr const char* kPrinted[4][3] = {
    {"2√2/3", "0", "1/3"}, {"−√2/3", "√6/3", "1/3"}, {"−√2/3", "−√6/3", "1/3"}, {"0", "0", "1"}};

/// The four axes in space, with their feet on the plane across the tool.
std::string script_of(const SensorArray& array, bool narrow) {
  std::string out = plot_head("geometry", 760, {430, 300}, narrow);
  out +=
      "set origin 0,0.06\n"
      "set view 64,52,2.25,1.0\n"
      "set view equal xyz\n"
      "unset border\n"
      "unset tics\n"
      "unset key\n"
      "set parametric\n"
      "set lmargin at screen 0\n"
      "set rmargin at screen 1\n"
      "set tmargin at screen 1\n"
      "set bmargin at screen 0\n"
      "set xyplane at 0\n"
      "set urange [0:2*pi]\n"
      "set xrange [-1.15:1.15]\n"
      "set yrange [-1.15:1.15]\n"
      "set zrange [0:1.2]\n"
      "set arrow from 0,0,0 to 1.15,0,0 nohead lw 0.8 dt 3 lc rgb '#8a8a8a'\n"
      "set arrow from 0,0,0 to 0,1.15,0 nohead lw 0.8 dt 3 lc rgb '#8a8a8a'\n"
      "set label 'x' at 1.22,0,0 center tc rgb '#8a8a8a'\n"
      "set label 'y' at 0,1.22,0 center tc rgb '#8a8a8a'\n"
      "set label 'z: the axis of the tool' at 0,0,1.16 left offset 1.2,0 tc rgb '#8a8a8a'\n"
      "set arrow from 0,0,1 to 0,0,1.18 nohead lw 0.8 dt 3 lc rgb '#8a8a8a'\n";
  double radius = 0.0;
  double height = 0.0;
  for (int i = 0; i < array.size(); ++i) {
    const Vec3& h = array.axis(i);
    const char* const colour = kSensorColour[i];
    const double across = norm({h[0], h[1], 0.0});
    out += fmt::format("set arrow from 0,0,0 to {:.6f},{:.6f},{:.6f} head filled size graph 0.03,18 lw 3 lc rgb '{}'\n",
                       h[0], h[1], h[2], colour);
    // Beside the tip: outwards on the cone, to the left of the tool's axis.
    out += fmt::format("set label '{}' at {:.6f},{:.6f},{:.6f} center offset {},0 tc rgb '{}' font ',18'\n",
                       array.row(i).id.data(), 1.12 * h[0], 1.12 * h[1], h[2] + (across > 0.5 ? 0.05 : 0.0),
                       across > 0.5 ? 0 : -2, colour);
    if (across < 0.5) continue;
    radius = across;
    height = h[2];
    out += fmt::format("set arrow from {0:.6f},{1:.6f},{2:.6f} to {0:.6f},{1:.6f},0 nohead lw 1 dt 2 lc rgb '{3}'\n",
                       h[0], h[1], h[2], colour);
  }
  return out + fmt::format(
                   "splot {0:.6f}*cos(u),{0:.6f}*sin(u),{1:.6f} with lines lw 0.9 lc rgb '#8a8a8a', "
                   "{0:.6f}*cos(u),{0:.6f}*sin(u),0 with lines lw 0.6 dt 3 lc rgb '#8a8a8a'\n",
                   radius, height);
}

render::Table axes_table(const SensorArray& array) {
  render::Table out;
  out.title = "Axes, eq (16)";
  out.head = {"sensor", "x", "y", "z", "as printed", "angle to z, deg"};
  for (int i = 0; i < array.size(); ++i) {
    const Vec3& h = array.axis(i);
    out.rows.push_back({array.row(i).id.data(), fmt::format("{:.4f}", h[0]), fmt::format("{:.4f}", h[1]),
                        fmt::format("{:.4f}", h[2]),
                        fmt::format("({}, {}, {})", kPrinted[i][0], kPrinted[i][1], kPrinted[i][2]),
                        fmt::format("{:.2f}", deg_from_rad(angle_between_rad(h, {0.0, 0.0, 1.0})))});
  }
  return out;
}

render::Table merit_table(const FiguresOfMerit& f) {
  render::Table out;
  out.title = "Figures of merit";
  out.head = {"figure", "value", "meaning"};
  const auto row = [&out](const char* name, const std::string& value, const char* meaning) {
    out.rows.push_back({name, value, meaning});
  };
  row("noise gain (GDOP)", fmt::format("{:.4f}", f.gdop),
      "noise of the vector over noise of a sensor; 1.5 is the best that four can do");
  row("condition of the axes", fmt::format("{:.4f}", f.condition), "1: every direction is measured equally well");
  row("nearest two axes", fmt::format("{:.2f} deg", deg_from_rad(f.nearest_angle_rad)),
      "between measurement lines; the larger, the easier to tell sensors apart");
  row("smallest |det| of a triple", fmt::format("{:.4f}", f.min_triple_det), "1: orthogonal, 0: in one plane");
  row("worst condition of a triple", fmt::format("{:.4f}", f.max_triple_condition),
      "loss of accuracy when one sensor is excluded");
  row("visibility of a common bias in parity", fmt::format("{:.4f}", f.common_bias_visibility),
      "0: a bias common to all sensors is invisible; 1: it is fully visible");
  row("confirmed grade", fmt::format("{}", f.confirmed_grade), "faulty sensors that can be excluded with confirmation");
  row("provisional grade", fmt::format("{}", f.provisional_grade),
      "faulty sensors that can be excluded provisionally, without knowing gravity");
  return out;
}

render::Table triple_table(const SensorArray& array) {
  render::Table out;
  out.title = "Triples, eqs (18) to (21)";
  out.head = {"sensors", "determinant", "condition"};
  for (int k = 0; k < array.triple_count(); ++k) {
    const Triple& t = array.triple(k);
    out.rows.push_back({study::name_of(t.set()), fmt::format("{:.5f}", t.det), fmt::format("{:.4f}", t.condition)});
  }
  out.note = "All four have the same quality; only a sign differs. Any one sensor may fail.";
  return out;
}

nlohmann::ordered_json facts_of(const SensorArray& array, const FiguresOfMerit& f) {
  nlohmann::ordered_json out = io::object({{"gdop", f.gdop},
                                           {"condition", f.condition},
                                           {"nearest_angle_deg", deg_from_rad(f.nearest_angle_rad)},
                                           {"min_triple_det", f.min_triple_det},
                                           {"max_triple_condition", f.max_triple_condition},
                                           {"common_bias_visibility", f.common_bias_visibility},
                                           {"confirmed_grade", f.confirmed_grade},
                                           {"provisional_grade", f.provisional_grade}});
  for (auto& value : out) {
    if (value.is_number_float()) value = std::stod(fmt::format("{:.9g}", value.get<double>()));
  }
  nlohmann::ordered_json triples = nlohmann::ordered_json::array();
  for (int k = 0; k < array.triple_count(); ++k) {
    const Triple& t = array.triple(k);
    triples.push_back(io::object({{"sensors", study::name_of(t.set())},
                                  {"det", std::stod(fmt::format("{:.9g}", t.det))},
                                  {"condition", std::stod(fmt::format("{:.9g}", t.condition))}}));
  }
  out["triples"] = triples;
  return out;
}

}  // namespace

io::FileExpected<DemoSection> demo_geometry(const DemoContext& context) {
  const Expected<SensorArray> array = context.tool.datasheet.array();
  if (!array) return study_failed(describe(array.error().code));
  const FiguresOfMerit f = figures_of_merit(*array);
  DemoSection out;
  out.chapter.id = "geometry";
  out.chapter.title = "1 The geometry";
  out.chapter.gist = "The axes of the paper's tool, and which faults they can detect and isolate.";
  out.chapter.text = {
      "Four accelerometers measure along four skewed axes: three on a cone about the axis of the tool, the fourth "
      "along it. Three of them are enough for a vector. The fourth gives one check: the readings of a1, a2 and a3 "
      "must add up to that of a4. One check detects a fault but does not isolate the sensor.",
      "The length of gravity is the second check: of the four triples only the one without the faulty sensor gives "
      "it at every attitude. This is the paper's idea, and the reason why several attitudes are needed below."};
  io::FileExpected<render::Picture> picture = draw(
      context.out, "geometry", [&array](bool narrow) { return script_of(*array, narrow); }, "Axes of the paper's tool",
      "The four axes in the frame of the tool. Gravity is measured along each of them.");
  if (!picture) return tl::unexpected<io::FileError>(picture.error());
  out.chapter.pictures.push_back(*std::move(picture));
  out.chapter.tables = {axes_table(*array), merit_table(f), triple_table(*array)};
  link_drawn(out.chapter, "geometry", "the axes");
  out.facts = facts_of(*array, f);
  out.console = fmt::format(
      "1 geometry: 4 axes, noise gain {:.3f}, nearest axes {:.1f} deg apart, every |det| of a triple >= {:.3f}\n",
      f.gdop, deg_from_rad(f.nearest_angle_rad), f.min_triple_det);
  return out;
}

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb

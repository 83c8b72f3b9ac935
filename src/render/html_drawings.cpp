// The two drawings that need no plotting program: axes in space, and the states.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <map>

#include "html_view.hpp"
#include "markup.hpp"
#include "plumb/core/units.hpp"
#include "plumb/io/json_fields.hpp"
#include "plumb/render/plot.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {
namespace {

struct Point {
  double x = 0.0, y = 0.0;
};

/// Seen from azimuth 30 deg, 25 deg above the xy plane, z downwards.
Point seen(double x, double y, double z) {
  constexpr double kSize = 150.0;
  const double a = rad_from_deg(30.0), e = rad_from_deg(25.0);
  const double right = -x * std::sin(a) + y * std::cos(a), near = x * std::cos(a) + y * std::sin(a);
  return {320.0 + kSize * right, 170.0 + kSize * (z * std::cos(e) + near * std::sin(e))};
}

std::string line(Point a, Point b, const std::string& style) {
  return fmt::format("<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" {}/>\n", a.x, a.y, b.x, b.y, style);
}

std::string text_at(Point p, const std::string& text, const std::string& style) {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" {}>{}</text>\n", p.x, p.y, style, in_markup(text));
}

constexpr std::array<const char*, 6> kAxisColours = {"#2f78b7", "#d0553c", "#2c8f57", "#b97a00", "#8f55c4", "#1f8a99"};

/// The states stand on an ellipse, in the order of the table.
struct Ellipse {
  double x, y, half_width, half_height, all_width, all_height;
  double first_rad;  ///< where the first state stands

  Point place(std::size_t k, std::size_t of) const {
    const double angle = first_rad + 2.0 * kPi * static_cast<double>(k) / static_cast<double>(of);
    return {x + half_width * std::cos(angle), y + half_height * std::sin(angle)};
  }
};
constexpr Ellipse kDesk{400.0, 235.0, 290.0, 185.0, 800.0, 470.0, -0.5 * kPi};
/// None of the states beside another.
constexpr Ellipse kPhone{200.0, 255.0, 112.0, 225.0, 400.0, 510.0, -0.5 * kPi + kPi / 14.0};

/// A bow from one state to another; the way back takes the other side.
std::string bow(Point a, Point b, double width, double opacity) {
  const double dx = b.x - a.x, dy = b.y - a.y, length = std::hypot(dx, dy);
  const Point middle{0.5 * (a.x + b.x) - 0.14 * dy, 0.5 * (a.y + b.y) + 0.14 * dx};
  const auto towards = [](Point from, Point to, double by) {
    const double d = std::hypot(to.x - from.x, to.y - from.y);
    return Point{from.x + by * (to.x - from.x) / d, from.y + by * (to.y - from.y) / d};
  };
  if (!(length > 0.0)) return "";
  const Point start = towards(a, middle, 44.0), end = towards(b, middle, 48.0), tip = towards(b, middle, 38.0);
  const double ux = (tip.x - end.x) / 10.0, uy = (tip.y - end.y) / 10.0;
  return fmt::format(
      "<path d=\"M{:.1f} {:.1f} Q{:.1f} {:.1f} {:.1f} {:.1f}\" fill=\"none\" stroke=\"currentColor\" "
      "stroke-width=\"{:.1f}\" opacity=\"{}\"/>\n"
      "<path d=\"M{:.1f} {:.1f} L{:.1f} {:.1f} L{:.1f} {:.1f} Z\" fill=\"currentColor\" opacity=\"{}\"/>\n",
      start.x, start.y, middle.x, middle.y, end.x, end.y, width, opacity, tip.x, tip.y, end.x - 4.5 * uy,
      end.y + 4.5 * ux, end.x + 4.5 * uy, end.y - 4.5 * ux, opacity);
}

const char* colour_of_state(const std::string& state) {
  for (const HealthState s : {HealthState::nominal, HealthState::suspect, HealthState::isolated,
                              HealthState::degraded_3_sensor, HealthState::recalibrating, HealthState::failed}) {
    if (state == to_string(s)) return colour_of(s);
  }
  return "#777777";
}

}  // namespace

std::string axes_svg(const Json& array) {
  std::string out =
      "<svg viewBox=\"110 60 430 310\" font-family=\"sans-serif\" font-size=\"15\" fill=\"currentColor\">\n";
  const std::string faint = "stroke=\"currentColor\" opacity=\"0.45\"";
  const Point origin = seen(0, 0, 0);
  for (int turn = 0; turn < 72; ++turn) {
    const double a = rad_from_deg(5.0 * turn), b = rad_from_deg(5.0 * (turn + 1));
    out += line(seen(std::cos(a), std::sin(a), 0), seen(std::cos(b), std::sin(b), 0), faint);
  }
  out += line(origin, seen(1.25, 0, 0), faint) + text_at(seen(1.35, 0, 0), "x", "opacity=\"0.7\"");
  out += line(origin, seen(0, 1.25, 0), faint) + text_at(seen(0, 1.3, 0), "y", "opacity=\"0.7\"");
  out += line(origin, seen(0, 0, 1.25), faint) + text_at(seen(0, 0.04, 1.3), "z", "opacity=\"0.7\"");
  std::size_t k = 0;
  for (const Json& sensor : array["sensors"]) {
    const double x = sensor["axis"][0], y = sensor["axis"][1], z = sensor["axis"][2];
    const std::string colour = kAxisColours[k++ % kAxisColours.size()];
    const Point tip = seen(x, y, z), foot = seen(x, y, 0);
    out += line(tip, foot, "stroke=\"" + colour + "\" stroke-dasharray=\"3 4\"") +
           line(origin, foot, "stroke=\"" + colour + "\" stroke-dasharray=\"3 4\"");
    out += line(origin, tip, "stroke=\"" + colour + "\" stroke-width=\"3\"");
    out += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"5\" fill=\"{}\"/>\n", tip.x, tip.y, colour);
    out += text_at({tip.x + (tip.x < 320.0 ? -10.0 : 10.0), tip.y + 5.0}, sensor["id"],
                   std::string("font-weight=\"bold\" text-anchor=\"") + (tip.x < 320.0 ? "end" : "start") + "\"");
  }
  return out + "</svg>";
}

std::string machine_svg(const Json& machine, bool narrow) {
  const Ellipse& ellipse = narrow ? kPhone : kDesk;
  std::string out =
      fmt::format("<svg viewBox=\"0 0 {} {}\" font-family=\"sans-serif\" font-size=\"{}\" fill=\"currentColor\">\n",
                  ellipse.all_width, ellipse.all_height, narrow ? 13 : 14);
  std::map<std::string, std::size_t> number;
  for (const Json& mode : machine["modes"]) {
    const std::size_t next = number.size();
    number[mode["mode"]] = next;
  }
  std::map<std::pair<std::size_t, std::size_t>, std::uint64_t> moves;
  for (const Json& cell : machine["cells"]) {
    if (cell["kind"] != "taken") continue;
    for (const Json& to : cell["leads_to"]) {
      const std::pair<std::size_t, std::size_t> move{number[cell["mode"]], number[to]};
      if (move.first != move.second) moves[move] += 0;
    }
  }
  if (!machine["coverage"].is_null()) {
    for (const Json& move : machine["coverage"]["moves"])
      moves[{number[move["from"]], number[move["to"]]}] += move["count"].get<std::uint64_t>();
  }
  for (const auto& [ends, count] : moves)
    out += bow(ellipse.place(ends.first, number.size()), ellipse.place(ends.second, number.size()),
               count > 0 ? 3.0 : 1.0, count > 0 ? 1.0 : 0.35);
  for (const Json& mode : machine["modes"]) {
    const Point p = ellipse.place(number[mode["mode"]], number.size());
    const std::string colour = colour_of_state(mode["state"]);
    const bool brief = mode["mode"].get<std::string>().size() < 12;
    const double width = brief ? 108.0 : narrow ? 160.0 : 178.0;
    out += fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{}\" height=\"36\" rx=\"9\" fill=\"{}\"/>\n",
                       p.x - 0.5 * width, p.y - 18.0, width, colour);
    out += text_at({p.x, p.y + 5.0}, mode["mode"], "text-anchor=\"middle\" fill=\"#ffffff\" font-weight=\"bold\"");
  }
  return out + "</svg>";
}

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb

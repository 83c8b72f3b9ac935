// A chart by gnuplot made fit to stand inside a page, on a screen and on paper.
#include <fmt/format.h>

#include <array>
#include <cstring>
#include <nlohmann/json.hpp>
#include <sstream>

#include "markup.hpp"
#include "plumb/render/plot.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {
namespace {

constexpr const char* kDownwards = " rotate(180)";
constexpr const char* kOnItsCorner = " rotate(45)";
constexpr const char* kSquare = "d='M-1,-1 h2 v2 h-2 z'";
constexpr const char* kCircle = "d='M-1,0 a1,1 0 1,0 2,0 a1,1 0 1,0 -2,0 z'";
constexpr const char* kTriangle = "d='M0,-1.33 L-1.33,0.67 L1.33,0.67 z'";
constexpr const char* kPentagon = "d='M0,1.330 L1.265,0.411 L0.782,-1.067 L-0.782,-1.076 L-1.265,0.411 z'";

struct PointType {
  const char* shape;
  bool filled;
  const char* turned;
};
/// gnuplot's point types, in its order.
constexpr std::array<PointType, 15> kPointTypes = {{{"d='M-1,0 h2 M0,-1 v2'", false, ""},
                                                    {"d='M-1,-1 L1,1 M1,-1 L-1,1'", false, ""},
                                                    {"d='M-1,0 h2 M0,-1 v2 M-1,-1 L1,1 M-1,1 L1,-1'", false, ""},
                                                    {kSquare, false, ""},
                                                    {kSquare, true, ""},
                                                    {kCircle, false, ""},
                                                    {kCircle, true, ""},
                                                    {kTriangle, false, ""},
                                                    {kTriangle, true, ""},
                                                    {kTriangle, false, kDownwards},
                                                    {kTriangle, true, kDownwards},
                                                    {kSquare, false, kOnItsCorner},
                                                    {kSquare, true, kOnItsCorner},
                                                    {kPentagon, false, ""},
                                                    {kPentagon, true, ""}}};

/// The value of an attribute of one tag; empty where it has none.
std::string tag_attribute(const std::string& tag, const char* name) {
  const std::string begins = std::string(" ") + name + "='";
  const std::size_t at = tag.find(begins);
  if (at == std::string::npos) return "";
  const std::size_t from = at + begins.size();
  return tag.substr(from, tag.find('\'', from) - from);
}

/// The mark that a <use> stands for, with its colour; the tag itself where it refers to something else.
std::string plain_mark(const std::string& tag) {
  constexpr const char* kName = "#gpPt";
  const std::string name = tag_attribute(tag, "xlink:href"), place = tag_attribute(tag, "transform");
  if (place.empty() || name.rfind(kName, 0) != 0) return tag;
  const std::size_t type = std::stoul(name.substr(std::strlen(kName)));
  if (type >= kPointTypes.size()) return tag;
  const PointType& mark = kPointTypes.at(type);
  const std::string colour = tag_attribute(tag, "color");
  return fmt::format("<path class='m' transform='{}{}' {} {}/>", place, mark.turned, mark.shape,
                     mark.filled ? fmt::format("fill='{}' stroke='none'", colour)
                                 : fmt::format("fill='none' stroke='{}' stroke-width='0.178'", colour));
}

std::string with_plain_marks(const std::string& svg) {
  std::string out;
  std::size_t from = 0;
  for (std::size_t at = svg.find("<use "); at != std::string::npos; at = svg.find("<use ", from)) {
    const std::size_t end = svg.find("/>", at);
    if (end == std::string::npos) break;
    out += svg.substr(from, at - from) + plain_mark(svg.substr(at, end + 2 - at));
    from = end + 2;
  }
  return out + svg.substr(from);
}

void drop_parts(std::string& text, const std::string& from, const std::string& to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at)) {
    const std::size_t end = text.find(to, at + from.size());
    if (end == std::string::npos) return;
    text.erase(at, end + to.size() - at);
  }
}

/// One axis: where it begins and ends on the picture, its values there, whether they are logarithmic, its name.
nlohmann::json told_axis(std::istream& numbers, const std::string& name) {
  double from = 0.0, to = 0.0, low = 0.0, high = 0.0;
  int log = 0;
  const auto pair = [&numbers](double& a, double& b) { numbers >> a >> b; };
  pair(from, to);
  pair(low, high);
  numbers >> log;
  return {from, to, low, high, log, name};
}

std::string told_axes(const std::string& told) {
  nlohmann::json out = nlohmann::json::array();
  std::istringstream lines(told);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t x = line.find('|'), y = line.find('|', x + 1);
    if (x == std::string::npos || y == std::string::npos) continue;
    std::istringstream numbers(line.substr(0, x));
    nlohmann::json panel;
    panel["x"] = told_axis(numbers, line.substr(x + 1, y - x - 1));
    panel["y"] = told_axis(numbers, line.substr(y + 1));
    if (numbers) out.push_back(std::move(panel));
  }
  return out.dump();
}

}  // namespace

std::string inline_svg(const std::string& svg, const std::string& axes) {
  const std::size_t begin = svg.find("<svg");
  if (begin == std::string::npos) return "";
  std::string out = svg.substr(begin);
  drop_parts(out, "<title>", "</title>");
  drop_parts(out, "<desc>", "</desc>");
  drop_parts(out, "xmlns=\"", "\"");
  drop_parts(out, "xmlns:xlink=\"", "\"");
  // What stands here is defined for the marks, and for boxed labels, which have a filter.
  if (out.find("<defs>") != std::string::npos) {
    const std::size_t defined = out.find("</defs>");
    if (out.find("url(#", defined) == std::string::npos && out.find("'#gpDot'", defined) == std::string::npos) {
      out.erase(out.find("<defs>"), defined + std::strlen("</defs>") - out.find("<defs>"));
    }
  }
  out = with_plain_marks(out);
  replace_all(out, "rgb(  0,   0,   0)", "currentColor");
  replace_all(out, "\"black\"", "\"currentColor\"");
  replace_all(out, "'black'", "'currentColor'");
  if (!axes.empty()) out.insert(std::strlen("<svg"), " data-axes=\"" + in_markup(told_axes(axes)) + "\"");
  return out;
}

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb

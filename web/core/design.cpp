// The first view of the page: a geometry, and what `plumb geometry` says of it.
#include <fmt/format.h>

#include <charconv>
#include <cmath>

#include "explorer.hpp"
#include "plumb/array/named.hpp"
#include "plumb/core/units.hpp"
#include "plumb/findings/geometry_study.hpp"
#include "plumb/io/json_fields.hpp"
#include "plumb/render/geometry_report.hpp"
#include "reading.hpp"

namespace plumb_web {

using namespace plumb;

namespace {

std::size_t slot(int i) { return static_cast<std::size_t>(i); }

/// One cell of the map over inclination and toolface; null where nothing is guaranteed at all.
io::Json map_of(const findings::GeometryStudy& study) {
  io::Json out = io::Json::array();
  for (const findings::AttitudePoint& point : study.map) {
    io::Json cell = io::Json::array();
    cell.push_back(point.inclination_deg);
    cell.push_back(point.toolface_deg);
    cell.push_back(io::finite_or_null(point.guaranteed_above_g0));
    cell.push_back(point.not_guaranteed_sensors);
    out.push_back(std::move(cell));
  }
  return out;
}

}  // namespace

std::string refusal(const std::string& text) { return io::object({{"error", text}}).dump(); }

std::string builtin_axes(const std::string& name) {
  AxisList axes{};
  int n = 0;
  const std::size_t colon = name.find(':');
  const std::string kind = name.substr(0, colon);
  int count = 0;
  if (colon != std::string::npos) std::from_chars(name.data() + colon + 1, name.data() + name.size(), count);
  if (name == "paper-tetrahedron") n = paper_tetrahedron(axes);
  if (name == "triad") n = orthogonal_triad(axes);
  const bool fits = count >= 3 && count <= kCapacity;
  if (fits && kind == "cone") n = cone(axes, count);
  if (fits && kind == "cone-axis") n = cone_with_axis(axes, count);
  if (fits && kind == "platonic") n = platonic(axes, count);
  if (n == 0) {
    return refusal(
        fmt::format("\"{}\" is not a built-in geometry. Remedy: choose a number of sensors that it has, from "
                    "3 to {}",
                    name, kCapacity));
  }
  io::Json out = io::Json::array();
  for (int i = 0; i < n; ++i) out.push_back(axes[slot(i)]);
  return out.dump();
}

std::string study(const std::string& design) {
  const json read = json::parse(design, nullptr, false);
  AxisList axes{};
  const int n = read.is_object() ? read_axes(read, axes) : 0;
  if (n == 0) return refusal(axes_wanted());
  std::array<SensorRow, kCapacity> rows{};
  for (int i = 0; i < n; ++i) {
    const double length = norm(axes[slot(i)]);
    if (!(length > 1e-6))
      return refusal(fmt::format("axis a{} has no direction. Remedy: change one of its numbers", i + 1));
    rows[slot(i)].id = make_id(fmt::format("a{}", i + 1).c_str());
    rows[slot(i)].axis = axes[slot(i)];
    rows[slot(i)].sigma_mps2 = number(read, "noise_mps2", 2e-4 * kG0_mps2);
    if (std::fabs(length - 1.0) > 1e-9) rows[slot(i)].axis = scaled(axes[slot(i)], 1.0 / length);
  }
  const Expected<SensorArray> array = SensorArray::make(rows.data(), n);
  if (!array) return refused(array.error());
  findings::GeometrySubject subject;
  const auto name = read.find("name");
  subject.name = name != read.end() && name->is_string() ? name->get<std::string>() : "design";
  subject.array = *array;
  subject.settings.samples = number(read, "samples", subject.settings.samples);
  const findings::GeometryStudy found = findings::study_geometry(subject);
  const std::string text = render::geometry_json(subject, found);
  if (number(read, "map", 0.0) == 0.0) return text;
  io::Json with_map = io::parsed(text);
  with_map["map"] = map_of(found);
  return with_map.dump();
}

}  // namespace plumb_web

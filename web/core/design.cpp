// The first view of the page: a geometry, and what `plumb geometry` says of it.
#include <fmt/format.h>

#include <charconv>
#include <cmath>

#include "explorer.hpp"
#include "plumb/array/named.hpp"
#include "plumb/core/units.hpp"
#include "plumb/findings/geometry_study.hpp"
#include "plumb/io/json_fields.hpp"
#include "plumb/motion/motion_evidence.hpp"
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
  const ChipList chips = read_chips(read);
  const double noise_mps2 = number(read, "noise_mps2", 2e-4 * kG0_mps2);
  std::array<SensorRow, kCapacity> rows{};
  for (int i = 0; i < n; ++i) {
    const double length = norm(axes[slot(i)]);
    if (!(length > 1e-6))
      return refusal(fmt::format("axis a{} has no direction. Remedy: change one of its numbers", i + 1));
    rows[slot(i)] = row_of(axes, chips, i, noise_mps2);
  }
  const Expected<SensorArray> array = SensorArray::make(rows.data(), n);
  if (!array) return refused(array.error());
  findings::GeometrySubject subject;
  const auto name = read.find("name");
  subject.name = name != read.end() && name->is_string() ? name->get<std::string>() : "design";
  subject.array = *array;
  subject.settings.samples = number(read, "samples", subject.settings.samples);
  const findings::GeometryStudy found = findings::study_geometry(subject);
  io::Json out = io::parsed(render::geometry_json(subject, found));
  // In motion parity alone isolates, and of so many sensors that all sets of four can be tested.
  if (n <= kMotionCapacity) {
    out["motion_grade"] = motion_grade(*array, array->all());
  } else {
    out["motion_grade"] = nullptr;
  }
  if (number(read, "map", 0.0) != 0.0) out["map"] = map_of(found);
  return out.dump();
}

}  // namespace plumb_web

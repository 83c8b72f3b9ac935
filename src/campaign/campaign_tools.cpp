// [[tool]] and [[attitude]] of the campaign file.
#include <cmath>

#include "../io/array_parts.hpp"
#include "campaign_parts.hpp"
#include "plumb/array/geometry.hpp"
#include "plumb/array/named.hpp"
#include "plumb/core/units.hpp"
#include "plumb/detection/detectable.hpp"
#include "plumb/detection/set_test.hpp"
#include "plumb/io/array_file.hpp"
#include "plumb/scenario/attitude.hpp"
#include "plumb/scenario/count_text.hpp"

namespace plumb {
namespace campaign {
namespace {

using io::Quantity;
using io::TomlTable;
using std::size_t;

constexpr int kMostBehindARow = 1000000;
/// A bias of this many MDB is missed by the parity test of one block in one case of a thousand.
constexpr double kMissed = 1e-3;

const std::vector<std::string>& geometries() {
  static const std::vector<std::string> names = {"tetrahedron", "triad", "cone", "cone-with-axis", "platonic"};
  return names;
}

int axes_of(int geometry, int sensors, AxisList& axes) {
  switch (geometry) {
    case 0: return paper_tetrahedron(axes);
    case 1: return orthogonal_triad(axes);
    case 2: return cone(axes, sensors);
    case 3: return cone_with_axis(axes, sensors);
    default: return platonic(axes, sensors);
  }
}

/// What the sensors state: `stability` comes with the usual one, and is that of an array file where it states any.
using StabilityOfAll = std::array<Stability, kCapacity>;

/// Magnetometers in a campaign of gravity, or the other way round.
[[noreturn]] void refuse_field(const TomlTable& table, const io::ArrayFile& file) {
  const bool magnetic = table.field_of() == io::FieldKind::magnetic;
  const bool rate = file.field == io::FieldKind::rate;
  table.fail(table.line_of("array"), "array",
             std::string("is of ") + io::units_of(file.field).sensor + "s, and this campaign is of " +
                 io::units_of(table.field_of()).vector,
             rate ? "a rate has no length to judge by; plumb geometry and plumb monitor --group serve gyros"
             : magnetic
                 ? "name a magnetic group of the file, \"tool.toml#mag\", or remove field = \"magnetic\""
                 : "set field = \"magnetic\" at the top of the campaign, or name the file without #" + file.group);
}

SensorArray array_from(const TomlTable& table, const io::FieldLookup& lookup, ToolPlan& tool,
                       StabilityOfAll& stability) {
  if (table.has("array")) {
    if (table.has("geometry"))
      table.fail(table.line_of("geometry"), "geometry", "and array both name axes", "keep one of the two");
    const io::FileExpected<io::ArrayFile> file = io::read_array_file(table.text("array", ""), lookup);
    if (!file) {
      table.fail(table.line_of("array"), "array", "cannot be used: " + file.error().text(),
                 "give the path of an array file, relative to the directory in which plumb runs");
    }
    if (file->field != table.field_of()) refuse_field(table, *file);
    tool.name = table.text("name", file->name);
    for (size_t i = 0; i < stability.size(); ++i) {
      if (file->stability[i].stated()) stability[i] = file->stability[i];
    }
    return file->array;
  }
  table.need("geometry", "give the axes: geometry = \"cone\" with sensors = 5, or array = \"my_tool.toml\"");
  const int geometry = table.choice("geometry", geometries(), 0);
  const int natural = geometry == 0 ? 4 : geometry == 1 ? 3 : 6;
  const int sensors = whole(table, "sensors", natural, 3, kMostSensors);
  AxisList axes{};
  const int made = axes_of(geometry, sensors, axes);
  if (made != sensors) {
    table.fail(
        table.line_of("sensors"), "sensors", "this geometry cannot have " + count_text(sensors, "sensor"),
        "give 4 for tetrahedron, 3 for triad, 4 or more for cone and cone-with-axis, 3, 4, 6 or 10 for platonic");
  }
  tool.name = table.text("name", geometries()[static_cast<size_t>(geometry)] + std::to_string(sensors));
  const std::string example = table.field_of() == io::FieldKind::magnetic ? "\"20 nT\"" : "\"0.2 mg0\"";
  const double sigma_mps2 =
      table.need_quantity(Quantity::acceleration, "noise", "give the noise of one sample, 1 sigma: noise = " + example);
  if (!(sigma_mps2 > 0.0)) table.fail(table.line_of("noise"), "noise", "is not above zero", "give it as " + example);
  std::array<SensorRow, kCapacity> rows{};
  for (int i = 0; i < sensors; ++i) {
    SensorRow& row = rows[static_cast<size_t>(i)];
    row.id = make_id(("a" + std::to_string(i + 1)).c_str());
    row.axis = axes[static_cast<size_t>(i)];
    row.sigma_mps2 = sigma_mps2;
  }
  const Expected<SensorArray> array = SensorArray::make(rows.data(), sensors);
  if (!array) table.fail(table.line(), "geometry", describe(array.error().code), remedy(array.error().code));
  return *array;
}

/// MDB of every sensor: noise alone, at the mean of one block.
void fill_detectable(const SensorArray& array, const MonitorConfig& monitor, ToolPlan& tool) {
  const TestLimits limits = TestLimits::from_rates(array.size(), monitor.false_alarm_rate, monitor.rejection_rate);
  const int rows = array.size() - 3;
  if (rows < 1) return;
  const double shift = detectable_shift(limits.parity_alarm[static_cast<size_t>(rows)], rows, kMissed);
  const LeastSquares map = least_squares(array, array.all());
  for (int i = 0; i < array.size(); ++i) {
    const auto a = static_cast<size_t>(i);
    const double leverage = 1.0 - dot(array.axis(i), map.column[a]);
    if (!(leverage > 1e-9)) continue;  // no other sensor checks this one
    tool.detectable_mps2[a] = shift * tool.sigma_mps2[a] / std::sqrt(leverage * monitor.window);
  }
}

}  // namespace

std::vector<ToolPlan> read_tools(const TomlTable& top, const MonitorConfig& monitor, const Stability& usual,
                                 const io::FieldLookup& lookup) {
  std::vector<ToolPlan> out;
  const std::vector<std::string> keys =
      io::with_stability_keys({"name", "geometry", "sensors", "noise", "array", "resolution", "samples_per_row"});
  for (const TomlTable& table : tables_of(top, "tool", keys)) {
    ToolPlan tool;
    StabilityOfAll stability{};
    stability.fill(usual);
    const SensorArray array = array_from(table, lookup, tool, stability);
    tool.sensors = array.size();
    // A row that is the mean of so many samples scatters less than one of them.
    const double shrink = std::sqrt(static_cast<double>(whole(table, "samples_per_row", 1, 1, kMostBehindARow)));
    for (int i = 0; i < array.size(); ++i) {
      tool.axis[static_cast<size_t>(i)] = array.axis(i);
      tool.chip[static_cast<size_t>(i)] = array.row(i).chip;
      tool.sigma_mps2[static_cast<size_t>(i)] = array.sigma_mps2(i) / shrink;
      const Stability own = io::read_stability(table, stability[static_cast<size_t>(i)]);
      tool.stability[static_cast<size_t>(i)] = {own.mps2, own.per_day_mps2, own.per_degc_mps2,
                                                own.per_degc_per_min_mps2};
    }
    tool.volt_per_mps2 = 3.0 / kG0_mps2;  // the paper's sensors; of magnetometers 3 V are at 39.2266 uT
    tool.resolution_raw = tool.volt_per_mps2 * table.quantity(Quantity::acceleration, "resolution", 0.0);
    tool.grade = confirmed_grade(array, array.all());
    fill_detectable(array, monitor, tool);
    out.push_back(tool);
  }
  if (out.empty()) {
    top.fail(0, "tool", "is missing", "add a table [[tool]] with geometry = \"tetrahedron\" and noise = \"0.2 mg0\"");
  }
  return out;
}

std::vector<AttitudePlan> read_attitudes(const TomlTable& top) {
  const std::vector<std::string> laws = {"random", "roll-test", "drilling-path", "fixed"};
  std::vector<AttitudePlan> out;
  for (const TomlTable& table :
       tables_of(top, "attitude",
                 {"law", "name", "inclination", "toolface", "build", "turn", "toolface_step", "toolface_jitter"})) {
    AttitudePlan plan;
    const int law = table.need_choice("law", laws, "give one of random, roll-test, drilling-path, fixed");
    plan.kind = static_cast<AttitudeKind>(law);
    plan.name = table.text("name", laws[static_cast<size_t>(law)]);
    const double usual_deg = plan.kind == AttitudeKind::drilling_path ? 5.0 : 90.0;
    plan.inclination_rad = table.quantity(Quantity::angle, "inclination", rad_from_deg(usual_deg));
    plan.build_rad = table.quantity(Quantity::angle, "build", rad_from_deg(55.0 / 13.0));
    plan.turn_rad = table.quantity(Quantity::angle, "turn", rad_from_deg(1.5));
    plan.toolface_step_rad = table.quantity(Quantity::angle, "toolface_step", rad_from_deg(137.5));
    plan.toolface_jitter_rad = table.quantity(Quantity::angle, "toolface_jitter", 0.0);
    const double toolface_rad = table.quantity(Quantity::angle, "toolface", 0.0);
    for (const double angle : {plan.inclination_rad, plan.build_rad, plan.turn_rad, plan.toolface_step_rad,
                               plan.toolface_jitter_rad, toolface_rad}) {
      if (!(std::fabs(angle) <= 1e3)) table.fail(table.line(), "law", "has an angle beyond 1000 rad", "give it in deg");
    }
    plan.direction = scenario::gravity_direction({plan.inclination_rad, 0.0, toolface_rad});
    out.push_back(plan);
  }
  if (out.empty()) out.push_back({AttitudeKind::random, "random", 0.0, 0.0, 0.0, 0.0, 0.0, {}});
  return out;
}

}  // namespace campaign
}  // namespace plumb

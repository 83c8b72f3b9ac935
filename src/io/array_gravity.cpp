#include <cmath>
#include <vector>

#include "array_parts.hpp"
#include "refusal.hpp"
#include "text_tools.hpp"
#include "toml_table.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {
namespace {

const std::vector<std::string>& known_models() {
  static const std::vector<std::string> names = {"normal", "paper", "value", "table"};
  return names;
}

const std::vector<std::string>& known_keys() {
  static const std::vector<std::string> names = {"model",  "latitude", "elevation", "depth",
                                                 "layers", "value",    "sigma",     "table"};
  return names;
}

/// A key that the chosen model does not use is a sign of a misunderstanding, so it is refused.
void refuse_unused(const TomlTable& table, const std::string& model, const std::vector<std::string>& used) {
  for (const auto& member : table.node().members) {
    bool known = member.first == "model" || member.first == "sigma";
    for (const std::string& key : used) known = known || key == member.first;
    if (!known) {
      table.fail(member.second.line, member.first, "is not used by model \"" + model + "\"",
                 "remove it, or choose another model; this model uses: " + joined(used) + ", sigma");
    }
  }
}

/// Puts file, line and field to an Error of gravity.hpp; `keys` by its index.
GravityReference checked(const TomlTable& table, const Expected<GravityReference>& gravity,
                         const std::vector<std::string>& keys) {
  if (gravity) return *gravity;
  const Error& error = gravity.error();
  const bool known = error.index >= 0 && static_cast<std::size_t>(error.index) < keys.size();
  const std::string key = known ? keys[static_cast<std::size_t>(error.index)] : "";
  const FileError words = from_error(error);
  table.fail(table.line_of(key.c_str()), key, words.what, words.remedy);
}

const std::vector<std::string>& fields_by_index() {
  static const std::vector<std::string> names = {"latitude", "elevation", "depth", "layers", "layers", "sigma"};
  return names;
}

GravityReference normal(const TomlTable& table, double sigma_mps2, std::optional<NormalGravityInput>& asked) {
  refuse_unused(table, "normal", {"latitude", "elevation", "depth", "layers"});
  NormalGravityInput in;
  in.latitude_deg = deg_from_rad(table.need_quantity(
      Quantity::angle, "latitude", "give latitude = \"60 deg\", or model = \"value\" with value = \"9.81 m/s^2\""));
  in.elevation_m = table.quantity(Quantity::length, "elevation", 0.0);
  in.depth_m = table.quantity(Quantity::length, "depth", 0.0);
  in.sigma_mps2 = sigma_mps2;
  const std::string form = "write layers = [{thickness = \"500 m\", density = \"1030 kg/m^3\"}, ...]";
  if (const TomlNode* layers = table.find("layers"); layers != nullptr) {
    if (layers->kind != TomlNode::Kind::array) table.fail(layers->line, "layers", "must be a list of tables", form);
    if (layers->items.size() > in.layers.size()) {
      table.fail(layers->line, "layers", "has more than " + std::to_string(in.layers.size()) + " layers",
                 "join neighbouring layers of similar density");
    }
    for (const TomlNode& item : layers->items) {
      const std::string path = "gravity.layers[" + std::to_string(in.layer_count + 1) + "]";
      const TomlTable layer(item, table.file(), path, {"thickness", "density"});
      DensityLayer& out = in.layers[static_cast<std::size_t>(in.layer_count++)];
      out.density_kgpm3 = layer.need_quantity(Quantity::density, "density", form);
      out.thickness_m = layer.need_quantity(Quantity::length, "thickness", form);
    }
  }
  asked = in;
  return checked(table, normal_gravity(in), fields_by_index());
}

/// A length that is given can be checked where the place is given too: beyond this it is a slip. Anomalies stay below
/// 0.06 %, an elevation that was omitted below 0.3 %.
constexpr double kMostOff = 0.003;

GravityReference compared(const TomlTable& table, const char* key, const GravityReference& given) {
  for (const char* about : {"elevation", "depth"}) {
    if (table.has(about) && !table.has("latitude") && table.has("value"))
      table.fail(table.line_of(about), about, "has no effect without latitude", "add latitude, or remove this key");
  }
  if (!table.has("latitude")) return given;
  NormalGravityInput in;
  in.latitude_deg = deg_from_rad(table.need_quantity(Quantity::angle, "latitude", ""));
  in.elevation_m = table.quantity(Quantity::length, "elevation", 0.0);
  in.depth_m = table.quantity(Quantity::length, "depth", 0.0);
  const GravityReference expected = checked(table, normal_gravity(in), fields_by_index());
  const double off = given.g_mps2 / expected.g_mps2 - 1.0;
  if (std::fabs(off) <= kMostOff) return given;
  table.fail(table.line_of(key), key,
             "gravity value is wrong by " + brief(100.0 * std::fabs(off), 2) + " %: the file gives " +
                 brief(given.g_mps2) + " m/s^2, and normal gravity at this latitude is " + brief(expected.g_mps2) +
                 " m/s^2",
             "correct the gravity value or the latitude (and elevation); otherwise every scale factor takes up this "
             "error");
}

GravityReference paper(const TomlTable& table, double sigma_mps2) {
  refuse_unused(table, "paper", {"latitude", "depth"});
  const double latitude_rad = table.need_quantity(Quantity::angle, "latitude", "give latitude = \"60 deg\"");
  return checked(table,
                 paper_gravity(deg_from_rad(latitude_rad), table.quantity(Quantity::length, "depth", 0.0), sigma_mps2),
                 fields_by_index());
}

GravityReference from_table(const TomlTable& table, double sigma_mps2) {
  refuse_unused(table, "table", {"table", "depth", "latitude", "elevation"});
  const std::string form =
      "write table = [{depth = \"0 m\", g = \"9.8125 m/s^2\"}, {depth = \"3 km\", g = \"9.8130 m/s^2\"}]";
  const TomlNode& rows = table.need("table", form);
  if (rows.kind != TomlNode::Kind::array || rows.items.empty())
    table.fail(rows.line, "table", "must be a list of tables", form);
  std::vector<double> depth_m;
  std::vector<double> g_mps2;
  for (const TomlNode& item : rows.items) {
    const TomlTable row(item, table.file(), "gravity.table[" + std::to_string(depth_m.size() + 1) + "]",
                        {"depth", "g"});
    depth_m.push_back(row.need_quantity(Quantity::length, "depth", form));
    g_mps2.push_back(row.need_quantity(Quantity::acceleration, "g", form));
    if (depth_m.size() > 1 && !(depth_m.back() > depth_m[depth_m.size() - 2])) {
      row.fail(row.line(), "depth", "must increase from row to row", "sort the table by depth, with each depth once");
    }
  }
  const double at_m = table.quantity(Quantity::length, "depth", 0.0);
  const auto count = static_cast<int>(depth_m.size());
  return compared(
      table, "table",
      checked(table, table_gravity(depth_m.data(), g_mps2.data(), count, at_m, sigma_mps2), fields_by_index()));
}

}  // namespace

GravityReference read_gravity(const TomlNode& root, const std::string& file,
                              std::optional<NormalGravityInput>& normal_input) {
  const TomlNode* node = root.find("gravity");
  if (node == nullptr) {
    throw Refusal(
        FileError{file, 0, "gravity", "is missing",
                  "add [gravity] with latitude = \"60 deg\" (and elevation, depth), or with model = \"value\" and "
                  "value = \"9.81 m/s^2\""});
  }
  const TomlTable table(*node, file, "gravity", known_keys());
  const double sigma_mps2 = table.quantity(Quantity::acceleration, "sigma", kDefaultGravitySigma_mps2);
  switch (table.choice("model", known_models(), 0)) {
    case 1: return paper(table, sigma_mps2);
    case 2: {
      refuse_unused(table, "value", {"value", "latitude", "elevation", "depth"});
      const double g_mps2 = table.need_quantity(Quantity::acceleration, "value", "give value = \"9.81 m/s^2\"");
      return compared(table, "value",
                      checked(table, given_gravity(g_mps2, sigma_mps2), {"value", "", "", "", "", "sigma"}));
    }
    case 3: return from_table(table, sigma_mps2);
    default: return normal(table, sigma_mps2, normal_input);
  }
}

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb

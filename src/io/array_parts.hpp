/// The parts of `parse_array_text`, one function per section (private to src/io). They throw Refusal.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "plumb/io/array_file.hpp"
#include "toml_table.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {

/// A group of sensors in the file: the file itself for accelerometers, a [[group]] for others.
struct GroupNode {
  const TomlNode& node;
  const std::string& file;
  FieldKind field = FieldKind::gravity;
  std::string prefix;  ///< of its sections in messages: "group[1]."
};

/// `normal`: what the model of that name was asked; of another model none.
GravityReference read_gravity(const TomlNode& root, const std::string& file, std::optional<NormalGravityInput>& normal);
MonitorConfig read_monitor(const GroupNode& group);
/// Of [monitor]: what holds of every sensor that states nothing of its own.
Stability read_usual_stability(const GroupNode& group);
/// The keys of a table that states one, for its list of known keys.
std::vector<std::string> with_stability_keys(std::vector<std::string> names);
/// A figure that the table omits is that of `fallback`.
Stability read_stability(const TomlTable& table, const Stability& fallback);
/// The keys of a sensor that bound what it may be off by in motion, for its list of known keys.
std::vector<std::string> with_motion_keys(std::vector<std::string> names);
/// [motion] and [gyro]; the sensors' bounds are those of [motion], until `read_motion_bounds` has seen their own.
MotionSpec read_motion(const TomlNode& root, const std::string& file, const InputSpec& input);
/// Of one sensor; what it does not state stays as it is. True where it states one.
bool read_motion_bounds(const TomlTable& table, MotionBounds& bounds);
/// All of [input] but the columns of the sensors.
InputSpec read_input(const TomlNode& root, const std::string& file, Reads& reads);
/// Fills `out.datasheet`, `out.array` and the columns; `out.input` and `out.gravity` must be set.
void read_sensors(const GroupNode& group, ArrayFile& out);
/// The keys of a gyro that bound its errors, for its list of known keys.
std::vector<std::string> with_rate_keys(std::vector<std::string> names);
void read_rate_bounds(const TomlTable& table, RateErrors& errors);
/// Every [[group]] of the file, with the layout of the log that `tool` states.
/// A column that a sensor of a group and an accelerometer of `tool` would both read.
void refuse_columns_of(const ArrayFile& tool, const std::vector<ArrayFile>& groups);
/// `group` of [gyro] that is no group of gyros, or whose rates would have to be interpolated.
void refuse_gyros_of(const TomlNode& root, const ArrayFile& tool, const std::vector<ArrayFile>& groups);
std::vector<ArrayFile> read_groups(const TomlNode& root, const ArrayFile& tool, const FieldLookup& lookup);
/// [[clock]], by the sensors, the gyros and [motion] of `out`, which must be set.
void read_clocks(const TomlNode& root, const std::string& file, ArrayFile& out);

/// The whole of it from its tree; throws Refusal. `group`: the name of a [[group]], empty for the accelerometers.
ArrayFile array_of(const TomlNode& root, const std::string& text, const std::string& path,
                   const FieldLookup& lookup = {}, const std::string& group = "");

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb

/// One plain number of a table of motion, whose unit stands in its key (private to src/io).
#pragma once

#include <optional>

#include "toml_table.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {

/// One number: what it may be (as `plumb::check` of a MotionSetup has it), and how it is written.
struct Figure {
  const char* key;
  const char* unit;  ///< empty: a ratio
  double least, most;
  const char* example;
};

/// Of a key that is there. Throws Refusal.
double read_figure(const TomlTable& table, const Figure& figure);

/// What the table does not state stays as it is.
void read_into(const TomlTable& table, const Figure& figure, std::optional<double>& out);
void read_into(const TomlTable& table, const Figure& figure, double& out);

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb

/// --fault, as `plumb inject` and `plumb simulate --flight` take it.
#pragma once

#include <string>
#include <vector>

#include "plumb/io/array_file.hpp"
#include "plumb/io/file_error.hpp"
#include "plumb/scenario/fault.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {

/// A refusal of one.
io::FileError fault_error(std::string what);

/// The faults that these texts name. In the place of a sensor a `package` may stand, where no sensor is called so: all
/// sensors of that chip.
io::FileExpected<std::vector<scenario::Fault>> faults_of(const std::vector<std::string>& texts,
                                                         const io::ArrayFile& array);

/// Those of the array, and of each of its groups: a fault is of the group that has a sensor or a chip of its name.
struct ToolFaults {
  std::vector<scenario::Fault> own;
  std::vector<std::vector<scenario::Fault>> group;  ///< in the order of the array file
};
io::FileExpected<ToolFaults> tool_faults_of(const std::vector<std::string>& texts, const io::ArrayFile& tool);

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb

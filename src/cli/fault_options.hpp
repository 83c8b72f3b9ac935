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

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb

/// A quantity as text that reads back as the same number, bit for bit.
#pragma once

#include <initializer_list>
#include <string>

#include "plumb/io/units.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {

/// "20 mg0": the shortest of the texts in these units that read back as the identical value. The last unit must be the
/// SI unit, whose factor of 1 makes it always exact.
std::string exact_text(Quantity quantity, double si, std::initializer_list<const char*> units);

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb

/// What reading and writing of faults share (private to src/scenario).
#pragma once

#include <string>

#include "fault_kinds.hpp"
#include "plumb/scenario/fault_text.hpp"
#include "quantity_text.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace scenario {

std::string id_of(const FaultContext& context, int sensor);
TextUnits level_units(const FaultContext& context, int sensor);

}  // namespace scenario
}  // namespace PLUMB_ABI
}  // namespace plumb

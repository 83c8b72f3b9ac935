// What the text of a fault means in the log of an array file.
#include "plumb/io/scenario_file.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {

scenario::FaultContext fault_context(const ArrayFile& array) {
  scenario::FaultContext context;
  context.datasheet = array.datasheet;
  switch (array.input.unit.kind) {
    case RawUnit::Kind::voltage: context.raw = scenario::FaultContext::Raw::voltage; break;
    case RawUnit::Kind::count: context.raw = scenario::FaultContext::Raw::count; break;
    case RawUnit::Kind::acceleration: context.raw = scenario::FaultContext::Raw::acceleration; break;
  }
  switch (array.field) {
    case FieldKind::gravity: context.vector = scenario::FaultContext::Vector::gravity; break;
    case FieldKind::magnetic: context.vector = scenario::FaultContext::Vector::magnetic; break;
    case FieldKind::rate: context.vector = scenario::FaultContext::Vector::rate; break;
  }
  context.base_per_raw = array.input.unit.base_per_unit;
  context.raw_unit = array.input.unit.name;
  return context;
}

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb

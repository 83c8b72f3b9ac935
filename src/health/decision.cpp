#include "plumb/health/detail/decision.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

SensorSet move_sensors(Action::Bits actions, const NamedSensors& named, SensorLedger& s) noexcept {
  SensorSet moved;
  if ((actions & Action::exclude) != 0) {
    moved = named.isolated;
    s.excluded = s.excluded | moved;
    // The survivors were just found consistent together, those provisionally excluded before among them: they serve
    // again, however often they were provisionally excluded. Provisional exclusion is not final: beyond its own grade
    // it may meet a healthy sensor time and again, and only the grade that excludes may take a sensor out for good.
    s.in_service = (s.in_service | s.provisionally_excluded) - moved;
    s.provisionally_excluded = SensorSet{};
  }
  if ((actions & Action::exclude_provisionally) != 0) {
    moved = named.suspected & s.in_service;
    s.in_service = s.in_service - moved;
    s.provisionally_excluded = s.provisionally_excluded | moved;
  }
  if ((actions & Action::mark_absent) != 0) {
    moved = named.lost - s.absent;
    s.in_service = s.in_service - moved;
    s.provisionally_excluded = s.provisionally_excluded - moved;
    s.excluded = s.excluded - moved;
    s.absent = s.absent | moved;
  }
  if ((actions & Action::mark_back) != 0) {
    moved = named.back & s.absent;
    s.absent = s.absent - moved;
    s.excluded = s.excluded | moved;
  }
  if ((actions & (Action::reinstate | Action::rearm)) != 0) {
    const bool reinstates = (actions & Action::reinstate) != 0;
    const SensorSet proven = (named.proven & (s.excluded | s.provisionally_excluded)) - s.readmitted;
    moved = reinstates ? named.units.whole(SensorSet::of(proven.lowest())) & proven : named.reset;
    if (reinstates) s.readmitted = s.readmitted | moved;
    s.excluded = s.excluded - moved;
    s.provisionally_excluded = s.provisionally_excluded - moved;
    s.absent = s.absent - moved;
    s.in_service = s.in_service | moved;
  }
  return moved;
}

}  // namespace PLUMB_ABI
}  // namespace plumb

// What is told of setups, samples, verdicts and records, figure by figure, in an order that stays.
#pragma once

#include "plumb/health/health_monitor.hpp"
#include "trace.hpp"

namespace plumb_replay {
inline namespace PLUMB_ABI {

void tell_setup(Trace& trace, const plumb::MonitorSetup& setup);
void tell_sample(Trace& trace, const plumb::Sample& sample, int sensors);
void tell_verdict(Trace& trace, const plumb::Verdict& verdict, int sensors);
void tell_record(Trace& trace, const plumb::TransitionRecord& record);
void tell_counters(Trace& trace, const plumb::MonitorCounters& counters);
void tell_model(Trace& trace, const plumb::SensorModel& model, const plumb::SensorArray& array);
void tell_error(Trace& trace, const plumb::Error& error);
/// Every stored figure of the monitor by its number in the list of tests/health/snapshot_format.txt, for the text
/// alone.
void tell_memory(Trace& trace, const plumb::HealthMonitor& monitor);

/// Scalars of a verdict, and those of them that `tell_verdict` tells: equal, or a field is not compared.
struct FieldCount {
  std::uint64_t there = 0, told = 0;
};
FieldCount count_verdict_fields();

}  // namespace PLUMB_ABI
}  // namespace plumb_replay

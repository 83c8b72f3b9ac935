/// A plan and a spec as scenarios: what the simulator plays, and what is stated to the monitor. Built
/// for every capacity (private to src/campaign).
#pragma once

#include "plumb/campaign/plan.hpp"
#include "plumb/health/health_monitor.hpp"
#include "plumb/scenario/scenario.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace campaign_kernel {

using campaign::AttitudePlan;
using campaign::Plan;
using campaign::Spec;
using campaign::ToolPlan;

Datasheet datasheet_of(const ToolPlan& tool) noexcept;

/// The tool as it really is in this scenario.
scenario::Tool tool_of(const Plan& plan, const Spec& spec, const Datasheet& datasheet) noexcept;

double true_gravity_mps2(const Plan& plan, const Spec& spec) noexcept;

scenario::Fault fault_of(const campaign::SpecFault& fault) noexcept;

/// Where gravity points at a station counted from 0, in the tool frame.
Vec3 direction_at(const AttitudePlan& attitude, int station, int stations, const scenario::Stream& stream) noexcept;

/// Time of the first sample: after the stations of validation, where a scenario begins with a validated monitor.
double start_s(const Plan& plan) noexcept;

/// The stations at which a tool is validated before a scenario begins, noise and all.
Spec trust_spec(const Plan& plan, int tool) noexcept;

/// The whole scenario for `scenario::Simulator`, directions spelled out.
scenario::Scenario scenario_of(const Plan& plan, const Spec& spec, double from_s);

/// What the monitor of this tool gets as configuration.
Expected<MonitorSetup> setup_of(const Plan& plan, int tool) noexcept;

/// How the calibrated axes have turned together beside the true ones: unobservable, so no claim is made about it. To
/// first order, which is enough for the milliradians that calibration leaves.
Vec3 common_turn_rad(const scenario::Tool& tool) noexcept;

}  // namespace campaign_kernel
}  // namespace PLUMB_ABI
}  // namespace plumb

// The tools that are attacked: what the monitor knows of each, and what is true.
#pragma once

#include <vector>

#include "laws/law_case.hpp"

namespace plumb_bench {
inline namespace PLUMB_ABI {

/// Noise of one sample of the tools of the pool: 0.2 mg.
inline constexpr double kPoolSigma_mps2 = 2e-4 * plumb::kG0_mps2;
inline constexpr double kMilligee_mps2 = 1e-3 * plumb::kG0_mps2;

/// A tool, and how its frame is turned against that of the calibrated axes: no test sees that, and no bound covers it.
struct AttackTool {
  plumb_test::LawTool law;
  plumb::Mat3 turn{1, 0, 0, 0, 1, 0, 0, 0, 1};  ///< from the true frame to that of the calibrated axes
  int n() const { return law.n(); }
  const plumb::SensorArray& array() const { return law.tool.array; }
  plumb::Vec3 seen(const plumb::Vec3& direction) const { return plumb::times(turn, direction); }
};
AttackTool attack_tool(plumb_test::LawTool tool);
/// What its calibration is wrong by in the length of a triple, over what it is bounded by: the bound holds for 99 % of
/// fits, and what plumb promises holds within it.
double worst_error(const plumb_test::LawTool& tool);

/// Tools of n sensors: two named geometries, each known exactly and by three fits over 24 attitudes of 32 samples. The
/// same in every run.
const std::vector<AttackTool>& pool(int n);
const AttackTool& any_tool(int n, plumb_test::TrialNoise& noise);
const AttackTool& exact_named_tool(int n);
/// Errors of rows and offsets drawn from one sigma, and another one stated.
AttackTool misstated_tool(int n, double actual_mps2, double stated_mps2, plumb_test::TrialNoise& noise);
AttackTool tool_with_axes(const plumb::AxisList& axes, int n);

}  // namespace PLUMB_ABI
}  // namespace plumb_bench

// The same costs in the hands of Ceres. Each starts from the datasheet and returns the cost it reached, counted as
// plumb counts it.
#pragma once

#include "calibration_bench.hpp"

namespace plumb_bench {
inline namespace PLUMB_ABI {

/// Forward model: W, b and one unit vector a station, Schur complement, derivatives by hand.
double ceres_forward(const Problem& problem);
/// Forward model with the unit vectors eliminated by hand: norm and parity residual of 16 parameters.
double ceres_eliminated(const Problem& problem);
/// The paper's cost, 20 parameters (12 for the first three sensors), normal equations, derivatives by hand.
double ceres_paper(const Problem& problem);
double ceres_paper_triple(const Problem& problem);
/// The same by ceres::TinySolver with automatic derivatives, in prior units.
double tiny_paper(const Problem& problem);
double tiny_paper_triple(const Problem& problem);

}  // namespace PLUMB_ABI
}  // namespace plumb_bench

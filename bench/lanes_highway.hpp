/// The rival of detection/lanes: the same kernel written with Google Highway.
#pragma once

#include <cstdint>

#include "plumb/detection/combination_mae.hpp"

namespace plumb_bench {
inline namespace PLUMB_ABI {

/// As `replace_side_by_side` with as many lanes as this processor has, chosen by Highway.
int replace_by_highway(const plumb::SensorArray& array, const double* y_mps2, double g_mps2, std::int32_t* slots,
                       std::int64_t* sums, plumb::TripleRange range);

}  // namespace PLUMB_ABI
}  // namespace plumb_bench

/// How much noise the tests in motion allow for.
#pragma once

#include "plumb/motion/motion_setup.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

/// So many sigmas does noise stay within in a test that is made once per block pair: the hourly rate of false alarms
/// over all `sets` and both rotation terms, and over the comparison of two gyros, in all scales.
double motion_noise_quantile(const MotionSetup& setup, int sets) noexcept;

}  // namespace PLUMB_ABI
}  // namespace plumb

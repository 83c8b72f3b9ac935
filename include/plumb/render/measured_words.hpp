/// Depths and angles as people read them: to the digits that they have. Files for machines keep all.
#pragma once

#include <string>

#include "plumb/core/config.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {

/// Measured depth in m to the centimetre, however deep: "12345.67"; "-" where it is not known.
std::string depth_words(double depth_m);

/// An angle in deg to the digits that its standard deviation earns: those of two significant digits of it. "32.684" for
/// 0.012, "33" for 1.2; three decimals where none is known; "-" where the angle is not.
std::string angle_words(double angle_deg, double sigma_deg);
/// "32.684 ± 0.012"
std::string angle_with_sigma(double angle_deg, double sigma_deg);

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb

/// The calibration file of imu_tk (private to src/coefficients).
#pragma once

#include <string>

#include "plumb/coefficients/coefficient_file.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace coefficients {

/// Numbers in an imu_tk file: two matrices and a vector.
inline constexpr std::size_t kImuTkNumbers = 21;

/// Whether the text holds as many numbers as a file of imu_tk, and nothing else.
bool looks_like_imu_tk(const std::string& text);
/// a = T K (reading - b). Throws a Refusal.
ChipCoefficients parse_imu_tk(const std::string& text, const std::string& path, int number);
/// The text of a chip whose readings are log values.
std::string imu_tk_text(const ChipCoefficients& chip);

}  // namespace coefficients
}  // namespace PLUMB_ABI
}  // namespace plumb

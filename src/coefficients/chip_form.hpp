/// Between the coefficients of a chip and those of its sensors in plumb's model, raw = scale (a + bias) with a along
/// the sensor's axis (private to src/coefficients).
#pragma once

#include <vector>

#include "../io/refusal.hpp"
#include "plumb/coefficients/chip_places.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace coefficients {

/// Rows of the inverse; all zero where there is none.
Mat3 inverse_of(const Mat3& m) noexcept;

/// What the sensors of a chip are by its coefficients; of those that are in the array. Throws a Refusal where the axes
/// of the chip depend on one another and its nominal axes are no frame.
std::vector<SensorStatement> sensors_of(const io::ArrayFile& array, const ChipCoefficients& chip,
                                        const ChipPlace& place);

/// The other way round, axis by axis: what m/s^2 readings need. Temperature terms and axes are not in it.
ChipCoefficients diagonal_chip(const io::ArrayFile& array, const SensorModel& model, const ChipPlace& place);

/// The other way round with the axes, for values of the log, in the frame of the nominal axes. Throws as `sensors_of`,
/// and where the three axes lie in one plane.
ChipCoefficients full_chip(const io::ArrayFile& array, const SensorModel& model, const SensorArray& axes,
                           const ChipPlace& place);

}  // namespace coefficients
}  // namespace PLUMB_ABI
}  // namespace plumb

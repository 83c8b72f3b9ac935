/// What a form of others cannot hold of a calibration (private to src/coefficients).
#pragma once

#include <vector>

#include "plumb/coefficients/calibration_export.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace coefficients {

/// The axis where it is not the nominal one.
void lose_axis(const io::ArrayFile& array, const Calibration& calibration, int sensor, std::vector<ExportLoss>& out);

/// The drift of bias and scale over the temperatures of the calibration.
void lose_drift(const io::ArrayFile& array, const Calibration& calibration, int sensor, std::vector<ExportLoss>& out);

/// The sigmas of a table, which hold for each sensor by itself: what the covariance of all sensors together does not
/// exceed in any combination. `factor` receives by how much they had to be widened for that, 1 where the covariance
/// is that of such sigmas. Empty where the calibration states none.
std::vector<Uncertainty> separate_sigmas(const SensorArray& array, double& factor);

}  // namespace coefficients
}  // namespace PLUMB_ABI
}  // namespace plumb

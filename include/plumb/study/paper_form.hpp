/// A calibration in the paper's parameters: bias, scale factor and misalignments m_ij of eqs (1)-(3), so that fits of
/// different kinds can be laid side by side.
#pragma once

#include <array>
#include <optional>

#include "plumb/calibration/paper_calibration.hpp"
#include "plumb/scenario/truth.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace study {

/// Sensors in one common frame: V_i = SF_i (h_i . g + B_i), axes of unit length.
struct CommonFrame {
  std::array<double, kCapacity> scale{};  ///< raw unit per m/s^2
  std::array<double, kCapacity> bias_mps2{};
  std::array<Vec3, kCapacity> axis{};
};

CommonFrame frame_of(const Calibration& calibration) noexcept;
/// From `Calibrator::parameters`.
CommonFrame frame_of(const Datasheet& datasheet, const std::array<double, kFitParameters>& parameters) noexcept;
/// What is really the case, turned so that the true axes lie as near to the nominal ones as one rotation allows:
/// gravity cannot tell how the array as a whole sits in its housing.
CommonFrame frame_of(const scenario::Tool& tool) noexcept;

/// The parameters of eq (3), in the order of `PaperParameters`, that turn the raw values of the sensors `used` into
/// accelerations along the nominal axes (calibration note 8). Three sensors: the row scale of I - M is taken up by the
/// scale factors. Four: one set of misalignments does it, and the scale factors and biases stay. Nothing for any other
/// number, or where the axes have rank < 3.
std::optional<PaperParameters> paper_form(const Datasheet& datasheet, const CommonFrame& frame,
                                          SensorSet used) noexcept;

/// Places within PaperParameters of n sensors, as positions among the fitted ones.
constexpr std::size_t bias_index(int i) noexcept { return static_cast<std::size_t>(i); }
constexpr std::size_t scale_index(int n, int i) noexcept { return static_cast<std::size_t>(n + i); }
constexpr std::size_t misalignment_index(int n, int i, int j) noexcept {
  return static_cast<std::size_t>(2 * n + i * (n - 1) + (j < i ? j : j - 1));
}

}  // namespace study
}  // namespace PLUMB_ABI
}  // namespace plumb

/// A calibration in the paper's parameters: bias, scale factor and misalignments m_ij, so that fits of
/// different kinds can be laid side by side.
#pragma once

#include <array>
#include <optional>

#include "plumb/paper/paper_calibration.hpp"
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

/// `plumb::paper_form` (calibration/paper_parameters.hpp) of the sensors `used` by themselves, in the order of
/// `PaperParameters`. Nothing for any number but 3 and 4, or where it refuses.
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
